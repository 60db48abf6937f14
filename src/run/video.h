// SPDX-License-Identifier: MIT
// Video files by way of the program ffmpeg: frames go to its standard input.
#pragma once

#include "base/error.h"
#include "image/image.h"

#include <stdint.h>

typedef struct Video Video;

typedef struct VideoOptions {
    const char *path;  // ends in .mp4 (H.264), .webm (VP9) or .gif
    int width, height; // pixels; mp4 is padded to even sizes by repeating the last column or row
    int channels;      // 3, or 4 for a transparent webm
    double fps;        // frames a second, 0 < fps <= 1000; a gif shows 50 of them at most
} VideoOptions;

// Starts ffmpeg, in a process group of its own, so that ^C on the terminal does not reach it, on a
// temporary file in the folder of `path`. RESULT_USAGE for options that the format cannot hold;
// RESULT_FAILED if ffmpeg is missing (the Debian package is named) or the file cannot be created.
Result video_create(Video **video, const VideoOptions *options, Error *error);

// Appends a frame of exactly the size and channels given at the start. Blocks while ffmpeg is busy.
// RESULT_FAILED with ffmpeg's own words if it has ended; then only video_destroy may follow.
// SIGPIPE must be blocked or ignored.
Result video_write(Video *video, const Image *image, Error *error);

// Ends the video, waits for ffmpeg and gives the file its name; `bytes` is its size. RESULT_FAILED
// with the reason if ffmpeg ended badly or the file could not be completed.
Result video_finish(Video *video, uint64_t *bytes, Error *error);

// Kills ffmpeg. Legal at any time between create and destroy and from any thread: a write or finish
// that is under way in another one then fails.
void video_kill(Video *video);

// Kills ffmpeg if it still runs and removes the unfinished file. NULL is legal.
void video_destroy(Video *video);
