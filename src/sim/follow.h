// SPDX-License-Identifier: MIT
// Followers on the GPU: hair that is drawn but not simulated. Its positions are computed from
// guides, which a solver simulates (glsl/sim/follow.comp).
#pragma once

#include "gpu/shader.h"
#include "sim/bound.h"
#include "sim/solver.h"
#include "strands/follow_plan.h"

// A batch of followers, its guides, and the buffers that follow.comp reads.
typedef struct FollowBatch {
    uint32_t guide_batch, first_guide; // guide s is strand first_guide + s of that batch
    GpuBuffer offsets, guides;
    // Only where the mesh deforms (follow_bind), [slots] each:
    MeshBinding roots;
    struct FollowerRoot *root;
    float (*offset)[4]; // the content of `offsets`
} FollowBatch;

typedef struct Follow {
    // The followers. They have no style. Follower i of guide g is strand g * per_guide + i of its
    // batch.
    Hair hair;
    FollowBatch *batches; // [hair.batch_count]
    const Hair *guides;
    GpuTimer *timer;
    StepPass pass;
    uint32_t per_guide;
    float tip_separation, clump;
    FollowOptions options;
    const MeshBinding *guide_roots; // of all guides, by strand; NULL: the mesh does not deform
    double (*guide_rest)[3];        // their roots at rest, m
    double shape;                   // bound_body_shape for which the offsets were computed
} Follow;

// Plans the followers of `guides`, which are `strands` on the GPU and must outlive `follow`. If
// there are no followers, the result is all zero and the other functions do nothing. RESULT_USAGE
// if there would be 2^32 vertices or more; RESULT_FAILED if memory is short or a guide's followers
// exceed the driver's limits.
Result follow_create(Follow *follow, const Gpu *gpu, GpuTimer *timer, const Hair *guides,
                     const Strands *strands, const SectionParams *params, uint32_t seed,
                     Error *error);
void follow_destroy(Follow *follow);

// Binds the followers' roots to the mesh, so that they stay on it where it stretches. `roots`: the
// binding of the guides, by strand. `body` and `roots` must outlive `follow`. RESULT_FAILED when
// memory is short.
Result follow_bind(Follow *follow, BoundBody *body, const MeshBinding *roots,
                   const Strands *strands, Error *error);

// Updates the followers' offsets for the shape of the mesh at a time (s). Does nothing for
// followers that are not bound.
void follow_move(Follow *follow, BoundBody *body, double time);

// Computes the followers' positions from their guides (timer span "follow"). Queues GPU work.
void follow_write(Follow *follow, const HeadPose *head);
