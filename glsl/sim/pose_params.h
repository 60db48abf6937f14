// SPDX-License-Identifier: MIT
// What pose.comp is given, for one batch of strands.
#include "common/shared.h"

UNIFORM_BLOCK(PoseParams, pose_params, BIND_STEP)
{
    vec4 head_rotation;    // quaternion x y z w: the head's frame -> world
    vec4 head_translation; // xyz, m
    vec4 hanging; // xyz: unit vector along which a strand at rest hangs, in the world (BOUND: at
                  // rest)
    vec4 turn_cos[2]; // polynomials of the turn, lowest power first (pose.c)
    vec4 turn_sin[2];
    uint strand_count;
    uint vertex_count;
    float held; // FADES 1: what is left of the style's hold on gravity, 0 .. 1
    uint lead;  // segments, from the root, that the head carries
}
END_BLOCK(PoseParams, pose_params);
