// SPDX-License-Identifier: MIT
// Implements --scalp: a head for hair without a mesh.
#pragma once

#include "scene/assets.h"

#include <stdio.h>

// For each body without a mesh, if --scalp is not none, fits an ellipsoid to the roots of all its
// visible sections (scalp_fit). If it looks like a head, the bundled head becomes the body's mesh,
// facing +z and scaled so that its scalp is the ellipsoid. Unless --no-collide-mesh is given, the
// body gets colliders that move with the head: a sphere and capsules inside the skull, which
// replace the mesh as a collider. Prints one line on `messages` (NULL: does not print) about it or,
// with `verbose`, about why there is no head. If the scalp's width differs from a head's by a
// factor of more than 1.4, another line suggests a --unit; if the roots surround a body (fur), one
// asks for --mesh. RESULT_FAILED when memory is short.
Result scalp_guess(Scene *scene, Assets *assets, FILE *messages, bool verbose, Error *error);
