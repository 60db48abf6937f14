// SPDX-License-Identifier: MIT
// Finds the nearest camera that sees all points of all frames, from the points themselves.
//
// A camera at target + d back looks along -back. Let `side` be the direction of one side of its
// frame (right, left, top or bottom) and s the slope of that side. A point p is within the side,
// with a margin `scale` (above 1), if
//     scale side . (p - target) <= s (d - back . (p - target)),
// that is, if d >= n . (p - target) with n = back + scale / s side. Each frame has four such n, and
// only the greatest n . p of all its points matters: d is the largest of (greatest n . p) - n .
// target. This is convex in the target, so nested searches find the best target.
#pragma once

#include "scene/outline.h"

typedef struct FitSide {
    float normal[3]; // n
    float widening;  // increase of n . p for a point with radius 1: scale / s
    float reach;     // m, greatest n . p; -infinity if there are no points yet
} FitSide;

// A zeroed struct may be destroyed.
typedef struct Fit {
    int frame_count;
    FitSide (*frames)[4]; // [frame_count], owned
} Fit;

// Whether the camera is automatic and its target does not move.
bool fit_is_free(const Scene *scene);

// Records the directions of the scene's camera in each of run.frames frames; `expected` is the
// result of outline_frame. RESULT_FAILED when memory is short.
Result fit_create(Fit *fit, const Scene *scene, const Framing *expected, Error *error);
void fit_destroy(Fit *fit);

// Adds points (metres) that must be visible in frame `frame`, each with a margin of `radius`.
void fit_add(Fit *fit, int frame, const float (*points)[3], size_t count, float radius);

// Moves the eye and, if it is automatic, the target of `framing`, which was passed to fit_create.
// Afterwards no point crosses the margin (run.margin) in any frame, and some point touches it. The
// target gets the height that brings the camera nearest. For whole turns, the axis is first moved
// to where left and right need the smallest distance. (For a part of a turn such an axis would lie
// in front of the hair.) Changes nothing if there are no points.
void fit_solve(const Fit *fit, const Scene *scene, Framing *framing);
