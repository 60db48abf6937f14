// SPDX-License-Identifier: MIT
#include "mesh/stand_in.h"

#include "mesh/head.h"

Result stand_in_make_mesh(Mesh *mesh, Error *error)
{
    const StandInTable *table = &STAND_IN_TABLE;
    TRY(mesh_create(mesh, table->vertex_count, table->triangle_count, error));
    for (uint32_t v = 0; v < table->vertex_count; v++)
        for (int i = 0; i < 3; i++)
            mesh->position[v][i] = (float)(table->position[v][i] * HEAD_UNIT);
    for (uint32_t t = 0; t < table->triangle_count; t++)
        for (int k = 0; k < 3; k++) mesh->triangle[t][k] = table->triangle[t][k];
    mesh_compute_normals(mesh);
    return RESULT_OK;
}
