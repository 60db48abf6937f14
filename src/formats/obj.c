// SPDX-License-Identifier: MIT
#include "formats/obj.h"

#include "base/decimal.h"
#include "base/outfile.h"
#include "formats/foreign.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- Statements.

static const char *const WORDS[OBJ_OTHER] = {"v", "vt", "vn", "l", "f"};

bool obj_matches(const Bytes *bytes)
{
    static const char *const others[] = {"vp", "o", "g", "s", "mtllib", "usemtl"};
    const char *text = (const char *)bytes->data;
    // A binary file may begin with a count of 35 or 118 in four bytes, which look like '#' or 'v'.
    if (strnlen(text, 4) < 4 && bytes->size >= 4) return false;
    text += strspn(text, " \t\r\n");
    if (*text == '#') return strncmp(text, "#usda", 5) != 0;
    size_t length = strcspn(text, " \t\r\n");
    for (size_t i = 0; i < OBJ_OTHER + sizeof others / sizeof *others; i++) {
        const char *word = i < OBJ_OTHER ? WORDS[i] : others[i - OBJ_OTHER];
        if (strlen(word) == length && strncmp(text, word, length) == 0) return true;
    }
    return false;
}

bool obj_next_statement(Reader *reader, ObjStatement *statement)
{
    if (reader_ended(reader)) return false;
    int word = 0;
    while (word < OBJ_OTHER && !reader_take(reader, WORDS[word])) word++;
    *statement = (ObjStatement)word;
    return true;
}

bool obj_goes_on(Reader *reader)
{
    return !reader_line_ended(reader) && reader->data[reader->at] != '#';
}

// Reads a non-zero integer at *text and moves *text behind it; 0 if there is none.
static int64_t scan_index(const char **text)
{
    char *end;
    if (**text != '-' && !(**text >= '0' && **text <= '9')) return 0;
    long long value = strtoll(*text, &end, 10);
    *text = end;
    return llabs(value) <= UINT32_MAX ? value : 0;
}

static bool parse_corner(const char *text, ObjCorner *corner)
{
    *corner = (ObjCorner){.vertex = scan_index(&text)};
    if (corner->vertex == 0) return false;
    if (*text == '/') {
        text++;
        bool textured = *text != '/' && *text != 0;
        if (textured && (corner->uv = scan_index(&text)) == 0) return false;
        if (*text == '/') {
            text++;
            if ((corner->normal = scan_index(&text)) == 0) return false;
        }
    }
    return *text == 0;
}

bool obj_take_corner(Reader *reader, ObjCorner *corner)
{
    Reader before = *reader;
    char text[64];
    if (reader_read_word(reader, text, sizeof text) && parse_corner(text, corner)) return true;
    *reader = before;
    return false;
}

void obj_put_line(FILE *stream, const char *word, const float *numbers, int count)
{
    fputs(word, stream);
    for (int i = 0; i < count; i++) decimal_put(stream, " ", numbers[i]);
    fputc('\n', stream);
}

// --- Reading a mesh.

// What a corner refers to: OBJ_VERTEX, OBJ_UV or OBJ_NORMAL. Vectors have `size` coordinates, of
// which the first `needed` are required; missing ones are 0.
static const struct {
    const char *name, *expected;
    int size, needed;
} KINDS[] = {
    [OBJ_VERTEX] = {"vertex", "a vertex's coordinate", 3, 3},
    [OBJ_UV] = {"texture coordinate", "a texture coordinate", 2, 1},
    [OBJ_NORMAL] = {"normal", "a normal's coordinate", 3, 3},
};
enum { KIND_COUNT = sizeof KINDS / sizeof *KINDS };

// An array that grows by doubling.
typedef struct Pile {
    void *data;
    size_t count, capacity;
} Pile;

// The content of the file.
typedef struct Obj {
    Reader reader;
    Pile vectors[KIND_COUNT];        // float[size]
    Pile triangles[KIND_COUNT];      // uint32_t[3], indices of the corners from 1; 0 if absent
    uint32_t largest[KIND_COUNT];    // largest index (from 1) that a face has used
    uint32_t largest_at[KIND_COUNT]; // the line of that face
} Obj;

// Adds room for one record of `size` bytes; NULL after an error.
static void *pile_add(Reader *reader, Pile *pile, size_t size)
{
    if (!reader_ok(reader)) return NULL;
    if (pile->count == UINT32_MAX - 1) {
        reader_fail(reader, "too many vertices or faces: expected fewer than 2^32 - 1");
        return NULL;
    }
    if (pile->count == pile->capacity) {
        size_t capacity = pile->capacity ? 2 * pile->capacity : 1024;
        void *data = reader_realloc(reader, pile->data, capacity, size);
        if (!data) {
            reader_fail_memory(reader);
            return NULL;
        }
        pile->data = data;
        pile->capacity = capacity;
    }
    return (char *)pile->data + size * pile->count++;
}

// Ignores what follows the vector; some programs add w or colours.
static void read_vector(Obj *obj, ObjStatement kind)
{
    Reader *reader = &obj->reader;
    int size = KINDS[kind].size;
    float vector[3] = {0};
    for (int i = 0; i < size && (i < KINDS[kind].needed || !reader_line_ended(reader)); i++) {
        Reader before = *reader;
        vector[i] = reader_read_number(reader, KINDS[kind].expected);
        if (!reader_ok(reader) || fabsf(vector[i]) <= MESH_MOST_COORDINATE) continue;
        *reader = before;
        reader_fail_expected(reader, KINDS[kind].expected);
    }
    float *record = pile_add(reader, &obj->vectors[kind], (size_t)size * sizeof *vector);
    if (record) memcpy(record, vector, (size_t)size * sizeof *vector);
}

// Converts an index of the file to one from 1; 0 for a missing or invalid index. An index beyond
// the vectors read so far may still become valid, so the largest one is checked at the end of the
// file.
static uint32_t resolve_index(Obj *obj, int kind, int64_t index)
{
    if (index < 0) index += (int64_t)obj->vectors[kind].count + 1;
    if (index <= 0) return 0;
    if (index > obj->largest[kind]) {
        obj->largest[kind] = (uint32_t)index;
        obj->largest_at[kind] = obj->reader.line;
    }
    return (uint32_t)index;
}

static void read_corner(Obj *obj, uint32_t index[KIND_COUNT])
{
    Reader before = obj->reader;
    ObjCorner corner;
    bool good = obj_take_corner(&obj->reader, &corner);
    if (good) {
        const int64_t given[KIND_COUNT] = {corner.vertex, corner.uv, corner.normal};
        for (int kind = 0; kind < KIND_COUNT; kind++) {
            index[kind] = resolve_index(obj, kind, given[kind]);
            good = good && (index[kind] || !given[kind]);
        }
    }
    if (good) return;
    obj->reader = before;
    reader_fail_expected(&obj->reader, "a corner v, v/t, v//n or v/t/n with an index in range");
}

static void read_face(Obj *obj)
{
    Reader *reader = &obj->reader;
    // The polygon's first corner, the previous one, this one.
    uint32_t corner[3][KIND_COUNT] = {{0}};
    size_t corners = 0;
    while (obj_goes_on(reader)) {
        memcpy(corner[1], corner[2], sizeof corner[1]);
        read_corner(obj, corner[2]);
        if (corners == 0) memcpy(corner[0], corner[2], sizeof corner[0]);
        if (++corners < 3) continue;
        for (int kind = 0; kind < KIND_COUNT; kind++) {
            uint32_t *triangle = pile_add(reader, &obj->triangles[kind], 3 * sizeof *triangle);
            for (int i = 0; triangle && i < 3; i++) triangle[i] = corner[i][kind];
        }
    }
    if (corners < 3) reader_fail(reader, "a face of %zu corners: expected at least 3", corners);
}

static void read_statements(Obj *obj)
{
    Reader *reader = &obj->reader;
    ObjStatement statement;
    while (obj_next_statement(reader, &statement)) {
        if (statement <= OBJ_NORMAL) read_vector(obj, statement);
        if (statement == OBJ_FACE) read_face(obj);
        reader_skip_line(reader);
    }
    if (reader_ok(reader) && obj->triangles[0].count == 0)
        reader_fail(reader, "no faces: " FOREIGN_WANTS_MESH);
    for (int kind = 0; kind < KIND_COUNT && reader_ok(reader); kind++) {
        if (obj->largest[kind] <= obj->vectors[kind].count) continue;
        reader->line = obj->largest_at[kind];
        reader_fail(reader, "a face uses %s %u: expected at most %zu, the number in the file",
                    KINDS[kind].name, obj->largest[kind], obj->vectors[kind].count);
    }
}

// Converts a position or direction to metres and y up.
static void turn(float to[3], const float from[3], float unit, bool up_z)
{
    to[0] = from[0] * unit;
    to[1] = (up_z ? from[2] : from[1]) * unit;
    to[2] = (up_z ? -from[1] : from[2]) * unit;
}

// Replaces computed normals by those of the file, where it has some. False if memory is short.
static bool apply_normals(Mesh *mesh, Obj *obj, bool up_z)
{
    float(*sum)[3] = reader_calloc(&obj->reader, (uint64_t)mesh->vertex_count + 1, sizeof *sum);
    if (!sum) return false;
    const uint32_t *vertex = obj->triangles[OBJ_VERTEX].data;
    const uint32_t *normal = obj->triangles[OBJ_NORMAL].data;
    const float(*given)[3] = obj->vectors[OBJ_NORMAL].data;
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++) {
        if (normal[i] == 0) continue;
        float turned[3];
        turn(turned, given[normal[i] - 1], 1.0f, up_z);
        for (int axis = 0; axis < 3; axis++) sum[vertex[i] - 1][axis] += turned[axis];
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

// Fills the mesh; with texture coordinates if any corner has some. False if memory is short.
static bool make_mesh(Mesh *mesh, Obj *obj, float unit, bool up_z)
{
    const float(*position)[3] = obj->vectors[OBJ_VERTEX].data;
    const uint32_t *vertex = obj->triangles[OBJ_VERTEX].data, *uv = obj->triangles[OBJ_UV].data;
    const Pile *uvs = &obj->vectors[OBJ_UV];
    size_t vertices = obj->vectors[OBJ_VERTEX].count, triangles = obj->triangles[0].count;
    if (!reader_charge(&obj->reader, vertices + triangles + uvs->count, 24)) return false;
    if (mesh_create(mesh, (uint32_t)vertices, (uint32_t)triangles, NULL) != RESULT_OK) return false;
    for (size_t v = 0; v < vertices; v++) turn(mesh->position[v], position[v], unit, up_z);
    for (size_t i = 0; i < 3 * triangles; i++) mesh->triangle[i / 3][i % 3] = vertex[i] - 1;
    mesh_compute_normals(mesh);
    if (obj->largest[OBJ_UV]) {
        if (mesh_create_uv(mesh, (uint32_t)uvs->count, NULL) != RESULT_OK) return false;
        memcpy(mesh->uv, uvs->data, uvs->count * sizeof *mesh->uv);
        for (size_t i = 0; i < 3 * triangles; i++)
            mesh->triangle_uv[i / 3][i % 3] = uv[i] - 1; // 0 (absent) becomes MESH_NO_UV
    }
    return obj->vectors[OBJ_NORMAL].count == 0 || apply_normals(mesh, obj, up_z);
}

Result obj_read_mesh_bytes(Mesh *mesh, const char *path, const Bytes *bytes, float unit, bool up_z,
                           Error *error)
{
    *mesh = (Mesh){0};
    Obj obj = {.reader = reader_begin_text(path, bytes, error)};
    obj.reader.continuation = true;
    read_statements(&obj);
    if (reader_ok(&obj.reader) && !make_mesh(mesh, &obj, unit, up_z)) {
        mesh_destroy(mesh);
        reader_fail_memory(&obj.reader);
    }
    for (int kind = 0; kind < KIND_COUNT; kind++) {
        free(obj.vectors[kind].data);
        free(obj.triangles[kind].data);
    }
    return obj.reader.result;
}

// --- Writing a mesh.

Result obj_write_mesh(const char *path, const Mesh *mesh, Error *error)
{
    OutFile file;
    TRY(outfile_open(&file, path, error));
    fprintf(file.stream, "# %u vertices, %u triangles; metres, y up\n", mesh->vertex_count,
            mesh->triangle_count);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        obj_put_line(file.stream, "v", mesh->position[v], 3);
    for (uint32_t i = 0; i < mesh->uv_count; i++) obj_put_line(file.stream, "vt", mesh->uv[i], 2);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        fputc('f', file.stream);
        for (int i = 0; i < 3; i++) {
            uint32_t uv = mesh->triangle_uv ? mesh->triangle_uv[t][i] : MESH_NO_UV;
            fprintf(file.stream, " %u", mesh->triangle[t][i] + 1);
            if (uv != MESH_NO_UV) fprintf(file.stream, "/%u", uv + 1);
        }
        fputc('\n', file.stream);
    }
    return outfile_commit(&file, error);
}
