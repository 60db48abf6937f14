// SPDX-License-Identifier: MIT
#include "run/sequence.h"
#include "base/activity.h"
#include "base/clock.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "gpu/gl_count.h"
#include "run/caption.h"
#include "run/record.h"

#include <malloc.h>
#include <string.h>

int sequence_last_frame(const RunParams *run)
{
    return run->last < 0 ? run->frames - 1 : run->last;
}

// The number of frames that --first, --last and --every select.
static int count_named(const RunParams *run)
{
    int last = sequence_last_frame(run);
    return last < run->first ? 0 : (last - run->first) / run->every + 1;
}

// The number of tiles of the contact sheet; 0 without a contact sheet.
static int count_tiles(const RunParams *run)
{
    int64_t tiles = (int64_t)run->contact_sheet[0] * run->contact_sheet[1];
    if (tiles <= 1) return 0;
    return tiles < count_named(run) ? (int)tiles : count_named(run);
}

// A contact sheet of T tiles shows the frames at places floor(i n / T) of n, i = 0 .. T - 1. They
// are evenly spaced, and a full turn does not repeat its start at the end. For a given place, only
// the first i with i n / T >= place can match.
static bool is_on_sheet(const RunParams *run, int place)
{
    int64_t named = count_named(run), tiles = count_tiles(run);
    if (tiles == 0) return true;
    int64_t i = (place * tiles + named - 1) / named;
    return i < tiles && i * named / tiles == place;
}

bool sequence_draws_frame(const RunParams *run, int frame)
{
    int place = (frame - run->first) / run->every;
    return frame >= run->first && frame <= sequence_last_frame(run) &&
           (frame - run->first) % run->every == 0 && place % run->part[1] == run->part[0] - 1 &&
           is_on_sheet(run, place);
}

int sequence_count_drawn(const RunParams *run)
{
    int all = count_named(run), before = run->part[0] - 1, parts = run->part[1];
    if (count_tiles(run)) return count_tiles(run);
    return all <= before ? 0 : (all - before - 1) / parts + 1;
}

// --- The loop.

// The previous image, which is repeated if neither hair nor camera has moved. A copy is kept only
// if a repeat is possible: in the first frame and in frames in which nothing moved.
typedef struct Previous {
    bool any;
    uint64_t changes; // simulation->changes when the image was drawn
    View view;
    Image image, layers[EXR_LAYERS];
} Previous;

// An image that is read back from the GPU while the next frame is simulated and drawn.
typedef struct Pending {
    Image *image; // NULL if there is none
    int frame, place;
    View view;
    bool still; // nothing had moved since the image before
} Pending;

// State that a run carries from frame to frame.
typedef struct Carried {
    Previous previous;
    Pending pending;
} Carried;

static bool same_view(const View *a, const View *b)
{
    return memcmp(a->view, b->view, sizeof a->view) == 0 &&
           memcmp(a->projection, b->projection, sizeof a->projection) == 0;
}

// Copies an image; allocates `to` the first time.
static Result copy(Image *to, const Image *from, Error *error)
{
    if (!from->pixels) return RESULT_OK;
    if (!to->pixels)
        TRY(image_create_kind(to, from->width, from->height, from->channels, from->kind, error));
    memcpy(to->pixels, from->pixels, image_size(from));
    return RESULT_OK;
}

static Result copy_layers(Image to[EXR_LAYERS], const Image from[EXR_LAYERS], Error *error)
{
    for (int l = 0; l < EXR_LAYERS; ++l) TRY(copy(&to[l], &from[l], error));
    return RESULT_OK;
}

static Result remember(Previous *previous, const View *view, Image *image, Error *error)
{
    TRY(copy(&previous->image, image, error));
    TRY(copy_layers(previous->layers, output_extra(image)->layers, error));
    previous->view = *view;
    previous->any = true;
    return RESULT_OK;
}

// Frees the memory of shader compilation before the first image is drawn, which lowers the peak by
// 10 MB on a CPU driver.
static void give_back_memory(void)
{
    glReleaseShaderCompiler();
    malloc_trim(0);
}

static Result hand_on(Sequence *sequence, int frame, Image *image, Error *error)
{
    if (*sequence->scene->run.caption) {
        char text[CAPTION_BYTES];
        caption_write(text, sequence->scene, frame);
        caption_draw(image, text);
    }
    activity_set("writing");
    return output_submit(sequence->output, frame, image, error);
}

// Finishes the image that is being read back, if there is one, and hands it to the output.
static Result finish_pending(Sequence *sequence, Carried *carried, Error *error)
{
    Pending pending = carried->pending;
    if (!pending.image) return RESULT_OK;
    carried->pending.image = NULL;
    TRY(images_take(sequence->images, pending.place, pending.image,
                    output_extra(pending.image)->layers, error));
    if (pending.still) TRY(remember(&carried->previous, &pending.view, pending.image, error));
    return hand_on(sequence, pending.frame, pending.image, error);
}

// Whether nothing has moved since the previous image. If so, the previous image is copied to
// `image`.
static Result repeat(Sequence *sequence, Carried *carried, const View *view, Image *image,
                     bool *still, bool *repeated, Error *error)
{
    Previous *previous = &carried->previous;
    const Simulation *simulation = sequence->source->simulation;
    *still = simulation->changes == previous->changes || sequence->frames_drawn == 0;
    previous->changes = simulation->changes;
    if (*still) TRY(finish_pending(sequence, carried, error));
    if (!*still) previous->any = false;
    *repeated = *still && previous->any && !sequence->scene->run.turn_lights &&
                same_view(view, &previous->view);
    if (!*repeated) return RESULT_OK;
    ++sequence->frames_repeated;
    TRY(copy(image, &previous->image, error));
    return copy_layers(output_extra(image)->layers, previous->layers, error);
}

// Begins an image and finishes the one before. With statistics each frame is finished at once, so
// that its times are its own.
static Result draw(Sequence *sequence, Carried *carried, int frame, const View *view, Image *image,
                   Error *error)
{
    Images *images = sequence->images;
    bool still, repeated;
    TRY(repeat(sequence, carried, view, image, &still, &repeated, error));
    if (repeated) return hand_on(sequence, frame, image, error);
    if (sequence->frames_drawn == 0) give_back_memory();
    const Pending begun = {.image = image,
                           .frame = frame,
                           .place = images_place(images),
                           .view = *view,
                           .still = still};
    TRY(images_begin(images, frame, view, image, output_extra(image)->layers, error));
    ++sequence->frames_drawn;
    TRY(finish_pending(sequence, carried, error));
    carried->pending = begun;
    if (images_are_late(images) && !sequence->stats->root) return RESULT_OK;
    TRY(images_settle(images, error));
    return finish_pending(sequence, carried, error);
}

static Result output_frame(Sequence *sequence, Carried *carried, int frame, FrameTimes *times,
                           Error *error)
{
    View view;
    Image *image;
    double begin = clock_ms();
    Result result = output_acquire(sequence->output, &image, error);
    double acquired = clock_ms();
    times->wait_ms = acquired - begin;
    if (result != RESULT_OK) return result;
    camera_view(&view, sequence->scene, sequence->images->framing, frame);
    images_output_matrices(output_extra(image), &view);
    fingerprint_of_image(output_extra(image)->scene, sequence->fingerprint, frame);
    result = draw(sequence, carried, frame, &view, image, error);
    times->draw_ms = clock_ms() - acquired;
    return result;
}

static Result export_frame(Sequence *sequence, int frame, Error *error)
{
    char scene[FINGERPRINT_BYTES];
    TRY(exporter_write(sequence->exporter, frame, error));
    if (!sequence->scene->run.resume) return RESULT_OK;
    fingerprint_of_hair(scene, sequence->fingerprint, frame);
    return record_add(&sequence->exporter->target, frame, scene, error);
}

static bool wants(const Sequence *sequence, int frame)
{
    return sequence_draws_frame(&sequence->scene->run, frame) &&
           !(sequence->done && sequence->done[frame]);
}

static Result run_frame(Sequence *sequence, Carried *carried, int frame, Error *error)
{
    FrameTimes times = {.frame = frame};
    double begin = clock_ms();
    bool wanted = wants(sequence, frame), draws = sequence->output != NULL;
    Result result = draws ? images_settle(sequence->images, error) : RESULT_OK;
    activity_set("simulating");
    THEN(result,
         frame_source_go(sequence->source, frame, wanted && (draws || sequence->exporter), error));
    times.simulate_ms = clock_ms() - begin;
    if (wanted && sequence->exporter) activity_set("exporting");
    if (result == RESULT_OK && wanted && sequence->exporter)
        result = export_frame(sequence, frame, error);
    if (result == RESULT_OK && wanted && draws)
        result = output_frame(sequence, carried, frame, &times, error);
    stats_add_frame(sequence->stats, sequence->timer, &times, &sequence->images->renderer.counts);
    gl_count_frame();
    return result;
}

// The last frame to simulate: the last frame that an output needs. A cache needs all frames.
static int last_wanted(const Sequence *sequence)
{
    int last = sequence_last_frame(&sequence->scene->run);
    if (*sequence->scene->run.cache) return last;
    while (last >= 0 && !wants(sequence, last)) --last;
    return last;
}

// Finishes the image that is still being read back, even if a later frame has failed or was
// interrupted.
static Result end(Sequence *sequence, Carried *carried, Error *error)
{
    if (!carried->pending.image) return RESULT_OK;
    TRY(images_settle(sequence->images, error));
    return finish_pending(sequence, carried, error);
}

Result sequence_run(Sequence *sequence, Error *error)
{
    const RunParams *run = &sequence->scene->run;
    int last = last_wanted(sequence), all = sequence_last_frame(run) + 1;
    Carried carried = {0};
    Progress progress;
    Result result = RESULT_OK;
    progress_start(&progress, stderr, all, run->quiet);
    for (int frame = 0; frame <= last && result == RESULT_OK; ++frame) {
        if (!wants(sequence, frame) && !frame_source_needs(sequence->source, frame)) continue;
        result = interrupt_requested() ? RESULT_INTERRUPTED
                                       : run_frame(sequence, &carried, frame, error);
        if (result == RESULT_INTERRUPTED) // also while a frame waits to be written
            error_set(error, result, "interrupted after %d of %d frames", frame, all);
        progress_update(&progress, frame + 1);
    }
    Result ended = end(sequence, &carried, result == RESULT_OK ? error : NULL);
    if (result == RESULT_OK) result = ended;
    progress_clear(&progress);
    image_destroy(&carried.previous.image);
    for (int l = 0; l < EXR_LAYERS; ++l) image_destroy(&carried.previous.layers[l]);
    return result;
}
