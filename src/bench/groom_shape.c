// SPDX-License-Identifier: MIT
#include "bench/groom_shape.h"
#include "base/parallel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- Shapes.

static double distance(const float a[3], const float b[3])
{
    double sum = 0;
    for (int k = 0; k < 3; ++k)
        sum += ((double)a[k] - (double)b[k]) * ((double)a[k] - (double)b[k]);
    return sqrt(sum);
}

static void take_strands(GroomShape *shape, const Hair *hair, const Strands *strands)
{
    uint32_t at = 0, s = 0;
    for (uint32_t b = 0; b < hair->batch_count; ++b)
        for (uint32_t i = 0; i < hair->batches[b].strand_count; ++i, ++s) {
            uint32_t own = hair->batches[b].strand[i], size = strands_size(strands, own);
            memcpy(shape->point[at], strands->position[strands->first[own]],
                   size * sizeof *shape->point);
            shape->first[s] = at;
            shape->length[s] = (float)strands_length(strands, own);
            at += size;
        }
    shape->first[s] = at;
}

static void find_voxels(GroomShape *shape)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    float side = 0;
    for (uint32_t v = 0; v < shape->first[shape->strand_count]; ++v)
        for (int k = 0; k < 3; ++k) {
            low[k] = fminf(low[k], shape->point[v][k]);
            high[k] = fmaxf(high[k], shape->point[v][k]);
        }
    for (int k = 0; k < 3; ++k) side = fmaxf(side, high[k] - low[k]);
    shape->edge = side / 100;
    for (int k = 0; k < 3; ++k) shape->low[k] = low[k] - shape->edge / 2;
}

static void find_depths(const GroomShape *shape, const float (*points)[3], float *depths);

Result groom_shape_create(GroomShape *shape, const Hair *hair, const Strands *strands,
                          const Mesh *mesh, Error *error)
{
    size_t particles = hair->particle_count;
    *shape = (GroomShape){.strand_count = hair->strand_count, .mesh = mesh};
    shape->first = calloc(hair->strand_count + (size_t)1, sizeof *shape->first);
    shape->length = calloc(hair->strand_count + (size_t)1, sizeof *shape->length);
    shape->point = calloc(particles + 1, sizeof *shape->point);
    shape->depth = calloc(particles + 1, sizeof *shape->depth);
    if (!shape->first || !shape->length || !shape->point || !shape->depth)
        return error_set(error, RESULT_FAILED, "no memory for the groom of %zu particles",
                         particles);
    take_strands(shape, hair, strands);
    find_voxels(shape);
    if (mesh) {
        TRY(surface_create(&shape->surface, mesh, "mesh", error));
        find_depths(shape, (const float(*)[3])shape->point, shape->depth);
    }
    return groom_shape_voxels(shape, (const float(*)[3])shape->point, &shape->voxels, error);
}

void groom_shape_destroy(GroomShape *shape)
{
    surface_destroy(&shape->surface);
    free(shape->first);
    free(shape->length);
    free(shape->point);
    free(shape->depth);
    *shape = (GroomShape){0};
}

// --- Distances from the groom.

void groom_shape_displacement(const GroomShape *shape, const float (*points)[3], double *mean,
                              double *tips)
{
    double sum = 0, at_tips = 0;
    for (uint32_t s = 0; s < shape->strand_count; ++s) {
        double off = 0, length = (double)shape->length[s];
        for (uint32_t v = shape->first[s] + 1; v < shape->first[s + 1]; ++v) {
            off = distance(points[v], shape->point[v]) / length;
            sum += off;
        }
        at_tips += off;
    }
    *mean = sum / (shape->first[shape->strand_count] - (double)shape->strand_count);
    *tips = at_tips / shape->strand_count;
}

double groom_shape_step(const GroomShape *shape, const float (*points)[3], const float (*before)[3])
{
    double most = 0;
    for (uint32_t s = 0; s < shape->strand_count; ++s)
        for (uint32_t v = shape->first[s]; v < shape->first[s + 1]; ++v) {
            most = groom_shape_greater(most,
                                       distance(points[v], before[v]) / (double)shape->length[s]);
        }
    return most;
}

double groom_shape_spread(const GroomShape *shape, const float (*points)[3], const float middle[3])
{
    double sum = 0;
    for (uint32_t s = 0; s < shape->strand_count; ++s) {
        const float *tip = points[shape->first[s + 1] - 1];
        sum += hypot((double)tip[0] - (double)middle[0], (double)tip[2] - (double)middle[2]);
    }
    return sum / shape->strand_count;
}

// --- Voxels, as a list of keys with 21 bits for each axis.

typedef struct Voxels {
    uint64_t *list;
    size_t count, room;
} Voxels;

static const double MOST_CELLS = (1 << 20) - 1; // in each direction from the origin
enum { SAMPLES_PER_EDGE = 4, MOST_SAMPLES = 100000 };

static uint64_t voxel_at(const GroomShape *shape, const double place[3])
{
    uint64_t number = 0;
    for (int k = 0; k < 3; ++k) {
        double cell = floor((place[k] - (double)shape->low[k]) / (double)shape->edge);
        cell = fmin(fmax(cell, -MOST_CELLS), MOST_CELLS);
        number = number << 21 | (uint64_t)(cell + MOST_CELLS);
    }
    return number;
}

static bool add_voxel(Voxels *voxels, uint64_t number)
{
    if (voxels->count && voxels->list[voxels->count - 1] == number) return true;
    if (voxels->count == voxels->room) {
        size_t room = 2 * voxels->room + 4096;
        uint64_t *more = realloc(voxels->list, room * sizeof *more);
        if (!more) return false;
        voxels->list = more, voxels->room = room;
    }
    voxels->list[voxels->count++] = number;
    return true;
}

static bool add_segment(const GroomShape *shape, const float a[3], const float b[3], Voxels *voxels)
{
    double pieces = ceil(distance(a, b) / (double)shape->edge * SAMPLES_PER_EDGE);
    pieces = fmin(fmax(pieces, 1), MOST_SAMPLES);
    for (int i = 0; i <= (int)pieces; ++i) {
        double place[3];
        for (int k = 0; k < 3; ++k)
            place[k] = (double)a[k] + i / pieces * ((double)b[k] - (double)a[k]);
        if (!add_voxel(voxels, voxel_at(shape, place))) return false;
    }
    return true;
}

static int compare_numbers(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

static bool all_finite(const GroomShape *shape, const float (*points)[3])
{
    for (uint32_t v = 0; v < shape->first[shape->strand_count]; ++v)
        for (int k = 0; k < 3; ++k)
            if (!isfinite(points[v][k])) return false;
    return true;
}

Result groom_shape_voxels(const GroomShape *shape, const float (*points)[3], double *count,
                          Error *error)
{
    Voxels voxels = {0};
    bool room = true;
    *count = NAN;
    if (!all_finite(shape, points)) return RESULT_OK;
    for (uint32_t s = 0; s < shape->strand_count && room; ++s)
        for (uint32_t v = shape->first[s] + 1; v < shape->first[s + 1] && room; ++v)
            room = add_segment(shape, points[v - 1], points[v], &voxels);
    if (room) {
        if (voxels.count > 0)
            qsort(voxels.list, voxels.count, sizeof *voxels.list, compare_numbers);
        *count = 0;
        for (size_t i = 0; i < voxels.count; ++i)
            *count += i == 0 || voxels.list[i] != voxels.list[i - 1];
    }
    free(voxels.list);
    return room ? RESULT_OK : error_set(error, RESULT_FAILED, "no memory for voxels");
}

// --- Depths.

typedef struct DepthWork {
    const GroomShape *shape;
    const float (*points)[3];
    float *depths;
    float low[3], high[3]; // bounds of the mesh
    int parts;
} DepthWork;

static bool is_within(const DepthWork *work, const float point[3])
{
    for (int k = 0; k < 3; ++k) // NaN is not inside
        if (!(point[k] > work->low[k] && point[k] < work->high[k])) return false;
    return true;
}

static void find_part(void *data, int part)
{
    const DepthWork *work = data;
    uint64_t count = work->shape->first[work->shape->strand_count];
    uint64_t begin = count * (uint64_t)part / (uint64_t)work->parts;
    uint64_t end = count * ((uint64_t)part + 1) / (uint64_t)work->parts;
    SurfacePoint nearest = {.triangle = work->shape->surface.triangle[0]};
    for (uint64_t v = begin; v < end; ++v) {
        Double3 place;
        double3_from_float(work->points[v], place);
        work->depths[v] = 0;
        if (is_within(work, work->points[v]))
            work->depths[v] =
                (float)fmax(0, -surface_nearest(&work->shape->surface, place, &nearest));
    }
}

static void find_depths(const GroomShape *shape, const float (*points)[3], float *depths)
{
    DepthWork work = {
        .shape = shape, .points = points, .depths = depths, .parts = parallel_threads()};
    mesh_bounds(shape->mesh, work.low, work.high);
    parallel_run(work.parts, find_part, &work);
}

Result groom_shape_depth(const GroomShape *shape, const float (*points)[3], double *deepest,
                         double *beyond, Error *error)
{
    uint32_t count = shape->first[shape->strand_count];
    *deepest = *beyond = NAN;
    if (!shape->surface.triangle_count) return RESULT_OK;
    float *depths = malloc((count + (size_t)1) * sizeof *depths);
    if (!depths) return error_set(error, RESULT_FAILED, "no memory for depths");
    find_depths(shape, points, depths);
    *deepest = *beyond = 0;
    for (uint32_t v = 0; v < count; ++v) {
        *deepest = fmax(*deepest, (double)depths[v]);
        *beyond = fmax(*beyond, (double)depths[v] - (double)shape->depth[v]);
    }
    free(depths);
    return RESULT_OK;
}
