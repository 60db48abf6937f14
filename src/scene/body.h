// SPDX-License-Identifier: MIT
// A body that deforms: its mesh over time, parted into the motion of the head, that is the rigid
// motion that fits all roots best, and what remains, seen from the head. Time 0 is rest: there the
// head is where the files have it, and hair is bound to the mesh as it is then.
#pragma once

#include "mesh/mesh_binding.h"
#include "mesh/mesh_sequence.h"
#include "scene/rigid_track.h"
#include "strands/strands.h"

// The surface's points at the roots (or some of them), of which the head is made.
typedef struct BodyAnchors {
    BoundPoint *points;
    uint32_t count;
    Double3 *from, *to;
} BodyAnchors;

typedef struct Body {
    MeshSequence sequence; // in the head's frame
    RigidSamples head;     // its times.cut is the sequence's
    const Mesh *mesh;      // at time 0, in the head's frame; not owned
    const char *name;      // of the mesh's file, for messages; not owned
    MeshBinding *roots;    // [section_count]: of all strands, to the mesh at time 0
    uint32_t section_count;
    BodyAnchors anchors; // of a body that is driven (body_drive); else empty
    float margin;        // m: how far such a body's vertices may come from where they were at first
} Body;

typedef struct BodyOptions {
    const char *name;
    float cut_distance, cut_angle_deg; // of --teleport, for samples at 24 a second or more
    bool driven; // the sequence has two samples, alike; body_drive says what comes
} BodyOptions;

// Takes the sequence over, whose faces are `mesh`. Binds the strands of all sections to `rest` (of
// the same faces; empty: the mesh at time 0) and carries their vertices to the mesh at time 0;
// makes that the mesh. Where the roots' middle moves or the head turns by more than the options say
// from a sample to the next (at slower rates by as much more as they are slower), nothing lies
// between: a cut. RESULT_BAD_INPUT, which names unit and rest pose, if half of the roots are more
// than BODY_FAR from the mesh; RESULT_FAILED when memory is short. A zeroed body may be destroyed.
Result body_create(Body *body, MeshSequence *sequence, Mesh *mesh, const Mesh *rest,
                   Strands *strands, uint32_t section_count, const BodyOptions *options,
                   Error *error);
void body_destroy(Body *body);

// Goes on: the mesh is at `position` (m, in the world) at the time `after` (s), and gets there
// straight from where it is at `before`.
void body_drive(Body *body, float (*position)[3], double before, double after);

// The middle of all roots at time 0.
void body_middle(const Body *body, float middle[3]);

// The greatest distance (m) of the nearer half of a section's roots from the mesh, over sections.
float body_distance(const Body *body);

#define BODY_FAR   0.05f // m: roots as far off are an error, ...
#define BODY_APART 0.01f // ... and these a warning
