// SPDX-License-Identifier: MIT
// A deforming body. The mesh's motion is split into the head's motion, which is the rigid motion
// that fits all roots best, and the deformation that remains in the head's frame. At time 0 the
// head is where the files have it, and hair is bound to the mesh of that time.
#pragma once

#include "formats/mesh_sequence.h"
#include "mesh/mesh_binding.h"
#include "scene/rigid_track.h"
#include "strands/strands.h"

// Points of the surface at the roots (or some of them), which determine the head's motion.
typedef struct BodyAnchors {
    BoundPoint *points;
    uint32_t count;
    Double3 *from, *to;
} BodyAnchors;

typedef struct Body {
    MeshSequence sequence; // in the head's frame
    RigidSamples head;     // its times.cut is that of the sequence
    const Mesh *mesh;      // at time 0, in the head's frame; not owned
    const char *name;      // file name of the mesh, for messages; not owned
    MeshBinding *roots;    // [section_count] binds all strands to the mesh at time 0
    uint32_t section_count;
    BodyAnchors anchors; // only if the body is driven (body_drive), otherwise empty
    float margin;        // m; how far vertices of a driven body may come from their first positions
} Body;

typedef struct BodyOptions {
    const char *name;
    float cut_distance, cut_angle_deg; // of --teleport, for at least 24 samples per second
    bool driven; // the sequence has two equal samples; body_drive gives the following ones
} BodyOptions;

// Takes over the sequence, whose faces are those of `mesh`. Binds the strands of all sections to
// `rest` (with the same faces; empty: the mesh at time 0), moves their vertices to the mesh at time
// 0, and stores that in `mesh`. There is a cut between two samples (nothing is interpolated) if the
// centre of the roots moves or the head turns by more than the options permit; at lower sample
// rates the limits are proportionally larger. RESULT_BAD_INPUT, which mentions unit and rest pose,
// if the median distance of the roots from the mesh is more than BODY_FAR; RESULT_FAILED when
// memory is short. A zeroed body may be destroyed.
Result body_create(Body *body, MeshSequence *sequence, Mesh *mesh, const Mesh *rest,
                   Strands *strands, uint32_t section_count, const BodyOptions *options,
                   Error *error);
void body_destroy(Body *body);

// The next sample: the mesh is at `position` (m, in the world) at time `after` (s); it moves there
// linearly from its position at time `before`.
void body_drive(Body *body, float (*position)[3], double before, double after);

// The centre of all roots at time 0.
void body_middle(const Body *body, float middle[3]);

// The median distance (m) of the roots from the mesh; the largest over all sections.
float body_distance(const Body *body);

#define BODY_FAR   0.05f // m; a greater median distance is an error
#define BODY_APART 0.01f // m; a greater median distance causes a warning
