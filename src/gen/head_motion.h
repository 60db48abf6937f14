// SPDX-License-Identifier: MIT
// The generated head in motion: a skinned mesh whose neck turns and nods, whose jaw opens and whose
// shoulders rise, over and over.
#pragma once

#include "mesh/mesh.h"

enum { HEAD_MOTION_RATE = 12, HEAD_MOTION_SECONDS = 8, HEAD_MOTION_TRIANGLES = 6000 };

// Writes HEAD_MOTION_SECONDS s of motion, HEAD_MOTION_RATE samples a second and one more, so that
// the last is the first again, as .npz (mesh_sequence.h): positions are whole numbers of 0.01 mm.
// `mesh`: that of head_make_mesh. The same bytes on every machine, but where rounding falls between
// two of those numbers. RESULT_FAILED with the reason.
Result head_motion_write(const char *path, const Mesh *mesh, Error *error);
