// SPDX-License-Identifier: MIT
// Functions with the same results on every machine, unlike those of C libraries.
#pragma once

// Sine and cosine of 2 pi `turns`, within 1e-11; |turns| < 2^31.
double portable_sine(double turns);
double portable_cosine(double turns);

// Smooth noise in space, between -1 and 1: random at integer coordinates and interpolated smoothly
// between them. 0 if a coordinate is beyond 1e15.
double portable_noise(double x, double y, double z);
