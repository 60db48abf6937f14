// SPDX-License-Identifier: MIT
#include "run/resume.h"
#include "base/bytes.h"
#include "base/target.h"
#include "draw/renderer_options.h"
#include "formats/format.h"
#include "image/exr_file.h"
#include "image/pfm.h"
#include "image/png.h"
#include "run/record.h"
#include "run/sequence.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// What a resumed run looks for.
typedef struct Search {
    const RunParams *run;
    const Fingerprint *fingerprint;
    Target images, hair;              // empty if the run does not write any
    Record image_record, hair_record; // for formats without text chunks
    FramesDone *done;
} Search;

static Result parse_targets(Target *images, Target *hair, const RunParams *run, Error *error)
{
    *images = *hair = (Target){0};
    if (*run->output) TRY(target_parse(images, run->output, error));
    return *run->export ? format_target(hair, run->export, error) : RESULT_OK;
}

static bool is_whole(const Target *target)
{
    return target->before && target->kind == TARGET_VIDEO;
}

Result resume_check(const RunParams *run, Error *error)
{
    Target images, hair;
    Result result = parse_targets(&images, &hair, run, error);
    if (result == RESULT_OK && !*run->cache && (is_whole(&images) || is_whole(&hair)))
        result = error_set(error, RESULT_USAGE,
                           "--resume: %s: is written in one piece: expected one file per frame, or "
                           "--cache to resume the simulation",
                           is_whole(&images) ? run->output : run->export);
    if (result == RESULT_OK && images.before && images.format == TARGET_JPEG)
        result = error_set(error, RESULT_USAGE,
                           "--resume: %s: a JPEG file does not say how it was rendered: expected "
                           "PNG",
                           run->output);
    target_destroy(&images);
    target_destroy(&hair);
    return result;
}

// --- One image.

static Result decode(Image *image, ImageTexts *texts, const Bytes *file, TargetFormat format,
                     const char *path, Error *error)
{
    if (format == TARGET_PFM) return pfm_decode(image, file, path, error);
    TRY(format == TARGET_PNG ? png_decode_deep(image, file, path, error)
                             : exr_file_decode(image, file, path, error));
    return format == TARGET_PNG ? png_decode_texts(texts, file, path, error)
                                : exr_file_decode_texts(texts, file, path, error);
}

static Result refuse(const char *name, Error *why, const char *kind, const char *was,
                     const char *expected)
{
    return error_set(why, RESULT_FAILED, "%.300s: %s %.200s, expected %.200s", name, kind, was,
                     expected);
}

static Result compare_form(const Search *search, const Image *image, const char *name, Error *why)
{
    static const char *const DEPTHS[] = {"8 bits", "16 bits", "floats"};
    const RunParams *run = search->run;
    const Target *target = &search->images;
    ImageKind kind = target->floats ? IMAGE_FLOAT : run->depth == DEPTH_16 ? IMAGE_16 : IMAGE_8;
    bool alpha =
        target->format == TARGET_EXR || (renderer_options_channels(run) == 4 && !target->floats);
    char was[40], expected[40];
    snprintf(was, sizeof was, "%d x %d pixels", image->width, image->height);
    snprintf(expected, sizeof expected, "%d x %d", run->size[0], run->size[1]);
    if (image->width != run->size[0] || image->height != run->size[1])
        return refuse(name, why, "has", was, expected);
    if (image->kind != kind) return refuse(name, why, "has", DEPTHS[image->kind], DEPTHS[kind]);
    if (image->channels != (alpha ? 4 : 3))
        return refuse(name, why, "has", alpha ? "no transparency" : "transparency",
                      alpha ? "some" : "none");
    return RESULT_OK;
}

static Result compare_texts(const Search *search, const ImageTexts *texts, int frame,
                            const char *name, Error *why)
{
    const char *scene = image_texts_find(texts, FINGERPRINT_KEY);
    char expected[FINGERPRINT_BYTES];
    fingerprint_of_image(expected, search->fingerprint, frame);
    if (search->image_record.lines)
        return record_compare(&search->image_record, frame, name, expected, why);
    if (!scene)
        return error_set(why, RESULT_FAILED, "%.300s: does not say how it was rendered", name);
    for (size_t i = 0; i < FINGERPRINT_ORIGIN_COUNT; ++i) {
        const char *was = image_texts_find(texts, FINGERPRINT_ORIGIN[i]);
        const char *is = image_texts_find(&search->fingerprint->origin, FINGERPRINT_ORIGIN[i]);
        if (!was || !is || strcmp(was, is) != 0)
            return refuse(name, why, "was drawn by", was ? was : "something else", is ? is : "");
    }
    if (strcmp(scene, expected) == 0) return RESULT_OK;
    return error_set(why, RESULT_FAILED, "%.300s: was made with other parameters or input files",
                     name);
}

// RESULT_OK if the file exists and has what this run would write.
static Result compare_image(const Search *search, int frame, const char *name, Error *why)
{
    Bytes file = {0};
    Image image = {0};
    ImageTexts texts = {0};
    Result result = bytes_read_plain(&file, name, why);
    THEN(result, decode(&image, &texts, &file, search->images.format, name, why));
    THEN(result, compare_form(search, &image, name, why));
    THEN(result, compare_texts(search, &texts, frame, name, why));
    bytes_destroy(&file);
    image_destroy(&image);
    image_texts_destroy(&texts);
    return result;
}

// --- All frames.

static void note_stale(FramesDone *done, const Error *why)
{
    if (!done->stale++) done->why = *why;
}

// Hair files are not decoded: the record has the file's checksum, so an unchanged file is a
// complete one.
static Result compare_hair(const Search *search, int frame, const char *name, Error *why)
{
    char expected[FINGERPRINT_BYTES];
    fingerprint_of_hair(expected, search->fingerprint, frame);
    if (search->hair_record.lines)
        return record_compare(&search->hair_record, frame, name, expected, why);
    return error_set(why, RESULT_FAILED, "%.300s: there is no record of how it was rendered", name);
}

// Whether the frame's file of this target is done. False also if memory is short.
static bool is_done(const Search *search, const Target *target, int frame)
{
    Error why = {{0}};
    if (!target->before) return true;
    char *name = target_name_frame(target, frame);
    bool there = name && access(name, F_OK) == 0;
    bool good = there && (target == &search->hair ? compare_hair : compare_image)(
                             search, frame, name, &why) == RESULT_OK;
    if (there && !good) note_stale(search->done, &why);
    free(name);
    return good;
}

static Result find_files(const Search *search, int last, Error *error)
{
    const RunParams *run = search->run;
    FramesDone *done = search->done;
    if (!*run->output && !*run->export) return RESULT_OK; // a cache knows which frames it has
    done->done = calloc((size_t)last + 1, sizeof *done->done);
    if (!done->done) return error_set(error, RESULT_FAILED, "no memory for %d frames", last);
    for (int frame = run->first; frame <= last; frame += run->every) {
        if (!sequence_draws_frame(run, frame)) continue;
        bool image = is_done(search, &search->images, frame),
             hair = is_done(search, &search->hair, frame);
        done->done[frame] = image && hair;
        done->count += image && hair;
    }
    return RESULT_OK;
}

Result resume_find(FramesDone *done, const RunParams *run, int last, const Fingerprint *fingerprint,
                   Error *error)
{
    Search search = {.run = run, .fingerprint = fingerprint, .done = done};
    *done = (FramesDone){0};
    Result result = parse_targets(&search.images, &search.hair, run, error);
    search.images.offset = search.hair.offset = run->frame_number.value;
    bool whole = is_whole(&search.images) || is_whole(&search.hair);
    if (result == RESULT_OK && search.images.kind == TARGET_FRAMES &&
        search.images.format == TARGET_PFM)
        result = record_read(&search.image_record, &search.images, last, error);
    if (result == RESULT_OK && search.hair.before && search.hair.kind == TARGET_FRAMES)
        result = record_read(&search.hair_record, &search.hair, last, error);
    if (result == RESULT_OK && !whole) result = find_files(&search, last, error);
    record_destroy(&search.image_record);
    record_destroy(&search.hair_record);
    target_destroy(&search.images);
    target_destroy(&search.hair);
    return result;
}

void resume_destroy(FramesDone *done)
{
    free(done->done);
    *done = (FramesDone){0};
}
