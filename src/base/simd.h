// SPDX-License-Identifier: MIT
// Loops over lanes that compilers turn into vector instructions: arithmetic for them, and the same
// loops built once for each kind of vectors. Such loops are innermost and have no branches.
// -ffp-contract=off and no function of libm keep the bits the same whatever the vectors are.
#pragma once

#include "base/parallel.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

// The vectors that a processor has.
typedef enum SimdLevel {
    SIMD_ANY,    // what every processor of its family has
    SIMD_AVX2,   // 8 floats, fused multiplication and addition
    SIMD_AVX512, // the same with twice as many registers
    SIMD_LEVELS
} SimdLevel;

// The best level of this processor.
SimdLevel simd_level(void);

// Attributes of a function for each level; elsewhere than on x86 they say nothing.
#define SIMD_FOR_ANY
#if defined __x86_64__
#define SIMD_FOR_AVX2   __attribute__((target("avx2,fma")))
#define SIMD_FOR_AVX512 __attribute__((target("avx2,fma,avx512vl,avx512dq,avx512bw")))
#else
#define SIMD_FOR_AVX2
#define SIMD_FOR_AVX512
#endif

#define SIMD_INLINE static inline __attribute__((always_inline))

// run_NAME(data, parts): NAME(const TYPE *data, int part), a SIMD_INLINE function, for each part
// on threads (see parallel.h), by the best vectors that the processor has.
#define SIMD_STAGE(name, type)                                                                     \
    SIMD_FOR_ANY static void name##_any(void *data, int part)                                      \
    {                                                                                              \
        name((const type *)data, part);                                                            \
    }                                                                                              \
    SIMD_FOR_AVX2 static void name##_avx2(void *data, int part)                                    \
    {                                                                                              \
        name((const type *)data, part);                                                            \
    }                                                                                              \
    SIMD_FOR_AVX512 static void name##_avx512(void *data, int part)                                \
    {                                                                                              \
        name((const type *)data, part);                                                            \
    }                                                                                              \
    static void run_##name(type *data, int parts)                                                  \
    {                                                                                              \
        static void (*const versions[SIMD_LEVELS])(void *, int) = {name##_any, name##_avx2,        \
                                                                   name##_avx512};                 \
        parallel_run(parts, versions[simd_level()], data);                                         \
    }

// call_NAME(data): NAME(const TYPE *data, 0) on this thread, by the best vectors.
#define SIMD_CALL(name, type)                                                                      \
    SIMD_FOR_ANY static void name##_any(const type *data)                                          \
    {                                                                                              \
        name(data, 0);                                                                             \
    }                                                                                              \
    SIMD_FOR_AVX2 static void name##_avx2(const type *data)                                        \
    {                                                                                              \
        name(data, 0);                                                                             \
    }                                                                                              \
    SIMD_FOR_AVX512 static void name##_avx512(const type *data)                                    \
    {                                                                                              \
        name(data, 0);                                                                             \
    }                                                                                              \
    static void call_##name(const type *data)                                                      \
    {                                                                                              \
        static void (*const versions[SIMD_LEVELS])(const type *) = {name##_any, name##_avx2,       \
                                                                    name##_avx512};                \
        versions[simd_level()](data);                                                              \
    }

SIMD_INLINE float simd_float_of(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

// One instruction each; an a that is not a number becomes the bound.
SIMD_INLINE float simd_max(float a, float least)
{
    return a > least ? a : least;
}
SIMD_INLINE float simd_min(float a, float most)
{
    return a < most ? a : most;
}

// The larger of x and 0, without a comparison: compilers turn one whose outcome decides the next
// into a jump, and do not vectorise its loop.
SIMD_INLINE float simd_positive(float x)
{
    return 0.5f * (x + fabsf(x));
}

// The least whole number that isn't less, of those that an int holds.
SIMD_INLINE float simd_ceil(float x)
{
    float whole = (float)(int)x;
    return whole < x ? whole + 1 : whole;
}
