// SPDX-License-Identifier: MIT
#include "gen/gen_output.h"
#include "base/target.h"

// Whether the path names an image or a video.
static bool names_image(const char *path)
{
    Target target = {0};
    bool image = target_parse(&target, path, NULL) == RESULT_OK && target.kind != TARGET_FRAMES &&
                 !target.stream;
    target_destroy(&target);
    return image;
}

Result gen_choose_format(GenOutput *output, Error *error)
{
    char suffixes[200];
    FormatKind kind = output->path ? format_choose(output->path, NULL) : FORMAT_KINDS;
    if (output->format >= 0) return RESULT_OK;
    output->format = kind < FORMAT_KINDS ? kind : FORMAT_TFX4;
    if (kind < FORMAT_KINDS || !output->path || !names_image(output->path)) return RESULT_OK;
    format_list_suffixes(suffixes, sizeof suffixes);
    return error_set(error, RESULT_USAGE,
                     "%s: an image, not hair: expected a name ending in %s (tractrix-render draws "
                     "the hair)",
                     output->path, suffixes);
}
