// SPDX-License-Identifier: MIT
#include "sim/moving_field.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// PADDING: grid points around the mesh. ROUNDED: vertices are rounded to 1/64 of a spacing, so that
// a mesh that barely moves keeps its field.
enum { PADDING = 3, ROUNDED = 64 };
static const float STILL = 1e-3f; // smallest motion that counts, spacings a step
static const uint32_t NONE = UINT32_MAX;

typedef struct MovingFieldWork {
    int32_t (*rounded)[3]; // [vertices], those of the current field
    float (*corner)[3];    // [vertices], `rounded` in spacings from the first grid point
    float (*moved)[3];     // [vertices], displacement in the step, m
    float *square;         // [points], squared distance in spacings
    uint32_t *triangle;    // [points], the nearest triangle; NONE if it is too far
    int16_t *crossing, *winding;
    int32_t *beyond;        // [columns], crossings behind the end of the column
    uint32_t *front, *next; // fronts of grid points that are being spread
    float (*texel)[4];
    bool moving; // the texels contain displacements
} MovingFieldWork;

void moving_field_destroy(MovingField *field)
{
    MovingFieldWork *work = field->work;
    if (work) {
        void *parts[] = {work->rounded,  work->corner,   work->moved,   work->square,
                         work->triangle, work->crossing, work->winding, work->beyond,
                         work->front,    work->next,     work->texel};
        for (size_t i = 0; i < sizeof parts / sizeof *parts; ++i) free(parts[i]);
        free(work);
    }
    distance_field_destroy(&field->field);
    *field = (MovingField){0};
}

static Result make_room(MovingField *field, Error *error)
{
    MovingFieldWork *work = field->work = calloc(1, sizeof *work);
    size_t points = distance_field_count(&field->field), vertices = field->mesh->vertex_count + 1u;
    const uint32_t *size = field->field.size;
    size_t columns =
        (size_t)size[0] * size[1] + (size_t)size[1] * size[2] + (size_t)size[2] * size[0];
    if (work) {
        work->rounded = calloc(vertices, sizeof *work->rounded);
        work->corner = calloc(vertices, sizeof *work->corner);
        work->moved = calloc(vertices, sizeof *work->moved);
        work->square = malloc(points * sizeof *work->square);
        work->triangle = malloc(points * sizeof *work->triangle);
        work->crossing = calloc(points, sizeof *work->crossing);
        work->winding = calloc(points, sizeof *work->winding);
        work->beyond = calloc(columns, sizeof *work->beyond);
        work->front = malloc(points * sizeof *work->front);
        work->next = malloc(points * sizeof *work->next);
        work->texel = malloc(points * sizeof *work->texel);
    }
    bool good = work && work->rounded && work->corner && work->moved && work->square &&
                work->triangle && work->crossing && work->winding && work->beyond && work->front &&
                work->next && work->texel;
    return good ? RESULT_OK
                : error_set(error, RESULT_FAILED, "no memory for a field of %zu distances", points);
}

// --- The grid.

static void add_point(float low[3], float high[3], const float p[3], float by)
{
    for (int k = 0; k < 3; ++k) {
        low[k] = fminf(low[k], p[k] - by);
        high[k] = fmaxf(high[k], p[k] + by);
    }
}

// The box of the mesh at all times, cut to where hair can reach.
static bool find_box(const Body *body, float reach, float low[3], float high[3])
{
    uint32_t vertices = body->mesh->vertex_count;
    bool *rooted = calloc((size_t)vertices + 1, sizeof *rooted);
    float hair_low[3], hair_high[3];
    if (!rooted) return false;
    for (uint32_t i = 0; i < body->section_count; ++i)
        for (uint32_t s = 0; s < body->roots[i].count; ++s)
            for (int c = 0; c < 3; ++c) rooted[body->roots[i].points[s].corner[c]] = true;
    for (int k = 0; k < 3; ++k) {
        low[k] = hair_low[k] = INFINITY;
        high[k] = hair_high[k] = -INFINITY;
    }
    for (uint32_t i = 0; i < body->sequence.times.count; ++i) {
        const float(*p)[3] = (const float(*)[3])mesh_sequence_at(&body->sequence, i);
        for (uint32_t v = 0; v < vertices; ++v) {
            add_point(low, high, p[v], body->margin);
            if (rooted[v]) add_point(hair_low, hair_high, p[v], reach + body->margin);
        }
    }
    for (int k = 0; k < 3; ++k) {
        low[k] = fmaxf(low[k], hair_low[k]);
        high[k] = fmaxf(fminf(high[k], hair_high[k]), low[k]);
    }
    free(rooted);
    return true;
}

static void choose_grid(DistanceField *field, const float low[3], const float high[3],
                        uint32_t resolution)
{
    float longest = 0;
    for (int k = 0; k < 3; ++k) longest = fmaxf(longest, high[k] - low[k]);
    field->spacing = longest > 0 ? longest / (float)resolution : 1;
    for (int k = 0; k < 3; ++k) {
        field->size[k] = (uint32_t)ceilf((high[k] - low[k]) / field->spacing) + 1 + 2 * PADDING;
        float length = (float)(field->size[k] - 1) * field->spacing;
        field->low[k] = 0.5f * (low[k] + high[k]) - 0.5f * length;
    }
}

Result moving_field_create(MovingField *field, const Gpu *gpu, const Body *body, float longest,
                           float outside, uint32_t resolution, Error *error)
{
    float low[3], high[3];
    *field = (MovingField){.mesh = body->mesh};
    if (!find_box(body, longest + outside, low, high))
        return error_set(error, RESULT_FAILED, "no memory for a mesh's vertices");
    choose_grid(&field->field, low, high, resolution);
    field->outside = outside + 2 * field->field.spacing;
    Result result = make_room(field, error);
    THEN(result, gpu_buffer_create(
                     &field->field.values, &gpu->limits, "a field of distances (--sdf-resolution)",
                     16 * (int64_t)distance_field_count(&field->field), NULL, GL_RGBA32F, error));
    if (result != RESULT_OK) moving_field_destroy(field);
    return result;
}

// --- Distances. All coordinates are in spacings from the first grid point.

typedef struct Closest {
    float square, weight[3];
} Closest;

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// The point of a triangle that is nearest to p (C. Ericson, "Real-Time Collision Detection", 2005,
// 5.1.5).
static Closest closest_on(const float p[3], const float a[3], const float b[3], const float c[3])
{
    float ab[3], ac[3], ap[3], bp[3], cp[3];
    Closest closest = {0, {1, 0, 0}};
    for (int k = 0; k < 3; ++k)
        ab[k] = b[k] - a[k], ac[k] = c[k] - a[k], ap[k] = p[k] - a[k], bp[k] = p[k] - b[k],
        cp[k] = p[k] - c[k];
    float d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
          d6 = dot(ac, cp), vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4,
          all = va + vb + vc, v = 0, w = 0;
    if (d1 <= 0 && d2 <= 0) {
        v = w = 0;
    } else if (d3 >= 0 && d4 <= d3) {
        v = 1;
    } else if (d6 >= 0 && d5 <= d6) {
        w = 1;
    } else if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) {
        v = d1 / (d1 - d3);
    } else if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) {
        w = d2 / (d2 - d6);
    } else if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0 && d4 - d3 + d5 - d6 > 0) {
        w = (d4 - d3) / (d4 - d3 + d5 - d6);
        v = 1 - w;
    } else if (all > 0) {
        v = vb / all;
        w = vc / all;
    }
    for (int k = 0; k < 3; ++k) {
        float away = ap[k] - v * ab[k] - w * ac[k];
        closest.square += away * away;
    }
    closest.weight[0] = 1 - v - w, closest.weight[1] = v, closest.weight[2] = w;
    return closest;
}

static Closest closest_on_triangle(const MovingField *field, uint32_t t, const float p[3])
{
    const uint32_t *corner = field->mesh->triangle[t];
    const MovingFieldWork *work = field->work;
    return closest_on(p, work->corner[corner[0]], work->corner[corner[1]], work->corner[corner[2]]);
}

static uint32_t clamp_index(float x, uint32_t size)
{
    return (uint32_t)fminf(fmaxf(x, 0), (float)size - 1);
}

// Assigns the triangle to the grid points within one spacing, unless they have a nearer triangle.
static void take_triangle(MovingField *field, uint32_t t)
{
    MovingFieldWork *work = field->work;
    const uint32_t *size = field->field.size, *corner = field->mesh->triangle[t];
    const float *a = work->corner[corner[0]], *b = work->corner[corner[1]],
                *c = work->corner[corner[2]];
    float normal[3], low[3], high[3], length, p[3];
    uint32_t from[3], to[3];
    for (int k = 0; k < 3; ++k) {
        int u = (k + 1) % 3, v = (k + 2) % 3;
        low[k] = fminf(a[k], fminf(b[k], c[k])) - 1;
        high[k] = fmaxf(a[k], fmaxf(b[k], c[k])) + 1;
        if (high[k] < 0 || low[k] > (float)size[k] - 1) return;
        from[k] = clamp_index(ceilf(low[k]), size[k]);
        to[k] = clamp_index(floorf(high[k]), size[k]);
        normal[k] = (b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]);
    }
    length = sqrtf(dot(normal, normal));
    for (uint32_t z = from[2]; z <= to[2]; ++z)
        for (uint32_t y = from[1]; y <= to[1]; ++y)
            for (uint32_t x = from[0]; x <= to[0]; ++x) {
                p[0] = (float)x, p[1] = (float)y, p[2] = (float)z;
                float height = normal[0] * (p[0] - a[0]) + normal[1] * (p[1] - a[1]) +
                               normal[2] * (p[2] - a[2]);
                // Farther than a spacing from the triangle's plane.
                if (fabsf(height) > length) continue;
                size_t at = ((size_t)z * size[1] + y) * size[0] + x;
                Closest closest = closest_on(p, a, b, c);
                if (closest.square > 1 || closest.square >= work->square[at]) continue;
                work->square[at] = closest.square;
                work->triangle[at] = t;
            }
}

// --- Inside or outside, computed as in glsl/field/field_cross.comp and field_sign.comp.

// +1 if p is to the left of the line from a to b, -1 if it is to the right. Both triangles at an
// edge compute it from the same end, so that rounding cannot put p into both of them or into
// neither.
static int side(const float a[3], const float b[3], int u, int v, const float p[2])
{
    bool turned = a[u] > b[u] || (a[u] == b[u] && a[v] > b[v]);
    const float *from = turned ? b : a, *to = turned ? a : b;
    double left = ((double)to[u] - (double)from[u]) * ((double)p[1] - (double)from[v]) -
                  ((double)to[v] - (double)from[v]) * ((double)p[0] - (double)from[u]);
    return (left >= 0) != turned ? 1 : -1;
}

static void cross_triangle(MovingField *field, uint32_t t, int axis, int32_t *beyond,
                           const size_t stride[3])
{
    MovingFieldWork *work = field->work;
    const uint32_t *size = field->field.size, *corner = field->mesh->triangle[t];
    const float *a = work->corner[corner[0]], *b = work->corner[corner[1]],
                *c = work->corner[corner[2]];
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    float low_u = fminf(a[u], fminf(b[u], c[u])), high_u = fmaxf(a[u], fmaxf(b[u], c[u])),
          low_v = fminf(a[v], fminf(b[v], c[v])), high_v = fmaxf(a[v], fmaxf(b[v], c[v]));
    if (high_u < 0 || high_v < 0 || low_u > (float)size[u] - 1 || low_v > (float)size[v] - 1)
        return;
    float nu = (b[v] - a[v]) * (c[axis] - a[axis]) - (b[axis] - a[axis]) * (c[v] - a[v]),
          nv = (b[axis] - a[axis]) * (c[u] - a[u]) - (b[u] - a[u]) * (c[axis] - a[axis]),
          na = (b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]);
    float lowest = fminf(a[axis], fminf(b[axis], c[axis])),
          highest = fmaxf(a[axis], fmaxf(b[axis], c[axis]));
    uint32_t end_u = clamp_index(floorf(high_u), size[u]),
             end_v = clamp_index(floorf(high_v), size[v]);
    for (uint32_t j = clamp_index(ceilf(low_v), size[v]); j <= end_v; ++j)
        for (uint32_t i = clamp_index(ceilf(low_u), size[u]); i <= end_u; ++i) {
            const float p[2] = {(float)i, (float)j};
            int sides = side(a, b, u, v, p) + side(b, c, u, v, p) + side(c, a, u, v, p);
            if (sides != 3 && sides != -3) continue;
            float height =
                a[axis] - (nu * (p[0] - a[u]) + nv * (p[1] - a[v])) / (na != 0 ? na : 1e-30f);
            float at = ceilf(fmaxf(fminf(fmaxf(height, lowest), highest), 0));
            int way = sides > 0 ? -1 : 1;
            if (at < (float)size[axis])
                work->crossing[i * stride[u] + j * stride[v] + (size_t)at * stride[axis]] +=
                    (int16_t)way;
            else
                beyond[(size_t)j * size[u] + i] += way;
        }
}

static void find_winding(MovingField *field)
{
    MovingFieldWork *work = field->work;
    const uint32_t *size = field->field.size;
    const size_t stride[3] = {1, size[0], (size_t)size[0] * size[1]};
    size_t points = distance_field_count(&field->field);
    memset(work->winding, 0, points * sizeof *work->winding);
    for (int axis = 0; axis < 3; ++axis) {
        int u = (axis + 1) % 3, v = (axis + 2) % 3;
        size_t columns = (size_t)size[u] * size[v];
        memset(work->beyond, 0, columns * sizeof *work->beyond);
        memset(work->crossing, 0, points * sizeof *work->crossing);
        for (uint32_t t = 0; t < field->mesh->triangle_count; ++t)
            cross_triangle(field, t, axis, work->beyond, stride);
        for (size_t j = 0; j < size[v]; ++j)
            for (size_t i = 0; i < size[u]; ++i) {
                size_t first = i * stride[u] + j * stride[v], step = stride[axis];
                int all = work->beyond[j * size[u] + i], before = 0;
                for (size_t k = 0; k < size[axis]; ++k) all += work->crossing[first + k * step];
                for (size_t k = 0; k < size[axis]; ++k) {
                    before += work->crossing[first + k * step];
                    work->winding[first + k * step] += (int16_t)(2 * before - all);
                }
            }
    }
}

static bool is_inside(const MovingFieldWork *work, size_t at)
{
    return work->winding[at] >= 3 || work->winding[at] <= -3;
}

// --- Distances of more than one spacing, spread from grid point to grid point.

typedef struct Spread {
    MovingField *field;
    size_t reached; // number of points in `next`
    float most;     // largest squared distance outside the mesh
} Spread;

static void reach(Spread *spread, size_t at, uint32_t t, const float p[3])
{
    MovingFieldWork *work = spread->field->work;
    bool fresh = work->triangle[at] == NONE;
    Closest closest = closest_on_triangle(spread->field, t, p);
    if (!fresh && closest.square >= work->square[at]) return;
    if (!is_inside(work, at) && closest.square > spread->most) return;
    work->square[at] = closest.square;
    work->triangle[at] = t;
    if (fresh) work->next[spread->reached++] = (uint32_t)at;
}

// Passes the triangles of the front's points on to their neighbours that have none yet. `level` is
// the number of the front that reached a point, so that points of the same front can still choose
// the nearest of several triangles.
static void spread_front(Spread *spread, size_t count, uint8_t *level, uint8_t now)
{
    MovingFieldWork *work = spread->field->work;
    const uint32_t *size = spread->field->field.size;
    const size_t stride[3] = {1, size[0], (size_t)size[0] * size[1]};
    for (size_t i = 0; i < count; ++i) {
        size_t from = work->front[i];
        const uint32_t at[3] = {(uint32_t)(from % size[0]), (uint32_t)(from / stride[1] % size[1]),
                                (uint32_t)(from / stride[2])};
        for (int k = 0; k < 3; ++k)
            for (int way = -1; way <= 1; way += 2) {
                if (way < 0 ? at[k] == 0 : at[k] + 1 == size[k]) continue;
                size_t to = way < 0 ? from - stride[k] : from + stride[k];
                if (level[to] && level[to] != now) continue;
                float p[3] = {(float)at[0], (float)at[1], (float)at[2]};
                p[k] += (float)way;
                size_t before = spread->reached;
                reach(spread, to, work->triangle[from], p);
                if (spread->reached > before) level[to] = now;
            }
    }
}

static void spread_all(MovingField *field)
{
    MovingFieldWork *work = field->work;
    size_t points = distance_field_count(&field->field), count = 0;
    uint8_t *level = (uint8_t *)work->crossing, now = 1; // reuses the memory of the crossings
    float most = field->outside / field->field.spacing;
    Spread spread = {.field = field, .most = most * most};
    memset(level, 0, points);
    for (size_t i = 0; i < points; ++i)
        if (work->triangle[i] != NONE) work->front[count++] = (uint32_t)i, level[i] = 1;
    while (count > 0) {
        now = now == 255 ? 2 : now + 1;
        spread.reached = 0;
        spread_front(&spread, count, level, now);
        uint32_t *front = work->front;
        work->front = work->next, work->next = front;
        count = spread.reached;
    }
}

// A front takes the first triangle that arrives, which may not be the nearest. Two sweeps over the
// grid, in opposite directions, let each inner point choose among the triangles of its neighbours.
static void sweep(MovingField *field, bool back)
{
    MovingFieldWork *work = field->work;
    const uint32_t *size = field->field.size;
    const size_t stride[3] = {1, size[0], (size_t)size[0] * size[1]};
    size_t points = distance_field_count(&field->field);
    for (size_t i = 0; i < points; ++i) {
        size_t at = back ? points - 1 - i : i;
        if (work->triangle[at] == NONE || work->square[at] <= 1 || !is_inside(work, at)) continue;
        const uint32_t place[3] = {(uint32_t)(at % size[0]), (uint32_t)(at / stride[1] % size[1]),
                                   (uint32_t)(at / stride[2])};
        const float p[3] = {(float)place[0], (float)place[1], (float)place[2]};
        for (int k = 0; k < 3; ++k) {
            if (back ? place[k] + 1 == size[k] : place[k] == 0) continue;
            uint32_t t = work->triangle[back ? at + stride[k] : at - stride[k]];
            if (t == NONE || t == work->triangle[at]) continue;
            Closest closest = closest_on_triangle(field, t, p);
            if (closest.square >= work->square[at]) continue;
            work->square[at] = closest.square;
            work->triangle[at] = t;
        }
    }
}

// --- The whole field.

static void fill_texels(MovingField *field)
{
    MovingFieldWork *work = field->work;
    const uint32_t *size = field->field.size;
    size_t points = distance_field_count(&field->field);
    float spacing = field->field.spacing;
    for (size_t i = 0; i < points; ++i) {
        bool inside = is_inside(work, i);
        float distance = work->triangle[i] == NONE ? (inside ? 0 : field->outside)
                                                   : spacing * sqrtf(work->square[i]);
        if (!inside) distance = fminf(distance, field->outside);
        work->texel[i][0] = inside ? -distance : distance;
        work->texel[i][1] = work->texel[i][2] = work->texel[i][3] = 0;
        if (!work->moving || work->triangle[i] == NONE) continue;
        const float p[3] = {(float)(i % size[0]), (float)(i / size[0] % size[1]),
                            (float)(i / size[0] / size[1])};
        const uint32_t *corner = field->mesh->triangle[work->triangle[i]];
        Closest closest = closest_on_triangle(field, work->triangle[i], p);
        for (int c = 0; c < 3; ++c)
            for (int k = 0; k < 3; ++k)
                work->texel[i][1 + k] += closest.weight[c] * work->moved[corner[c]][k];
    }
    gpu_buffer_write(&field->field.values, 0, work->texel, field->field.values.size);
}

static void build(MovingField *field)
{
    MovingFieldWork *work = field->work;
    size_t points = distance_field_count(&field->field);
    for (size_t i = 0; i < points; ++i) work->square[i] = 1e30f, work->triangle[i] = NONE;
    for (uint32_t t = 0; t < field->mesh->triangle_count; ++t) take_triangle(field, t);
    find_winding(field);
    spread_all(field);
    sweep(field, false);
    sweep(field, true);
    ++field->builds;
}

// Rounds the vertices. Returns whether any of them changed.
static bool take_vertices(MovingField *field, const float (*after)[3])
{
    MovingFieldWork *work = field->work;
    float fine = (float)ROUNDED / field->field.spacing;
    bool changed = !field->made;
    for (uint32_t v = 0; v < field->mesh->vertex_count; ++v)
        for (int k = 0; k < 3; ++k) {
            float x = (after[v][k] - field->field.low[k]) * fine;
            int32_t rounded = (int32_t)lrintf(fminf(fmaxf(x, -1e9f), 1e9f));
            changed = changed || rounded != work->rounded[v][k];
            work->rounded[v][k] = rounded;
            work->corner[v][k] = (float)rounded / (float)ROUNDED;
        }
    return changed;
}

// Computes the displacements. Returns whether any vertex moves by more than STILL in the step.
static bool take_moves(MovingField *field, const float (*before)[3], const float (*after)[3])
{
    MovingFieldWork *work = field->work;
    float most = 0;
    for (uint32_t v = 0; v < field->mesh->vertex_count; ++v)
        for (int k = 0; k < 3; ++k) {
            work->moved[v][k] = after[v][k] - before[v][k];
            most = fmaxf(most, fabsf(work->moved[v][k]));
        }
    return most > STILL * field->field.spacing;
}

void moving_field_update(MovingField *field, const float (*before)[3], const float (*after)[3])
{
    if (!field->work) return;
    bool changed = take_vertices(field, after), moved = take_moves(field, before, after);
    if (changed) build(field);
    bool fill = changed || moved || field->work->moving;
    field->work->moving = moved;
    field->made = true;
    if (fill) fill_texels(field);
}
