// SPDX-License-Identifier: MIT
// Raw video, YUV4MPEG2, for programs that read pipes: full chroma (4:4:4), 8 bits, BT.709, limited
// range, as players and encoders assume where a file does not say.
#pragma once

#include "base/error.h"
#include "base/outfile.h"
#include "image/image.h"

#include <stdint.h>

// A zeroed struct may be destroyed.
typedef struct Y4m {
    OutFile file;
    int width, height;
    uint8_t *planes; // [3][height][width], owned
    uint64_t bytes;  // written so far
} Y4m;

// Begins the file, or standard output where `path` is "-". `fps` is written as a fraction: exact
// for whole numbers and for those of broadcast (30000/1001), else to a millionth. RESULT_FAILED
// with path and reason.
Result y4m_create(Y4m *y4m, const char *path, int width, int height, double fps, Error *error);

// Appends an IMAGE_8 of 3 channels. RESULT_FAILED with path and reason.
Result y4m_write(Y4m *y4m, const Image *image, Error *error);

// Completes the file, which then has its name. RESULT_FAILED with path and reason.
Result y4m_finish(Y4m *y4m, Error *error);

// Removes the file if it is not complete.
void y4m_destroy(Y4m *y4m);
