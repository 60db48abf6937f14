// SPDX-License-Identifier: MIT
#include "formats/strands_numbered.h"

#include "base/target.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// Whether the path is a pattern: it has %d or %04d, and no file has this name.
static bool is_numbered(const char *path)
{
    return strchr(path, '%') && access(path, F_OK) != 0;
}

static Result read_one(Strands *strands, const Target *target, int number,
                       const StrandsReadOptions *options, StrandsReport *report, Error *error)
{
    char *name = target_name_frame(target, number);
    if (!name) return error_set(error, RESULT_FAILED, "no memory for a name");
    Result result = strands_read(strands, name, options, report, error);
    free(name);
    return result;
}

static bool same_strands(const Strands *a, const Strands *b)
{
    return a->strand_count == b->strand_count && a->vertex_count == b->vertex_count &&
           memcmp(a->first, b->first, ((size_t)a->strand_count + 1) * sizeof *a->first) == 0;
}

static Result read_frames(const Strands *first, StrandsFrames *frames, const Target *target,
                          const StrandsReadOptions *options, Error *error)
{
    size_t each = first->vertex_count;
    Result result = RESULT_OK;
    frames->position = malloc((size_t)frames->count * each * sizeof *frames->position + 1);
    if (!frames->position)
        return error_set(error, RESULT_FAILED, "no memory for %u frames of hair", frames->count);
    memcpy(frames->position, first->position, each * sizeof *first->position);
    for (uint32_t i = 1; i < frames->count && result == RESULT_OK; ++i) {
        Strands next;
        int number = frames->first + (int)i;
        result = read_one(&next, target, number, options, NULL, error);
        if (result == RESULT_OK && !same_strands(&next, first))
            result = error_set(error, RESULT_BAD_INPUT,
                               "%s%d%s: other strands than in the first file: expected the same "
                               "strands in all frames",
                               target->before, number, target->after);
        if (result == RESULT_OK)
            memcpy(frames->position + i * each, next.position, each * sizeof *next.position);
        strands_destroy(&next);
    }
    return result;
}

static Result read_pattern(Strands *strands, StrandsFrames *frames, const Target *target,
                           const char *path, const StrandsReadOptions *options,
                           StrandsReport *report, Error *error)
{
    TargetNumbers numbers = {.last = -1};
    if (target->kind == TARGET_FRAMES) numbers = target_find_numbers(target);
    if (numbers.last < 0)
        return error_set(error, RESULT_BAD_INPUT,
                         "%s: no file has such a name: expected frames as x_0000.tfx", path);
    if (numbers.last - numbers.first + 1 != numbers.count)
        return error_set(error, RESULT_BAD_INPUT,
                         "%s: %d files from %d to %d: expected all numbers between", path,
                         numbers.count, numbers.first, numbers.last);
    StrandsReadOptions same = *options;
    TRY(read_one(strands, target, numbers.first, options, report, error));
    same.unit = report->unit_used;
    same.up = report->up_z ? UP_Z : UP_Y;
    same.recenters = false;
    same.origin = strands->origin;
    report->samples = (uint32_t)numbers.count;
    report->all_samples = frames != NULL;
    if (!frames || numbers.count < 2) return RESULT_OK;
    *frames = (StrandsFrames){.count = (uint32_t)numbers.count,
                              .vertices = strands->vertex_count,
                              .first = numbers.first};
    return read_frames(strands, frames, target, &same, error);
}

static Result read_numbered(Strands *strands, StrandsFrames *frames, const char *path,
                            const StrandsReadOptions *options, StrandsReport *report, Error *error)
{
    const StrandsReadOptions defaults = {0};
    StrandsReport unwanted;
    Target target = {0};
    *strands = (Strands){0};
    Result result = target_parse_any(&target, path, error);
    THEN(result, read_pattern(strands, frames, &target, path, options ? options : &defaults,
                              report ? report : &unwanted, error));
    if (result != RESULT_OK) {
        strands_destroy(strands);
        if (frames) strands_frames_destroy(frames);
    }
    target_destroy(&target);
    return result;
}

Result strands_read_any(Strands *strands, StrandsFrames *frames, const char *path,
                        const StrandsReadOptions *options, StrandsReport *report, Error *error)
{
    return (is_numbered(path) ? read_numbered : strands_read_frames)(strands, frames, path, options,
                                                                     report, error);
}
