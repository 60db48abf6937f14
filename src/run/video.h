// SPDX-License-Identifier: MIT
// Video files by the program ffmpeg, which reads frames from its standard input.
#pragma once

#include "base/error.h"
#include "image/image.h"

#include <stdint.h>

typedef struct Video Video;

typedef struct VideoOptions {
    const char *path;  // ends in .mp4 (H.264), .webm (VP9) or .gif
    int width, height; // pixels; mp4 is padded to even sizes by repeating the last column or row
    int channels;      // 3, or 4 for a transparent webm
    double fps;        // frames per second, 0 < fps <= 1000; a gif shows at most 50
} VideoOptions;

// RESULT_USAGE for options that the format can't hold.
Result video_check(const VideoOptions *options, Error *error);

// Starts ffmpeg with a temporary file in the folder of `path`, in its own process group, so that ^C
// on the terminal does not reach it. Errors of video_check; RESULT_FAILED if ffmpeg is missing (the
// message names the Debian package) or the file can't be created.
Result video_create(Video **video, const VideoOptions *options, Error *error);

// Appends a frame of exactly the initial size and channels. Blocks while ffmpeg is busy. If ffmpeg
// has ended, RESULT_FAILED with its message; then only video_destroy may follow. SIGPIPE must be
// blocked or ignored.
Result video_write(Video *video, const Image *image, Error *error);

// Ends the video, waits for ffmpeg and gives the file its name; `bytes` is its size. RESULT_FAILED
// with the reason if ffmpeg failed or the file could not be completed.
Result video_finish(Video *video, uint64_t *bytes, Error *error);

// Kills ffmpeg. Allowed at any time between create and destroy and from any thread: a write or
// finish in another thread then fails.
void video_kill(Video *video);

// Kills ffmpeg if it still runs, and removes the unfinished file. NULL is allowed.
void video_destroy(Video *video);
