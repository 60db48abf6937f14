// SPDX-License-Identifier: MIT
// What vectors the processor has. A function that compilers make vectors of is built several times,
// and the best one that can run is called.
#pragma once

typedef enum Processor {
    PROCESSOR_ANY,    // what every processor of its family has
    PROCESSOR_AVX2,   // 8 floats, fused multiplication and addition
    PROCESSOR_AVX512, // the same with twice as many registers
    PROCESSOR_KINDS
} Processor;

// The best that this processor is.
Processor processor_kind(void);

// Attributes of a function for each; elsewhere than on x86 they say nothing.
#define FOR_ANY
#if defined __x86_64__
#define FOR_AVX2   __attribute__((target("avx2,fma")))
#define FOR_AVX512 __attribute__((target("avx2,fma,avx512vl,avx512dq,avx512bw")))
#else
#define FOR_AVX2
#define FOR_AVX512
#endif
