// SPDX-License-Identifier: MIT
// Animated meshes in Alembic's Ogawa files: joins all visible polygon meshes and subdivision
// surfaces (AbcGeom's IPolyMesh, ISubD) with the transforms above them into one mesh. Polygons
// become triangle fans. Alembic lists corners clockwise; meshes here are counter-clockwise.
#include "formats/alembic.h"
#include "formats/foreign.h"
#include "formats/format.h"
#include "formats/mesh_sequence.h"

#include <stdlib.h>
#include <string.h>

typedef struct AbcMesh {
    OgawaProperties own;           // properties of ".geom"
    const OgawaProperty *position; // its positions, which are one of the properties
    int object;
    uint64_t first, count; // range of its vertices in the joined mesh
    double *still;         // positions if they do not change
} AbcMesh;

typedef struct AbcMeshes {
    Alembic alembic;
    AbcMesh *mesh; // [count]
    uint32_t count;
    double origin[3];           // taken away from all positions
    uint32_t sampling, samples; // those of the mesh with the most samples
} AbcMeshes;

static bool match(const char *path, const Bytes *bytes)
{
    (void)path;
    return ogawa_matches(bytes);
}

static bool begins_with(const char *text, const char *start)
{
    return strncmp(text, start, strlen(start)) == 0;
}

static void open_mesh(AbcMeshes *all, int object, MeshSamples *samples)
{
    Ogawa *file = &all->alembic.file;
    AbcMesh *mesh = &all->mesh[all->count++];
    *mesh = (AbcMesh){.object = object, .first = samples->vertex_count};
    mesh->own = ogawa_compound(file, &file->object[object].own, ".geom");
    const OgawaProperty *position = mesh->position = ogawa_find(&mesh->own, "P");
    file->reader->at = (size_t)file->object[object].group;
    if (!position || position->extent != 3 || !position->samples) {
        reader_fail(file->reader, "%s: no positions: expected P", file->object[object].path);
        return;
    }
    size_t numbers;
    double *first = ogawa_numbers(file, position, 0, &numbers);
    if (position->last)
        free(first);
    else
        mesh->still = first;
    mesh->count = numbers / 3;
    samples->vertex_count += mesh->count;
    uint32_t count = position->last ? position->samples : 1, sampling = position->sampling;
    alembic_longest(&all->alembic, object, &sampling, &count);
    if (count > all->samples) {
        all->samples = count;
        all->sampling = sampling;
    }
}

static bool is_wanted(const OgawaObject *object, const MeshSamples *samples)
{
    const FormatWishes wishes = {.objects = samples->objects};
    return (begins_with(object->schema, "AbcGeom_PolyMesh") ||
            begins_with(object->schema, "AbcGeom_SubD")) &&
           format_wants_object(&wishes, object->path);
}

static void open_all(AbcMeshes *all, MeshSamples *samples)
{
    Ogawa *file = &all->alembic.file;
    uint32_t curves = 0, shown = 0, hidden = 0;
    all->mesh = reader_calloc(file->reader, (uint64_t)file->count + 1, sizeof *all->mesh);
    for (int i = 0; i < file->count && reader_ok(file->reader); ++i) {
        const char *schema = file->object[i].schema;
        curves += begins_with(schema, "AbcGeom_Curve");
        bool is_mesh = is_wanted(&file->object[i], samples);
        hidden += is_mesh && all->alembic.hidden[i];
        shown += is_mesh && !all->alembic.hidden[i];
    }
    for (int i = 0; i < file->count && reader_ok(file->reader); ++i) {
        bool is_mesh = is_wanted(&file->object[i], samples);
        if (is_mesh && (shown == 0 || !all->alembic.hidden[i])) open_mesh(all, i, samples);
    }
    if (shown == 0 && hidden)
        mesh_samples_note(samples, "all meshes are hidden: they are read all the same");
    file->reader->at = 0;
    if (reader_ok(file->reader) && all->count == 0)
        reader_fail(file->reader,
                    curves ? "hair and no visible mesh: " FOREIGN_WANTS_MESH : "no visible mesh");
}

// --- Faces.

// All values of a property that must not change over time.
static double *read_fixed(AbcMeshes *all, const AbcMesh *mesh, const char *name, size_t *count)
{
    Ogawa *file = &all->alembic.file;
    const OgawaProperty *property = ogawa_find(&mesh->own, name);
    const char *path = file->object[mesh->object].path;
    *count = 0;
    if (property && property->last)
        reader_fail(file->reader, "%s: faces change: expected the same faces in all samples", path);
    else if (!property || !property->samples)
        reader_fail(file->reader, "%s: no faces: expected %s", path, name);
    return reader_ok(file->reader) ? ogawa_numbers(file, property, 0, count) : NULL;
}

static bool make_room(Reader *reader, MeshSamples *samples, uint64_t more)
{
    uint64_t count = samples->triangle_count + more;
    if (count > UINT32_MAX / 8) return false;
    uint32_t(*triangle)[3] =
        reader_realloc(reader, samples->triangle, (size_t)count, sizeof *triangle);
    if (triangle) samples->triangle = triangle;
    return triangle;
}

static void read_faces(AbcMeshes *all, const AbcMesh *mesh, MeshSamples *samples)
{
    Reader *reader = all->alembic.file.reader;
    const char *path = all->alembic.file.object[mesh->object].path;
    size_t faces, corners, at = 0;
    double *size = read_fixed(all, mesh, ".faceCounts", &faces);
    double *corner = read_fixed(all, mesh, ".faceIndices", &corners);
    if (reader_ok(reader) && !make_room(reader, samples, corners)) reader_fail_memory(reader);
    for (size_t f = 0; f < faces && reader_ok(reader); ++f) {
        if (!(size[f] >= 0 && size[f] <= (double)(corners - at))) {
            reader_fail(reader, "%s: face %zu has %g corners: expected at most %zu", path, f,
                        size[f], corners - at);
            break;
        }
        size_t n = (size_t)size[f];
        for (size_t c = 0; c < n && reader_ok(reader); ++c)
            if (!(corner[at + c] >= 0 && corner[at + c] < (double)mesh->count))
                reader_fail(reader, "%s: face %zu has corner %g: expected less than %llu", path, f,
                            corner[at + c], (unsigned long long)mesh->count);
        for (size_t c = 2; c < n && reader_ok(reader); ++c) {
            uint32_t *to = samples->triangle[samples->triangle_count++];
            to[0] = (uint32_t)(mesh->first + (uint64_t)corner[at]);
            to[1] = (uint32_t)(mesh->first + (uint64_t)corner[at + c]);
            to[2] = (uint32_t)(mesh->first + (uint64_t)corner[at + c - 1]);
        }
        at += n;
    }
    free(size);
    free(corner);
}

// --- Positions.

static double *read_sample(AbcMeshes *all, const AbcMesh *mesh, uint32_t sample)
{
    Ogawa *file = &all->alembic.file;
    size_t numbers;
    double *number = ogawa_numbers(file, mesh->position, sample, &numbers);
    if (number && numbers / 3 != mesh->count)
        reader_fail(file->reader, "%s: sample %u has %zu vertices: expected %llu as in the first",
                    file->object[mesh->object].path, sample, numbers / 3,
                    (unsigned long long)mesh->count);
    return number;
}

static void place(AbcMeshes *all, const AbcMesh *mesh, double time, float (*to)[3])
{
    uint32_t a = 0, b = 0;
    double matrix[4][4], share = 0;
    double *from = mesh->still, *next = NULL;
    if (!from) {
        share = ogawa_around(&all->alembic.file, mesh->position->sampling, mesh->position->samples,
                             time, &a, &b);
        from = read_sample(all, mesh, share < 1 ? a : b);
        if (share > 0 && share < 1) next = read_sample(all, mesh, b);
    }
    alembic_matrix(&all->alembic, mesh->object, time, matrix);
    for (int k = 0; k < 3; ++k) matrix[3][k] -= all->origin[k];
    reader_work(all->alembic.file.reader, mesh->count + 1, 50);
    for (uint64_t v = 0; v < mesh->count && reader_ok(all->alembic.file.reader); ++v) {
        double p[3];
        for (int k = 0; k < 3; ++k) {
            p[k] = from[3 * v + (uint64_t)k];
            if (next) p[k] += share * (next[3 * v + (uint64_t)k] - p[k]);
        }
        for (int k = 0; k < 3; ++k)
            to[v][k] = (float)(p[0] * matrix[0][k] + p[1] * matrix[1][k] + p[2] * matrix[2][k] +
                               matrix[3][k]);
    }
    free(next);
    if (from != mesh->still) free(from);
}

static void read(MeshSamples *samples, Reader *reader)
{
    AbcMeshes all = {0};
    if (alembic_open(&all.alembic, reader) == RESULT_OK) open_all(&all, samples);
    const Ogawa *file = &all.alembic.file;
    const OgawaFrames frames = ogawa_frames(file, all.sampling, all.samples);
    samples->count = frames.count;
    for (uint32_t i = 0; i < all.count && reader_ok(reader); ++i)
        read_faces(&all, &all.mesh[i], samples);
    if (reader_ok(reader) && mesh_samples_create(samples, reader)) {
        double m[4][4];
        alembic_matrix(&all.alembic, all.mesh[0].object, frames.start, m);
        mesh_samples_find_origin(samples, m[3]);
        memcpy(all.origin, samples->origin, sizeof all.origin);
        for (uint32_t s = 0; s < frames.count && reader_ok(reader); ++s)
            for (uint32_t i = 0; i < all.count; ++i)
                place(&all, &all.mesh[i], ogawa_frame_time(file, &frames, s),
                      samples->position + s * samples->vertex_count + all.mesh[i].first);
    }
    samples->rate = frames.rate;
    samples->first = frames.rate > 0 ? frames.start * frames.rate : 0;
    samples->unit = file->unit;
    samples->up_z = file->up_z;
    for (uint32_t i = 0; i < all.count; ++i) {
        ogawa_free(&all.mesh[i].own);
        free(all.mesh[i].still);
    }
    free(all.mesh);
    alembic_close(&all.alembic);
}

const MeshSequenceFormat MESH_SEQUENCE_ALEMBIC = {.match = match, .read = read};
