// SPDX-License-Identifier: MIT
// The camera that fills its frames: the nearest one that sees all points of all frames, found
// from the points themselves.
//
// A camera at target + d back looks along -back and sees a point p within `scale` (above 1) times
// the slope s of a side of its frame, given by the vector `side` (right, left, top or bottom), if
//     scale side . (p - target) <= s (d - back . (p - target)),
// so if d >= n . (p - target) with n = back + scale / s side. Four such n belong to a frame, and
// of all its points only the greatest n . p counts: d is the largest of greatest - n . target.
// That is convex in the target, so nested searches find the best one.
#pragma once

#include "scene/outline.h"

typedef struct FitSide {
    float normal[3]; // n
    float widening;  // of n . p by a point's own radius of 1: scale / s
    float reach;     // m, greatest n . p; -infinity: no points yet
} FitSide;

// A zeroed struct may be destroyed.
typedef struct Fit {
    int frame_count;
    FitSide (*frames)[4]; // [frame_count], owned
} Fit;

// Whether the scene leaves the camera to the program, and its target does not move.
bool fit_is_free(const Scene *scene);

// Takes the directions of the scene's camera in each of run.frames frames; `expected` is what
// outline_frame has found. RESULT_FAILED when memory is short.
Result fit_create(Fit *fit, const Scene *scene, const Framing *expected, Error *error);
void fit_destroy(Fit *fit);

// Points that are to be seen in frame `frame`, metres, each with so much around it.
void fit_add(Fit *fit, int frame, const float (*points)[3], size_t count, float radius);

// Moves the eye, and the target if that is automatic, of `framing`, which fit_create was given: in
// no frame does a point cross the margin (run.margin), and in some it touches it. The target gets
// the height that brings the camera nearest; of whole turns, before that, the axis from which left
// and right need the least distance. (Of a part of a turn that would be one in front of the hair.)
// Without points nothing changes.
void fit_solve(const Fit *fit, const Scene *scene, Framing *framing);
