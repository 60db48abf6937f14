// SPDX-License-Identifier: MIT
// The name of what draws, by which goldens are kept: two machines of one name draw the same bytes.
#pragma once

#include <stdbool.h>

enum { PLATFORM_BYTES = 96 }; // with the zero

// What the name is made from.
typedef struct PlatformFacts {
    const char *vendor, *renderer, *version; // GL_VENDOR, GL_RENDERER, GL_VERSION
    const char *machine;                     // of the processor: "x86_64"
    bool software;                           // a CPU driver
    bool fma;                                // which uses fused multiplication and addition
    bool assumed;                            // treated as hardware (gpu/assume.h)
} PlatformFacts;

// "llvmpipe-mesa22.3-llvm15-256-fma-x86_64", "nvidia-h100-pcie-550", "amd-radeon-rx-6800-mesa23.2":
// lower-case letters, digits, '_', '.' and '-'. A CPU driver begins with its own name, a GPU with
// its maker's, "gpu" if that is another one than those three. What rounds otherwise has another
// name: version of Mesa and LLVM, width of vectors, FMA, processor; of GPUs the driver's version.
void platform_name(char name[PLATFORM_BYTES], const PlatformFacts *facts);

// Whether Mesa's CPU drivers fuse on this processor.
bool platform_has_fma(void);
