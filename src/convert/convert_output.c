// SPDX-License-Identifier: MIT
#include "convert/convert_output.h"

#include "formats/format.h"
#include "strands/paint.h"
#include "strands/strands.h"
#include "strands/strands_edit.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

// --- The name.

static const char *suffix_of(const char *path)
{
    const char *dot = strrchr(path, '.'), *slash = strrchr(path, '/');
    return dot && (!slash || dot > slash) ? dot : "";
}

static bool is_npz(const char *path, int format)
{
    return format ? format - 1 == FORMAT_NPZ : strcasecmp(suffix_of(path), ".npz") == 0;
}

// With --format any name is allowed.
static Result parse_target(ConvertOutput *output, Error *error)
{
    if (!output->format && strcmp(output->path, "-") == 0)
        return error_set(error, RESULT_USAGE,
                         "-: standard output has no suffix: expected --format");
    if (!output->format) return format_target(&output->target, output->path, error);
    TRY(target_parse_any(&output->target, output->path, error));
    if (FORMAT_TABLE[output->format - 1]->animated && output->target.kind == TARGET_STILL)
        output->target.kind = TARGET_VIDEO;
    return RESULT_OK;
}

bool convert_output_is_still(const char *path, int format)
{
    ConvertOutput output = {.path = path, .format = format};
    bool still = parse_target(&output, NULL) != RESULT_OK || output.target.kind == TARGET_STILL;
    target_destroy(&output.target);
    return still && !is_npz(path, format);
}

Result convert_output_open(ConvertOutput *output, int frame_count, Error *error)
{
    TRY(parse_target(output, error));
    if (output->animated && output->target.kind == TARGET_STILL &&
        is_npz(output->path, output->format))
        output->target.kind = TARGET_VIDEO;
    if (output->target.kind == TARGET_STILL && frame_count > 1)
        return error_set(error, RESULT_USAGE,
                         "%s: one file name for %d frames: expected a frame number in the name "
                         "(x_%%04d%s), or .usda, .abc or .npz",
                         output->path, frame_count, suffix_of(output->path));
    return target_prepare(&output->target, error);
}

void convert_output_close(ConvertOutput *output)
{
    frames_file_discard(&output->frames);
    strands_destroy(&output->still);
    target_destroy(&output->target);
    free(output->widths);
    *output = (ConvertOutput){0};
}

// --- Output for scenes (curves with widths), and files that hold all frames.

// A diameter for each strand, in proportion to the file's thickness, or one for all strands if the
// file has no thickness by strand.
static Result find_widths(ConvertOutput *output, const Strands *strands, CurvesLook *look,
                          Error *error)
{
    double width = output->width > 0 ? output->width / output->unit
                                     : 2 * (double)paint_auto_radius(strands, 0);
    const float *thickness = strands->strand_thickness;
    uint32_t count = thickness ? strands->strand_count : 1;
    double mean = 0;
    if (strands->vertex_thickness && output->width <= 0) return RESULT_OK;
    free(output->widths);
    output->widths = malloc(((size_t)count + 1) * sizeof *output->widths);
    if (!output->widths) return error_set(error, RESULT_FAILED, "no memory for the widths");
    for (uint32_t s = 0; thickness && s < count; ++s) mean += (double)thickness[s] / count;
    for (uint32_t s = 0; s < count; ++s)
        output->widths[s] = (float)(thickness && mean > 0 ? width * thickness[s] / mean : width);
    look->width = output->widths;
    look->width_rate = thickness ? CURVES_UNIFORM : CURVES_CONSTANT;
    return RESULT_OK;
}

static Result describe(ConvertOutput *output, const Strands *strands, bool animated,
                       CurvesOptions *options, Error *error)
{
    *options = (CurvesOptions){.metres_per_unit = output->unit,
                               .up_z = output->up_z,
                               .animated = animated,
                               .fps = output->fps,
                               .first = output->first,
                               .last = output->last};
    return find_widths(output, strands, &options->look, error);
}

// Keeps the strands of the first frame, because the writer reads their layout and colours for all
// frames.
static Result open_frames(ConvertOutput *output, Strands *strands, Error *error)
{
    CurvesOptions options;
    output->still = *strands;
    *strands = (Strands){0};
    TRY(describe(output, &output->still, output->animated, &options, error));
    return frames_file_open(&output->frames, output->kind, output->target.before, &output->still,
                            &options, error);
}

static bool same_strands(const Strands *a, const Strands *b)
{
    return a->strand_count == b->strand_count &&
           memcmp(a->first, b->first, ((size_t)a->strand_count + 1) * sizeof *a->first) == 0;
}

static Result check_same(const ConvertOutput *output, int frame, const Strands *strands,
                         Error *error)
{
    if (same_strands(&output->still, strands)) return RESULT_OK;
    return error_set(error, RESULT_FAILED,
                     "%s: the strands of frame %d differ from those of frame %d: expected the same "
                     "strands in all frames of a file",
                     output->path, frame, output->first);
}

static Result add_frame(ConvertOutput *output, int frame, Strands *strands, Error *error)
{
    bool begins = !output->frames.strands;
    if (begins)
        TRY(open_frames(output, strands, error));
    else
        TRY(check_same(output, frame, strands, error));
    const Strands *now = begins ? &output->still : strands;
    return frames_file_add(&output->frames, frame, (const float(*)[3])now->position, error);
}

// --- Output of any kind.

static Result write_file(ConvertOutput *output, int frame, const Strands *strands, Error *error)
{
    CurvesOptions options;
    char *name = target_name_frame(&output->target, frame);
    if (!name) return error_set(error, RESULT_FAILED, "no memory for the name of a frame");
    Result result = RESULT_OK;
    if (frames_file_has_look(output->kind)) {
        result = describe(output, strands, false, &options, error);
        THEN(result, frames_file_write_still(output->kind, name, strands, &options, error));
    } else {
        result = format_write(name, output->kind, strands, error);
    }
    output->files += result == RESULT_OK;
    free(name);
    return result;
}

Result convert_output_add(ConvertOutput *output, int frame, Strands *strands, Error *error)
{
    if (strands->strand_count == 0)
        return error_set(error, RESULT_FAILED, "%s: no strands to write", output->path);
    output->kind =
        output->format ? (FormatKind)output->format - 1 : format_choose(output->path, strands);
    // Only scene files have transforms, which hold an origin exactly.
    if (!frames_file_has_look(output->kind)) strands_give_back_origin(strands);
    strands_to_unit(strands, output->unit, output->up_z);
    output->lost |= strands_features(strands) & ~FORMAT_TABLE[output->kind]->features;
    if (output->target.kind == TARGET_VIDEO) return add_frame(output, frame, strands, error);
    return write_file(output, frame, strands, error);
}

Result convert_output_finish(ConvertOutput *output, Error *error)
{
    if (!output->frames.strands) return RESULT_OK;
    Result result = frames_file_finish(&output->frames, error);
    output->files += result == RESULT_OK;
    return result;
}
