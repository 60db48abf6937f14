// SPDX-License-Identifier: MIT
#include "draw/render_shadow_mesh.h"

#include <cglm/cglm.h>

#include <math.h>
#include <string.h>

enum {
    MARGIN = 6
}; // texels at the edges of a map that stay empty: all that a point beside it looks at

Result render_shadow_mesh_reserve(RenderShadowMesh *shadow, int maps, Error *error)
{
    if (shadow->maps >= maps) return RESULT_OK;
    render_shadow_mesh_destroy(shadow);
    glGenTextures(1, &shadow->depth);
    glBindTexture(GL_TEXTURE_2D, shadow->depth);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_DEPTH_COMPONENT32F, SHADOW_MESH_SIDE,
                   SHADOW_MESH_SIDE * maps);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glGenFramebuffers(1, &shadow->frame);
    glBindFramebuffer(GL_FRAMEBUFFER, shadow->frame);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, shadow->depth, 0);
    glDrawBuffer(GL_NONE);
    Result result = shader_build_draw(&shadow->program, "draw/shadow_mesh.vert", "draw/depth.frag",
                                      NULL, error);
    if (result == RESULT_OK) result = gpu_check("the mesh's shadow map", error);
    shadow->maps = maps;
    if (result != RESULT_OK) render_shadow_mesh_destroy(shadow);
    return result;
}

void render_shadow_mesh_destroy(RenderShadowMesh *shadow)
{
    if (shadow->program) glDeleteProgram(shadow->program);
    if (shadow->depth) glDeleteTextures(1, &shadow->depth);
    if (shadow->frame) glDeleteFramebuffers(1, &shadow->frame);
    *shadow = (RenderShadowMesh){0};
}

void shadow_mesh_add_box(const ShadowMesh *mesh, const LightView *view, double box[6])
{
    for (int corner = 0; corner < 8; ++corner) {
        vec3 x;
        versor turn = {0};
        double world[3], place[3];
        memcpy(turn, mesh->rotation, sizeof turn);
        for (int k = 0; k < 3; ++k)
            x[k] = (corner >> k & 1 ? mesh->mesh->high : mesh->mesh->low)[k];
        glm_quat_rotatev(turn, x, x);
        for (int k = 0; k < 3; ++k) world[k] = (double)(x[k] + mesh->translation[k]);
        if (!light_view_place(view, world, place)) continue;
        for (int k = 0; k < 3; ++k) {
            double bound = k < 2 && view->perspective ? LIGHT_FRAME_WIDE : LIGHT_FRAME_FAR;
            double value = fmin(fmax(place[k], -bound), bound);
            box[k] = fmin(box[k], value);
            box[k + 3] = fmax(box[k + 3], value);
        }
    }
}

// A texel's depth is that of its middle: on a surface that the light meets at 45 degrees it is off
// by a texel. Two of them by depth, and as much as a texel and a half along the normal. Before a
// lamp a texel is as wide as half-way, and its depth as steep as at the far end: less elsewhere.
ShadowMeshFrame shadow_mesh_frame(const LightView *view, const double box[6])
{
    ShadowMeshFrame mesh = {.frame = light_frame_drawn(view, box, SHADOW_MESH_SIDE, MARGIN)};
    double near = mesh.frame.depth[0], far = mesh.frame.depth[1], texel = mesh.frame.texel;
    if (view->perspective) {
        texel *= 0.5 * (near + far);
        mesh.depth_shift = 2 * texel * near / (far * (far - near));
    } else {
        mesh.depth_shift = 2 * texel / (far - near);
    }
    mesh.lift = 1.5 * texel;
    return mesh;
}

void render_shadow_mesh_draw(const RenderShadowMesh *shadow, const RenderMesh *mesh, int map)
{
    const float farthest = 1;
    glBindFramebuffer(GL_FRAMEBUFFER, shadow->frame);
    glDisable(GL_SCISSOR_TEST);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    if (map == 0) glClearBufferfv(GL_DEPTH, 0, &farthest);
    glViewport(0, map * SHADOW_MESH_SIDE, SHADOW_MESH_SIDE, SHADOW_MESH_SIDE);
    glUseProgram(shadow->program);
    glUniform1i(1, map);
    glBindVertexArray(mesh->vertex_array);
    glDrawElements(GL_TRIANGLES, (GLsizei)(3 * mesh->triangle_count), GL_UNSIGNED_INT, NULL);
    glDisable(GL_DEPTH_TEST);
}
