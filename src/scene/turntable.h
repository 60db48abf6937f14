// SPDX-License-Identifier: MIT
// How far a turntable has come round.
#pragma once

#include "base/params.h"

// The angle at frame `frame` (>= 0; run.frames is the end of the first round), degrees, as far as a
// camera can tell: 0 at frames 0 and run.frames of whole turns, exactly.
//
// The speed rises from 0 over the first run.ease_in of the sequence, is constant, and falls to 0
// over its last run.ease_out, as 3 s^2 - 2 s^3, so that the acceleration is continuous, too.
double turntable_angle_deg(const RunParams *run, int frame);
