// SPDX-License-Identifier: MIT
// An exposure meter.
#pragma once

#include "image/image.h"
#include "image/tone.h"

// The exposure (EV) at which hair of the colour METER_GREY shows as METER_GREY. `image` is a
// drawing of such hair with the actual lights and camera; the first channel of `hair` is the share
// of each pixel that hair covers. Both are IMAGE_FLOAT of the same size; `image` has 4 channels of
// linear light, premultiplied.
//
// The exposure makes the mean display luminance (through `tone`) of all pixels that are more than
// half hair equal to METER_GREY. But all pixels that are more than half covered, by hair or mesh,
// must stay below METER_WHITE, except for the brightest METER_BRIGHT of them. If no pixel is more
// than half hair, all pixels that are more than half covered are used instead. The result is a
// multiple of METER_STEP, so that rounding differences do not matter; it is 0 if there are no such
// pixels or if they are too dark for 20 EV. RESULT_FAILED when memory is short.
Result meter_exposure(float *exposure, const Image *image, const Image *hair, Tone tone,
                      Error *error);

#define METER_GREY   0.19
#define METER_BRIGHT 0.03
#define METER_WHITE  1.2
#define METER_STEP   0.0625
