// SPDX-License-Identifier: MIT
// The destination of frames: the meaning of the value of `-o`.
#pragma once

#include "base/error.h"

#include <stdbool.h>

typedef enum TargetKind {
    TARGET_FRAMES, // one numbered file per frame
    TARGET_STILL,  // one file for a single frame
    TARGET_VIDEO,  // one file for all frames
} TargetKind;

// The format of the files.
typedef enum TargetFormat {
    TARGET_PNG,
    TARGET_PFM,
    TARGET_EXR,
    TARGET_JPEG,
    TARGET_Y4M,    // raw video
    TARGET_FFMPEG, // video that ffmpeg encodes
} TargetFormat;

typedef struct Target {
    TargetKind kind;
    TargetFormat format;
    bool stream;  // standard output; `before` is "-"
    char *before; // the name before the frame number; the full name of a still or a video
    char *after;  // the name after the number, with the suffix
    bool floats;  // the files are PFM or EXR
    int offset;   // number of frame 0
    int digits;   // minimum number of digits, padded with zeros
} Target;

// Parses "DIR/" or an existing folder (frame_0000.png, frame_0001.png, ... in it), a name ending in
// .png with one %d or %0Nd (N from 1 to 9) in its last part ("%%" is a percent sign), a plain name
// ending in .png, the same with .pfm, .exr, .jpg or .jpeg, or one ending in .mp4, .webm, .gif or
// .y4m; for standard output "-" or "-.png" (a sequence of PNG files, TARGET_VIDEO), "-.y4m",
// "-.pfm" or "-.exr". RESULT_USAGE for anything else, RESULT_FAILED when memory is short.
Result target_parse(Target *target, const char *text, Error *error);

// Parses any name, with or without a number (TARGET_STILL), with any suffix. Errors as above.
Result target_parse_any(Target *target, const char *text, Error *error);
void target_destroy(Target *target);

// The file name for a frame (>= 0), which the caller frees; large numbers get more digits. The same
// name for every frame of a still or a video. NULL when memory is short.
char *target_name_frame(const Target *target, int frame);

// Whether `name` (without folder) is a file of the pattern, and its frame number.
bool target_read_number(const Target *target, const char *name, int *frame);

// The numbers of a pattern's existing files; `last` is -1 if there are none or the folder cannot be
// read.
typedef struct TargetNumbers {
    int first, last, count;
} TargetNumbers;
TargetNumbers target_find_numbers(const Target *target);

// Makes missing folders and checks that a file can be created there. RESULT_FAILED with path and
// reason.
Result target_prepare(const Target *target, Error *error);
