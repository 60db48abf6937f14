// SPDX-License-Identifier: MIT
// Hair that is bound to a mesh that deforms (scene/body.h). Each strand has a frame of its own
// within the head's frame: the rotation and translation that take the strand from its place at
// rest to its place on the deformed mesh. Frames depend on the time alone, so a run may begin at
// any time.
#pragma once

#include "gpu/gpu_buffer.h"
#include "sim/hair.h"
#include "sim/head.h"

// The mesh at one time.
typedef struct BodyPose {
    bool known;
    uint64_t used;        // the number of the last call that returned this pose
    double shape;         // mesh_sequence_shape
    float (*position)[3]; // in the head's frame
    double (*turn)[4];    // unit quaternions, of the vertices that strands are bound to
} BodyPose;

enum { BODY_POSES = 4 };

// The mesh that deforms, shared by all sections. A zeroed struct may be destroyed.
typedef struct BoundBody {
    const Body *body; // NULL: nothing deforms
    MeshTurns turns;
    bool *wanted; // [vertices]: whether a strand is bound there, so that its turn is needed
    BodyPose poses[BODY_POSES];
    uint64_t calls; // number of calls of bound_body_pose
} BoundBody;

// `body` may be NULL, and outlives it. RESULT_FAILED when memory is short.
Result bound_body_create(BoundBody *bound, const Body *body, Error *error);
void bound_body_destroy(BoundBody *bound);

// A number that identifies the shape of the mesh: it is equal at two times only if the mesh is the
// same bit for bit. 0 without a body.
double bound_body_shape(const BoundBody *bound, double time);

// The mesh at a time (s). The result stays valid during the next BODY_POSES - 1 calls.
const BodyPose *bound_body_pose(BoundBody *bound, double time);

// What Bound.frames hold at the moment.
typedef enum BoundContent {
    BOUND_NOTHING,
    BOUND_FRAMES,
    BOUND_BETWEEN,
    BOUND_MOTIONS
} BoundContent;

// A section's strands. A zeroed struct may be destroyed.
typedef struct Bound {
    BoundBody *body; // NULL: nothing is bound
    const MeshBinding *roots;
    const Hair *hair;
    GpuBuffer *frames; // [hair->batch_count], for BIND_FRAMES (glsl/common/shared.h)
    BoundContent content;
    double shapes[3];   // bound_body_shape at the times for which the buffers were filled
    float (*texels)[4]; // a copy of the buffers: MOST_TEXELS a strand, batch after batch
} Bound;

// Binds `hair`, the strands of the body's section `section`, to the body. `hair` and `body` must
// outlive `bound`. Without a body the result is all zero. RESULT_FAILED when memory is short.
Result bound_create(Bound *bound, BoundBody *body, uint32_t section, const Hair *hair,
                    const GpuLimits *limits, Error *error);
void bound_destroy(Bound *bound);

// The following functions fill the buffers; they do nothing if the buffers already hold the
// result. This one fills in the frames at two times (s), before and after a step.
void bound_set(Bound *bound, double before, double after);

// Fills in the frames at one time (s), in the place of those after a step.
void bound_set_after(Bound *bound, double after);

// Fills in the frames at three times (s), for inbetween.comp.
void bound_set_between(Bound *bound, double earlier, double later, double now);

// Fills in each strand's rigid motion, for carry.comp: from rest on head and mesh at one time to
// rest on them at another time.
void bound_set_way(Bound *bound, double from_time, const HeadPose *from, double to_time,
                   const HeadPose *to);

// Fills in the velocities that strands at rest on mesh and head have at time 0, for carry.comp.
void bound_set_start(Bound *bound, const RigidTrack *head);

// Binds other points than strands to the mesh: the roots of followers, points[count].
Result bound_points_create(MeshBinding *binding, BoundBody *body, const float (*points)[3],
                           uint32_t count, Error *error);
