// SPDX-License-Identifier: MIT
// The frame sink writes finished images on worker threads while the next ones are computed. It
// starts with one worker and adds more, up to the number of processors, while images have to wait.
// Files appear in the order of their frames. Videos, sheets and standard output have one worker.
//
// Use: output_create; for each frame output_acquire, fill the image, output_submit; output_finish;
// output_destroy. All functions must be called from one thread. The workers block every signal.
// After a failure of any function, or instead of output_finish, call output_destroy, after
// output_flush if wanted: no incomplete file or video remains.
#pragma once

#include "base/error.h"
#include "image/image.h"
#include "image/image_text.h"
#include "run/frame_file.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct Output Output;

typedef struct OutputOptions {
    const char *target; // as for target_parse: "DIR/", "name_%04d.png", "x.png", "x.mp4", "x.webm",
                        // "x.gif", "x.y4m", "-", ...
    int width, height;  // pixels of every frame
    int channels;       // 3, or 4 for PNG, PFM, EXR and webm
    ImageKind kind;     // 16 bits for PNG only; floats for PFM and EXR only
    bool layers;        // of EXR: each frame has layers
    bool exr_float;     // of EXR: 32 bits per channel
    bool records;       // of PFM: write the scene of each file into a file next to them (record.h)
    double fps;         // frames per second of videos
    int frame_count;    // number of frames to come, 0: unknown; "x.png" takes 1, or a sheet
    int first_number;   // number of frame 0, in names and texts
    int columns, rows;  // of a contact sheet of all frames, such as "x.png"; <= 1: no sheet
    const ImageTexts *texts; // of each PNG file, to which the frame's number is added; NULL: none
    int queue_length; // images in the pool: drawn, waiting or being encoded; 0: 3, plus one for
                      // each worker after the first
} OutputOptions;

typedef struct OutputCounters {
    int frames;       // number encoded so far
    uint64_t bytes;   // in the files; a video or sheet counts once it is complete
    double encode_ms; // wall time that the workers spent encoding and writing
} OutputCounters;

// Checks target and options without opening anything. RESULT_USAGE for an invalid target or
// combination.
Result output_check(const OutputOptions *options, Error *error);

// Refuses a terminal, creates the folder if needed, tests that a file can be created there, starts
// ffmpeg for a video, and starts a worker. Errors of output_check, otherwise RESULT_FAILED with
// path and reason.
Result output_create(Output **output, const OutputOptions *options, Error *error);

// Lends an image of the pool, with undefined pixels. Blocks while all images are waiting or being
// encoded. RESULT_FAILED with path and reason if a worker has failed; RESULT_INTERRUPTED once
// interrupt_requested().
Result output_acquire(Output *output, Image **image, Error *error);

// The extra data of an image that is lent, to be filled like the image. Sheets and videos ignore
// it.
FrameExtra *output_extra(Image *image);

// Returns the image to be written as frame `frame_index` (>= 0, part of the file's name; videos use
// the order of submission). Never blocks. Fails like output_acquire, and takes the image back in
// that case, too.
Result output_submit(Output *output, int frame_index, Image *image, Error *error);

// Waits until everything submitted is written and a video or sheet has its final name. Fails like
// output_acquire, and with RESULT_FAILED if a video has no frame.
Result output_finish(Output *output, Error *error);

// For a run that has failed: writes waiting frames that are separate files or pieces of a stream.
// Does nothing for a video or a sheet, which would be incomplete.
void output_flush(Output *output);

// Without a successful output_finish, this drops waiting images, kills ffmpeg and removes the
// unfinished file. NULL is allowed.
void output_destroy(Output *output);

// Current counters. Does not wait.
OutputCounters output_count(Output *output);

// The names of the results: "out/frame_0000.png ... out/frame_0119.png" or the single file. Valid
// until the next call or destroy.
const char *output_describe(Output *output);
