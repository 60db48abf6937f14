// SPDX-License-Identifier: MIT
#include "draw/render_floor.h"

#include "draw/render_uniforms.h"

enum { CORNERS = 64 };

bool render_floor_is_seen(const Floor *floor, const DrawParams *draw)
{
    return floor->kind != FLOOR_NONE && draw->eye[1] > floor->middle[1];
}

Result render_floor_build(RenderFloor *render, Error *error)
{
    const ShaderDefine defines[] = {{"FLOOR_CORNERS", CORNERS}, {NULL, 0}};
    if (render->depth) return RESULT_OK;
    glGenVertexArrays(1, &render->vertex_array);
    return shader_build_draw(&render->depth, "draw/floor.vert", "draw/depth.frag", defines, error);
}

static void set_place(const Floor *floor, float radius)
{
    glUniform3fv(0, 1, floor->middle);
    glUniform3f(1, floor->whole, floor->faded, radius);
}

void render_floor_set(const Floor *floor)
{
    float color[3];
    linear_from_srgb_color(floor->color, color);
    set_place(floor, floor->faded);
    glUniform3fv(2, 1, color);
}

// What lies before or behind all that the camera frames stays in the picture: its depth is cut.
Result render_floor_draw_depth(RenderFloor *render, const Floor *floor, Error *error)
{
    if (floor->kind != FLOOR_PLANE) return RESULT_OK;
    Result result = render_floor_build(render, error);
    if (result != RESULT_OK) return result;
    glUseProgram(render->depth);
    set_place(floor, 0.5f * (floor->whole + floor->faded));
    glEnable(GL_DEPTH_CLAMP);
    glBindVertexArray(render->vertex_array);
    glDrawArrays(GL_TRIANGLE_FAN, 0, CORNERS + 2);
    glDisable(GL_DEPTH_CLAMP);
    return RESULT_OK;
}

void render_floor_destroy(RenderFloor *render)
{
    if (render->depth) glDeleteProgram(render->depth);
    if (render->vertex_array) glDeleteVertexArrays(1, &render->vertex_array);
    *render = (RenderFloor){0};
}
