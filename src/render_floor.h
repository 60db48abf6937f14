// SPDX-License-Identifier: MIT
// The floor behind the hair: a disc that is seen from above and receives shadows, but casts none.
#pragma once

#include "floor.h"
#include "render_target.h"
#include "shader.h"

#include "draw.h"

// A zeroed struct is empty.
typedef struct RenderFloor {
    GLuint depth, color[2]; // programs; color where nothing but hair casts shadows, and with a mesh
    GLuint vertex_array;    // without attributes
} RenderFloor;

// Whether anything of the floor is to be drawn: not to an eye that is not above it.
bool render_floor_is_seen(const Floor *floor, const DrawParams *draw);

// Compiles what such a floor needs, unless it is there.
Result render_floor_build(RenderFloor *render, const Floor *floor, Shadow shadow, bool by_mesh,
                          Error *error);

// Draws over what the target's samples show and into its depth, which hides hair below a plane
// where more than half of it is left. `shadow`: what it receives, the mesh's, too, if `by_mesh`.
// Needs the DrawParams block and render_shadow_bind. RESULT_FAILED if a shader does not compile.
Result render_floor_draw(RenderFloor *render, const Floor *floor, const RenderTarget *target,
                         Shadow shadow, bool by_mesh, Error *error);
void render_floor_destroy(RenderFloor *render);
