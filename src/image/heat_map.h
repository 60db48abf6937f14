// SPDX-License-Identifier: MIT
// Images that show where two images differ.
#pragma once

#include "base/error.h"
#include "image/image.h"

// The colour of an error between 0 (black) and 1 (pale yellow), by way of violet, red and orange.
// Lightness increases evenly, so the map also works in grey. Other values are clamped.
void heat_map_color(uint8_t rgb[3], float error);

// Quantises errors [count] to HEAT_MAP_STEPS even steps from 0 to 1, so that a map has few colours.
// No positive error becomes 0. NAN stays.
enum { HEAT_MAP_STEPS = 64 };
void heat_map_round(float *errors, size_t count);

// Draws the errors [height][width] as an IMAGE_8 of 3 channels, with grey stripes for NAN (ignored
// pixels). RESULT_FAILED when memory is short.
Result heat_map_create(Image *image, const float *errors, int width, int height, Error *error);

// Draws A, B and the heat map of their errors side by side, with a gap. Transparent parts show a
// grey checkerboard, floats are clamped. `a` and `b` must have the same size. RESULT_FAILED when
// memory is short or the sheet exceeds the largest image.
Result heat_map_create_sheet(Image *sheet, const Image *a, const Image *b, const float *errors,
                             Error *error);
