// SPDX-License-Identifier: MIT
#include "passes/mesh_shadow.h"

#include <string.h>

enum { SIDE = SHADOW_MESH_SIDE };

void mesh_shadow_destroy(MeshShadow *shadow)
{
    shader_release(shadow->program);
    if (shadow->depth) glDeleteTextures(1, &shadow->depth);
    if (shadow->frame) glDeleteFramebuffers(1, &shadow->frame);
    *shadow = (MeshShadow){0};
}

Result mesh_shadow_reserve(MeshShadow *shadow, int maps, Error *error)
{
    if (shadow->maps >= maps) return RESULT_OK;
    mesh_shadow_destroy(shadow);
    glGenTextures(1, &shadow->depth);
    glBindTexture(GL_TEXTURE_2D, shadow->depth);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_DEPTH_COMPONENT32F, SIDE, SIDE * maps);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glGenFramebuffers(1, &shadow->frame);
    glBindFramebuffer(GL_FRAMEBUFFER, shadow->frame);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, shadow->depth, 0);
    glDrawBuffer(GL_NONE);
    Result result = shader_build_draw(&shadow->program, "draw/shadow_mesh.vert", "draw/depth.frag",
                                      NULL, error);
    THEN(result, gpu_check("the mesh's shadow map", error));
    shadow->maps = maps;
    if (result != RESULT_OK) mesh_shadow_destroy(shadow);
    return result;
}

static void draw_maps(const MeshShadow *shadow, const RenderMesh *mesh, int maps)
{
    const float farthest = 1;
    glBindFramebuffer(GL_FRAMEBUFFER, shadow->frame);
    glDisable(GL_SCISSOR_TEST);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glClearBufferfv(GL_DEPTH, 0, &farthest);
    glUseProgram(shadow->program);
    glBindVertexArray(mesh->vertex_array);
    for (int map = 0; map < maps; ++map) {
        glViewport(0, map * SIDE, SIDE, SIDE);
        glUniform1i(1, map);
        glDrawElements(GL_TRIANGLES, (GLsizei)(3 * mesh->triangle_count), GL_UNSIGNED_INT, NULL);
    }
    glDisable(GL_DEPTH_TEST);
}

void mesh_shadow_draw(MeshShadow *shadow, const ShadowFrames *frames, const RenderMesh *mesh)
{
    ShadowMeshKey key = shadow_frames_mesh_key(frames);
    if (memcmp(&shadow->shown, &key, sizeof key) == 0) return;
    draw_maps(shadow, mesh, key.maps);
    memcpy(&shadow->shown, &key, sizeof key);
}

void mesh_shadow_bind(const MeshShadow *shadow)
{
    glActiveTexture(GL_TEXTURE0 + BIND_SHADOW_MESH);
    glBindTexture(GL_TEXTURE_2D, shadow->depth);
}
