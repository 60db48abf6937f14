// SPDX-License-Identifier: MIT
#include "gen/gen_output.h"

Result gen_output_write(const GenOutput *output, const Strands *strands, uint32_t guides,
                        Error *error)
{
    TRY(format_write(output->path, (FormatKind)output->format, strands, error));
    if (output->quiet) return RESULT_OK;
    printf("%s: %u strands of %u vertices, ", output->path, strands->strand_count,
           strands_size(strands, 0));
    if (guides) printf("%u of them guides, ", guides);
    printf("%s\n", FORMAT_TABLE[output->format]->name);
    return RESULT_OK;
}
