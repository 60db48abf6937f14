// SPDX-License-Identifier: MIT
// Arithmetic for loops over lanes that compilers turn into vector instructions, and the same loops
// for wider vectors. For cpu_*.c and block_*.c; such loops are innermost and have no
// branches. -ffp-contract=off and no function of libm keep the bits the same whatever the vectors
// are.
#pragma once

#include "base/parallel.h"
#include "base/processor.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#define INLINE static inline __attribute__((always_inline))

// run_NAME(data, parts): NAME(const TYPE *data, int part), an INLINE function, for each part on
// threads (see parallel.h), by the best vectors that the processor has.
#define STAGE(name, type)                                                                          \
    FOR_ANY static void name##_any(void *data, int part)                                           \
    {                                                                                              \
        name((const type *)data, part);                                                            \
    }                                                                                              \
    FOR_AVX2 static void name##_avx2(void *data, int part)                                         \
    {                                                                                              \
        name((const type *)data, part);                                                            \
    }                                                                                              \
    static void run_##name(type *data, int parts)                                                  \
    {                                                                                              \
        parallel_run(parts, processor_kind() >= PROCESSOR_AVX2 ? name##_avx2 : name##_any, data);  \
    }

INLINE float float_of(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

// The larger, the smaller: one instruction; an a that is not a number becomes the bound.
INLINE float larger(float a, float least)
{
    return a > least ? a : least;
}
INLINE float smaller(float a, float most)
{
    return a < most ? a : most;
}

// The larger of x and 0, without a comparison: one whose outcome tells that of the next becomes a
// jump, and its loop does not become vector instructions.
INLINE float positive(float x)
{
    return 0.5f * (x + fabsf(x));
}

// The least whole number that isn't less, of those that an int holds.
INLINE float ceiling(float x)
{
    float whole = (float)(int)x;
    return whole < x ? whole + 1 : whole;
}

// 2^x for -60 <= x <= 0: of the fraction -1/2 .. 1/2 the Taylor series to the sixth power (1.2e-7
// off), the rest as exponent bits.
INLINE float exp2_of(float x)
{
    int whole = (int)(x - 0.5f);
    float f = (x - (float)whole) * 0.693147181f;
    float power =
        1 + f * (1 + f * (0.5f + f * (1.f / 6 + f * (1.f / 24 + f * (1.f / 120 + f / 720)))));
    union {
        int bits;
        float value;
    } exponent = {.bits = (whole + 127) * (1 << 23)};
    return power * exponent.value;
}
