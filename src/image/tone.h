// SPDX-License-Identifier: MIT
// How light becomes colour (glsl/draw/display.glsl), and back.
#pragma once

#include "base/params.h"

// What display.glsl's macro TONE may be beside a Tone: light stays as it is.
enum { TONE_LIGHT = TONE_FILMIC + 1 };

// Light (>= 0) of one channel to a linear colour value.
double tone_map(Tone tone, double light);

// The light that becomes `value`, 0..1.
double tone_unmap(Tone tone, double value);
