// SPDX-License-Identifier: MIT
#include "reference/shadow_reference.h"
#include "base/parallel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE_MAX = 1024 };

static void find_span(const Shape *shape, int axis, double *low, double *high)
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
    for (uint32_t i = 0; i < reference->shapes.count; ++i)
        for (int k = 0; k < 2; ++k) {
            double a, b;
            find_span(&reference->shapes.shapes[i], k, &a, &b);
            reference->low[k] = i ? fmin(reference->low[k], a) : a;
            high[k] = i ? fmax(high[k], b) : b;
        }
    reference->side = (uint32_t)fmin(fmax(sqrt(reference->shapes.count), 1), SIDE_MAX);
    for (int k = 0; k < 2; ++k)
        reference->step[k] = fmax(high[k] - reference->low[k], 1e-30) / reference->side;
}

static uint32_t column_of(const ShadowReference *reference, int axis, double value)
{
    double column = floor((value - reference->low[axis]) / reference->step[axis]);
    return (uint32_t)fmin(fmax(column, 0), reference->side - 1);
}

// Adds each shape to the cells that it covers. next[cell] is advanced for each shape; if `shapes`
// is not NULL, the shape's number is stored there.
static void fill_cells(const ShadowReference *reference, uint32_t *next, uint32_t *shapes)
{
    for (uint32_t i = 0; i < reference->shapes.count; ++i) {
        uint32_t from[2], to[2];
        for (int k = 0; k < 2; ++k) {
            double low, high;
            find_span(&reference->shapes.shapes[i], k, &low, &high);
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
    // Advances first[cell + 1] to the end of the cell.
    fill_cells(reference, first + 1, reference->cell_shapes);
    return RESULT_OK;
}

Result shadow_reference_create(ShadowReference *reference, const ReferenceScene *scene,
                               const Light *light, const float middle[3], Error *error)
{
    *reference = (ShadowReference){.view = light_frame_view(light, middle)};
    TRY(image_reference_shapes(&reference->shapes, scene, &reference->view, error));
    Result result = make_grid(reference, error);
    if (result != RESULT_OK) shadow_reference_destroy(reference);
    return result;
}

void shadow_reference_destroy(ShadowReference *reference)
{
    image_reference_destroy_shapes(&reference->shapes);
    free(reference->cell_first);
    free(reference->cell_shapes);
    *reference = (ShadowReference){0};
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
    double limit = clearance - place[2]; // as inverse_w, which is larger for nearer shapes
    if (reference->view.perspective) limit = limit < 0 ? -1 / limit : INFINITY;
    uint32_t cell =
        column_of(reference, 1, place[1]) * reference->side + column_of(reference, 0, place[0]);
    for (uint32_t i = reference->cell_first[cell]; i < reference->cell_first[cell + 1]; ++i) {
        const Shape *shape = &reference->shapes.shapes[reference->cell_shapes[i]];
        double crossing[4];
        int count = image_reference_cross(shape, place[1], crossing), beyond = 0;
        for (int c = 0; c < count; ++c) beyond += place[0] < crossing[c];
        if (beyond % 2 && image_reference_plane(&shape->inverse_w, place[0], place[1]) > limit)
            light *= 1 - shape->opacity;
    }
    return light;
}

// The vertices to be lit. Threads take strands in turn.
typedef struct Filling {
    const ShadowReference *reference;
    const ReferenceItem *item;
    float *left;
    int parts;
} Filling;

// The unit vector that is perpendicular to the fibre from `a` to `b` and to the direction of the
// light.
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

// The sum of the light at points on the half of a segment that is nearer to its vertex `here`.
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
