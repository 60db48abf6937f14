// SPDX-License-Identifier: MIT
// Random values for a strand, the same in C and GLSL.
#ifdef __STDC__
#pragma once
#endif
#include "common/shared_math.h"

// Uniform random bits from a number, the same on every machine (the finaliser "lowbias32" of C.
// Wellons).
SHARED_FUNCTION uint hash_bits(uint id)
{
    id = (id ^ (id >> 16)) * 0x7feb352du;
    id = (id ^ (id >> 15)) * 0x846ca68bu;
    return id ^ (id >> 16);
}

// Uniform in -1 .. 1.
SHARED_FUNCTION float hash_signed(uint id)
{
    return FLOAT(INT(hash_bits(id) >> 8)) * (2.0f / 16777215.0f) - 1.0f;
}
