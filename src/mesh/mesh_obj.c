// SPDX-License-Identifier: MIT
// Wavefront OBJ in and out.
#include "base/bytes.h"
#include "base/outfile.h"
#include "mesh/mesh.h"
#include "mesh/obj_text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// An array that grows by doubling.
typedef struct Pile {
    void *data;
    size_t count, capacity;
} Pile;

// The file's content while it is read.
typedef struct Obj {
    Reader reader;
    Pile position, normal, uv;                   // float[3], [3], [2]
    Pile triangle, triangle_normal, triangle_uv; // uint32_t[3]; normals and uvs from 1, 0: none
    uint32_t largest[3];      // index (from 1) that a face used: vertex, normal, uv
    uint32_t largest_line[3]; // and where
} Obj;

// Room for one more record of `size` bytes; NULL after failing.
static void *pile_add(Reader *reader, Pile *pile, size_t size)
{
    if (!reader_ok(reader)) return NULL;
    if (pile->count == UINT32_MAX - 1) {
        reader_fail(reader, "more than 32-bit indices hold");
        return NULL;
    }
    if (pile->count == pile->capacity) {
        size_t capacity = pile->capacity ? 2 * pile->capacity : 1024;
        void *data = realloc(pile->data, capacity * size);
        if (!data) {
            reader_fail_memory(reader);
            return NULL;
        }
        pile->data = data;
        pile->capacity = capacity;
    }
    return (char *)pile->data + size * pile->count++;
}

// Reads `size` coordinates; those behind the first `needed` are 0 where the line ends before them.
// What follows, w or colours that some programs put there, is left.
static void read_vector(Reader *reader, Pile *pile, int size, int needed, const char *what)
{
    float vector[3] = {0};
    for (int i = 0; i < size && (i < needed || !reader_line_ended(reader)); i++) {
        Reader before = *reader;
        vector[i] = reader_read_number(reader, what);
        if (!reader_ok(reader) || fabsf(vector[i]) <= 1e18f) continue;
        before.locale = reader->locale;
        *reader = before;
        reader_fail_expected(reader, what);
    }
    float *record = pile_add(reader, pile, (size_t)size * sizeof *vector);
    if (record) memcpy(record, vector, (size_t)size * sizeof *vector);
}

// The index from 1 that `index` of the file means, 0 for a mistake and for none. An index beyond
// what has been read so far may still become valid: the largest is kept and checked at the end.
static uint32_t resolve_index(Obj *obj, int64_t index, size_t count, int which)
{
    if (index < 0) index += (int64_t)count + 1;
    if (index <= 0) return 0;
    if (index > obj->largest[which]) {
        obj->largest[which] = (uint32_t)index;
        obj->largest_line[which] = obj->reader.line;
    }
    return (uint32_t)index;
}

// Vertex, normal, uv from 1; a normal or uv that is missing is 0.
static void read_corner(Obj *obj, uint32_t index[3])
{
    Reader *reader = &obj->reader;
    Reader before = *reader;
    ObjCorner corner;
    if (obj_text_take_corner(reader, &corner)) {
        index[0] = resolve_index(obj, corner.vertex, obj->position.count, 0);
        index[1] = resolve_index(obj, corner.normal, obj->normal.count, 1);
        index[2] = resolve_index(obj, corner.uv, obj->uv.count, 2);
        if (index[0] && (index[1] || !corner.normal) && (index[2] || !corner.uv)) return;
    }
    *reader = before;
    reader_fail_expected(reader, "a corner v, v/t, v//n or v/t/n with an index in range");
}

static void add_triangle(Obj *obj, uint32_t corner[3][3])
{
    uint32_t *triangle = pile_add(&obj->reader, &obj->triangle, 3 * sizeof *triangle);
    uint32_t *normal = pile_add(&obj->reader, &obj->triangle_normal, 3 * sizeof *normal);
    uint32_t *uv = pile_add(&obj->reader, &obj->triangle_uv, 3 * sizeof *uv);
    for (int i = 0; i < 3 && triangle && normal && uv; i++) {
        triangle[i] = corner[i][0] - 1;
        normal[i] = corner[i][1];
        uv[i] = corner[i][2];
    }
}

static void read_face(Obj *obj)
{
    Reader *reader = &obj->reader;
    uint32_t corner[3][3] = {{0}}; // the first, the one before, this one
    size_t corners = 0;
    while (obj_text_goes_on(reader)) {
        memcpy(corner[1], corner[2], sizeof corner[1]);
        read_corner(obj, corner[2]);
        if (corners == 0) memcpy(corner[0], corner[2], sizeof corner[0]);
        if (++corners >= 3) add_triangle(obj, corner);
    }
    if (corners < 3) reader_fail(reader, "a face of %zu corners: expected at least 3", corners);
}

static void read_statements(Obj *obj)
{
    Reader *reader = &obj->reader;
    ObjStatement statement;
    while (obj_text_next(reader, &statement)) {
        if (statement == OBJ_VERTEX)
            read_vector(reader, &obj->position, 3, 3, "a vertex's coordinate");
        if (statement == OBJ_UV) read_vector(reader, &obj->uv, 2, 1, "a texture coordinate");
        if (statement == OBJ_NORMAL)
            read_vector(reader, &obj->normal, 3, 3, "a normal's coordinate");
        if (statement == OBJ_FACE) read_face(obj);
        reader_skip_line(reader);
    }
    if (reader_ok(reader) && obj->triangle.count == 0) reader_fail(reader, "no faces");
    static const char *const names[] = {"vertex", "normal", "texture coordinate"};
    const size_t counts[] = {obj->position.count, obj->normal.count, obj->uv.count};
    for (int which = 0; which < 3 && reader_ok(reader); which++) {
        size_t count = counts[which];
        if (obj->largest[which] <= count) continue;
        reader->line = obj->largest_line[which];
        reader_fail(reader, "a face uses %s %u, the file has %zu", names[which],
                    obj->largest[which], count);
    }
}

// A direction or position in the file's axes, y up.
static void turn(float to[3], const float from[3], float unit, bool up_z)
{
    to[0] = from[0] * unit;
    to[1] = (up_z ? from[2] : from[1]) * unit;
    to[2] = (up_z ? -from[1] : from[2]) * unit;
}

// Replaces computed normals where the file gives some.
static bool apply_normals(Mesh *mesh, const Obj *obj, bool up_z)
{
    float(*sum)[3] = calloc((size_t)mesh->vertex_count + 1, sizeof *sum);
    if (!sum) return false;
    const uint32_t *vertex = obj->triangle.data, *normal = obj->triangle_normal.data;
    for (size_t i = 0; i < 3 * obj->triangle.count; i++) {
        if (normal[i] == 0) continue;
        float turned[3];
        turn(turned, (const float *)obj->normal.data + 3 * ((size_t)normal[i] - 1), 1.0f, up_z);
        for (int axis = 0; axis < 3; axis++) sum[vertex[i]][axis] += turned[axis];
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const float *n = sum[v];
        double length = sqrt((double)n[0] * n[0] + (double)n[1] * n[1] + (double)n[2] * n[2]);
        if (!(length > 1e-6) || !isfinite(length)) continue;
        for (int axis = 0; axis < 3; axis++) mesh->normal[v][axis] = (float)(n[axis] / length);
    }
    free(sum);
    return true;
}

// Texture coordinates, if any corner names one.
static bool apply_uv(Mesh *mesh, const Obj *obj)
{
    const uint32_t *index = obj->triangle_uv.data;
    if (obj->largest[2] == 0) return true;
    if (mesh_create_uv(mesh, (uint32_t)obj->uv.count, NULL) != RESULT_OK) return false;
    memcpy(mesh->uv, obj->uv.data, obj->uv.count * sizeof *mesh->uv);
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++)
        mesh->triangle_uv[i / 3][i % 3] = index[i] - 1; // 0, none, becomes MESH_NO_UV
    return true;
}

static Result make_mesh(Mesh *mesh, Obj *obj, float unit, bool up_z)
{
    if (!reader_ok(&obj->reader)) return obj->reader.result;
    uint32_t vertices = (uint32_t)obj->position.count, triangles = (uint32_t)obj->triangle.count;
    if (mesh_create(mesh, vertices, triangles, NULL) != RESULT_OK)
        return reader_fail_memory(&obj->reader);
    const float *position = obj->position.data;
    for (size_t v = 0; v < vertices; v++) turn(mesh->position[v], position + 3 * v, unit, up_z);
    memcpy(mesh->triangle, obj->triangle.data, triangles * sizeof *mesh->triangle);
    mesh_compute_normals(mesh);
    if (!apply_uv(mesh, obj)) {
        mesh_destroy(mesh);
        return reader_fail_memory(&obj->reader);
    }
    if (obj->normal.count == 0 || apply_normals(mesh, obj, up_z)) return RESULT_OK;
    mesh_destroy(mesh);
    return reader_fail_memory(&obj->reader);
}

Result mesh_read_obj(Mesh *mesh, const char *path, float unit, bool up_z, Error *error)
{
    *mesh = (Mesh){0};
    Bytes bytes;
    Result result = bytes_read_file(&bytes, path, error);
    if (result != RESULT_OK) return result;
    Obj obj = {.reader = reader_begin_text(path, &bytes, error)};
    obj.reader.continuation = true;
    read_statements(&obj);
    result = make_mesh(mesh, &obj, unit, up_z);
    reader_end(&obj.reader);
    free(obj.position.data);
    free(obj.normal.data);
    free(obj.triangle.data);
    free(obj.triangle_normal.data);
    free(obj.uv.data);
    free(obj.triangle_uv.data);
    bytes_destroy(&bytes);
    return result;
}

static void put_face(FILE *stream, const Mesh *mesh, uint32_t t)
{
    fputc('f', stream);
    for (int i = 0; i < 3; i++) {
        uint32_t uv = mesh->triangle_uv ? mesh->triangle_uv[t][i] : MESH_NO_UV;
        fprintf(stream, " %u", mesh->triangle[t][i] + 1);
        if (uv != MESH_NO_UV) fprintf(stream, "/%u", uv + 1);
    }
    fputc('\n', stream);
}

Result mesh_write_obj(const char *path, const Mesh *mesh, Error *error)
{
    OutFile file;
    Result result = outfile_open(&file, path, error);
    if (result != RESULT_OK) return result;
    fprintf(file.stream, "# %u vertices, %u triangles; metres, y up\n", mesh->vertex_count,
            mesh->triangle_count);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        obj_text_put(file.stream, "v", mesh->position[v], 3);
    for (uint32_t i = 0; i < mesh->uv_count; i++) obj_text_put(file.stream, "vt", mesh->uv[i], 2);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) put_face(file.stream, mesh, t);
    return outfile_commit(&file, error);
}
