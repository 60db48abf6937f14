// SPDX-License-Identifier: MIT
// Meshes of Wavefront OBJ.
#include "fuzz/fuzz.h"
#include "mesh/obj.h"

#include <math.h>

void fuzz_mesh(const Bytes *bytes, int unused);

static void claim_mesh(const Mesh *mesh)
{
    fuzz_claim(mesh->vertex_count > 0 && mesh->triangle_count > 0, "an empty mesh");
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; ++i)
        fuzz_claim(mesh->triangle[i / 3][i % 3] < mesh->vertex_count, "a corner of no vertex");
    for (size_t i = 0; i < 3 * (size_t)mesh->vertex_count; ++i)
        fuzz_claim(isfinite(mesh->position[i / 3][i % 3]) && isfinite(mesh->normal[i / 3][i % 3]),
                   "vertex %zu is not finite", i / 3);
}

void fuzz_mesh(const Bytes *bytes, int unused)
{
    (void)unused;
    Mesh mesh = {0}, again = {0};
    Error error = {{0}};
    const char *path = fuzz_path("again.obj");
    Result result = obj_read_mesh(&mesh, fuzz_file("x.obj", bytes), 1, false, &error);
    fuzz_claim_error(result, &error);
    if (result == RESULT_OK) {
        claim_mesh(&mesh);
        result = obj_write_mesh(path, &mesh, &error);
        THEN(result, obj_read_mesh(&again, path, 1, false, &error));
        fuzz_claim(result == RESULT_OK, "written, but not read back: %s", error.text);
        fuzz_claim(mesh.vertex_count == again.vertex_count &&
                       mesh.triangle_count == again.triangle_count,
                   "written, the mesh reads back another");
    }
    mesh_destroy(&mesh);
    mesh_destroy(&again);
}
