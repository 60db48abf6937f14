// SPDX-License-Identifier: MIT
#include "run/output.h"

#include "base/clock.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "run/single_file.h"

#include <assert.h>
#include <errno.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

// One image is being drawn, one is read back from the GPU or waits, one is encoded. If encoding is
// slower than drawing, each further worker gets another image.
#define QUEUE_LENGTH_DEFAULT 3
// A wait checks for interrupts this often.
#define WAIT_SLICE_NS 20000000

typedef enum SlotState { SLOT_FREE, SLOT_LENT, SLOT_QUEUED } SlotState;

typedef struct Slot {
    Image image; // must be first: a pointer to the image is also one to its slot
    FrameExtra extra;
    SlotState state;
    int frame;
} Slot;

// An encoding thread.
typedef struct Worker {
    Output *output;
    pthread_t thread;
    ImageTexts texts;
} Worker;

struct Output {
    Target target;
    SingleFile single; // used if all frames go to one file; then there is one worker
    ImageTexts texts;  // each worker starts with a copy
    bool has_texts;
    OutputOptions options; // only its numbers are valid; its pointers may dangle
    Slot *slots;           // [slot_room]
    Slot **queue;          // ring of slot_room entries: it can hold all slots
    int slot_count, slot_room;
    char *description;

    Worker workers[PARALLEL_MOST];
    int worker_count, most_workers;
    pthread_mutex_t mutex; // guards the members below and the slots' states
    pthread_cond_t changed;
    int queue_first, queued;
    uint64_t taken, written; // numbers of frames; files appear in the order of frames
    int at_work;             // workers that are still running
    int submitted, frame_first, frame_last;
    bool closing;  // no more frames will come
    bool aborting; // discard the frames that wait
    bool ended;    // all workers have finished
    Result result; // the first failure of a worker, with its message
    Error failure;
    OutputCounters counters;
};

// A frame that a worker has taken.
typedef struct Taken {
    FrameFile file;
    uint64_t turn; // number of frames that were taken before
    char scene[FINGERPRINT_BYTES];
    Result result; // of encoding and writing
    Error error;
} Taken;

static FrameFile name_file(const Output *output, int first, int last)
{
    return (FrameFile){&output->target, first, last, .exr_float = output->options.exr_float};
}

static ImageTexts *texts_of(Worker *worker)
{
    return worker->output->has_texts ? &worker->texts : NULL;
}

static void encode(Worker *worker, const Slot *slot, Taken *taken)
{
    SingleFile *single = &worker->output->single;
    taken->result = single_file_is_used(single)
                        ? single_file_add(single, &slot->image, &taken->error)
                        : frame_file_write(&taken->file, &slot->image, texts_of(worker),
                                           &slot->extra, &taken->error);
}

// Keeps the first failure. Call with the mutex held.
static void fail(Output *output, Result result, const Error *why)
{
    if (output->result != RESULT_OK) return;
    output->result = result;
    output->failure = *why;
}

static bool goes_on(const Output *output)
{
    return output->result == RESULT_OK && !output->aborting;
}

// Renames the frame's temporary file to its name, unless all frames go to one file.
static Result commit(Output *output, Taken *taken)
{
    if (taken->result != RESULT_OK || single_file_is_used(&output->single)) return taken->result;
    return frame_file_commit(&taken->file, output->options.records ? taken->scene : "",
                             &taken->error);
}

// Waits until the files of all earlier frames have their names, then commits this one. If an
// earlier frame has failed, the file is discarded. Call with the mutex held; it is released while
// waiting and writing. The same is true of the functions below.
static void end_frame(Output *output, Taken *taken)
{
    while (output->written != taken->turn && goes_on(output))
        pthread_cond_wait(&output->changed, &output->mutex);
    if (goes_on(output)) {
        pthread_mutex_unlock(&output->mutex);
        Result result = commit(output, taken);
        pthread_mutex_lock(&output->mutex);
        if (result != RESULT_OK) {
            fail(output, result, &taken->error);
        } else {
            output->written++;
            output->counters.frames++;
            output->counters.bytes += taken->file.bytes;
        }
    }
    frame_file_discard(&taken->file);
}

// Encodes the oldest frame in the queue.
static void encode_next(Worker *worker)
{
    Output *output = worker->output;
    Slot *slot = output->queue[output->queue_first];
    Taken taken = {.file = name_file(output, slot->frame, slot->frame), .turn = output->taken++};
    output->queue_first = (output->queue_first + 1) % output->slot_room;
    output->queued--;
    pthread_mutex_unlock(&output->mutex);
    double start_ms = clock_ms();
    memcpy(taken.scene, slot->extra.scene, sizeof taken.scene);
    encode(worker, slot, &taken);
    double encode_ms = clock_ms() - start_ms;
    pthread_mutex_lock(&output->mutex);
    slot->state = SLOT_FREE;
    output->counters.encode_ms += encode_ms;
    pthread_cond_broadcast(&output->changed);
    end_frame(output, &taken);
}

// Completes the file that holds all frames, if there is one.
static void end_file(Worker *worker)
{
    Output *output = worker->output;
    if (!single_file_is_used(&output->single)) return;
    FrameFile file = name_file(output, output->frame_first, output->frame_last);
    pthread_mutex_unlock(&output->mutex);
    double start_ms = clock_ms();
    uint64_t bytes = 0;
    Error error;
    Result result = single_file_finish(&output->single, &file, texts_of(worker), &bytes, &error);
    double encode_ms = clock_ms() - start_ms;
    pthread_mutex_lock(&output->mutex);
    output->counters.encode_ms += encode_ms;
    output->counters.bytes += bytes;
    if (result != RESULT_OK) fail(output, result, &error);
}

static void *work(void *argument)
{
    Worker *worker = argument;
    Output *output = worker->output;
    pthread_mutex_lock(&output->mutex);
    while (goes_on(output)) {
        if (output->queued > 0)
            encode_next(worker);
        else if (output->closing)
            break;
        else
            pthread_cond_wait(&output->changed, &output->mutex);
        pthread_cond_broadcast(&output->changed);
    }
    if (goes_on(output)) end_file(worker);
    output->ended = --output->at_work == 0;
    pthread_cond_broadcast(&output->changed);
    pthread_mutex_unlock(&output->mutex);
    return NULL;
}

// Waits for a change, at most for one slice. Call with the mutex held.
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
                         "%s: a contact sheet is one image: expected a name ending in .png, .jpg, "
                         ".pfm or .exr, without a number",
                         options->target);
    bool many = target->kind == TARGET_STILL && !sheet && options->frame_count > 1;
    if (many && target->stream)
        return error_set(error, RESULT_USAGE,
                         "%s: one image for %d frames: expected - (PNG) or -.y4m, or --frames 1",
                         options->target, options->frame_count);
    if (many)
        return error_set(error, RESULT_USAGE,
                         "%s: one file name for %d frames: expected a frame number in the name "
                         "(frame_%%04d.png), or --frames 1",
                         options->target, options->frame_count);
    const char *opaque = target->format == TARGET_Y4M    ? ".y4m"
                         : target->format == TARGET_JPEG ? "JPEG"
                                                         : NULL;
    if (opaque && options->channels == 4)
        return error_set(
            error, RESULT_USAGE,
            "%s: %s cannot hold a transparent background: expected .webm or PNG frames",
            options->target, opaque);
    if (target->floats != (options->kind == IMAGE_FLOAT) ||
        (target->format >= TARGET_JPEG && options->kind != IMAGE_8))
        return error_set(error, RESULT_USAGE,
                         "%s: this format cannot store the image's kind of numbers: expected .png "
                         "for whole numbers, .pfm or .exr for floats",
                         options->target);
    if (options->channels != 3 && options->channels != 4)
        return error_set(error, RESULT_USAGE, "%s: frames of %d channels: expected 3 or 4",
                         options->target, options->channels);
    if (options->width < 1 || options->height < 1)
        return error_set(error, RESULT_USAGE,
                         "%s: frames of %d x %d pixels: expected at least 1 x 1", options->target,
                         options->width, options->height);
    return RESULT_OK;
}

static VideoOptions video_options(const OutputOptions *options, const Target *target)
{
    return (VideoOptions){
        .path = target->before,
        .width = options->width,
        .height = options->height,
        .channels = options->channels,
        .fps = options->fps,
    };
}

Result output_check(const OutputOptions *options, Error *error)
{
    Target target = {0};
    Result result = target_parse(&target, options->target, error);
    THEN(result, check_options(options, &target, error));
    if (result == RESULT_OK && target.format == TARGET_FFMPEG) {
        const VideoOptions video = video_options(options, &target);
        result = video_check(&video, error);
    }
    target_destroy(&target);
    return result;
}

static Result add_slot(Output *output, Error *error)
{
    const OutputOptions *options = &output->options;
    Slot *slot = &output->slots[output->slot_count];
    int layers = output->target.format == TARGET_EXR && options->layers ? EXR_LAYERS : 0;
    Result result = image_create_kind(&slot->image, options->width, options->height,
                                      options->channels, options->kind, error);
    for (int i = 0; i < layers && result == RESULT_OK; i++)
        result = image_create_kind(&slot->extra.layers[i], options->width, options->height, 3,
                                   IMAGE_FLOAT, error);
    output->slot_count += result == RESULT_OK;
    if (result == RESULT_OK) return result;
    image_destroy(&slot->image);
    for (int i = 0; i < layers; i++) image_destroy(&slot->extra.layers[i]);
    return result;
}

static Result create_slots(Output *output, const OutputOptions *options, Error *error)
{
    bool fixed = options->queue_length > 0;
    int count = fixed ? options->queue_length : QUEUE_LENGTH_DEFAULT;
    output->slot_room = fixed ? count : count + PARALLEL_MOST;
    output->slots = calloc((size_t)output->slot_room, sizeof *output->slots);
    output->queue = calloc((size_t)output->slot_room, sizeof *output->queue);
    if (!output->slots || !output->queue)
        return error_set(error, RESULT_FAILED, "no memory for the output's queue");
    output->options = *options;
    Result result = RESULT_OK;
    for (int i = 0; i < count && result == RESULT_OK; i++) result = add_slot(output, error);
    return result;
}

// Call with the mutex held, or before there are workers.
static Result start_worker(Output *output, Error *error)
{
    Worker *worker = &output->workers[output->worker_count];
    worker->output = output;
    TRY(image_texts_copy(&worker->texts, &output->texts, error));
    int reason = parallel_start(&worker->thread, work, worker);
    if (reason == 0) {
        output->worker_count++;
        output->at_work++;
        return RESULT_OK;
    }
    image_texts_destroy(&worker->texts);
    return error_set(error, RESULT_FAILED, "cannot start the thread that writes frames: %s",
                     strerror(reason));
}

// Adds a worker and an image for it, because all images wait or are being encoded. If that fails,
// the output goes on with the workers that it has. Call with the mutex held.
static void grow(Output *output)
{
    if (output->worker_count >= output->most_workers || output->slot_count >= output->slot_room)
        return;
    if (start_worker(output, NULL) != RESULT_OK || add_slot(output, NULL) != RESULT_OK)
        output->most_workers = output->worker_count;
}

static Result start_sheet(Output *output, const OutputOptions *options, Error *error)
{
    if (!is_sheet(options)) return RESULT_OK;
    Result result = single_file_start_sheet(&output->single, options->columns, options->rows,
                                            &output->slots[0].image, error);
    return result == RESULT_USAGE ? error_prefix(error, result, "%s: ", options->target) : result;
}

static Result start_video(Output *output, const OutputOptions *options, Error *error)
{
    const VideoOptions video = video_options(options, &output->target);
    if (output->target.kind != TARGET_VIDEO) return RESULT_OK;
    return single_file_start_video(&output->single, output->target.format, &video, error);
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
    Result result = target_parse(&created->target, options->target, error);
    created->target.offset = options->first_number;
    THEN(result, check_options(options, &created->target, error));
    THEN(result, image_texts_copy(&created->texts, options->texts, error));
    THEN(result, create_slots(created, options, error));
    THEN(result, start_sheet(created, options, error));
    THEN(result, target_prepare(&created->target, error));
    THEN(result, start_video(created, options, error));
    bool one = single_file_is_used(&created->single) || created->target.stream;
    created->most_workers = one ? 1 : parallel_threads();
    if (result == RESULT_OK) {
        pthread_mutex_lock(&created->mutex);
        result = start_worker(created, error);
        pthread_mutex_unlock(&created->mutex);
    }
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
        grow(output);
        if ((slot = find_free_slot(output))) break;
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

FrameExtra *output_extra(Image *image)
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
        output->queue[(output->queue_first + output->queued++) % output->slot_room] = slot;
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
    if (single_file_is_video(&output->single) && output->submitted == 0)
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
    if (!single_file_is_used(&output->single)) output_finish(output, NULL);
}

static void stop_workers(Output *output)
{
    pthread_mutex_lock(&output->mutex);
    output->aborting = true;
    bool ended = output->ended;
    pthread_cond_broadcast(&output->changed);
    pthread_mutex_unlock(&output->mutex);
    // A worker may be waiting for ffmpeg: stopping ffmpeg wakes it.
    if (!ended) single_file_stop(&output->single);
    for (int i = 0; i < output->worker_count; i++) {
        pthread_join(output->workers[i].thread, NULL);
        image_texts_destroy(&output->workers[i].texts);
    }
}

void output_destroy(Output *output)
{
    if (!output) return;
    if (output->worker_count) stop_workers(output);
    single_file_destroy(&output->single);
    image_texts_destroy(&output->texts);
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
