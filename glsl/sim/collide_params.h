// SPDX-License-Identifier: MIT
// What collide.comp is given, for one batch of strands. SI units.
#include "common/collider_table.h"
#include "common/shared.h"

#define CONTACT_VELOCITY_ROUNDS 8 // of Newton's method for the velocities, at most
#define CONTACT_PUSH_ROUNDS     3 // to push a particle out
// vec4 that are kept for a particle, and if strands bend (contact.glsl).
#define CONTACT_PLACES         7
#define CONTACT_BENDING_PLACES 10

UNIFORM_BLOCK(CollideParams, collide_params, BIND_STEP)
{
    vec4 head_rotation;        // quaternion x y z w: the head's frame -> world, at the step's end
    vec4 head_translation;     // xyz
    vec4 head_translation_old; // at its start
    vec4 head_turn_back; // quaternion: from the head's rotation at the end to that at the start
    vec4 field_low;      // a mesh's grid of distances: first point in the head's frame, spacing
    vec4 field_size;     // points along x y z
    // Of each group (collider_table.h): its first shape, the end of those that move with the head,
    // its end.
    uvec4 shapes[COLLIDER_GROUPS];
    float dt;           // s
    float margin;       // colliders are this much larger, m
    float longest;      // length of a strand at most, m
    float friction;     // Coulomb's coefficient
    float stamp;        // number of this step ...
    float stamp_before; // ... and of the one before
    float part;         // of the whole step that this (sub-)step is
    float bend;         // stiffness of bending over that of inertia, m^2 (SolverRecipe.bend)
    uint strand_count;
    uint vertex_count;
    uint carried; // vertices, from the root, that the head carries
    uint rounds;  // of Newton's method for the places, at most
}
END_BLOCK(CollideParams, collide_params);
