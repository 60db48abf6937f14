// SPDX-License-Identifier: MIT
// The pass that pushes a section's hair out of the scene's colliders (glsl/sim/collide.comp).
#pragma once

#include "gpu/shader.h"
#include "sim/recipe.h"

#include "glsl/sim/collide_params.h"

// What the pass works on; the values are those of MODE in collide.comp.
typedef enum CollisionMode {
    COLLISION_PARTICLES, // positions in Hair's buffer and velocities
    COLLISION_SEGMENTS,  // unit directions with lengths, and tips: the state of split
    COLLISION_DRAWN,     // positions in Hair's buffer alone
    COLLISION_FINDING,   // pushes nothing: measures the clearances (see collide.comp)
} CollisionMode;

typedef struct CollisionBatch {
    GpuBuffer contacts; // vec4 a particle: its position (xyz) at the end of step number w
    // With COLLISION_PARTICLES:
    GpuBuffer forces;  // vec4 a particle: see collide.comp
    GpuBuffer scratch; // of the lanes: glsl/sim/scratch.glsl
    GpuBuffer counts;  // uvec4 a strand: see collide.comp
} CollisionBatch;

// A zeroed struct is a pass that does nothing.
typedef struct Collision {
    const Hair *hair;
    const Hair *bounds; // hair whose bounds and longest strand are used for `hair`
    const SectionParams *params;
    const Colliders *colliders; // never NULL while it is on
    const DistanceField *field; // may be NULL
    const GpuBuffer *frames;    // of bound strands (bound.h); may be NULL
    CollisionMode mode;
    uint32_t carried; // vertices, from the root, that the head carries
    float (*bend)(const SectionParams *params, double dt); // SolverRecipe.bend
    bool midpoint;                                         // SolverRecipe.midpoint
    uint32_t strands_per_lane;
    bool software;
    StepPass pass;
    GpuBuffer shapes;
    CollisionBatch *batches; // [hair->batch_count]; NULL with COLLISION_DRAWN
    GpuBuffer *clearances;   // [hair->batch_count] float a particle: see collide.comp; NULL: none
    CollideParams step;      // the present one's
} Collision;

// The result is empty if the scene has no colliders.
// With setup->keeps_groom, particles may stay as near to colliders as they are in the groom,
// except in mode COLLISION_SEGMENTS. The hair's positions must then be those of the groom, with
// the head at the origin.
// Mode COLLISION_DRAWN changes no velocities and has no friction.
// `recipe`: of the solver; NULL: the hair only follows other hair.
// RESULT_USAGE for more colliders than the loops of a CPU driver can take.
Result collision_create(Collision *collision, const SolverSetup *setup, CollisionMode mode,
                        const SolverRecipe *recipe, Error *error);
void collision_destroy(Collision *collision);

// Places the colliders for the end of sub-step `part` (1 .. `parts`) of a step; step->head is the
// head at that time. False if the hair cannot reach any collider.
bool collision_begin(Collision *collision, const SolverStep *step, int part, int parts);

// Pushes batch `batch` out of the colliders. `state`: its velocities or segments; `tips`: the tips
// of `split`, NULL for other solvers. Queues GPU work; later texture fetches and storage reads see
// the result.
void collision_push(Collision *collision, uint32_t batch, const GpuBuffer *state,
                    const GpuBuffer *tips);

// collision_begin and collision_push for all batches, for COLLISION_DRAWN.
void collision_push_drawn(Collision *collision, const HeadPose *head);

// What batch `batch` passes on to the next step; NULL: nothing. Valid as long as the collision.
const CollisionBatch *collision_memory(const Collision *collision, uint32_t batch);

// Adds contacts and depths to `report`. Waits for the GPU.
void collision_report(const Collision *collision, SolverReport *report);
