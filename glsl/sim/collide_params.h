// SPDX-License-Identifier: MIT
// What collide.comp is given, for one batch of strands. SI units.
#include "common/shared.h"

UNIFORM_BLOCK(CollideParams, collide_params, BIND_STEP)
{
    vec4 head_rotation;        // quaternion x y z w: the head's frame -> world, at the step's end
    vec4 head_translation;     // xyz
    vec4 head_translation_old; // at its start
    vec4 head_turn_back; // quaternion: from the head's rotation at the end to that at the start
    vec4 field_low;      // a mesh's grid of distances: first point in the head's frame, spacing
    vec4 field_size;     // points along x y z
    float dt;            // s
    float margin;        // colliders are this much larger, m
    float longest;       // length of a strand at most, m
    float friction;      // Coulomb's coefficient
    float stamp;         // number of this step ...
    float stamp_before;  // ... and of the one before
    uint strand_count;
    uint vertex_count;
    uint carried;     // vertices, from the root, that the head carries
    uint cones;       // rounded cones in `colliders` ...
    uint cones_moved; // ... of which the first so many move with the head
    uint planes;      // planes, behind the cones
}
END_BLOCK(CollideParams, collide_params);

// Texels of a collider.
#define COLLIDER_TEXELS 3
