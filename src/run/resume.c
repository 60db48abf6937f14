// SPDX-License-Identifier: MIT
#include "run/resume.h"
#include "image/png.h"
#include "run/sequence.h"

#include <stdlib.h>
#include <unistd.h>

static bool picture_is_whole(const Target *target, int frame, const RunParams *run)
{
    char *name = target_name_frame(target, frame);
    bool whole =
        name && png_is_whole(name, run->size[0], run->size[1], run->background[3] < 1 ? 4 : 3);
    free(name);
    return whole;
}

static bool file_is_there(const Target *target, int frame)
{
    char *name = target_name_frame(target, frame);
    bool there = name && access(name, R_OK) == 0;
    free(name);
    return there;
}

static Result find_files(Resume *resume, const RunParams *run, int last, const Target *pictures,
                         const Target *hair, Error *error)
{
    bool draws = *run->output != 0, exports = *run->export != 0;
    if (!draws && !exports) return RESULT_OK; // a cache alone knows itself
    resume->done = calloc((size_t)last + 1, sizeof *resume->done);
    if (!resume->done) return error_set(error, RESULT_FAILED, "no memory for %d frames", last);
    for (int frame = run->first; frame <= last; frame += run->every) {
        if (!sequence_draws_frame(run, frame)) continue;
        resume->done[frame] = (!draws || picture_is_whole(pictures, frame, run)) &&
                              (!exports || file_is_there(hair, frame));
        resume->count += resume->done[frame];
    }
    return RESULT_OK;
}

Result resume_find(Resume *resume, const RunParams *run, int last, Error *error)
{
    Target pictures = {0}, hair = {0};
    *resume = (Resume){0};
    Result result = *run->output ? target_parse(&pictures, run->output, error) : RESULT_OK;
    if (result == RESULT_OK && *run->export) result = format_target(&hair, run->export, error);
    bool video = result == RESULT_OK && *run->output && pictures.kind == TARGET_VIDEO;
    bool whole = video || (result == RESULT_OK && *run->export && hair.kind == TARGET_VIDEO);
    if (whole && !*run->cache)
        result = error_set(error, RESULT_USAGE,
                           "--resume: %s: it is written in one piece; with --cache at least its "
                           "simulation can be resumed",
                           video ? run->output : run->export);
    if (result == RESULT_OK && !whole)
        result = find_files(resume, run, last, &pictures, &hair, error);
    target_destroy(&pictures);
    target_destroy(&hair);
    return result;
}

void resume_destroy(Resume *resume)
{
    free(resume->done);
    *resume = (Resume){0};
}
