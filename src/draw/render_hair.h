// SPDX-License-Identifier: MIT
// The hair as camera-facing ribbons: projects and shades particles, then sends the ribbons'
// fragments to the A-buffer.
#pragma once

#include "draw/render_cull.h"
#include "draw/render_look.h"
#include "gpu/gpu_timer.h"
#include "sim/hair.h"

#include <stdbool.h>

typedef struct RenderHair {
    LookPrograms project;
    GLuint draw;                // program
    GLuint vertex_array;        // without attributes
    GpuBuffer edges, shades;    // uvec4 a particle, see hair.vert
    GpuBuffer indices, command; // triangles, and how many of them: glDrawElementsIndirect
    GpuBuffer material;
} RenderHair;

// `nearest`: a ribbon hides all that is behind it, in every pixel of which it covers a sixteenth.
Result render_hair_create(RenderHair *hair, bool nearest, Error *error);
void render_hair_destroy(RenderHair *hair);

// Draws one batch into the current framebuffer and A-buffer, through the scissor, but for strands
// that `cull` leaves out if it tries. RESULT_FAILED if memory is short or a shader does not
// compile.
Result render_hair_draw(RenderHair *hair, const HairBatch *batch, const Look *look,
                        RenderCull *cull, const GpuLimits *limits, GpuTimer *timer, Error *error);
