// SPDX-License-Identifier: MIT
// What stress.comp is given.
#include "common/shared.h"

// Buffer texture: positions before the step.
#define BIND_STRESS_BEFORE BIND_STATE

// Shader storage.
#define BIND_STRESS_WORST                                                                          \
    0 // vec4 a strand: greatest length error, energy and move, over what is
      // allowed; w > 0: energy and move were not looked at
#define BIND_STRESS_FIRST                                                                          \
    1 // uvec4 a strand: the first step that broke a rule, 0: none: a number
      // that is not finite, length, energy, rest

UNIFORM_BLOCK(StressParams, stress_params, BIND_STEP)
{
    vec4 gravity;       // xyz, m/s^2: what is felt in this step
    vec4 gravity_first; // xyz, m/s^2: in the first one
    float strongest;    // m/s^2: the most that was felt so far
    float changes;      // m/s^2: all changes of what is felt so far
    float hangs;        // 1: the strand began hanging straight down, behind what the head carries
    float per_dt;       // 1/s
    float kicks;        // m/s: all changes of the root's velocity so far
    float spun;         // 1/s: as kicks, of vertex 1 about the root, over their distance; where the
                        // head carries it, else 0
    float carried;      // 1: it does
    float added;        // m^2/s^2: what wind and the turning style may have added, twice the energy
    float rise;         // share of this and of mean(|g| l) by which energy may rise
    float rounding;     // of a coordinate's size: error of a stored length or move
    float bends;        // m^2/s^2: bends by a radian add this to twice the energy
    float resolved;     // roundings that all segments must be long for energy to be looked at
    float noise_steps;  // steps whose rounding may add up in velocities
    float length_error; // allowed, of a segment's length; 0: not looked at
    float rest_shortest; // m: strands with a segment as short need not rest
    float rest_resolved; // roundings: nor those with one as short as this
    float flutter;       // load over stiffness if all of the weight presses the strand together
    float most_flutter;  // above it, times the share that does, only lengths are looked at
    float rest_move;     // m: allowed in this step; 0: not looked at
    float used_most;     // share of what is allowed, above 0 to 1, that keeps a rule
    uint energy;         // whether it is looked at
    uint step;
    uint strand_count;
    uint vertex_count;
}
END_BLOCK(StressParams, stress_params);
