// SPDX-License-Identifier: MIT
#include "gen/gen_output.h"

StrandsKind gen_output_kind(const GenOutput *output)
{
    static const StrandsKind kinds[] = {STRANDS_TFX2_TEXT, STRANDS_TFX3, STRANDS_TFX4,
                                        STRANDS_HAIR};
    return kinds[output->format];
}

Result gen_output_write(const GenOutput *output, const Strands *strands, uint32_t guides,
                        Error *error)
{
    StrandsKind kind = gen_output_kind(output);
    Result result = strands_write(output->path, kind, strands, error);
    if (result != RESULT_OK || output->quiet) return result;
    printf("%s: %u strands of %u vertices, ", output->path, strands->strand_count,
           strands_size(strands, 0));
    if (guides) printf("%u of them guides, ", guides);
    printf("%s\n", strands_kind_name(kind));
    return RESULT_OK;
}
