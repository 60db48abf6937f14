// SPDX-License-Identifier: MIT
#include "bench/shadow_reference.h"
#include "base/parallel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE_MAX = 1024 };

static const double LEAST_COSINE = 0.25; // of the joints' 1 + d0.d1: longer mitres are cut

// A convex outline across the light whose depth is linear. Before a lamp "depth" is -1/depth, which
// is linear there and grows with it.
typedef struct ShadowShape {
    double corner[4][2]; // u, v in turn
    int corners;
    double depth, du, dv; // depth + du u + dv v
    double nearest, farthest;
    double opacity;
} ShadowShape;

typedef struct Place {
    bool seen;
    double at[3]; // u, v, depth
    double radius;
} Place;

static void add_shape(ShadowReference *reference, const ShadowShape *shape)
{
    reference->shapes[reference->count++] = *shape;
}

static bool find_way(const Place *a, const Place *b, double way[2])
{
    double u = b->at[0] - a->at[0], v = b->at[1] - a->at[1], length = hypot(u, v);
    way[0] = length > 0 ? u / length : 0;
    way[1] = length > 0 ? v / length : 0;
    return length > 0 && a->seen && b->seen;
}

// From the middle line to the left edge where ribbons along d0 and d1 meet. Off a lamp's axis the
// outline of a fibre is wider (image_reference.h).
static void find_mitre(const Place *at, bool lamp, const double d0[2], const double d1[2],
                       double mitre[2])
{
    double n[2] = {-d0[1] - d1[1], d0[0] + d1[0]}, length = hypot(n[0], n[1]);
    double q = lamp && length > 0 ? (n[0] * at->at[0] + n[1] * at->at[1]) / length : 0;
    double cosine = fmax(1 + d0[0] * d1[0] + d0[1] * d1[1], LEAST_COSINE);
    for (int k = 0; k < 2; ++k) mitre[k] = n[k] * at->radius * sqrt(1 + q * q) / cosine;
}

static void add_ribbon(ShadowReference *reference, const Place *a, const Place *b,
                       const double before[2], const double way[2], const double after[2],
                       double opacity)
{
    double first[2], last[2], length = hypot(b->at[0] - a->at[0], b->at[1] - a->at[1]);
    bool lamp = reference->view.perspective;
    find_mitre(a, lamp, before[0] || before[1] ? before : way, way, first);
    find_mitre(b, lamp, way, after[0] || after[1] ? after : way, last);
    ShadowShape shape = {.corners = 4, .opacity = opacity};
    for (int k = 0; k < 2; ++k) {
        shape.corner[0][k] = a->at[k] - first[k], shape.corner[1][k] = a->at[k] + first[k];
        shape.corner[2][k] = b->at[k] + last[k], shape.corner[3][k] = b->at[k] - last[k];
    }
    double slope = (b->at[2] - a->at[2]) / length;
    shape.du = slope * way[0], shape.dv = slope * way[1];
    shape.depth = a->at[2] - shape.du * a->at[0] - shape.dv * a->at[1];
    shape.nearest = fmin(a->at[2], b->at[2]);
    shape.farthest = fmax(a->at[2], b->at[2]);
    add_shape(reference, &shape);
}

static bool find_point(const ShadowReference *reference, const float x[3], double at[3])
{
    bool seen = light_frame_place(&reference->view, (double[3]){x[0], x[1], x[2]}, at);
    if (reference->view.perspective) at[2] = seen ? -1 / at[2] : -1;
    return seen;
}

static Place find_place(const ShadowReference *reference, const ReferenceItem *item, uint32_t s,
                        uint32_t j)
{
    const Strands *strands = item->strands;
    uint32_t vertex = strands->first[s] + j;
    const float *x = strands->position[vertex];
    double thinning = (1 - (double)item->material->tip_ratio) / (strands_size(strands, s) - 1);
    double share =
        item->paint && item->paint->color ? item->paint->thickness[vertex] : 1 - thinning * j;
    Place place = {.radius = item->radius * share};
    place.seen = find_point(reference, x, place.at);
    if (reference->view.perspective) place.radius *= -place.at[2];
    return place;
}

static void add_strand(ShadowReference *reference, const ReferenceItem *item, uint32_t s)
{
    uint32_t n = strands_size(item->strands, s);
    double before[2] = {0}, way[2], after[2] = {0}, opacity = item->material->shadow_opacity;
    if (item->paint && item->paint->color)
        opacity *= (double)item->paint->color[item->strands->first[s]][3];
    Place a = find_place(reference, item, s, 0), b = find_place(reference, item, s, 1);
    bool seen = find_way(&a, &b, way);
    for (uint32_t j = 1; j < n; ++j) {
        Place next = b;
        bool next_seen = false;
        after[0] = after[1] = 0;
        if (j + 1 < n) {
            next = find_place(reference, item, s, j + 1);
            next_seen = find_way(&b, &next, after);
        }
        if (seen) add_ribbon(reference, &a, &b, before, way, after, opacity);
        memcpy(before, way, sizeof before);
        memcpy(way, after, sizeof way);
        a = b, b = next, seen = next_seen;
    }
}

static void add_triangle(ShadowReference *reference, const Mesh *mesh, uint32_t t)
{
    double at[3][3];
    ShadowShape shape = {.corners = 3, .opacity = 1};
    for (int i = 0; i < 3; ++i) {
        if (!find_point(reference, mesh->position[mesh->triangle[t][i]], at[i])) return;
        memcpy(shape.corner[i], at[i], sizeof shape.corner[i]);
    }
    double p[3], q[3];
    for (int k = 0; k < 3; ++k) p[k] = at[1][k] - at[0][k], q[k] = at[2][k] - at[0][k];
    double area = p[0] * q[1] - p[1] * q[0];
    if (area == 0) return;
    shape.du = (p[2] * q[1] - q[2] * p[1]) / area;
    shape.dv = (q[2] * p[0] - p[2] * q[0]) / area;
    shape.depth = at[0][2] - shape.du * at[0][0] - shape.dv * at[0][1];
    shape.nearest = fmin(fmin(at[0][2], at[1][2]), at[2][2]);
    shape.farthest = fmax(fmax(at[0][2], at[1][2]), at[2][2]);
    add_shape(reference, &shape);
}

static void find_span(const ShadowShape *shape, int axis, double *low, double *high)
{
    *low = *high = shape->corner[0][axis];
    for (int i = 1; i < shape->corners; ++i) {
        *low = fmin(*low, shape->corner[i][axis]);
        *high = fmax(*high, shape->corner[i][axis]);
    }
}

static void lay_grid(ShadowReference *reference)
{
    double high[2] = {0};
    for (uint32_t i = 0; i < reference->count; ++i)
        for (int k = 0; k < 2; ++k) {
            double a, b;
            find_span(&reference->shapes[i], k, &a, &b);
            reference->low[k] = i ? fmin(reference->low[k], a) : a;
            high[k] = i ? fmax(high[k], b) : b;
        }
    reference->side = (uint32_t)fmin(fmax(sqrt(reference->count), 1), SIDE_MAX);
    for (int k = 0; k < 2; ++k)
        reference->step[k] = fmax(high[k] - reference->low[k], 1e-30) / reference->side;
}

static uint32_t column_of(const ShadowReference *reference, int axis, double value)
{
    double column = floor((value - reference->low[axis]) / reference->step[axis]);
    return (uint32_t)fmin(fmax(column, 0), reference->side - 1);
}

// Counts the shapes of each cell up from where `next` begins, or, with `shapes`, enters them.
static void fill_cells(const ShadowReference *reference, uint32_t *next, uint32_t *shapes)
{
    for (uint32_t i = 0; i < reference->count; ++i) {
        uint32_t from[2], to[2];
        for (int k = 0; k < 2; ++k) {
            double low, high;
            find_span(&reference->shapes[i], k, &low, &high);
            from[k] = column_of(reference, k, low), to[k] = column_of(reference, k, high);
        }
        for (uint32_t v = from[1]; v <= to[1]; ++v)
            for (uint32_t u = from[0]; u <= to[0]; ++u) {
                uint32_t at = next[v * reference->side + u]++;
                if (shapes) shapes[at] = i;
            }
    }
}

static Result make_grid(ShadowReference *reference, Error *error)
{
    lay_grid(reference);
    size_t cells = (size_t)reference->side * reference->side;
    reference->cell_first = calloc(cells + 2, sizeof *reference->cell_first);
    if (!reference->cell_first)
        return error_set(error, RESULT_FAILED, "no memory for a grid of %zu cells", cells);
    uint32_t *first = reference->cell_first;
    fill_cells(reference, first + 2, NULL);
    for (size_t i = 0; i < cells; ++i) first[i + 2] += first[i + 1];
    reference->cell_shapes = malloc(((size_t)first[cells + 1] + 1) * sizeof(uint32_t));
    if (!reference->cell_shapes)
        return error_set(error, RESULT_FAILED, "no memory for %u shapes", first[cells + 1]);
    fill_cells(reference, first + 1, reference->cell_shapes); // counts up to the next cell's
    return RESULT_OK;
}

Result shadow_reference_create(ShadowReference *reference, const ReferenceScene *scene,
                               const Light *light, const float middle[3], Error *error)
{
    size_t most = scene->mesh ? scene->mesh->triangle_count : 0;
    for (uint32_t i = 0; i < scene->item_count; ++i) most += scene->items[i].strands->vertex_count;
    *reference = (ShadowReference){.view = light_frame_view(light, middle)};
    reference->shapes = malloc((most + 1) * sizeof *reference->shapes);
    if (!reference->shapes)
        return error_set(error, RESULT_FAILED, "no memory for %zu shapes", most);
    for (uint32_t i = 0; i < scene->item_count; ++i)
        for (uint32_t s = 0; s < scene->items[i].strands->strand_count; ++s)
            add_strand(reference, &scene->items[i], s);
    for (uint32_t t = 0; scene->mesh && t < scene->mesh->triangle_count; ++t)
        add_triangle(reference, scene->mesh, t);
    Result result = make_grid(reference, error);
    if (result != RESULT_OK) shadow_reference_destroy(reference);
    return result;
}

void shadow_reference_destroy(ShadowReference *reference)
{
    free(reference->shapes);
    free(reference->cell_first);
    free(reference->cell_shapes);
    *reference = (ShadowReference){0};
}

// Outlines may turn either way. Of an edge that two shapes share, only one has the points on it.
static bool is_inside(const ShadowShape *shape, double u, double v)
{
    bool inside = false;
    for (int i = 0; i < shape->corners; ++i) {
        const double *a = shape->corner[i], *b = shape->corner[(i + 1) % shape->corners];
        if (a[1] > b[1]) { // the same sum for both shapes at an edge
            const double *other = a;
            a = b, b = other;
        }
        if (v < a[1] || v >= b[1]) continue;
        if (u < a[0] + (b[0] - a[0]) * ((v - a[1]) / (b[1] - a[1]))) inside = !inside;
    }
    return inside;
}

double shadow_reference_light(const ShadowReference *reference, const double point[3],
                              double clearance)
{
    double place[3], light = 1;
    if (!light_frame_place(&reference->view, point, place)) return 1;
    for (int k = 0; k < 2; ++k) {
        double cell = (place[k] - reference->low[k]) / reference->step[k];
        if (!(cell >= 0 && cell <= reference->side)) return 1;
    }
    double limit = place[2] - clearance;
    if (reference->view.perspective) limit = limit > 0 ? -1 / limit : -INFINITY;
    uint32_t cell =
        column_of(reference, 1, place[1]) * reference->side + column_of(reference, 0, place[0]);
    for (uint32_t i = reference->cell_first[cell]; i < reference->cell_first[cell + 1]; ++i) {
        const ShadowShape *shape = &reference->shapes[reference->cell_shapes[i]];
        double depth = shape->depth + shape->du * place[0] + shape->dv * place[1];
        depth = fmin(fmax(depth, shape->nearest), shape->farthest);
        if (depth < limit && is_inside(shape, place[0], place[1])) light *= 1 - shape->opacity;
    }
    return light;
}

// The vertices whose light is sought, dealt out to the threads by strands.
typedef struct Filling {
    const ShadowReference *reference;
    const ReferenceItem *item;
    float *left;
    int parts;
} Filling;

// Unit, square to the fibre from `a` to `b` and to the light's way there.
static void find_across(const ShadowReference *reference, const float a[3], const float b[3],
                        double across[3])
{
    double way[3], along[3], length = 0;
    for (int k = 0; k < 3; ++k) {
        way[k] = reference->view.perspective ? (double)a[k] - reference->view.origin[k]
                                             : reference->view.axis[2][k];
        along[k] = (double)b[k] - a[k];
    }
    for (int k = 0; k < 3; ++k) {
        int m = (k + 1) % 3, n = (k + 2) % 3;
        across[k] = along[m] * way[n] - along[n] * way[m];
        length += across[k] * across[k];
    }
    for (int k = 0; k < 3; ++k) across[k] /= fmax(sqrt(length), 1e-30);
}

// Over the half of the segment from vertex `here` that lies before or behind it.
static double sum_half(const Filling *filling, const float here[3], const float other[3],
                       double radius)
{
    enum { ALONG = 2, ACROSS = SHADOW_REFERENCE_POINTS / 2 / ALONG };
    double across[3], point[3], sum = 0;
    find_across(filling->reference, here, other, across);
    for (int i = 0; i < ALONG * ACROSS; ++i) {
        double share = 0.5 * (i % ALONG + 0.5) / ALONG,
               aside = radius * (2 * (i / ALONG + 0.5) / ACROSS - 1);
        for (int k = 0; k < 3; ++k)
            point[k] = here[k] + share * ((double)other[k] - here[k]) + aside * across[k];
        sum += shadow_reference_light(filling->reference, point, radius);
    }
    return sum;
}

static void fill_part(void *data, int part)
{
    const Filling *filling = data;
    const ReferenceItem *item = filling->item;
    const Strands *strands = item->strands;
    for (uint32_t s = (uint32_t)part; s < strands->strand_count; s += (uint32_t)filling->parts)
        for (uint32_t v = strands->first[s]; v < strands->first[s + 1]; ++v) {
            const float *here = strands->position[v];
            const float *before = strands->position[v > strands->first[s] ? v - 1 : v + 1],
                        *after = strands->position[v + 1 < strands->first[s + 1] ? v + 1 : v - 1];
            double thinning =
                (1 - (double)item->material->tip_ratio) / (strands_size(strands, s) - 1);
            double radius = item->radius * (1 - thinning * (v - strands->first[s]));
            filling->left[v] = (float)((sum_half(filling, here, before, radius) +
                                        sum_half(filling, here, after, radius)) /
                                       SHADOW_REFERENCE_POINTS);
        }
}

void shadow_reference_fill(const ShadowReference *reference, const ReferenceItem *item, float *left)
{
    Filling filling = {reference, item, left, parallel_threads()};
    parallel_run(filling.parts, fill_part, &filling);
}
