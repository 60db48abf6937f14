// SPDX-License-Identifier: MIT
// The floor behind the hair: a disc that is seen from above and receives shadows, but casts none.
#pragma once

#include "draw/render_target.h"
#include "gpu/shader.h"
#include "scene/floor.h"

#include "glsl/draw/draw.h"

// A zeroed struct is empty.
typedef struct RenderFloor {
    GLuint depth;        // program
    GLuint vertex_array; // without attributes
} RenderFloor;

// Whether anything of the floor is to be drawn: not to an eye that is not above it.
bool render_floor_is_seen(const Floor *floor, const DrawParams *draw);

// Compiles what a floor's depth needs, unless it is there.
Result render_floor_build(RenderFloor *render, Error *error);

// Gives a program in use that includes glsl/draw/floor_light.glsl the floor's place and colour.
void render_floor_set(const Floor *floor);

// Draws a plane's depth to the frame that is bound, which hides hair below it where more than half
// of it is left. Needs the DrawParams block, depth test and writing on. RESULT_FAILED if the shader
// does not compile.
Result render_floor_draw_depth(RenderFloor *render, const Floor *floor, Error *error);
void render_floor_destroy(RenderFloor *render);
