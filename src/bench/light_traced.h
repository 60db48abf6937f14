// SPDX-License-Identifier: MIT
// Draws a case of path-traced light by our own path tracer (light_reference.h).
#pragma once

#include "bench/light_stage.h"

// Draws the stage's hair at rest into its image. `orders`: the most fibres that light meets;
// `paths`: for each pixel. RESULT_USAGE: the scene has a mesh, an environment, tilted scales or
// fibres that get thinner, or a light that is not directional and sharp.
Result light_traced_draw(LightStage *stage, int orders, int paths, Error *error);
