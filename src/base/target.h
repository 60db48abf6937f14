// SPDX-License-Identifier: MIT
// Where frames go: what the text behind `-o` means.
#pragma once

#include "base/error.h"

#include <stdbool.h>

typedef enum TargetKind {
    TARGET_FRAMES, // one file a frame, numbered
    TARGET_STILL,  // one file for the only frame
    TARGET_VIDEO,  // one file for all frames
} TargetKind;

// What the files hold.
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
    char *before; // the name up to the frame number; the full name of a still or a video
    char *after;  // the name behind the number, with the suffix
    bool floats;  // the files are PFM or EXR
    int digits;   // the number is padded with zeros to this length
} Target;

// Takes "DIR/" or an existing folder (frame_0000.png, frame_0001.png, ... in it), a name ending in
// .png with one %d or %0Nd (N from 1 to 9) in its last part ("%%" is a percent sign), a plain name
// ending in .png, the same with .pfm, .exr, .jpg or .jpeg, or one ending in .mp4, .webm, .gif or
// .y4m; or, for standard output, "-" or "-.png" (PNG files one after the other, TARGET_VIDEO),
// "-.y4m", "-.pfm" or
// "-.exr". RESULT_USAGE for anything else, RESULT_FAILED when memory is short.
Result target_parse(Target *target, const char *text, Error *error);

// Takes any name, with a number or without one (TARGET_STILL), whatever it ends in. Errors as
// above.
Result target_parse_any(Target *target, const char *text, Error *error);
void target_destroy(Target *target);

// The file for a frame (>= 0), to be freed; numbers that need more digits get them. The same name
// for every frame of a still or a video. NULL when memory is short.
char *target_name_frame(const Target *target, int frame);

// Whether `name`, without a folder, is one of a pattern's files, and of which frame.
bool target_read_number(const Target *target, const char *name, int *frame);

// The numbers of a pattern's files that there are; `last` -1: none, or the folder cannot be read.
typedef struct TargetNumbers {
    int first, last, count;
} TargetNumbers;
TargetNumbers target_find_numbers(const Target *target);

// Makes the folders that are missing and tries to create a file there. RESULT_FAILED with path and
// reason.
Result target_prepare(const Target *target, Error *error);
