// SPDX-License-Identifier: MIT
// Draws a case of path-traced light by our own path tracer (light_reference.h).
#pragma once

#include "bench/light_stage.h"

// Draws the stage's hair at rest into its image. `orders`: the most fibres that light meets;
// `paths`: for each pixel. RESULT_USAGE for a scene with a mesh, an environment, a light that is
// not directional and sharp, or fibres that differ, move or have other than Marschner's shading
// with scales that are not tilted.
Result light_traced_draw(LightStage *stage, int orders, int paths, Error *error);
