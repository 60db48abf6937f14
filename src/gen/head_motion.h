// SPDX-License-Identifier: MIT
// The generated head in motion: a skinned mesh that repeatedly turns and nods its neck, opens its
// jaw and raises its shoulders.
#pragma once

#include "mesh/mesh.h"

enum { HEAD_MOTION_RATE = 12, HEAD_MOTION_SECONDS = 8, HEAD_MOTION_TRIANGLES = 6000 };

// Writes HEAD_MOTION_SECONDS s of motion at HEAD_MOTION_RATE samples per second, plus a last sample
// that equals the first, as .npz (mesh_sequence.h); positions are integers in units of 0.01 mm.
// `mesh`: by head_make_mesh. The bytes are equal on every machine, except where rounding decides
// between two of those integers. RESULT_FAILED with the reason.
Result head_motion_write(const char *path, const Mesh *mesh, Error *error);
