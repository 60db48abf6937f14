// SPDX-License-Identifier: MIT
#include "passes/render_mesh.h"

#include <math.h>

enum { OPEN = 2, TINT = 3 }; // places of attributes in mesh.vert, after position and normal

static void find_bounds(RenderMesh *mesh, const Mesh *source)
{
    for (int k = 0; k < 3; ++k) {
        mesh->low[k] = mesh->high[k] = source->position[0][k];
        for (uint32_t v = 1; v < source->vertex_count; ++v) {
            mesh->low[k] = fminf(mesh->low[k], source->position[v][k]);
            mesh->high[k] = fmaxf(mesh->high[k], source->position[v][k]);
        }
    }
}

static Result upload(RenderMesh *mesh, const Mesh *source, const GpuLimits *limits, Error *error)
{
    int64_t size = (int64_t)source->vertex_count * 12;
    TRY(gpu_buffer_create(&mesh->position, limits, "mesh positions", size, source->position, 0,
                          error));
    TRY(gpu_buffer_create(&mesh->normal, limits, "mesh normals", size, source->normal, 0, error));
    return gpu_buffer_create(&mesh->triangle, limits, "mesh triangles",
                             (int64_t)source->triangle_count * 12, source->triangle, 0, error);
}

static void describe_vertices(RenderMesh *mesh)
{
    const GpuBuffer *const attributes[] = {&mesh->position, &mesh->normal};
    glGenVertexArrays(1, &mesh->vertex_array);
    glBindVertexArray(mesh->vertex_array);
    for (GLuint i = 0; i < 2; ++i) {
        glBindBuffer(GL_ARRAY_BUFFER, attributes[i]->buffer);
        glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, 0, NULL);
        glEnableVertexAttribArray(i);
    }
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh->triangle.buffer);
    glBindVertexArray(0);
}

Result render_mesh_create(RenderMesh *mesh, const Mesh *source, const GpuLimits *limits,
                          Error *error)
{
    *mesh = (RenderMesh){0};
    if (source->triangle_count == 0) return RESULT_OK;
    find_bounds(mesh, source);
    Result result = upload(mesh, source, limits, error);
    THEN(result,
         shader_build_draw(&mesh->surface, "draw/mesh.vert", "draw/surface.frag", NULL, error));
    THEN(result, shader_build_draw(&mesh->edges, "draw/mesh.vert", "draw/depth.frag", NULL, error));
    if (result != RESULT_OK) {
        render_mesh_destroy(mesh);
        return result;
    }
    describe_vertices(mesh);
    mesh->triangle_count = source->triangle_count;
    return RESULT_OK;
}

void render_mesh_move(RenderMesh *mesh, const Mesh *moved)
{
    if (!mesh->triangle_count) return;
    find_bounds(mesh, moved);
    gpu_buffer_write(&mesh->position, 0, moved->position, mesh->position.size);
    gpu_buffer_write(&mesh->normal, 0, moved->normal, mesh->normal.size);
}

static void add_attribute(const RenderMesh *mesh, GLuint place, GLint width,
                          const GpuBuffer *values)
{
    glBindVertexArray(mesh->vertex_array);
    glBindBuffer(GL_ARRAY_BUFFER, values->buffer);
    glVertexAttribPointer(place, width, GL_FLOAT, GL_FALSE, 0, NULL);
    glEnableVertexAttribArray(place);
    glBindVertexArray(0);
}

Result render_mesh_set_openness(RenderMesh *mesh, const float (*open)[2], uint32_t vertex_count,
                                const GpuLimits *limits, Error *error)
{
    if (!mesh->triangle_count) return RESULT_OK;
    TRY(gpu_buffer_create(&mesh->open, limits, "the sky on the mesh",
                          (int64_t)vertex_count * (int64_t)sizeof *open, open, 0, error));
    add_attribute(mesh, OPEN, 2, &mesh->open);
    return RESULT_OK;
}

Result render_mesh_set_tint(RenderMesh *mesh, const float (*tint)[3], uint32_t vertex_count,
                            const GpuLimits *limits, Error *error)
{
    if (!mesh->triangle_count) return RESULT_OK;
    TRY(gpu_buffer_create(&mesh->tint, limits, "the mesh's tint",
                          (int64_t)vertex_count * (int64_t)sizeof *tint, tint, 0, error));
    add_attribute(mesh, TINT, 3, &mesh->tint);
    return RESULT_OK;
}

void render_mesh_destroy(RenderMesh *mesh)
{
    const GLuint programs[] = {mesh->surface, mesh->edges};
    for (int i = 0; i < 2; ++i) shader_release(programs[i]);
    if (mesh->vertex_array) glDeleteVertexArrays(1, &mesh->vertex_array);
    gpu_buffer_destroy(&mesh->position);
    gpu_buffer_destroy(&mesh->normal);
    gpu_buffer_destroy(&mesh->triangle);
    gpu_buffer_destroy(&mesh->open);
    gpu_buffer_destroy(&mesh->tint);
    *mesh = (RenderMesh){0};
}

static void draw_with(const RenderMesh *mesh, GLuint program)
{
    glUseProgram(program);
    glBindVertexArray(mesh->vertex_array);
    if (!mesh->open.buffer) glVertexAttrib2f(OPEN, 1, 1);
    if (!mesh->tint.buffer) glVertexAttrib3f(TINT, 1, 1, 1);
    glDrawElements(GL_TRIANGLES, (GLsizei)(3 * mesh->triangle_count), GL_UNSIGNED_INT, NULL);
}

void render_mesh_draw(const RenderMesh *mesh, const RenderTarget *target)
{
    if (!mesh->triangle_count) return;
    glBindFramebuffer(GL_FRAMEBUFFER, target->surface_frame);
    draw_with(mesh, mesh->surface);
    glBindFramebuffer(GL_FRAMEBUFFER, target->edge_frame);
    draw_with(mesh, mesh->edges);
}
