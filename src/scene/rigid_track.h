// SPDX-License-Identifier: MIT
// The motion of a rigid body, the head, over time: by keyframes, by formulas, or by samples.
#pragma once

#include "base/formula.h"
#include "mesh/mesh_binding.h"
#include "mesh/sample_span.h"
#include "scene/keyframes.h"

// A motion by samples at even times. Between them it follows the smooth curve (sample_span) of the
// screw motions from a sample to its neighbours, so that what turns evenly about any axis, or flies
// with constant acceleration, does so between samples too.
typedef struct RigidSamples {
    SampleTimes times;
    RigidMotion *motion; // [times.count]
} RigidSamples;

RigidMotion rigid_samples_evaluate(const RigidSamples *samples, double time);

// Rotations are rotation vectors, axis times angle in radians, interpolated number by number: about
// one fixed axis that is the slerp, except that turns beyond 180 degrees, even several, are made as
// written. A track without keys and formulas moves or turns nothing; one of the two has either.
typedef struct RigidTrack {
    Keyframes translation;          // width 3, m
    Keyframes rotation;             // width 3, rad
    Formula translation_formula[3]; // m; all three or none
    Formula rotation_formula[3];    // degrees
    float pivot[3];                 // m, point that the rotation leaves in place
    const RigidSamples *samples;    // made before the rest of the track; not owned; NULL: none
} RigidTrack;

// Metres, and degrees of a formula's rotation, are cut to this either way.
#define RIGID_TRACK_MAX 1e6

// The motion at `time` (s): x' = R x + translation takes a point from where it is without the track
// to where it is at that time. `rotation` is the unit quaternion x, y, z, w of R (cglm's order). A
// formula's value beyond RIGID_TRACK_MAX counts as that, NaN as 0.
void rigid_track_evaluate(const RigidTrack *track, double time, float rotation[4],
                          float translation[3]);

// True if the body is at one place at all times.
bool rigid_track_is_still(const RigidTrack *track);

// Whether all formulas are finite and within RIGID_TRACK_MAX at `time`; RESULT_BAD_INPUT naming the
// formula.
Result rigid_track_check(const RigidTrack *track, double time, Error *error);

// A zeroed one may be destroyed.
void rigid_track_destroy(RigidTrack *track);
