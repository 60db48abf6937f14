// SPDX-License-Identifier: MIT
// The name of a rendering platform, by which goldens are kept: machines with the same name draw the
// same bytes.
#pragma once

#include <stdbool.h>

enum { PLATFORM_BYTES = 96 }; // with the zero

// The facts that determine the name.
typedef struct PlatformFacts {
    const char *vendor, *renderer, *version; // GL_VENDOR, GL_RENDERER, GL_VERSION
    const char *machine;                     // architecture of the processor: "x86_64"
    bool software;                           // a CPU driver
    bool fma;                                // the CPU driver uses fused multiply-add
    bool assumed;                            // treated as hardware (gpu/assume.h)
} PlatformFacts;

// Names such as "llvmpipe-mesa22.3-llvm15-256-fma-x86_64", "nvidia-h100-pcie-550",
// "amd-radeon-rx-6800-mesa23.2": lower-case letters, digits, '_', '.' and '-'. A CPU driver's name
// comes first; for a GPU the maker's, or "gpu" if the maker is unknown. Everything that changes
// rounding is part of the name: versions of Mesa and LLVM, vector width, FMA, processor; for GPUs
// the driver's version.
void platform_name(char name[PLATFORM_BYTES], const PlatformFacts *facts);

// Whether Mesa's CPU drivers use fused multiply-add on this processor.
bool platform_has_fma(void);
