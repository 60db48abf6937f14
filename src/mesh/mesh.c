// SPDX-License-Identifier: MIT
#include "mesh/mesh.h"

#include <cglm/cglm.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

Result mesh_create(Mesh *mesh, uint32_t vertex_count, uint32_t triangle_count, Error *error)
{
    *mesh = (Mesh){.vertex_count = vertex_count, .triangle_count = triangle_count};
    mesh->position = calloc((size_t)vertex_count + 1, sizeof *mesh->position);
    mesh->normal = calloc((size_t)vertex_count + 1, sizeof *mesh->normal);
    mesh->triangle = calloc((size_t)triangle_count + 1, sizeof *mesh->triangle);
    if (mesh->position && mesh->normal && mesh->triangle) return RESULT_OK;
    mesh_destroy(mesh);
    return error_set(error, RESULT_FAILED, "no memory for a mesh of %u vertices and %u triangles",
                     vertex_count, triangle_count);
}

Result mesh_create_uv(Mesh *mesh, uint32_t uv_count, Error *error)
{
    mesh->uv_count = uv_count;
    mesh->uv = calloc((size_t)uv_count + 1, sizeof *mesh->uv);
    mesh->triangle_uv = malloc(((size_t)mesh->triangle_count + 1) * sizeof *mesh->triangle_uv);
    if (!mesh->uv || !mesh->triangle_uv)
        return error_set(error, RESULT_FAILED, "no memory for %u texture coordinates", uv_count);
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++)
        mesh->triangle_uv[i / 3][i % 3] = MESH_NO_UV;
    return RESULT_OK;
}

void mesh_destroy(Mesh *mesh)
{
    free(mesh->position);
    free(mesh->normal);
    free(mesh->triangle);
    free(mesh->uv);
    free(mesh->triangle_uv);
    *mesh = (Mesh){0};
}

void mesh_take_away(Mesh *mesh, const double origin[3])
{
    if (origin[0] == 0 && origin[1] == 0 && origin[2] == 0) return;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        for (int k = 0; k < 3; k++)
            mesh->position[v][k] = (float)(mesh->position[v][k] - origin[k]);
}

void mesh_bounds(const Mesh *mesh, float low[3], float high[3])
{
    for (int axis = 0; axis < 3; axis++) {
        low[axis] = high[axis] = mesh->vertex_count ? mesh->position[0][axis] : 0.0f;
        for (uint32_t v = 1; v < mesh->vertex_count; v++) {
            low[axis] = fminf(low[axis], mesh->position[v][axis]);
            high[axis] = fmaxf(high[axis], mesh->position[v][axis]);
        }
    }
}

double mesh_diagonal(const Mesh *mesh)
{
    float low[3], high[3];
    double square = 0.0;
    mesh_bounds(mesh, low, high);
    for (int axis = 0; axis < 3; axis++) square += pow((double)high[axis] - (double)low[axis], 2);
    return sqrt(square);
}

// The cross product of two edges has twice the area of the triangle as its length, so the sum is
// weighted by area.
void mesh_compute_normals(Mesh *mesh)
{
    memset(mesh->normal, 0, mesh->vertex_count * sizeof *mesh->normal);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *corner = mesh->triangle[t];
        const float *a = mesh->position[corner[0]], *b = mesh->position[corner[1]];
        const float *c = mesh->position[corner[2]];
        float u[3], w[3];
        for (int i = 0; i < 3; i++) {
            u[i] = b[i] - a[i];
            w[i] = c[i] - a[i];
        }
        for (int i = 0; i < 3; i++) {
            int j = (i + 1) % 3, k = (i + 2) % 3;
            float normal = u[j] * w[k] - u[k] * w[j];
            for (int v = 0; v < 3; v++) mesh->normal[corner[v]][i] += normal;
        }
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        float *n = mesh->normal[v];
        double length = sqrt((double)n[0] * n[0] + (double)n[1] * n[1] + (double)n[2] * n[2]);
        bool usable = length > 0.0 && isfinite(length);
        for (int i = 0; i < 3; i++) n[i] = usable ? (float)(n[i] / length) : i == 1;
    }
}
