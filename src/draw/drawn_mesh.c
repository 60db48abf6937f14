// SPDX-License-Identifier: MIT
#include "draw/drawn_mesh.h"

#include <stdlib.h>
#include <string.h>

static void copy_vertices(DrawnMesh *drawn, const Mesh *mesh)
{
    memcpy(drawn->mesh.position, mesh->position, mesh->vertex_count * sizeof *mesh->position);
    memcpy(drawn->mesh.normal, mesh->normal, mesh->vertex_count * sizeof *mesh->normal);
    mesh_bounds(mesh, drawn->low, drawn->high);
}

Result drawn_mesh_set(DrawnMesh *drawn, const Mesh *mesh, const float color[3], Error *error)
{
    uint64_t version = drawn->version + 1;
    drawn_mesh_destroy(drawn);
    drawn->version = version;
    memcpy(drawn->color, color, sizeof drawn->color);
    if (mesh->triangle_count == 0) return RESULT_OK;
    TRY(mesh_create(&drawn->mesh, mesh->vertex_count, mesh->triangle_count, error));
    memcpy(drawn->mesh.triangle, mesh->triangle, mesh->triangle_count * sizeof *mesh->triangle);
    copy_vertices(drawn, mesh);
    return RESULT_OK;
}

void drawn_mesh_move(DrawnMesh *drawn, const Mesh *moved)
{
    if (!drawn->mesh.triangle_count) return;
    copy_vertices(drawn, moved);
    ++drawn->version;
}

Result drawn_mesh_set_openness(DrawnMesh *drawn, const float (*open)[2], Error *error)
{
    size_t size = drawn->mesh.vertex_count * sizeof *open;
    if (!size) return RESULT_OK;
    if (!drawn->open) drawn->open = malloc(size);
    if (!drawn->open) return error_set(error, RESULT_FAILED, "no memory for the sky on the mesh");
    memcpy(drawn->open, open, size);
    ++drawn->version;
    return RESULT_OK;
}

Result drawn_mesh_set_tint(DrawnMesh *drawn, const float (*tint)[3], Error *error)
{
    size_t size = drawn->mesh.vertex_count * sizeof *tint;
    if (!size) return RESULT_OK;
    if (!drawn->tint) drawn->tint = malloc(size);
    if (!drawn->tint) return error_set(error, RESULT_FAILED, "no memory for the mesh's tint");
    memcpy(drawn->tint, tint, size);
    ++drawn->version;
    return RESULT_OK;
}

void drawn_mesh_destroy(DrawnMesh *drawn)
{
    mesh_destroy(&drawn->mesh);
    free(drawn->open);
    free(drawn->tint);
    *drawn = (DrawnMesh){0};
}
