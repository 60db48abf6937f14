// SPDX-License-Identifier: MIT
// Half-precision floats (IEEE 754 binary16).
#pragma once

#include <stdint.h>

// The number of the low 16 bits: 1 bit of sign, 5 of exponent, 10 of fraction. Exact for every
// pattern, also below the smallest normal number, 2^-14; infinities and NaN stay what they are.
double half_number(uint32_t bits);
