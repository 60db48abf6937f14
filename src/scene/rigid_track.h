// SPDX-License-Identifier: MIT
// The motion of a rigid body (the head) over time: by keyframes, formulas or samples.
#pragma once

#include "mesh/mesh_binding.h"
#include "mesh/sample_span.h"
#include "scene/track.h"

// A motion given by samples at even times. Between samples it follows the smooth curve
// (sample_span) of the screw motions from a sample to its neighbours. So a body that turns evenly
// about any axis, or flies with constant acceleration, does so between samples, too.
typedef struct RigidSamples {
    SampleTimes times;
    RigidMotion *motion; // [times.count]
} RigidSamples;

RigidMotion rigid_samples_evaluate(const RigidSamples *samples, double time);

// Rotations are rotation vectors (axis times angle, rad), interpolated by component. For a fixed
// axis this is a slerp, except that turns of more than 180 degrees, even several turns, are made as
// written. A track without keys and formulas does nothing; translation and rotation each have
// either keys or formulas.
typedef struct RigidTrack {
    Track translation;           // width 3, m
    Track rotation;              // width 3, rad; formulas in degrees
    float pivot[3];              // m, point that rotations leave in place
    const RigidSamples *samples; // applied before the rest of the track; not owned; NULL if there
                                 // are none
} RigidTrack;

// The largest coordinate of a moved body (m), and the largest value of a formula (m or degrees).
#define RIGID_TRACK_MAX 1e6

// The ranges of formulas: up to RIGID_TRACK_MAX in either direction.
extern const TrackRange RIGID_TRACK_METRES, RIGID_TRACK_DEGREES;

// The motion at `time` (s): x' = R x + translation moves a point from its place without the track
// to its place at that time. `rotation` is the unit quaternion x, y, z, w of R (cglm's order).
void rigid_track_evaluate(const RigidTrack *track, double time, float rotation[4],
                          float translation[3]);

// Where the motion takes `point` (m), in double precision: `translation` above is rounded by more
// than a short step moves a body that is far from the origin.
void rigid_track_place(const RigidTrack *track, double time, const float point[3], double place[3]);

// Whether the body stays at one place.
bool rigid_track_is_still(const RigidTrack *track);

// Checks that all formulas are finite and in their range at `time`; RESULT_BAD_INPUT with the
// formula's name.
Result rigid_track_check(const RigidTrack *track, double time, Error *error);

// A zeroed track may be destroyed.
void rigid_track_destroy(RigidTrack *track);
