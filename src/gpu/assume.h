// SPDX-License-Identifier: MIT
// Other devices imitated on this one, so that tests see what no machine of theirs has: decisions as
// on a GPU, few work groups, a framebuffer that is small, maths that rounds otherwise.
#pragma once

#include "base/error.h"

#include <stdbool.h>

// What TRACTRIX_ASSUME of the environment asks for: words, each once, e.g. "hardware groups=7".
typedef struct Assumptions {
    bool hardware; // "hardware": sizes, shaders and ways as on a GPU, also on a CPU driver
    int groups;    // "groups=N": at most so many work groups side by side; 0: as the driver allows
    int side_px;   // "side=N": framebuffers of at most so many pixels across; 0: as the driver
    int ulps;      // "ulps=N": sqrt, exp, log, sin and their like are off by N units in the last
                   // place (glsl/common/perturb.glsl); 0: as the driver has them
} Assumptions;

// RESULT_USAGE with the word that is not known. All 0 without the variable.
Result assumptions_read(Assumptions *assumptions, Error *error);

// Takes the switch --assume-hardware, which no help names, out of argv: as "hardware" does, in this
// process and those that it starts. RESULT_FAILED without memory.
Result assumptions_take_option(int *argc, char **argv, Error *error);
