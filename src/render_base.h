// SPDX-License-Identifier: MIT
// What stands behind and among the hair: mesh and floor over the background.
#pragma once

#include "gpu_timer.h"
#include "render_floor.h"
#include "render_mesh.h"

// A zeroed struct has no mesh.
typedef struct RenderBase {
    RenderMesh mesh;
    RenderFloor floor;
} RenderBase;

// Whether there is more than background.
bool render_base_is_needed(const RenderBase *base, const Floor *floor);

// Fills the target's depth and its `base`, over the background of the DrawParams block `draw`.
// `shadow`: what mesh and floor receive; needs render_shadow_bind. Spans "draw_mesh" and
// "draw_floor". Leaves scissor and writing of depth off. RESULT_FAILED if a shader does not
// compile.
Result render_base_draw(RenderBase *base, const Floor *floor, const RenderTarget *target,
                        const DrawParams *draw, Shadow shadow, GpuTimer *timer, Error *error);
void render_base_destroy(RenderBase *base);
