// SPDX-License-Identifier: MIT
// An exposure meter.
#pragma once

#include "image/image.h"
#include "image/tone.h"

// The exposure (EV) that shows hair of the colour METER_GREY as just that. `image` is a drawing of
// such hair under the lights and before the camera that count, `hair` the share of each pixel that
// the hair covers, in its first channel; both IMAGE_FLOAT, of one size, the light of 4 channels,
// linear light, premultiplied.
//
// The mean luminance that `tone` shows of the pixels that are more than half hair comes to
// METER_GREY; but all of what is more than half covered, by hair or by a mesh, except for the
// brightest METER_BRIGHT, stays below METER_WHITE. Where no pixel is more than half hair, all that
// are more than half covered are taken for it. The result is a multiple of METER_STEP, so that a
// difference in rounding does not matter; 0 if no pixel counts or they are too dark for 20 EV.
// RESULT_FAILED when memory is short.
Result meter_exposure(float *exposure, const Image *image, const Image *hair, Tone tone,
                      Error *error);

#define METER_GREY   0.19
#define METER_BRIGHT 0.03
#define METER_WHITE  1.2
#define METER_STEP   0.0625
