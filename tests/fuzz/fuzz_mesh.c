// SPDX-License-Identifier: MIT
// Meshes of Wavefront OBJ and PLY, and animated meshes of Alembic and USD.
#include "formats/mesh_read.h"
#include "formats/mesh_sequence.h"
#include "formats/obj.h"
#include "fuzz/fuzz.h"

#include <math.h>

void fuzz_mesh(const Bytes *bytes, int unused);
void fuzz_sequence(const Bytes *bytes, int unused);

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
    Result result = mesh_read(&mesh, fuzz_file("x.obj", bytes), 1, false, &error);
    fuzz_claim_error(result, &error);
    if (result == RESULT_OK) {
        claim_mesh(&mesh);
        result = obj_write_mesh(path, &mesh, &error);
        THEN(result, mesh_read(&again, path, 1, false, &error));
        fuzz_claim(result == RESULT_OK, "written, but not read back: %s", error.text);
        fuzz_claim(mesh.vertex_count == again.vertex_count &&
                       mesh.triangle_count == again.triangle_count,
                   "written, the mesh reads back another");
    }
    mesh_destroy(&mesh);
    mesh_destroy(&again);
}

void fuzz_sequence(const Bytes *bytes, int unused)
{
    (void)unused;
    Mesh mesh = {0}, rest = {0};
    MeshSequence sequence = {0};
    Error error = {{0}};
    const MeshSequenceOptions options = {
        .otherwise_unit = 1, .up_z = -1, .rest = "", .otherwise_rate = 24};
    const char *path = fuzz_file("x.abc", bytes);
    if (!mesh_sequence_matches(path)) return;
    Result result = mesh_sequence_read(&sequence, &mesh, &rest, path, &options, &error);
    fuzz_claim_error(result, &error);
    if (result == RESULT_OK) {
        claim_mesh(&mesh);
        fuzz_claim(sequence.vertex_count == mesh.vertex_count && sequence.times.count > 0,
                   "samples of another mesh");
    }
    mesh_sequence_destroy(&sequence);
    mesh_destroy(&mesh);
    mesh_destroy(&rest);
}
