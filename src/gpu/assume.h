// SPDX-License-Identifier: MIT
// Imitates other devices for tests: decisions as on a GPU, few work groups, a small framebuffer,
// maths with other rounding.
#pragma once

#include "base/error.h"

#include <stdbool.h>

// The words of the environment variable TRACTRIX_ASSUME, each at most once, e.g. "hardware
// groups=7".
typedef struct Assumptions {
    bool hardware; // "hardware": work sizes, shaders and code paths as on a GPU, even on a CPU
                   // driver
    int groups;    // "groups=N": most work groups side by side; 0: the driver's limit
    int side_px;   // "side=N": most pixels across a framebuffer; 0: the driver's limit
    // "ulps=N": errors of sqrt, exp, log, sin and similar functions, in units of the last place
    // (glsl/common/perturb.glsl); 0: the driver's.
    int ulps;
} Assumptions;

// RESULT_USAGE with an unknown word. All 0 if the variable is not set.
Result assumptions_read(Assumptions *assumptions, Error *error);

// Removes the switch --assume-hardware, which the help does not list, from argv. It acts like
// "hardware" in this process and those that it starts. RESULT_FAILED when memory is short.
Result assumptions_take_option(int *argc, char **argv, Error *error);
