// SPDX-License-Identifier: MIT
// Images that show where two others differ.
#pragma once

#include "base/error.h"
#include "image/image.h"

// Red, green, blue for an error between 0 (black) and 1 (pale yellow), over violet, red and orange;
// lightness rises evenly, so that it reads in grey as well. Others are clamped.
void heat_map_color(uint8_t rgb[3], float error);

// Rounds errors [count] to HEAT_MAP_STEPS even steps from 0 to 1, so that a map has as few colours;
// no error above 0 becomes 0. NAN stays.
enum { HEAT_MAP_STEPS = 64 };
void heat_map_round(float *errors, size_t count);

// The errors [height][width] in these colours, an IMAGE_8 of 3 channels; grey stripes where they
// are NAN, as those of ignored pixels are. RESULT_FAILED when memory is short.
Result heat_map_create(Image *image, const float *errors, int width, int height, Error *error);

// A, B and the heat map of their errors side by side, with a gap between. Transparent parts show
// grey squares, floats are clamped. `a` and `b` have one size. RESULT_FAILED when memory is short
// or the sheet is larger than an image can be.
Result heat_map_create_sheet(Image *sheet, const Image *a, const Image *b, const float *errors,
                             Error *error);
