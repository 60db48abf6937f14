// SPDX-License-Identifier: MIT
#include "run/drawn_bodies.h"

#include <cglm/cglm.h>

#include <stdlib.h>
#include <string.h>

void drawn_bodies_destroy(DrawnBodies *drawn)
{
    for (uint32_t b = 0; drawn->bodies && b < drawn->assets->body_count; ++b)
        mesh_destroy(&drawn->bodies[b].deformed);
    free(drawn->bodies);
    mesh_destroy(&drawn->mesh);
    *drawn = (DrawnBodies){0};
}

// The motion that takes points from the frame of `own` to that of `first`.
static HeadPose find_way(const HeadPose *own, const HeadPose *first)
{
    HeadPose way = {0};
    versor back;
    glm_quat_conjugate((float *)first->rotation, back);
    glm_quat_mul(back, (float *)own->rotation, way.rotation);
    glm_vec3_sub((float *)own->translation, (float *)first->translation, way.translation);
    glm_quat_rotatev(back, way.translation, way.translation);
    return way;
}

// The body's mesh in its own head's frame.
static const Mesh *shape_now(DrawnBodies *drawn, uint32_t b)
{
    BoundBody *body = &drawn->simulation->bodies[b].mesh;
    Mesh *mesh = &drawn->bodies[b].deformed;
    if (!body->body) return &drawn->assets->meshes[b];
    const BodyPose *pose = bound_body_pose(body, drawn->simulation->time);
    memcpy(mesh->position, pose->position, mesh->vertex_count * sizeof *mesh->position);
    mesh_compute_normals(mesh);
    return mesh;
}

static void place(const Mesh *from, const HeadPose *way, Mesh *to, uint32_t first)
{
    for (uint32_t v = 0; v < from->vertex_count; ++v) {
        float *position = to->position[first + v];
        glm_quat_rotatev((float *)way->rotation, from->position[v], position);
        glm_vec3_add(position, (float *)way->translation, position);
        glm_quat_rotatev((float *)way->rotation, from->normal[v], to->normal[first + v]);
    }
}

static bool move_body(DrawnBodies *drawn, uint32_t b)
{
    const MovingBody *moving = &drawn->simulation->bodies[b];
    const HeadPose *first = &drawn->simulation->bodies[0].head;
    DrawnBody *body = &drawn->bodies[b];
    double shape = bound_body_shape(&moving->mesh, drawn->simulation->time);
    HeadPose way = {.rotation = {0, 0, 0, 1}};
    if (b) way = find_way(&moving->head, first);
    if (body->placed && body->shape == shape && head_is_same(&body->way, &way)) return false;
    const Mesh *now = shape_now(drawn, b);
    if (b) {
        place(now, &way, &drawn->mesh, body->first);
    } else if (now->vertex_count > 0) { // a body without a mesh has no arrays
        memcpy(drawn->mesh.position, now->position, now->vertex_count * sizeof *now->position);
        memcpy(drawn->mesh.normal, now->normal, now->vertex_count * sizeof *now->normal);
    }
    *body = (DrawnBody){body->first, true, shape, way, body->deformed};
    return now->vertex_count > 0;
}

bool drawn_bodies_move(DrawnBodies *drawn)
{
    bool moved = false;
    for (uint32_t b = 0; b < drawn->assets->body_count; ++b)
        if (move_body(drawn, b)) moved = true;
    return moved;
}

static Result copy_triangles(DrawnBodies *drawn, uint32_t b, uint32_t first, Error *error)
{
    const Mesh *mesh = &drawn->assets->meshes[b];
    uint32_t(*to)[3] = drawn->mesh.triangle + first;
    Mesh *deformed = &drawn->bodies[b].deformed;
    for (uint32_t t = 0; t < mesh->triangle_count; ++t)
        for (int c = 0; c < 3; ++c) to[t][c] = mesh->triangle[t][c] + drawn->bodies[b].first;
    if (!drawn->simulation->bodies[b].mesh.body) return RESULT_OK;
    TRY(mesh_create(deformed, mesh->vertex_count, mesh->triangle_count, error));
    memcpy(deformed->triangle, mesh->triangle, mesh->triangle_count * sizeof *mesh->triangle);
    return RESULT_OK;
}

Result drawn_bodies_create(DrawnBodies *drawn, const Assets *assets, Simulation *simulation,
                           Error *error)
{
    *drawn = (DrawnBodies){.assets = assets, .simulation = simulation};
    uint64_t vertices = 0, triangles = 0;
    drawn->bodies = calloc((size_t)assets->body_count + 1, sizeof *drawn->bodies);
    for (uint32_t b = 0; drawn->bodies && b < assets->body_count; ++b) {
        drawn->bodies[b].first = (uint32_t)vertices;
        vertices += assets->meshes[b].vertex_count;
        triangles += assets->meshes[b].triangle_count;
    }
    if (!drawn->bodies || vertices > UINT32_MAX || triangles > UINT32_MAX)
        return error_set(error, RESULT_FAILED, "no memory for the meshes of %u bodies",
                         assets->body_count);
    TRY(mesh_create(&drawn->mesh, (uint32_t)vertices, (uint32_t)triangles, error));
    uint32_t first = 0;
    for (uint32_t b = 0; b < assets->body_count; ++b) {
        TRY(copy_triangles(drawn, b, first, error));
        first += assets->meshes[b].triangle_count;
    }
    drawn_bodies_move(drawn);
    return RESULT_OK;
}
