// SPDX-License-Identifier: MIT
#include "render_floor.h"

#include "render_uniforms.h"

enum { CORNERS = 64 };

bool render_floor_is_seen(const Floor *floor, const DrawParams *draw)
{
    return floor->kind != FLOOR_NONE && draw->eye[1] > floor->middle[1];
}

Result render_floor_build(RenderFloor *render, const Floor *floor, Shadow shadow, bool by_mesh,
                          Error *error)
{
    const ShaderDefine defines[] = {{"LIGHTS", 1},
                                    {"SHADOW", shadow},
                                    {"SHADOW_BY_MESH", by_mesh},
                                    {"CATCHER", floor->kind == FLOOR_SHADOW},
                                    {"FLOOR_CORNERS", CORNERS},
                                    {NULL, 0}};
    GLuint *color = &render->color[by_mesh];
    Result result = RESULT_OK;
    if (!*color) result = shader_build_draw(color, "floor.vert", "floor.frag", defines, error);
    if (result == RESULT_OK && !render->depth)
        result = shader_build_draw(&render->depth, "floor.vert", "depth.frag", defines, error);
    if (!render->vertex_array) glGenVertexArrays(1, &render->vertex_array);
    return result;
}

// What lies before or behind all that the camera frames stays in the picture: its depth is cut.
static void draw_disc(const RenderFloor *render, const Floor *floor, GLuint program, float radius)
{
    glUseProgram(program);
    glUniform3fv(0, 1, floor->middle);
    glUniform3f(1, floor->whole, floor->faded, radius);
    glEnable(GL_DEPTH_CLAMP);
    glBindVertexArray(render->vertex_array);
    glDrawArrays(GL_TRIANGLE_FAN, 0, CORNERS + 2);
    glDisable(GL_DEPTH_CLAMP);
}

Result render_floor_draw(RenderFloor *render, const Floor *floor, const RenderTarget *target,
                         Shadow shadow, bool by_mesh, Error *error)
{
    float color[3];
    Result result = render_floor_build(render, floor, shadow, by_mesh, error);
    if (result != RESULT_OK) return result;
    linear_from_srgb_color(floor->color, color);
    glUseProgram(render->color[by_mesh]);
    glUniform3fv(2, 1, color);
    glBindFramebuffer(GL_FRAMEBUFFER, target->smooth_frame);
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    draw_disc(render, floor, render->color[by_mesh], floor->faded);
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
    if (floor->kind == FLOOR_SHADOW) return RESULT_OK;
    glBindFramebuffer(GL_FRAMEBUFFER, target->hair_frame);
    draw_disc(render, floor, render->depth, 0.5f * (floor->whole + floor->faded));
    return RESULT_OK;
}

void render_floor_destroy(RenderFloor *render)
{
    const GLuint programs[] = {render->depth, render->color[0], render->color[1]};
    for (int i = 0; i < 3; ++i)
        if (programs[i]) glDeleteProgram(programs[i]);
    if (render->vertex_array) glDeleteVertexArrays(1, &render->vertex_array);
    *render = (RenderFloor){0};
}
