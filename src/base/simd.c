// SPDX-License-Identifier: MIT
#include "base/simd.h"

SimdLevel simd_level(void)
{
#if defined __x86_64__
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return SIMD_ANY;
    if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw"))
        return SIMD_AVX512;
    return SIMD_AVX2;
#else
    return SIMD_ANY;
#endif
}
