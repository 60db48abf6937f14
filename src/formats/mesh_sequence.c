// SPDX-License-Identifier: MIT
#include "formats/mesh_sequence.h"
#include "base/target.h"
#include "formats/foreign.h"
#include "formats/mesh_read.h"

#include <libdeflate.h>

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const MeshSequenceFormat *const FORMATS[] = {&MESH_SEQUENCE_NPZ,     &MESH_SEQUENCE_NPY,
                                                    &MESH_SEQUENCE_PC2,     &MESH_SEQUENCE_MDD,
                                                    &MESH_SEQUENCE_ALEMBIC, &MESH_SEQUENCE_USD};
enum { FORMAT_COUNT = sizeof FORMATS / sizeof *FORMATS };

// The most vertices of all samples together (96 GB).
static const uint64_t MOST_VERTICES = UINT64_C(1) << 33;

bool mesh_samples_create(MeshSamples *samples, Reader *reader)
{
    uint64_t count = samples->count, vertices = samples->vertex_count;
    if (!reader_ok(reader)) return false;
    if (count == 0 || vertices == 0)
        return reader_fail(reader, "%llu samples of %llu vertices: expected at least one of each",
                           (unsigned long long)count, (unsigned long long)vertices) == RESULT_OK;
    if (count > UINT32_MAX / 2 || vertices > UINT32_MAX / 4 || vertices > MOST_VERTICES / count)
        return reader_fail(reader, "%llu samples of %llu vertices do not fit into memory",
                           (unsigned long long)count, (unsigned long long)vertices) == RESULT_OK;
    samples->position = reader_malloc_frames(reader, count, vertices);
    return samples->position;
}

void mesh_samples_find_origin(MeshSamples *samples, const double translation[3])
{
    bool far = false;
    for (int k = 0; k < 3; ++k)
        far = far || (fabs(translation[k]) > 1000 && fabs(translation[k]) < 1e15);
    for (int k = 0; k < 3 && far; ++k) samples->origin[k] = round(translation[k]);
}

void mesh_samples_note(MeshSamples *samples, const char *format, ...)
{
    size_t used = strlen(samples->note);
    va_list arguments;
    va_start(arguments, format);
    if (used > 0 && used + 2 < sizeof samples->note)
        used += (size_t)sprintf(samples->note + used, "; ");
    vsnprintf(samples->note + used, sizeof samples->note - used, format, arguments);
    va_end(arguments);
}

static void mesh_samples_destroy(MeshSamples *samples)
{
    free(samples->position);
    free(samples->triangle);
    *samples = (MeshSamples){0};
}

static bool is_pattern(const char *path)
{
    return strchr(path, '%') != NULL;
}

static const MeshSequenceFormat *find_format(const char *path, const Bytes *bytes)
{
    for (int i = 0; i < FORMAT_COUNT; ++i)
        if (FORMATS[i]->match(path, bytes)) return FORMATS[i];
    return NULL;
}

// Looks only into regular files, because bytes that are read from a pipe would be lost.
bool mesh_sequence_matches(const char *path)
{
    uint8_t first[16];
    if (is_pattern(path)) return true;
    const Bytes bytes = {first, bytes_peek(path, first, sizeof first)};
    return bytes.size > 0 && find_format(path, &bytes) != NULL;
}

void mesh_sequence_destroy(MeshSequence *sequence)
{
    free(sequence->position);
    free(sequence->times.cut);
    *sequence = (MeshSequence){0};
}

// --- Sequences of numbered OBJ files.

static Result check_gaps(const Target *target, TargetNumbers numbers, Error *error)
{
    Result result = RESULT_OK;
    if (numbers.last - numbers.first + 1 == numbers.count) return RESULT_OK;
    for (int i = numbers.first; i < numbers.last && result == RESULT_OK; ++i) {
        char *name = target_name_frame(target, i);
        if (!name)
            result = error_set(error, RESULT_FAILED, "no memory for a name");
        else if (access(name, F_OK) != 0)
            result = error_set(error, RESULT_BAD_INPUT,
                               "%s: missing: expected files for samples %d to %d without gaps",
                               name, numbers.first, numbers.last);
        free(name);
    }
    return result;
}

static Result compare(const Mesh *mesh, const Mesh *first, const char *name, const char *than,
                      Error *error)
{
    if (mesh->vertex_count != first->vertex_count)
        return error_set(error, RESULT_BAD_INPUT, "%s: %u vertices: expected %u as in %s", name,
                         mesh->vertex_count, first->vertex_count, than);
    if (mesh->triangle_count != first->triangle_count)
        return error_set(error, RESULT_BAD_INPUT, "%s: %u triangles: expected %u as in %s", name,
                         mesh->triangle_count, first->triangle_count, than);
    for (uint32_t t = 0; t < mesh->triangle_count; ++t)
        if (memcmp(mesh->triangle[t], first->triangle[t], sizeof *mesh->triangle) != 0)
            return error_set(error, RESULT_BAD_INPUT,
                             "%s: triangle %u has other corners than in %s: expected the same "
                             "faces in all",
                             name, t + 1, than);
    return RESULT_OK;
}

static Result read_numbered(MeshSequence *sequence, Mesh *mesh, const Target *target,
                            TargetNumbers numbers, const MeshSequenceOptions *options, Error *error)
{
    const int first = numbers.first, last = numbers.last;
    TRY(check_gaps(target, numbers, error));
    float unit = (float)(options->unit > 0 ? options->unit : options->otherwise_unit);
    bool up_z = (options->up_z >= 0 ? options->up_z : options->otherwise_up_z) == 1;
    char *than = target_name_frame(target, first);
    Result result = than ? RESULT_OK : error_set(error, RESULT_FAILED, "no memory for a name");
    THEN(result, mesh_read(mesh, than, unit, up_z, error));
    size_t count = (size_t)(last - first) + 1, vertices = mesh->vertex_count;
    if (result == RESULT_OK && vertices > MOST_VERTICES / count)
        result = error_set(error, RESULT_BAD_INPUT, "%s: %zu samples do not fit into memory", than,
                           count);
    if (result == RESULT_OK) {
        sequence->times.count = (uint32_t)count;
        sequence->first = first;
        sequence->vertex_count = mesh->vertex_count;
        sequence->position = malloc(count * vertices * sizeof *sequence->position + 1);
        if (!sequence->position)
            result =
                error_set(error, RESULT_FAILED, "no memory for %zu samples of %s", count, than);
    }
    for (int i = first; i <= last && result == RESULT_OK; ++i) {
        Mesh next = {0};
        char *name = target_name_frame(target, i);
        if (!name) result = error_set(error, RESULT_FAILED, "no memory for a name");
        THEN(result, mesh_read(&next, name, unit, up_z, error));
        if (result == RESULT_OK) mesh_take_away(&next, options->origin);
        THEN(result, compare(&next, mesh, name, than, error));
        if (result == RESULT_OK)
            memcpy(mesh_sequence_at(sequence, (uint32_t)(i - first)), next.position,
                   vertices * sizeof *next.position);
        mesh_destroy(&next);
        free(name);
    }
    free(than);
    return result;
}

static Result read_pattern(MeshSequence *sequence, Mesh *mesh, const char *path,
                           const MeshSequenceOptions *options, Error *error)
{
    Target target = {0};
    TRY(target_parse_any(&target, path, error));
    TargetNumbers numbers = {.last = -1};
    Result result = RESULT_OK;
    if (target.kind == TARGET_FRAMES) numbers = target_find_numbers(&target);
    if (numbers.last < 0)
        result = error_set(error, RESULT_BAD_INPUT,
                           "%s: no file has such a name: expected samples as x_0000.obj", path);
    THEN(result, read_numbered(sequence, mesh, &target, numbers, options, error));
    target_destroy(&target);
    return result;
}

// --- Files that contain all samples.

static Result check_finite(const MeshSamples *samples, const char *path, Error *error)
{
    for (uint64_t i = 0; i < samples->count * samples->vertex_count; ++i)
        for (int k = 0; k < 3; ++k)
            if (!(fabsf(samples->position[i][k]) <= MESH_MOST_COORDINATE))
                return error_set(
                    error, RESULT_BAD_INPUT,
                    "%s: sample %llu: a coordinate of vertex %llu is NaN, infinite or beyond 1e18",
                    path, (unsigned long long)(i / samples->vertex_count),
                    (unsigned long long)(i % samples->vertex_count));
    return RESULT_OK;
}

static void convert(MeshSamples *samples, float unit, bool up_z, const double origin[3])
{
    bool far = false;
    for (int k = 0; k < 3; ++k) far = far || samples->origin[k] != 0 || origin[k] != 0;
    // The scene's origin in the file's axes.
    const double away[3] = {origin[0], up_z ? -origin[2] : origin[1], up_z ? origin[1] : origin[2]};
    for (uint64_t i = 0; i < samples->count * samples->vertex_count; ++i) {
        float *p = samples->position[i], y;
        for (int k = 0; k < 3; ++k)
            p[k] =
                far ? (float)((p[k] + samples->origin[k]) * (double)unit - away[k]) : p[k] * unit;
        if (up_z) y = p[1], p[1] = p[2], p[2] = -y;
    }
}

// Makes the mesh from the first sample's positions and the faces of the file or, if it has none, of
// the rest pose.
static Result make_mesh(Mesh *mesh, MeshSamples *samples, const Mesh *rest, const char *path,
                        bool takes_rest, Error *error)
{
    bool own = samples->triangle != NULL;
    if (!own && !rest->vertex_count)
        return error_set(error, RESULT_BAD_INPUT, "%s: no faces: " FOREIGN_WANTS_MESH "%s", path,
                         takes_rest ? ", or --mesh-rest with an OBJ or PLY file that has them"
                                    : "");
    uint64_t triangles = own ? samples->triangle_count : rest->triangle_count;
    if (triangles == 0 || triangles > UINT32_MAX / 8)
        return error_set(error, RESULT_BAD_INPUT,
                         "%s: %llu triangles: expected at least 1 and fewer than 2^29", path,
                         (unsigned long long)triangles);
    TRY(mesh_create(mesh, (uint32_t)samples->vertex_count, (uint32_t)triangles, error));
    memcpy(mesh->triangle, own ? samples->triangle : rest->triangle,
           triangles * sizeof *mesh->triangle);
    for (uint64_t i = 0; i < 3 * triangles; ++i)
        if (mesh->triangle[i / 3][i % 3] >= samples->vertex_count)
            return error_set(error, RESULT_BAD_INPUT,
                             "%s: triangle %llu has corner %u: expected less than %llu", path,
                             (unsigned long long)(i / 3), mesh->triangle[i / 3][i % 3],
                             (unsigned long long)samples->vertex_count);
    memcpy(mesh->position, samples->position, samples->vertex_count * sizeof *mesh->position);
    return RESULT_OK;
}

static Result take_samples(MeshSequence *sequence, Mesh *mesh, MeshSamples *samples,
                           const Mesh *rest, const char *path, const MeshSequenceOptions *options,
                           Error *error)
{
    double unit = options->unit > 0   ? options->unit
                  : samples->unit > 0 ? samples->unit
                                      : options->otherwise_unit;
    int up_z = options->up_z >= 0   ? options->up_z
               : samples->up_z >= 0 ? samples->up_z
                                    : options->otherwise_up_z;
    convert(samples, (float)unit, up_z == 1, options->origin);
    TRY(check_finite(samples, path, error));
    TRY(make_mesh(mesh, samples, rest, path, options->rest != NULL, error));
    sequence->times.count = (uint32_t)samples->count;
    sequence->times.rate = samples->rate;
    sequence->first = samples->first;
    memcpy(sequence->note, samples->note, sizeof sequence->note);
    sequence->vertex_count = mesh->vertex_count;
    sequence->position = samples->position;
    samples->position = NULL;
    return RESULT_OK;
}

static Result read_file(MeshSequence *sequence, Mesh *mesh, const Mesh *rest, const char *path,
                        const MeshSequenceOptions *options, Error *error)
{
    Bytes bytes = {0};
    TRY(bytes_read_file(&bytes, path, error));
    const MeshSequenceFormat *format = find_format(path, &bytes);
    MeshSamples samples = {.up_z = -1, .objects = options->objects};
    Result result = RESULT_OK;
    if (format) {
        Reader reader =
            (format->text ? reader_begin_text : reader_begin_binary)(path, &bytes, error);
        format->read(&samples, &reader);
        result = reader.result;
    } else {
        result = error_set(error, RESULT_BAD_INPUT,
                           "%s: no sequence of meshes: expected x_%%04d.obj, .npz, .npy, .pc2, "
                           ".mdd, .abc or .usda",
                           path);
    }
    THEN(result, take_samples(sequence, mesh, &samples, rest, path, options, error));
    mesh_samples_destroy(&samples);
    bytes_destroy(&bytes);
    return result;
}

// --- Both kinds.

static Result read_rest(Mesh *rest, const MeshSequenceOptions *options, Error *error)
{
    if (!options->rest || !*options->rest) return RESULT_OK;
    float unit = (float)(options->unit > 0 ? options->unit : options->otherwise_unit);
    bool up_z = (options->up_z >= 0 ? options->up_z : options->otherwise_up_z) == 1;
    TRY(mesh_read(rest, options->rest, unit, up_z, error));
    mesh_take_away(rest, options->origin);
    return RESULT_OK;
}

static Result read_all(MeshSequence *sequence, Mesh *mesh, Mesh *rest, const char *path,
                       const MeshSequenceOptions *options, Error *error)
{
    TRY(read_rest(rest, options, error));
    TRY(is_pattern(path) ? read_pattern(sequence, mesh, path, options, error)
                         : read_file(sequence, mesh, rest, path, options, error));
    if (rest->vertex_count) TRY(compare(rest, mesh, options->rest, path, error));
    if (rest->uv && !mesh->uv) {
        TRY(mesh_create_uv(mesh, rest->uv_count, error));
        memcpy(mesh->uv, rest->uv, rest->uv_count * sizeof *mesh->uv);
        memcpy(mesh->triangle_uv, rest->triangle_uv,
               rest->triangle_count * sizeof *mesh->triangle_uv);
    }
    SampleTimes *times = &sequence->times;
    times->rate = options->rate > 0 ? options->rate
                  : times->rate > 0 ? times->rate
                                    : options->otherwise_rate;
    times->start = options->start;
    times->linear = options->linear;
    if (!(times->rate > 0) || !isfinite(times->rate)) times->rate = options->otherwise_rate;
    sequence->checksum =
        libdeflate_crc32(0, sequence->position,
                         (size_t)times->count * sequence->vertex_count * sizeof *mesh->position);
    mesh_compute_normals(mesh);
    return RESULT_OK;
}

Result mesh_sequence_read(MeshSequence *sequence, Mesh *mesh, Mesh *rest, const char *path,
                          const MeshSequenceOptions *options, Error *error)
{
    *sequence = (MeshSequence){0};
    *mesh = *rest = (Mesh){0};
    Result result = read_all(sequence, mesh, rest, path, options, error);
    if (result != RESULT_OK) {
        mesh_sequence_destroy(sequence);
        mesh_destroy(mesh);
        mesh_destroy(rest);
    }
    return result;
}

void mesh_sequence_evaluate(const MeshSequence *sequence, double time, float (*position)[3])
{
    SampleSpan span = sample_span(&sequence->times, time);
    const size_t vertices = sequence->vertex_count;
    if (span.weight[1] == 1) { // exactly the sample, without rounding
        memcpy(position, mesh_sequence_at(sequence, span.at[1]), vertices * sizeof *position);
        return;
    }
    float *to = position[0];
    const float *sample[4], w[4] = {(float)span.weight[0], (float)span.weight[1],
                                    (float)span.weight[2], (float)span.weight[3]};
    for (int i = 0; i < 4; ++i) sample[i] = mesh_sequence_at(sequence, span.at[i])[0];
    // Interpolating differences from the nearest sample keeps the rounding error at that of the
    // positions.
    for (size_t v = 0; v < 3 * vertices; ++v) {
        float p = sample[1][v];
        to[v] =
            p + (w[0] * (sample[0][v] - p) + w[2] * (sample[2][v] - p) + w[3] * (sample[3][v] - p));
    }
}

static bool is_equal(const MeshSequence *sequence, uint32_t a, uint32_t b)
{
    return a == b || memcmp(mesh_sequence_at(sequence, a), mesh_sequence_at(sequence, b),
                            sequence->vertex_count * sizeof *sequence->position) == 0;
}

double mesh_sequence_shape(const MeshSequence *sequence, double time)
{
    SampleSpan span = sample_span(&sequence->times, time);
    double at = 0;
    bool still = true;
    for (int i = 0; i < 4; ++i) {
        if (span.weight[i] == 0) continue;
        still = still && is_equal(sequence, span.at[i], span.at[1]);
        at += span.weight[i] * span.at[i];
    }
    if (!still) return sequence->earlier + at;
    uint32_t first = span.at[1];
    while (first > 0 && is_equal(sequence, first - 1, first)) --first;
    return sequence->earlier + first;
}

void mesh_sequence_push(MeshSequence *sequence, const float (*position)[3], double before,
                        double after)
{
    const size_t size = sequence->vertex_count * sizeof *position;
    sequence->earlier += !is_equal(sequence, 0, 1);
    memcpy(mesh_sequence_at(sequence, 0), mesh_sequence_at(sequence, 1), size);
    memcpy(mesh_sequence_at(sequence, 1), position, size);
    sequence->times.start = before;
    sequence->times.rate = 1 / (after - before);
}
