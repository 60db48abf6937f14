// SPDX-License-Identifier: MIT
// A head that moves by formulas, for tests.
#pragma once

#include "scene/rigid_track.h"

// The test fails if a formula is wrong. The track has no keys.
void head_set_translation(RigidTrack *head, const char *x, const char *y, const char *z); // m
void head_set_rotation(RigidTrack *head, const char *x, const char *y, const char *z);    // degrees
