// SPDX-License-Identifier: MIT
// Inputs of stress.comp.
#include "common/shared.h"

// Buffer texture: positions before the step.
#define BIND_STRESS_BEFORE BIND_STATE

// Shader storage.
#define BIND_STRESS_WORST                                                                          \
    0 // vec4 per strand: largest length error, energy and move, relative to
      // their bounds; w > 0: energy and move were not checked
#define BIND_STRESS_FIRST                                                                          \
    1 // uvec4 per strand: the first step that broke each rule, 0: none. Rules:
      // finite numbers, length, energy, rest

UNIFORM_BLOCK(StressParams, stress_params, BIND_STEP)
{
    vec4 gravity;       // xyz, m/s^2: gravity that acts on the strand in this step
    vec4 gravity_first; // xyz, m/s^2: the same in the first step
    float strongest;    // m/s^2: largest such gravity so far
    float changes;      // m/s^2: sum of all changes of it so far
    float hangs;        // 1: the strand, except for carried vertices, began hanging straight down
    float per_dt;       // 1/s
    float kicks;        // m/s: sum of all changes of the root's velocity so far
    float spun; // 1/s: changes of velocity of vertex 1 about the root over their distance, if the
                // head carries vertex 1; otherwise 0
    float carried;     // 1: the head carries vertex 1
    float added;       // m^2/s^2: twice the energy that wind and a turning style may have added
    float rise;        // share of its bound and of mean(|g| l) by which energy may exceed the bound
    float rounding;    // error of a stored length or move, over a coordinate's size
    float bends;       // m^2/s^2: added to twice the energy by bending of one radian
    float resolved;    // energy is checked if segments are longer than this many roundings
    float noise_steps; // steps whose rounding errors may add up in velocities
    float length_error;  // allowed error of a segment's length; 0: not checked
    float rest_shortest; // m: strands with a segment as short as this need not rest
    float rest_resolved; // roundings: nor strands with a segment as short as this
    float flutter;       // load over stiffness if all weight compresses the strand
    float most_flutter; // above this (flutter times the compressing share) only lengths are checked
    float rest_move;    // m: allowed move in this step; 0: not checked
    float used_most;    // share of the allowed value up to which a rule is kept
    uint energy;        // whether energy is checked
    uint step;
    uint strand_count;
    uint vertex_count;
}
END_BLOCK(StressParams, stress_params);
