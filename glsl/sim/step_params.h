// SPDX-License-Identifier: MIT
// What a step of any solver is given, for one batch of strands. SI units. A solver's own parameters
// stand in a block of their own (BIND_SOLVER), such as chain_params.h.
#include "common/shared.h"

UNIFORM_BLOCK(StepParams, step_params, BIND_STEP)
{
    vec4 head_rotation_old;    // quaternion x y z w: the head's frame -> world, at the step's start
    vec4 head_translation_old; // xyz
    vec4 head_rotation;        // at the step's end
    vec4 head_translation;
    vec4 head_pivot; // xyz, m, a point near the roots, in the head's frame
    vec4 head_move;  // xyz, m, the pivot's displacement in the step
    vec4 gravity;    // xyz, m/s^2
    // xyz, m/s^2, BOUND 1: what the groom holds of it (solver.c), in the strand's frame of rest
    vec4 held;
    vec4 wind[4]; // xyz, m/s: four directions around the main one, mixed for each strand
    // xyz, m: the middle of the head; w: share of the wind that it keeps off behind it
    vec4 shelter;
    vec4 head_velocity; // xyz, m/s, of that middle
    float dt;           // s
    float decay;        // e^{-c h}: what drag leaves of a velocity
    float gain;         // h f: seconds that an acceleration acts
    float drag;         // c, 1/s
    uint strand_count;
    uint vertex_count;
    uint phase;      // which dispatch of a step this is
    float frame_old; // BOUND 1: shares of the way from the frames before the whole step to those
    float frame_now; // after it, at the start and the end of this part of it
}
END_BLOCK(StepParams, step_params);
