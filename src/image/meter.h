// SPDX-License-Identifier: MIT
// An exposure meter.
#pragma once

#include "image/image.h"

// The exposure (EV) with which what is drawn in `image` shows its form, IMAGE_FLOAT of 4 channels:
// linear light, premultiplied, and coverage. Only pixels that are more than half covered count.
//
// Their mean (of logarithms) comes to METER_MIDDLE, but for a part METER_KEPT of how much darker or
// brighter than that it is, so that black hair stays darker than fair hair; and all but the
// brightest METER_BRIGHT of them stay below METER_WHITE. The result is a multiple of METER_STEP, so
// that a difference in rounding does not matter. 0 if no pixel counts, or all are black.
// RESULT_FAILED when memory is short.
Result meter_exposure(float *exposure, const Image *image, Error *error);

#define METER_MIDDLE 0.13
#define METER_KEPT   0.4
#define METER_BRIGHT 0.03
#define METER_WHITE  1.2
#define METER_STEP   0.0625
