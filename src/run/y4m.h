// SPDX-License-Identifier: MIT
// Raw video, YUV4MPEG2, for programs that read pipes: full chroma (4:4:4), 8 bits, BT.709, limited
// range, which players and encoders assume by default.
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

// Creates the file, or uses standard output if `path` is "-". `fps` is written as a fraction: exact
// for integers and broadcast rates (30000/1001), otherwise to a millionth. RESULT_FAILED with path
// and reason.
Result y4m_create(Y4m *y4m, const char *path, int width, int height, double fps, Error *error);

// Appends an IMAGE_8 of 3 channels. RESULT_FAILED with path and reason.
Result y4m_write(Y4m *y4m, const Image *image, Error *error);

// Completes the file and gives it its name. RESULT_FAILED with path and reason.
Result y4m_finish(Y4m *y4m, Error *error);

// Removes an incomplete file.
void y4m_destroy(Y4m *y4m);
