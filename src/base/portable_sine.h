// SPDX-License-Identifier: MIT
// Sine and cosine that are the same on every machine, as those of C libraries are not.
#pragma once

// Of 2 pi `turns`, within 1e-11; |turns| < 2^31.
double portable_sine(double turns);
double portable_cosine(double turns);
