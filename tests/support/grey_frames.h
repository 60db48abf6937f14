// SPDX-License-Identifier: MIT
// Frames for tests of the output. Each has a single grey level, which encodes its number; a real
// encoder changes it by less than half a step.
#pragma once

#include "run/output.h"

enum { GREY_WIDTH = 33, GREY_HEIGHT = 17 };

// Options for small images at 25 frames a second.
OutputOptions grey_options(const char *target, int channels);

// The level of all channels of a frame.
uint8_t grey_of_frame(int frame);
void grey_fill(Image *image, int frame);

// Hands frames 0 .. count - 1 to the output until a call fails.
Result grey_draw(Output *output, int count, Error *error);

// Like grey_draw, with its own output, from creation to finish.
Result grey_write(const OutputOptions *options, int count, Error *error);

// Fails unless the PNG file at `path` shows this frame.
void grey_assert_frame(const char *path, int frame, int channels);

// Fails unless the error is a single line that contains `part`.
void grey_assert_line(const Error *error, const char *part);
