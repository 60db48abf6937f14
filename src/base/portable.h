// SPDX-License-Identifier: MIT
// Functions that are the same on every machine, as those of C libraries are not.
#pragma once

// Sine and cosine of 2 pi `turns`, within 1e-11; |turns| < 2^31.
double portable_sine(double turns);
double portable_cosine(double turns);

// Smooth noise in space, between -1 and 1: random at whole coordinates, between them joined
// smoothly. 0 where a coordinate is beyond 1e15.
double portable_noise(double x, double y, double z);
