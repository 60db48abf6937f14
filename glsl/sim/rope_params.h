// SPDX-License-Identifier: MIT
// Parameters of rope.comp.
#include "common/shared.h"
#include "sim/style_spring.h"

UNIFORM_BLOCK(RopeParams, rope_params, BIND_SOLVER)
{
    StyleSpring first_spring; // in the first small step ...
    StyleSpring spring;       // ... and in later ones
    float first_decay;        // drag in the first small step: see forces.glsl
    float first_gain;
    float kept;     // 1 - damping, of a small step
    float softness; // alpha/h^2
    int small_steps;
    int sweeps;         // of each small step
    uint stretch_drawn; // 1: links are drawn as long as they are
}
END_BLOCK(RopeParams, rope_params);
