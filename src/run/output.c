// SPDX-License-Identifier: MIT
#include "run/output.h"

#include "base/bytes.h"
#include "base/clock.h"
#include "base/interrupt.h"
#include "base/target.h"
#include "image/pfm.h"
#include "image/png.h"
#include "run/record.h"
#include "run/video.h"
#include "run/y4m.h"

#include <assert.h>
#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

// One image is drawn, one encoded, one waits: more helps only if the times vary a lot from frame to
// frame.
#define QUEUE_LENGTH_DEFAULT 3
// How soon a wait sees an interrupt.
#define WAIT_SLICE_NS 20000000

typedef enum SlotState { SLOT_FREE, SLOT_LENT, SLOT_QUEUED } SlotState;

typedef struct Slot {
    Image image; // first, so that an image lent out leads back to its slot
    OutputExtra extra;
    SlotState state;
    int frame;
} Slot;

struct Output {
    Target target;
    Video *video; // NULL unless ffmpeg writes a video
    Y4m y4m;      // the worker's
    bool exr_float;
    ImageSheet sheet; // empty unless a contact sheet is; the worker's
    ImageTexts texts; // the worker's
    bool has_texts;
    Slot *slots;
    Slot **queue; // ring of `slot_count`, so there is always room
    int slot_count;
    char *description;

    pthread_t worker;
    bool has_worker;
    pthread_mutex_t mutex; // guards all that follows, and the slots' states
    pthread_cond_t changed;
    int queue_first, queued;
    int submitted, frame_first, frame_last;
    bool closing;  // no more frames will come
    bool aborting; // the frames that wait are not wanted
    bool ended;    // the worker has done all it will do
    Result result; // the worker's failure and what it says
    Error failure;
    OutputCounters counters;
};

// Of a sheet the first and the last. `extra`: NULL: a sheet has none.
static Result set_texts(Output *output, int frame, const OutputExtra *extra, Error *error)
{
    char text[40];
    if (!output->has_texts) return RESULT_OK;
    if (output->sheet.columns)
        snprintf(text, sizeof text, "%d-%d", output->frame_first, output->frame_last);
    else
        snprintf(text, sizeof text, "%d", frame);
    TRY(image_texts_set(&output->texts, "Frame", text, error));
    if (!extra || !*extra->scene) return RESULT_OK;
    return image_texts_set(&output->texts, FINGERPRINT_KEY, extra->scene, error);
}

static Result encode(const Output *output, const Image *image, const OutputExtra *extra,
                     Bytes *file, Error *error)
{
    if (output->target.format == TARGET_PFM) return pfm_encode(image, file, error);
    if (output->target.format == TARGET_PNG) return png_encode(image, &output->texts, file, error);
    ExrFile exr = {.image = image, .floats = output->exr_float, .texts = &output->texts};
    if (extra) {
        exr.layers = extra->layers[0].pixels ? extra->layers : NULL;
        exr.world_to_camera = (const float(*)[4])extra->world_to_camera;
        exr.world_to_ndc = (const float(*)[4])extra->world_to_ndc;
    }
    return exr_file_encode(&exr, file, error);
}

// `extra`: NULL: a sheet has none.
static Result write_image(Output *output, const Image *image, const OutputExtra *extra, int frame,
                          uint64_t *bytes, Error *error)
{
    char *name = target_name_frame(&output->target, frame);
    if (!name) return error_set(error, RESULT_FAILED, "no memory for the name of frame %d", frame);
    Bytes png = {0};
    Result result = set_texts(output, frame, extra, error);
    THEN(result, encode(output, image, extra, &png, error));
    *bytes = png.size;
    if (result == RESULT_OK)
        result = bytes_write_file(&png, name, error);
    else
        error_prefix(error, result, "%s: ", name);
    if (output->target.format == TARGET_PFM && extra && *extra->scene)
        THEN(result, record_add(&output->target, frame, extra->scene, error));
    bytes_destroy(&png);
    free(name);
    return result;
}

static Result take_frame(Output *output, const Slot *slot, uint64_t *bytes, Error *error)
{
    if (output->video) return video_write(output->video, &slot->image, error);
    if (output->y4m.planes) return y4m_write(&output->y4m, &slot->image, error);
    if (!output->sheet.columns)
        return write_image(output, &slot->image, &slot->extra, slot->frame, bytes, error);
    image_sheet_add(&output->sheet, &slot->image);
    return RESULT_OK;
}

// Encodes the oldest frame that waits. Called with the mutex held, which is let go meanwhile.
static Result encode_next(Output *output)
{
    Slot *slot = output->queue[output->queue_first];
    output->queue_first = (output->queue_first + 1) % output->slot_count;
    output->queued--;
    pthread_mutex_unlock(&output->mutex);
    double start_ms = clock_ms();
    uint64_t bytes = 0;
    Error error;
    Result result = take_frame(output, slot, &bytes, &error);
    double encode_ms = clock_ms() - start_ms;
    pthread_mutex_lock(&output->mutex);
    slot->state = SLOT_FREE;
    output->counters.encode_ms += encode_ms;
    if (result == RESULT_OK) {
        output->counters.frames++;
        output->counters.bytes += bytes;
    } else {
        output->failure = error;
    }
    return result;
}

// Completes the one file that all frames have gone to, if there is one.
static Result end_file(Output *output)
{
    bool y4m = output->y4m.planes != NULL;
    if (!output->video && !y4m && !output->sheet.columns) return RESULT_OK;
    pthread_mutex_unlock(&output->mutex);
    double start_ms = clock_ms();
    uint64_t bytes = 0;
    Error error;
    Result result = output->video ? video_finish(output->video, &bytes, &error)
                    : y4m         ? y4m_finish(&output->y4m, &error)
                          : write_image(output, &output->sheet.image, NULL, 0, &bytes, &error);
    if (y4m) bytes = output->y4m.bytes;
    double encode_ms = clock_ms() - start_ms;
    pthread_mutex_lock(&output->mutex);
    output->counters.encode_ms += encode_ms;
    output->counters.bytes += bytes;
    if (result != RESULT_OK) output->failure = error;
    return result;
}

static void *work(void *argument)
{
    Output *output = argument;
    Result result = RESULT_OK;
    pthread_mutex_lock(&output->mutex);
    while (result == RESULT_OK && !output->aborting) {
        if (output->queued > 0)
            result = encode_next(output);
        else if (output->closing)
            break;
        else
            pthread_cond_wait(&output->changed, &output->mutex);
        pthread_cond_broadcast(&output->changed);
    }
    if (result == RESULT_OK && !output->aborting) result = end_file(output);
    output->result = result;
    output->ended = true;
    pthread_cond_broadcast(&output->changed);
    pthread_mutex_unlock(&output->mutex);
    return NULL;
}

// Waits for a change, but not for long. Called with the mutex held.
static Result wait_changed(Output *output, Error *error)
{
    if (interrupt_requested()) return error_set(error, RESULT_INTERRUPTED, "interrupted");
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_nsec += WAIT_SLICE_NS;
    until.tv_sec += until.tv_nsec / 1000000000;
    until.tv_nsec %= 1000000000;
    pthread_cond_timedwait(&output->changed, &output->mutex, &until);
    return RESULT_OK;
}

static Result report_failure(const Output *output, Error *error)
{
    if (output->result == RESULT_OK) return RESULT_OK;
    return error_set(error, output->result, "%s", output->failure.text);
}

static bool is_sheet(const OutputOptions *options)
{
    return options->columns > 1 || options->rows > 1;
}

static Result check_options(const OutputOptions *options, const Target *target, Error *error)
{
    bool sheet = is_sheet(options);
    bool one_png = target->stream && target->format == TARGET_PNG;
    if (sheet && target->kind != TARGET_STILL && !one_png)
        return error_set(error, RESULT_USAGE,
                         "%s: a contact sheet is one image: expected a name ending in .png, .pfm "
                         "or .exr, without a number",
                         options->target);
    bool many = target->kind == TARGET_STILL && !sheet && options->frame_count > 1;
    if (many && target->stream)
        return error_set(error, RESULT_USAGE,
                         "%s: one image for %d frames: expected - (PNG) or -.y4m, or --frames 1",
                         options->target, options->frame_count);
    if (many)
        return error_set(
            error, RESULT_USAGE,
            "%s: one name for %d frames: expected a number in it (frame_%%04d.png), or --frames 1",
            options->target, options->frame_count);
    if (target->format == TARGET_Y4M && options->channels == 4)
        return error_set(error, RESULT_USAGE,
                         "%s: .y4m cannot hold a transparent background, write .webm or PNG frames",
                         options->target);
    if (target->floats != (options->kind == IMAGE_FLOAT) ||
        (target->format >= TARGET_Y4M && options->kind != IMAGE_8))
        return error_set(error, RESULT_USAGE, "%s: cannot store images of this depth",
                         options->target);
    if (options->channels != 3 && options->channels != 4)
        return error_set(error, RESULT_USAGE, "%s: frames of %d channels, expected 3 or 4",
                         options->target, options->channels);
    if (options->width < 1 || options->height < 1)
        return error_set(error, RESULT_USAGE, "%s: frames of %d x %d pixels", options->target,
                         options->width, options->height);
    return RESULT_OK;
}

static Result create_slots(Output *output, const OutputOptions *options, Error *error)
{
    int count = options->queue_length > 0 ? options->queue_length : QUEUE_LENGTH_DEFAULT;
    output->slots = calloc((size_t)count, sizeof *output->slots);
    output->queue = calloc((size_t)count, sizeof *output->queue);
    if (!output->slots || !output->queue)
        return error_set(error, RESULT_FAILED, "no memory for the output's queue");
    output->slot_count = count;
    Result result = RESULT_OK;
    for (int i = 0; i < count && result == RESULT_OK; i++)
        result = image_create_kind(&output->slots[i].image, options->width, options->height,
                                   options->channels, options->kind, error);
    int layers = output->target.format == TARGET_EXR && options->layers ? EXR_LAYERS : 0;
    for (int i = 0; i < count * layers && result == RESULT_OK; i++)
        result = image_create_kind(&output->slots[i / layers].extra.layers[i % layers],
                                   options->width, options->height, 3, IMAGE_FLOAT, error);
    return result;
}

// Signals are the main thread's; with SIGPIPE and SIGXFSZ blocked a write that fails says so by its
// result.
static Result start_worker(Output *output, Error *error)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    int reason = pthread_create(&output->worker, NULL, work, output);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    output->has_worker = reason == 0;
    if (reason == 0) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "cannot start the thread that writes frames: %s",
                     strerror(reason));
}

static Result start_sheet(Output *output, const OutputOptions *options, Error *error)
{
    if (!is_sheet(options)) return RESULT_OK;
    Result result = image_sheet_create(&output->sheet, options->columns, options->rows,
                                       &output->slots[0].image, error);
    return result == RESULT_USAGE ? error_prefix(error, result, "%s: ", options->target) : result;
}

static Result start_video(Output *output, const OutputOptions *options, Error *error)
{
    if (output->target.format == TARGET_PNG) return RESULT_OK; // file after file
    if (output->target.format == TARGET_Y4M)
        return y4m_create(&output->y4m, output->target.before, options->width, options->height,
                          options->fps, error);
    VideoOptions video = {
        .path = output->target.before,
        .width = options->width,
        .height = options->height,
        .channels = options->channels,
        .fps = options->fps,
    };
    return video_create(&output->video, &video, error);
}

static void create_lock(Output *output)
{
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_cond_init(&output->changed, &attributes);
    pthread_condattr_destroy(&attributes);
    pthread_mutex_init(&output->mutex, NULL);
}

Result output_create(Output **output, const OutputOptions *options, Error *error)
{
    *output = NULL;
    Output *created = calloc(1, sizeof *created);
    if (!created) return error_set(error, RESULT_FAILED, "no memory for the output");
    create_lock(created);
    created->has_texts = options->texts != NULL;
    created->exr_float = options->exr_float;
    Result result = target_parse(&created->target, options->target, error);
    THEN(result, check_options(options, &created->target, error));
    THEN(result, image_texts_copy(&created->texts, options->texts, error));
    THEN(result, create_slots(created, options, error));
    THEN(result, start_sheet(created, options, error));
    THEN(result, target_prepare(&created->target, error));
    if (result == RESULT_OK && created->target.kind == TARGET_VIDEO)
        result = start_video(created, options, error);
    THEN(result, start_worker(created, error));
    if (result == RESULT_OK)
        *output = created;
    else
        output_destroy(created);
    return result;
}

static Slot *find_free_slot(Output *output)
{
    for (int i = 0; i < output->slot_count; i++)
        if (output->slots[i].state == SLOT_FREE) return &output->slots[i];
    return NULL;
}

Result output_acquire(Output *output, Image **image, Error *error)
{
    *image = NULL;
    pthread_mutex_lock(&output->mutex);
    Slot *slot = NULL;
    Result result = report_failure(output, error);
    while (result == RESULT_OK && !(slot = find_free_slot(output))) {
        result = wait_changed(output, error);
        THEN(result, report_failure(output, error));
    }
    if (slot) {
        slot->state = SLOT_LENT;
        *image = &slot->image;
    }
    pthread_mutex_unlock(&output->mutex);
    return result;
}

OutputExtra *output_extra(Image *image)
{
    return &((Slot *)image)->extra;
}

Result output_submit(Output *output, int frame_index, Image *image, Error *error)
{
    Slot *slot = (Slot *)image;
    assert(frame_index >= 0);
    pthread_mutex_lock(&output->mutex);
    assert(slot->state == SLOT_LENT && !output->closing);
    Result result = report_failure(output, error);
    if (result == RESULT_OK) {
        slot->state = SLOT_QUEUED;
        slot->frame = frame_index;
        output->queue[(output->queue_first + output->queued++) % output->slot_count] = slot;
        if (output->submitted++ == 0) output->frame_first = frame_index;
        output->frame_last = frame_index;
        pthread_cond_broadcast(&output->changed);
    } else {
        slot->state = SLOT_FREE;
    }
    pthread_mutex_unlock(&output->mutex);
    return result;
}

Result output_finish(Output *output, Error *error)
{
    pthread_mutex_lock(&output->mutex);
    Result result = RESULT_OK;
    if ((output->video || output->y4m.planes) && output->submitted == 0)
        result = error_set(error, RESULT_FAILED, "%s: a video needs at least one frame",
                           output->target.before);
    output->closing = result == RESULT_OK;
    pthread_cond_broadcast(&output->changed);
    while (result == RESULT_OK && !output->ended) result = wait_changed(output, error);
    THEN(result, report_failure(output, error));
    pthread_mutex_unlock(&output->mutex);
    return result;
}

void output_flush(Output *output)
{
    if (!output->video && !output->y4m.planes && !output->sheet.columns)
        output_finish(output, NULL);
}

static void stop_worker(Output *output)
{
    pthread_mutex_lock(&output->mutex);
    output->aborting = true;
    bool ended = output->ended;
    pthread_cond_broadcast(&output->changed);
    pthread_mutex_unlock(&output->mutex);
    // The worker may be waiting for ffmpeg: its end wakes it.
    if (output->video && !ended) video_kill(output->video);
    pthread_join(output->worker, NULL);
}

void output_destroy(Output *output)
{
    if (!output) return;
    if (output->has_worker) stop_worker(output);
    video_destroy(output->video);
    image_sheet_destroy(&output->sheet);
    image_texts_destroy(&output->texts);
    y4m_destroy(&output->y4m);
    for (int i = 0; i < output->slot_count; i++) {
        image_destroy(&output->slots[i].image);
        for (int l = 0; l < EXR_LAYERS; l++) image_destroy(&output->slots[i].extra.layers[l]);
    }
    free(output->slots);
    free(output->queue);
    free(output->description);
    target_destroy(&output->target);
    pthread_cond_destroy(&output->changed);
    pthread_mutex_destroy(&output->mutex);
    free(output);
}

OutputCounters output_count(Output *output)
{
    pthread_mutex_lock(&output->mutex);
    OutputCounters counters = output->counters;
    pthread_mutex_unlock(&output->mutex);
    return counters;
}

const char *output_describe(Output *output)
{
    pthread_mutex_lock(&output->mutex);
    int first = output->frame_first, last = output->frame_last;
    pthread_mutex_unlock(&output->mutex);
    if (output->target.stream) return "standard output";
    char *first_name = target_name_frame(&output->target, first);
    char *last_name = target_name_frame(&output->target, last);
    free(output->description);
    output->description = NULL;
    if (first_name && last_name && strcmp(first_name, last_name) != 0 &&
        asprintf(&output->description, "%s ... %s", first_name, last_name) < 0)
        output->description = NULL;
    if (!output->description && first_name) {
        output->description = first_name;
        first_name = NULL;
    }
    free(first_name);
    free(last_name);
    return output->description ? output->description : output->target.before;
}
