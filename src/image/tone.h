// SPDX-License-Identifier: MIT
// Tone mapping from light to colour (glsl/draw/display.glsl).
#pragma once

#include "base/params.h"

// A value of display.glsl's macro TONE besides those of Tone: light stays linear.
enum { TONE_LIGHT = TONE_FILMIC + 1 };

// Maps the light (>= 0) of one channel to a linear colour value.
double tone_map(Tone tone, double light);
