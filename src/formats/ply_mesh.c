// SPDX-License-Identifier: MIT
#include "formats/ply_mesh.h"

#include "formats/foreign.h"
#include "formats/ply.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef enum Role { X, Y, Z, STRANDS, INDICES, INDEX, ROLES } Role;

static const char *const ROLE_NAMES[ROLES] = {"x",           "y", "z", "nsegs", "vertex_indices",
                                              "vertex_index"};

enum { MOST_CORNERS = 4096 }; // corners of a polygon

typedef struct PlyMesh {
    PlyFile file;
    Reader *reader;
    float (*position)[3]; // [vertices]
    uint32_t vertices;
    uint32_t (*triangle)[3]; // [triangles]
    size_t triangles, room;
} PlyMesh;

bool ply_mesh_matches(const Bytes *bytes)
{
    return ply_matches(bytes);
}

static void read_vertices(PlyMesh *ply, const PlyElement *element, float unit, bool up_z)
{
    Reader *reader = ply->reader;
    if (!element->has[X] || !element->has[Y] || !element->has[Z])
        reader_fail(reader, "vertices without x, y and z");
    if (!reader_ok(reader) || !ply_check_count(&ply->file, element)) return;
    ply->position = reader_malloc(reader, ((size_t)element->count + 1), sizeof *ply->position);
    for (uint32_t v = 0; v < element->count && reader_ok(reader); v++) {
        double values[ROLES] = {0};
        ply_read_row(&ply->file, element, values);
        const double p[3] = {values[X] * (double)unit, values[up_z ? Z : Y] * (double)unit,
                             (up_z ? -values[Y] : values[Z]) * (double)unit};
        for (int k = 0; k < 3; k++) {
            if (!(fabs(p[k]) <= (double)MESH_MOST_COORDINATE) && reader_ok(reader))
                reader_fail(reader, "a coordinate of vertex %u is NaN, infinite or beyond 1e18", v);
            ply->position[v][k] = (float)p[k];
        }
    }
    ply->vertices = element->count;
}

static void add_face(PlyMesh *ply, uint32_t face, const uint32_t *corner, uint32_t count)
{
    Reader *reader = ply->reader;
    if (count > MOST_CORNERS)
        reader_fail(reader, "face %u has %u corners: expected at most %d", face, count,
                    MOST_CORNERS);
    for (uint32_t c = 0; c < count && reader_ok(reader); c++)
        if (corner[c] >= ply->vertices)
            reader_fail(reader, "face %u has corner %u: expected less than %u", face, corner[c],
                        ply->vertices);
    for (uint32_t c = 2; c < count && reader_ok(reader); c++) {
        if (ply->triangles == ply->room) {
            size_t room = 2 * ply->room + 64;
            uint32_t(*more)[3] = reader_realloc(reader, ply->triangle, room, sizeof *more);
            if (!more) {
                reader_fail_memory(reader);
                return;
            }
            ply->triangle = more;
            ply->room = room;
        }
        const uint32_t triangle[3] = {corner[0], corner[c - 1], corner[c]};
        memcpy(ply->triangle[ply->triangles++], triangle, sizeof triangle);
    }
}

static void read_faces(PlyMesh *ply, const PlyElement *element)
{
    Reader *reader = ply->reader;
    if (!element->has[INDICES] && !element->has[INDEX])
        reader_fail(reader, "faces without vertex_indices: expected a list of this name");
    if (!ply->position) reader_fail(reader, "faces before vertices: expected vertices first");
    if (!reader_ok(reader) || !ply_check_count(&ply->file, element)) return;
    for (uint32_t f = 0; f < element->count && reader_ok(reader); f++) {
        double unused[ROLES];
        uint32_t corner[MOST_CORNERS], count = 0;
        ply_read_row_list(&ply->file, element, unused, corner, MOST_CORNERS, &count);
        add_face(ply, f, corner, count);
    }
}

// Strips of triangles, in which each corner after the second one makes a triangle with the two
// before it, every other one turned round. -1 begins another strip.
static void read_strips(PlyMesh *ply, const PlyElement *element)
{
    Reader *reader = ply->reader;
    if (!element->has[INDICES] && !element->has[INDEX])
        reader_fail(reader, "strips without vertex_indices: expected a list of this name");
    if (!ply->position) reader_fail(reader, "strips before vertices: expected vertices first");
    if (!reader_ok(reader) || !ply_check_count(&ply->file, element)) return;
    uint32_t most = reader_left(reader) < UINT32_MAX ? (uint32_t)reader_left(reader) : UINT32_MAX;
    uint32_t *corner = reader_malloc(reader, (uint64_t)most + 1, sizeof *corner);
    ply->file.restarts = true;
    for (uint32_t s = 0; corner && s < element->count && reader_ok(reader); s++) {
        double unused[ROLES];
        uint32_t count = 0, begin = 0;
        ply_read_row_list(&ply->file, element, unused, corner, most, &count);
        for (uint32_t i = 0; i < count && reader_ok(reader); i++) {
            bool turned = (i - begin) % 2;
            if (corner[i] == PLY_RESTART)
                begin = i + 1;
            else if (i >= begin + 2)
                add_face(ply, s,
                         (uint32_t[]){corner[i - 2 + turned], corner[i - 1 - turned], corner[i]},
                         3);
        }
    }
    ply->file.restarts = false;
    free(corner);
}

static void read_elements(PlyMesh *ply, float unit, bool up_z)
{
    Reader *reader = ply->reader;
    bool strands = false;
    for (uint32_t i = 0; i < ply->file.element_count && reader_ok(reader); i++) {
        const PlyElement *element = &ply->file.element[i];
        double unused[ROLES];
        strands = strands || element->has[STRANDS] || strcmp(element->name, "edge") == 0;
        if (strcmp(element->name, "vertex") == 0 && !ply->position)
            read_vertices(ply, element, unit, up_z);
        else if (strcmp(element->name, "face") == 0)
            read_faces(ply, element);
        else if (strcmp(element->name, "tristrips") == 0)
            read_strips(ply, element);
        else if (ply_check_count(&ply->file, element) && element->property_count)
            for (uint32_t k = 0; k < element->count && reader_ok(reader); k++)
                ply_read_row(&ply->file, element, unused);
    }
    if (reader_ok(reader) && ply->triangles == 0)
        reader_fail(reader, strands ? "hair, not a mesh: " FOREIGN_WANTS_MESH
                                    : "no faces: expected a mesh");
    if (reader_ok(reader) && ply->triangles > UINT32_MAX / 8)
        reader_fail(reader, "%zu triangles: expected fewer than 2^29", ply->triangles);
}

static void make_mesh(PlyMesh *ply, Mesh *mesh)
{
    if (!reader_charge(ply->reader, ply->vertices + ply->triangles, 24)) return;
    if (mesh_create(mesh, ply->vertices, (uint32_t)ply->triangles, NULL) != RESULT_OK) {
        reader_fail_memory(ply->reader);
        return;
    }
    memcpy(mesh->position, ply->position, (size_t)ply->vertices * sizeof *mesh->position);
    memcpy(mesh->triangle, ply->triangle, ply->triangles * sizeof *mesh->triangle);
    mesh_compute_normals(mesh);
}

Result ply_mesh_read(Mesh *mesh, const char *path, const Bytes *bytes, float unit, bool up_z,
                     Error *error)
{
    Reader reader = reader_begin_text(path, bytes, error);
    PlyMesh *ply = reader_calloc(&reader, 1, sizeof *ply);
    *mesh = (Mesh){0};
    if (!ply) return reader_fail_memory(&reader);
    ply->reader = &reader;
    ply->file = (PlyFile){.reader = &reader,
                          .roles = ROLE_NAMES,
                          .role_count = ROLES,
                          .first_whole = STRANDS,
                          .first_list = INDICES};
    ply_read_header(&ply->file);
    read_elements(ply, unit, up_z);
    if (reader_ok(&reader)) make_mesh(ply, mesh);
    free(ply->position);
    free(ply->triangle);
    free(ply);
    return reader.result;
}
