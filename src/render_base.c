// SPDX-License-Identifier: MIT
#include "render_base.h"

bool render_base_is_needed(const RenderBase *base, const Floor *floor)
{
    return base->mesh.triangle_count > 0 || floor->kind != FLOOR_NONE;
}

static void begin(const RenderTarget *target, const float background[4])
{
    const float farthest = 1;
    glDisable(GL_SCISSOR_TEST);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glBindFramebuffer(GL_FRAMEBUFFER, target->hair_frame);
    glClearBufferfv(GL_DEPTH, 0, &farthest);
    glBindFramebuffer(GL_FRAMEBUFFER, target->smooth_frame);
    glClearBufferfv(GL_DEPTH, 0, &farthest);
    glClearBufferfv(GL_COLOR, 0, background);
}

static void finish(const RenderTarget *target)
{
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target->smooth_frame);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target->base_frame);
    int width = target->width * target->samples, height = target->height * target->samples;
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glDepthMask(GL_FALSE);
}

Result render_base_draw(RenderBase *base, const Floor *floor, const RenderTarget *target,
                        const DrawParams *draw, Shadow shadow, GpuTimer *timer, Error *error)
{
    Result result = RESULT_OK;
    if (!render_base_is_needed(base, floor)) return result;
    gpu_timer_begin(timer, "draw_mesh");
    begin(target, draw->background);
    render_mesh_draw(&base->mesh, target);
    gpu_timer_end(timer);
    if (render_floor_is_seen(floor, draw)) {
        gpu_timer_begin(timer, "draw_floor");
        result = render_floor_draw(&base->floor, floor, target, shadow,
                                   base->mesh.triangle_count > 0, error);
        gpu_timer_end(timer);
    }
    finish(target);
    return result;
}

void render_base_destroy(RenderBase *base)
{
    render_mesh_destroy(&base->mesh);
    render_floor_destroy(&base->floor);
}
