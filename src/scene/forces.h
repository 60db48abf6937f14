// SPDX-License-Identifier: MIT
// Forces on all hair at a time: gravity and wind.
#pragma once

#include "scene/scene.h"

// There are four winds around the main wind, which is their mean. Each strand gets a mix of them
// that depends on the place of its root, so that neighbours move alike and distant hair does not
// move in step.
typedef struct Forces {
    float gravity[3]; // m/s^2
    float wind[4][3]; // m/s
} Forces;

// Forces at `time` (s): from keyframes or formulas if the scene has them, otherwise constant.
// Before time 0 keyframes and formulas keep their values of time 0, as the head does. The wind's
// strength is modulated by sines of gust_period and fractions of it, between (1 - gust) and (1 +
// gust) times the mean.
void forces_evaluate(Forces *forces, const Scene *scene, double time);

// The greatest gravity (m/s^2) and main wind (m/s, at the peak of a gust) of the whole run.
typedef struct ForcesMost {
    double gravity, wind;
} ForcesMost;
ForcesMost forces_most(const Scene *scene);

// True if neither gravity nor wind changes over time.
bool forces_are_constant(const Scene *scene);
