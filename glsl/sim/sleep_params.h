// SPDX-License-Identifier: MIT
// What sleep.comp is given, for one batch of strands.
#include "common/shared.h"

// Shader storage.
#define BIND_ANCHORS_OUT 0 // vec4 a particle: where it was (m), how far it has been from there (m)
#define BIND_CALM_OUT    1 // uint a strand: checks in a row that found it calm, and SLEEP_READY

#define SLEEP_READY 0x80000000u // they were enough once

// New anchors: for strands that have left theirs; for those too that are not ready; for all.
#define SLEEP_ANCHOR_LEFT    0u
#define SLEEP_ANCHOR_UNREADY 1u
#define SLEEP_ANCHOR_ALL     2u

UNIFORM_BLOCK(SleepParams, sleep_params, BIND_STEP)
{
    float leave;        // of a strand's length: a particle farther from its anchor is on its way
    float grow;         // of a strand's length: it has come farther if it has by more than this
    float checks;       // in a row that are enough for a strand that does not tremble
    float checks_reach; // more of them for each strand's length of trembling
    uint anchor;        // SLEEP_ANCHOR_...
    uint strand_count;
    uint vertex_count;
}
END_BLOCK(SleepParams, sleep_params);
