// SPDX-License-Identifier: MIT
// The frame sink: takes finished images and writes them on worker threads while the next ones are
// computed: one, and more, up to the number of processors, when images have to wait for it. Files
// appear in the order of their frames. Videos, sheets and standard output have one.
//
// Use: output_create; for each frame output_acquire, fill the image, output_submit; output_finish;
// output_destroy. All functions are called from one thread. The workers have every signal blocked.
// After a failure of any function, or instead of output_finish, call output_destroy, if need be
// after output_flush: no half-written file and no half a video remains.
#pragma once

#include "base/error.h"
#include "image/image.h"
#include "image/image_text.h"
#include "run/frame_file.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct Output Output;

typedef struct OutputOptions {
    const char *target; // as target_parse takes it: "DIR/", "name_%04d.png", "x.png", "x.mp4",
                        // "x.webm", "x.gif", "x.y4m", "-", ...
    int width, height;  // pixels of every frame
    int channels;       // 3, or 4 for PNG, PFM, EXR and webm
    ImageKind kind;     // 16 bits for PNG only; floats for PFM and EXR and for nothing else
    bool layers;        // of EXR: each frame has layers
    bool exr_float;     // of EXR: 32 bits a channel
    bool records;       // of PFM: which scene each file shows, into a file beside them (record.h)
    double fps;         // frames a second, used for videos
    int frame_count;    // how many will come, 0: not known; "x.png" takes 1, or a sheet
    int columns, rows;  // of a contact sheet that takes all frames, "x.png" or the like; <= 1: none
    const ImageTexts *texts; // of each PNG file, which adds its frame's number; NULL: none
    int queue_length; // images in the pool: drawn, waiting or being encoded; 0: 3, and one for
                      // each worker more
} OutputOptions;

typedef struct OutputCounters {
    int frames;       // encoded so far
    uint64_t bytes;   // in the files; a video or sheet counts when it is complete
    double encode_ms; // wall time that the workers spent encoding and writing
} OutputCounters;

// Refuses a terminal, makes the folder if needed, tries that a file can be created there, starts
// ffmpeg for a video, and a worker. RESULT_USAGE for a target or a combination that makes no
// sense, RESULT_FAILED with path and reason otherwise.
Result output_create(Output **output, const OutputOptions *options, Error *error);

// Lends an image of the pool; its pixels are undefined. Blocks while all are waiting or being
// encoded. RESULT_FAILED with a worker's error, path and reason, if that has failed;
// RESULT_INTERRUPTED once interrupt_requested().
Result output_acquire(Output *output, Image **image, Error *error);

// What belongs to an image that is lent out, to be filled like it. Sheets and videos leave it
// out.
FrameExtra *output_extra(Image *image);

// Gives the image back to be written as frame `frame_index` (>= 0, part of the file's name; videos
// go by the order of submission). Never blocks. Fails like output_acquire, the image is given back
// all the same.
Result output_submit(Output *output, int frame_index, Image *image, Error *error);

// Waits until everything submitted is written and a video or sheet has its final name. Fails like
// output_acquire, and with RESULT_FAILED if a video has no frame.
Result output_finish(Output *output, Error *error);

// Of a run that has failed: writes the frames that wait, each a file or a piece of a stream of its
// own. Nothing for a video or a sheet, which would lack the rest.
void output_flush(Output *output);

// Without a successful output_finish: drops what waits, kills ffmpeg and removes the unfinished
// file. NULL is legal.
void output_destroy(Output *output);

// What has happened so far. Waits for nothing.
OutputCounters output_count(Output *output);

// Where to look: "out/frame_0000.png ... out/frame_0119.png" or the one file. Valid until the next
// call or destroy.
const char *output_describe(Output *output);
