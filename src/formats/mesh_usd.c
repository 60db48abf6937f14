// SPDX-License-Identifier: MIT
// Animated meshes in `.usda` files: joins all visible Mesh prims with the transforms above them
// into one mesh. Polygons become triangle fans.
#include "formats/foreign.h"
#include "formats/format.h"
#include "formats/mesh_sequence.h"
#include "formats/usd_stage.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Face corners are read as float32, which represents all integers up to this one.
static const uint64_t MOST_WHOLE = 1 << 24;

typedef struct UsdMesh {
    int prim;
    UsdSamples points, counts, corners;
    bool left_handed; // corners are listed clockwise
    bool unwanted;    // the caller's choice leaves it out
    bool copy;        // of another one, which owns the samples
    uint64_t first;   // first vertex in the joined mesh
} UsdMesh;

typedef struct UsdMeshes {
    Reader *reader;
    UsdStage stage;
    UsdMesh *mesh; // [count] only meshes with points
    FormatWishes wishes;
    double origin[3];                       // taken away from all positions
    uint32_t count, kept, left_out, curves; // the first `kept` meshes are read
} UsdMeshes;

static bool match(const char *path, const Bytes *bytes)
{
    (void)path;
    return usd_stage_matches(bytes);
}

static void destroy_mesh(UsdMesh *mesh)
{
    if (mesh->copy) return;
    usd_samples_destroy(&mesh->points);
    usd_samples_destroy(&mesh->counts);
    usd_samples_destroy(&mesh->corners);
}

// --- The schema.

static void *begin_mesh(void *to, const char *type, int prim)
{
    UsdMeshes *all = to;
    all->curves += strcmp(type, "BasisCurves") == 0;
    if (strcmp(type, "Mesh") != 0) return NULL;
    UsdMesh *mesh = reader_calloc(all->reader, 1, sizeof *mesh);
    if (mesh) mesh->prim = prim;
    return mesh;
}

static bool read_attribute(void *to, void *object, const char *name, size_t length, bool samples,
                           char (**rate)[16])
{
    Reader *reader = ((UsdMeshes *)to)->reader;
    UsdMesh *mesh = object;
    (void)rate;
    const struct {
        const char *name;
        UsdSamples *values;
    } known[] = {{"points", &mesh->points},
                 {"faceVertexCounts", &mesh->counts},
                 {"faceVertexIndices", &mesh->corners}};
    for (int i = 0; i < 3; ++i)
        if (length == strlen(known[i].name) && strncmp(name, known[i].name, length) == 0) {
            usd_samples_read(known[i].values, reader, samples, true);
            return true;
        }
    if (strcmp(name, "orientation") != 0 || usd_text_peek(reader, false) != '"') return false;
    char word[USD_WORD_SIZE];
    usd_text_read_string(reader, word);
    mesh->left_handed = strcmp(word, "leftHanded") == 0;
    return true;
}

static void add_mesh(UsdMeshes *all, UsdMesh *mesh)
{
    Reader *reader = all->reader;
    if (!reader_ok(reader) || mesh->points.count == 0 || mesh->points.sample[0].count == 0)
        return; // an `over`, or an empty mesh
    UsdMesh *more = reader_realloc(reader, all->mesh, ((size_t)all->count + 1), sizeof *more);
    if (!more) {
        reader_fail_memory(reader);
        return;
    }
    all->mesh = more;
    all->mesh[all->count++] = *mesh;
    *mesh = (UsdMesh){0};
}

static void end_mesh(void *to, void *object)
{
    UsdMeshes *all = to;
    UsdMesh *mesh = object;
    mesh->unwanted = !format_wants_object(&all->wishes, all->stage.path);
    add_mesh(all, mesh);
    destroy_mesh(object);
    free(object);
}

// The mesh of a prim that another one repeats.
static void repeat_mesh(void *to, int of, int prim, const char *path)
{
    UsdMeshes *all = to;
    int from = -1;
    if (!reader_work(all->reader, all->count, 3)) return;
    for (uint32_t i = 0; i < all->count; ++i) {
        if (all->mesh[i].prim == prim) return;
        if (all->mesh[i].prim == of) from = (int)i;
    }
    if (from < 0) return;
    UsdMesh copy = all->mesh[from];
    copy.prim = prim;
    copy.copy = true;
    copy.unwanted = !format_wants_object(&all->wishes, path);
    add_mesh(all, &copy);
}

static const UsdSchema MESHES = {"Mesh", begin_mesh, read_attribute, NULL, end_mesh, repeat_mesh};

// Keeps the meshes that are drawn, or if all are hidden, the hidden ones; the others go to the end.
static void choose_meshes(UsdMeshes *all, MeshSamples *samples)
{
    Reader *reader = all->reader;
    const UsdStage *stage = &all->stage;
    uint32_t shown = 0, hidden = 0, kept = 0, scattered = 0;
    for (uint32_t i = 0; i < all->count; ++i) {
        bool lacks = usd_stage_lacks(stage, all->mesh[i].prim) || all->mesh[i].unwanted;
        bool hides = usd_stage_hides(stage, all->mesh[i].prim);
        shown += !lacks && !hides;
        hidden += !lacks && hides;
    }
    for (uint32_t i = 0; i < all->count && reader_ok(reader); ++i) {
        UsdMesh *mesh = &all->mesh[i], other = *mesh;
        bool in_instancer = usd_stage_instances(stage, mesh->prim);
        scattered += in_instancer;
        if (usd_stage_lacks(stage, mesh->prim) || mesh->unwanted || in_instancer ||
            (shown && usd_stage_hides(stage, mesh->prim)))
            continue;
        if (usd_stage_skins(stage, mesh->prim) && !mesh->points.timed)
            reader_fail(reader, "a mesh that a skeleton moves: expected baked points "
                                "(points.timeSamples), from the program that exported it");
        *mesh = all->mesh[kept];
        all->mesh[kept++] = other;
    }
    if (!shown && hidden)
        mesh_samples_note(samples, "all meshes are hidden: they are read all the same");
    if (scattered)
        mesh_samples_note(samples, "meshes of a PointInstancer are left out: make them real "
                                   "objects in the program that exported them");
    all->left_out = all->count - kept;
    all->kept = kept;
}

// --- Faces.

// The values, which must be the same in all samples.
static const UsdValues *find_fixed(Reader *reader, const UsdSamples *samples, const char *name,
                                   uint32_t line)
{
    reader->line = line;
    if (samples->count == 0) {
        reader_fail(reader, "a mesh without %s", name);
        return NULL;
    }
    const UsdValues *first = &samples->sample[0];
    for (size_t i = 1; i < samples->count; ++i) {
        const UsdValues *other = &samples->sample[i];
        reader->line = other->line;
        if (other->count != first->count ||
            memcmp(other->value, first->value, first->count * sizeof *first->value) != 0)
            reader_fail(reader, "%s: the faces change: expected the same faces in all samples",
                        name);
    }
    return reader_ok(reader) ? first : NULL;
}

// Adds triangles.
static void read_faces(Reader *reader, const UsdMesh *mesh, MeshSamples *samples)
{
    const uint32_t line = mesh->points.sample[0].line;
    const uint64_t vertices = mesh->points.sample[0].count / 3;
    const UsdValues *counts = find_fixed(reader, &mesh->counts, "faceVertexCounts", line);
    const UsdValues *corners = find_fixed(reader, &mesh->corners, "faceVertexIndices", line);
    if (!reader_ok(reader)) return;
    const uint64_t most = samples->triangle_count + corners->count;
    uint32_t(*triangle)[3] =
        reader_realloc(reader, samples->triangle, (size_t)most, sizeof *triangle);
    if (!triangle) {
        reader_fail_memory(reader);
        return;
    }
    samples->triangle = triangle;
    reader->line = corners->line;
    for (size_t i = 0; i < corners->count && reader_ok(reader); ++i) {
        const float corner = corners->value[i];
        if (!(corner >= 0 && corner < (float)vertices && corner == floorf(corner)))
            reader_fail(reader, "faceVertexIndices: %g: expected a vertex from 0 to %llu",
                        (double)corner, (unsigned long long)(vertices - 1));
    }
    size_t at = 0;
    for (size_t f = 0; f < counts->count && reader_ok(reader); ++f) {
        const float count = counts->value[f];
        if (!(count >= 0 && count <= (float)(corners->count - at) && count == floorf(count))) {
            reader_fail(reader, "face %zu has %g corners: expected at most %zu", f, (double)count,
                        corners->count - at);
            return;
        }
        const size_t n = (size_t)count, turn = mesh->left_handed;
        for (size_t c = 2; c < n; ++c) {
            const float *corner = corners->value + at;
            uint32_t *to = samples->triangle[samples->triangle_count++];
            to[0] = (uint32_t)(mesh->first + (uint64_t)corner[0]);
            to[1] = (uint32_t)(mesh->first + (uint64_t)corner[c - 1 + turn]);
            to[2] = (uint32_t)(mesh->first + (uint64_t)corner[c - turn]);
        }
        at += n;
    }
}

// --- Positions.

static void check_points(Reader *reader, const UsdMesh *mesh)
{
    const UsdSamples *points = &mesh->points;
    const size_t first = points->sample[0].count;
    reader->line = points->sample[0].line;
    if (first % 3) reader_fail(reader, "points: %zu numbers: expected three a vertex", first);
    if (first / 3 > MOST_WHOLE)
        reader_fail(reader, "%zu vertices: expected at most %llu", first / 3,
                    (unsigned long long)MOST_WHOLE);
    for (size_t i = 1; i < points->count && reader_ok(reader); ++i) {
        reader->line = points->sample[i].line;
        if (points->sample[i].count != first)
            reader_fail(reader,
                        "the sample at %g has %zu vertices: expected %zu as in the first one",
                        points->sample[i].time, points->sample[i].count / 3, first / 3);
    }
}

static void place(const UsdMeshes *all, const UsdMesh *mesh, double time, float (*to)[3])
{
    const float *a, *b;
    const double share = usd_samples_find(&mesh->points, time, &a, &b);
    double m[4][4];
    usd_stage_find_matrix(&all->stage, mesh->prim, time, m);
    for (int k = 0; k < 3; ++k) m[3][k] -= all->origin[k];
    reader_work(all->reader, mesh->points.sample[0].count / 3 + 1, 50);
    for (size_t v = 0; v < mesh->points.sample[0].count / 3 && reader_ok(all->reader); ++v) {
        double p[3];
        for (size_t k = 0; k < 3; ++k) {
            const double from = (double)a[3 * v + k];
            p[k] = share > 0 ? from + share * ((double)b[3 * v + k] - from) : from;
        }
        for (int k = 0; k < 3; ++k)
            to[v][k] = (float)(p[0] * m[0][k] + p[1] * m[1][k] + p[2] * m[2][k] + m[3][k]);
    }
}

static void read_positions(UsdMeshes *all, const UsdTimes *times, MeshSamples *samples)
{
    Reader *reader = all->reader;
    samples->count = times->count ? times->count : 1;
    if (!mesh_samples_create(samples, reader)) return;
    double m[4][4];
    usd_stage_find_matrix(&all->stage, all->mesh[0].prim, times->count ? times->time[0] : 0, m);
    mesh_samples_find_origin(samples, m[3]);
    memcpy(all->origin, samples->origin, sizeof all->origin);
    for (uint64_t s = 0; s < samples->count && reader_ok(reader); ++s)
        for (uint32_t i = 0; i < all->kept; ++i)
            place(all, &all->mesh[i], times->count ? times->time[s] : 0,
                  samples->position + s * samples->vertex_count + all->mesh[i].first);
}

static void make_samples(UsdMeshes *all, MeshSamples *samples)
{
    Reader *reader = all->reader;
    UsdTimes times = {.step = 1};
    for (uint32_t i = 0; i < all->kept && reader_ok(reader); ++i) {
        UsdMesh *mesh = &all->mesh[i];
        check_points(reader, mesh);
        mesh->first = samples->vertex_count;
        samples->vertex_count += mesh->points.sample[0].count / 3;
        if (reader_ok(reader)) read_faces(reader, mesh, samples);
        usd_stage_add_times(&all->stage, mesh->prim, &mesh->points, &times);
    }
    if (reader_ok(reader)) usd_times_sort(&times);
    if (reader_ok(reader) && times.count > 1) usd_times_even_out(&times, reader);
    if (reader_ok(reader)) read_positions(all, &times, samples);
    samples->rate = usd_stage_rate(&all->stage) / (times.step > 0 ? times.step : 1);
    samples->first = times.first;
    usd_times_destroy(&times);
}

static void read(MeshSamples *samples, Reader *reader)
{
    UsdMeshes all = {.reader = reader, .wishes.objects = samples->objects};
    usd_stage_read(&all.stage, reader, &MESHES, &all);
    if (reader_ok(reader)) choose_meshes(&all, samples);
    if (reader_ok(reader) && all.kept == 0)
        reader_fail(reader, all.left_out ? "no visible Mesh prim"
                            : all.curves ? "hair, not a mesh: " FOREIGN_WANTS_MESH
                                         : "no Mesh prim with points");
    if (reader_ok(reader)) make_samples(&all, samples);
    samples->unit = (double)all.stage.unit;
    samples->up_z = all.stage.up_z;
    for (uint32_t i = 0; i < all.count; ++i) destroy_mesh(&all.mesh[i]);
    free(all.mesh);
    usd_stage_destroy(&all.stage);
}

const MeshSequenceFormat MESH_SEQUENCE_USD = {.match = match, .read = read, .text = true};
