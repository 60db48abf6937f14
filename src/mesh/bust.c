// SPDX-License-Identifier: MIT
#include "mesh/bust.h"

#include <cglm/cglm.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

static Result grow_mesh(Mesh *mesh, uint32_t vertices, uint32_t triangles, Error *error)
{
    Mesh larger;
    Result result = mesh_create(&larger, mesh->vertex_count + vertices,
                                mesh->triangle_count + triangles, error);
    if (result != RESULT_OK) return result;
    memcpy(larger.position, mesh->position, mesh->vertex_count * sizeof *mesh->position);
    memcpy(larger.triangle, mesh->triangle, mesh->triangle_count * sizeof *mesh->triangle);
    if (mesh->uv && mesh_create_uv(&larger, mesh->uv_count, error) != RESULT_OK) {
        mesh_destroy(&larger);
        return RESULT_FAILED;
    }
    if (mesh->uv) {
        memcpy(larger.uv, mesh->uv, mesh->uv_count * sizeof *mesh->uv);
        memcpy(larger.triangle_uv, mesh->triangle_uv,
               mesh->triangle_count * sizeof *mesh->triangle_uv);
    }
    mesh_destroy(mesh);
    *mesh = larger;
    return RESULT_OK;
}

// A vertex of ring `ring` (0 .. rings), whose normal makes an angle of pi ring/rings with the axis
// e from b to a: it belongs to the sphere about a where that cosine is above the slope of the
// cone's side, (rb - ra)/length, else to that about b.
static void set_vertex(float at[3], const float a[4], const float b[4], vec3 frame[3], double slope,
                       double angle, double turn)
{
    const float *end = cos(angle) > slope ? a : b;
    vec3 normal = {0};
    glm_vec3_muladds(frame[0], (float)cos(angle), normal);
    glm_vec3_muladds(frame[1], (float)(sin(angle) * cos(turn)), normal);
    glm_vec3_muladds(frame[2], (float)(sin(angle) * sin(turn)), normal);
    for (int k = 0; k < 3; ++k) at[k] = end[k] + end[3] * normal[k];
}

// Squares between rings, triangles at the poles, which are rings of equal vertices.
static void set_triangles(Mesh *mesh, uint32_t first_vertex, uint32_t first_triangle,
                          uint32_t rings, uint32_t sectors)
{
    uint32_t t = first_triangle;
    for (uint32_t ring = 0; ring < rings; ++ring)
        for (uint32_t s = 0; s < sectors; ++s) {
            uint32_t a = first_vertex + ring * sectors + s;
            uint32_t b = first_vertex + ring * sectors + (s + 1) % sectors;
            uint32_t c = a + sectors, d = b + sectors;
            if (ring > 0) memcpy(mesh->triangle[t++], (uint32_t[]){a, c, b}, 12);
            if (ring + 1 < rings) memcpy(mesh->triangle[t++], (uint32_t[]){b, c, d}, 12);
        }
}

Result bust_append_cone(Mesh *mesh, const float a[4], const float b[4], uint32_t rings,
                        Error *error)
{
    const double pi = 3.14159265358979323846;
    uint32_t sectors = 2 * rings, vertices = mesh->vertex_count, triangles = mesh->triangle_count;
    Result result = grow_mesh(mesh, (rings + 1) * sectors, 2 * (rings - 1) * sectors, error);
    if (result != RESULT_OK) return result;
    vec3 frame[3];
    glm_vec3_sub((float *)a, (float *)b, frame[0]);
    double length = (double)glm_vec3_norm(frame[0]);
    glm_vec3_normalize(frame[0]);
    glm_vec3_ortho(frame[0], frame[1]);
    glm_vec3_normalize(frame[1]);
    glm_vec3_cross(frame[0], frame[1], frame[2]);
    double slope = length > 0 ? (double)(b[3] - a[3]) / length : 0;
    for (uint32_t ring = 0; ring <= rings; ++ring)
        for (uint32_t s = 0; s < sectors; ++s)
            set_vertex(mesh->position[vertices + ring * sectors + s], a, b, frame, slope,
                       pi * ring / rings, 2 * pi * s / sectors);
    set_triangles(mesh, vertices, triangles, rings, sectors);
    mesh_compute_normals(mesh);
    return RESULT_OK;
}

Result bust_append_shoulders(Mesh *mesh, Error *error)
{
    static const float cones[][2][4] = {
        {{0, -0.15f, -0.02f, 0.05f}, {0, -0.26f, -0.03f, 0.075f}},
        {{0.03f, -0.225f, -0.03f, 0.055f}, {0.165f, -0.255f, -0.03f, 0.052f}},
        {{-0.03f, -0.225f, -0.03f, 0.055f}, {-0.165f, -0.255f, -0.03f, 0.052f}},
        {{0.172f, -0.262f, -0.03f, 0.05f}, {0.2f, -0.4f, -0.02f, 0.042f}},
        {{-0.172f, -0.262f, -0.03f, 0.05f}, {-0.2f, -0.4f, -0.02f, 0.042f}},
        {{0.065f, -0.33f, -0.02f, 0.095f}, {-0.065f, -0.33f, -0.02f, 0.095f}},
    };
    Result result = RESULT_OK;
    for (size_t i = 0; i < sizeof cones / sizeof *cones && result == RESULT_OK; ++i)
        result = bust_append_cone(mesh, cones[i][0], cones[i][1], 12, error);
    return result;
}
