// SPDX-License-Identifier: MIT
// --scalp: a head for hair that comes without a mesh.
#pragma once

#include "scene/assets.h"

#include <stdio.h>

// Without a mesh, and unless --scalp is none, fits an ellipsoid to the roots of all sections that
// are not hidden (scalp_fit). If it looks like a head, the bundled one becomes the assets' mesh,
// its face towards +z, stretched so that its scalp is the ellipsoid; and, unless
// --no-collide-mesh, colliders of the scene that move with the head: a sphere and capsules inside
// the skull, which replace the mesh as a collider. One line on `messages` (NULL: not) says so, or
// with `verbose` why there is none; another names the --unit that gives the scalp a head's size
// where its width is 1.4 times another. RESULT_FAILED when
// memory is short.
Result scalp_guess(Scene *scene, Assets *assets, FILE *messages, bool verbose, Error *error);
