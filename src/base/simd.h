// SPDX-License-Identifier: MIT
// Loops over lanes that compilers vectorise: arithmetic for them, and the same loops compiled once
// for each vector extension. Such loops are innermost and have no branches. -ffp-contract=off and
// not using libm keep results the same for all vector extensions.
#pragma once

#include "base/parallel.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

// The vector extensions of a processor.
typedef enum SimdLevel {
    SIMD_ANY,    // available on every processor of the family
    SIMD_AVX2,   // 8 floats, fused multiply-add
    SIMD_AVX512, // the same with twice as many registers
    SIMD_LEVELS
} SimdLevel;

// The best level of this processor.
SimdLevel simd_level(void);

// Function attributes for each level; empty except on x86.
#define SIMD_FOR_ANY
#if defined __x86_64__
#define SIMD_FOR_AVX2   __attribute__((target("avx2,fma")))
#define SIMD_FOR_AVX512 __attribute__((target("avx2,fma,avx512vl,avx512dq,avx512bw")))
#else
#define SIMD_FOR_AVX2
#define SIMD_FOR_AVX512
#endif

// SIMD_WITH_AVX512(code): code for SIMD_AVX512; SIMD_AVX512_OF(name): name_avx512. AddressSanitizer
// takes the version for AVX2: GCC 12 aligns the frames that it keeps after a return to 32 bytes
// only, and stores vectors of 64 bytes there as if they were aligned (GCC bug 110027).
// SIMD_ALIGNED: for structs of arrays of lanes. A vector of 64 bytes that crosses a cache line is
// slower to load and store.
#if defined __SANITIZE_ADDRESS__
#define SIMD_WITH_AVX512(...)
#define SIMD_AVX512_OF(name) name##_avx2
#define SIMD_ALIGNED         __attribute__((aligned(32)))
#else
#define SIMD_WITH_AVX512(...) __VA_ARGS__
#define SIMD_AVX512_OF(name)  name##_avx512
#define SIMD_ALIGNED          __attribute__((aligned(64)))
#endif

#define SIMD_INLINE static inline __attribute__((always_inline))

// Defines run_NAME(data, parts), which calls the SIMD_INLINE function NAME(const TYPE *data, int
// part) for each part on threads (parallel.h), compiled for the best level of the processor.
#define SIMD_STAGE(name, type)                                                                     \
    SIMD_FOR_ANY static void name##_any(void *data, int part)                                      \
    {                                                                                              \
        name((const type *)data, part);                                                            \
    }                                                                                              \
    SIMD_FOR_AVX2 static void name##_avx2(void *data, int part)                                    \
    {                                                                                              \
        name((const type *)data, part);                                                            \
    }                                                                                              \
    SIMD_WITH_AVX512(SIMD_FOR_AVX512 static void name##_avx512(void *data, int part) {             \
        name((const type *)data, part);                                                            \
    })                                                                                             \
    static void run_##name(type *data, int parts)                                                  \
    {                                                                                              \
        static void (*const versions[SIMD_LEVELS])(void *, int) = {name##_any, name##_avx2,        \
                                                                   SIMD_AVX512_OF(name)};          \
        parallel_run(parts, versions[simd_level()], data);                                         \
    }

// Defines call_NAME(data), which calls NAME(const TYPE *data, 0) on this thread at the best level.
#define SIMD_CALL(name, type)                                                                      \
    SIMD_FOR_ANY static void name##_any(const type *data)                                          \
    {                                                                                              \
        name(data, 0);                                                                             \
    }                                                                                              \
    SIMD_FOR_AVX2 static void name##_avx2(const type *data)                                        \
    {                                                                                              \
        name(data, 0);                                                                             \
    }                                                                                              \
    SIMD_WITH_AVX512(                                                                              \
        SIMD_FOR_AVX512 static void name##_avx512(const type *data) { name(data, 0); })            \
    static void call_##name(const type *data)                                                      \
    {                                                                                              \
        static void (*const versions[SIMD_LEVELS])(const type *) = {name##_any, name##_avx2,       \
                                                                    SIMD_AVX512_OF(name)};         \
        versions[simd_level()](data);                                                              \
    }

SIMD_INLINE float simd_float_of(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

// One instruction each; for NaN they return the bound.
SIMD_INLINE float simd_max(float a, float least)
{
    return a > least ? a : least;
}
SIMD_INLINE float simd_min(float a, float most)
{
    return a < most ? a : most;
}

// The larger of x and 0, without a comparison: compilers turn comparisons whose outcome decides the
// next one into jumps, which prevents vectorisation.
SIMD_INLINE float simd_positive(float x)
{
    return 0.5f * (x + fabsf(x));
}

// The smallest integer that is not less, within the range of int.
SIMD_INLINE float simd_ceil(float x)
{
    float whole = (float)(int)x;
    return whole < x ? whole + 1 : whole;
}
