// SPDX-License-Identifier: MIT
// What acts on all hair at a time: gravity and wind.
#pragma once

#include "scene/scene.h"

// The wind comes from four directions around the main one. A strand takes a mix of them by the
// place of its root, so that neighbours move alike and distant hair does not move in step. The mean
// of the four is the main wind.
typedef struct Forces {
    float gravity[3]; // m/s^2
    float wind[4][3]; // m/s
} Forces;

// Forces at `time` (s): keyframes if the scene has them, else the constants. The wind's strength is
// modulated by sines of gust_period and parts of it: between (1 - gust) and (1 + gust) of the mean.
void forces_evaluate(Forces *forces, const Scene *scene, double time);

// True if neither gravity nor wind changes over time.
bool forces_are_constant(const Scene *scene);
