// SPDX-License-Identifier: MIT
// Hair that is bound to a body that deforms (scene/body.h): each strand has a frame of its own
// within the head's, a rotation and a translation that take it from rest to where the mesh has
// it. Frames depend on the time alone, so that a run may begin at any.
#pragma once

#include "gpu/gpu_buffer.h"
#include "sim/hair.h"
#include "sim/head.h"

// The mesh at one time.
typedef struct BodyPose {
    bool known;
    uint64_t used;        // the number of the last call that has given it
    double shape;         // mesh_sequence_shape
    float (*position)[3]; // in the head's frame
    double (*turn)[4];    // of the vertices that strands are bound to: unit quaternions
} BodyPose;

enum { BODY_POSES = 4 };

// The body of a simulation. A zeroed one may be destroyed.
typedef struct BoundBody {
    const Body *body; // NULL: nothing deforms
    MeshTurns turns;
    bool *wanted; // [vertices]: whose turns are found
    BodyPose poses[BODY_POSES];
    uint64_t calls; // of bound_body_pose
} BoundBody;

// `body` may be NULL, and outlives it. RESULT_FAILED when memory is short.
Result bound_body_create(BoundBody *bound, const Body *body, Error *error);
void bound_body_destroy(BoundBody *bound);

// A number that is equal for two times only if the mesh is equal to the bit; 0 without a body.
double bound_body_shape(const BoundBody *bound, double time);

// The mesh at a time. It holds for the next BODY_POSES - 1 calls.
const BodyPose *bound_body_pose(BoundBody *bound, double time);

// What the buffers hold.
typedef enum BoundContent {
    BOUND_NOTHING,
    BOUND_FRAMES,
    BOUND_BETWEEN,
    BOUND_MOTIONS
} BoundContent;

// A section's strands. A zeroed one may be destroyed.
typedef struct Bound {
    BoundBody *body; // NULL: nothing is bound
    const MeshBinding *roots;
    const Hair *hair;
    GpuBuffer *frames; // [hair->batch_count], for BIND_FRAMES (glsl/common/shared.h)
    BoundContent content;
    double shapes[3];   // of the mesh, for which the buffers are
    float (*texels)[4]; // what the buffers hold, MOST_TEXELS a strand, batch after batch
} Bound;

// Binds the strands of section `section`, which are `hair`. Both, and the body, outlive it; without
// a body the result is zero. RESULT_FAILED when memory is short.
Result bound_create(Bound *bound, BoundBody *body, uint32_t section, const Hair *hair,
                    const GpuLimits *limits, Error *error);
void bound_destroy(Bound *bound);

// Fills the buffers with the frames at two times (s). Skips what has not changed.
void bound_set(Bound *bound, double before, double after);

// The same where only the frames at one time matter, in the place of those after a step.
void bound_set_after(Bound *bound, double after);

// ... and for inbetween.comp.
void bound_set_between(Bound *bound, double earlier, double later, double now);

// ... with each strand's motion, for carry.comp: from rest on the mesh, and with the head, at one
// time to rest on both at another.
void bound_set_way(Bound *bound, double from_time, const HeadPose *from, double to_time,
                   const HeadPose *to);

// ... with the velocities that strands have at time 0, resting on mesh and head.
void bound_set_start(Bound *bound, const Scene *scene);

// Points beside the strands (followers' roots) that the mesh carries, too: [count].
Result bound_points_create(MeshBinding *binding, BoundBody *body, const float (*points)[3],
                           uint32_t count, Error *error);
