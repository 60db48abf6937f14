// SPDX-License-Identifier: MIT
#include "formats/basis_curves.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const uint32_t CURVES_WIDTHS[CURVES_ARRAYS] = {1, 1, 3, 1, 2, 2, 1, 1, 1};

void basis_curves_destroy(BasisCurves *curves)
{
    for (int i = 0; i < CURVES_ARRAYS; ++i) {
        free(curves->array[i].value);
        free(curves->indices[i].value);
    }
    usd_samples_destroy(&curves->points);
    *curves = (BasisCurves){0};
}

static void copy_values(UsdValues *copy, const UsdValues *values, Reader *reader)
{
    *copy = *values;
    copy->value = NULL;
    copy->room = values->count;
    if (!values->value) return;
    copy->value = reader_malloc(reader, values->count, sizeof *copy->value);
    if (copy->value)
        memcpy(copy->value, values->value, values->count * sizeof *copy->value);
    else
        copy->count = copy->room = 0;
}

void basis_curves_copy(BasisCurves *copy, const BasisCurves *curves, Reader *reader)
{
    *copy = *curves;
    for (int i = 0; i < CURVES_ARRAYS; ++i) {
        copy_values(&copy->array[i], &curves->array[i], reader);
        copy_values(&copy->indices[i], &curves->indices[i], reader);
    }
    size_t count = curves->points.count;
    copy->points.count = 0;
    copy->points.sample = reader_calloc(reader, count + 1, sizeof *copy->points.sample);
    for (size_t i = 0; copy->points.sample && i < count; ++i)
        copy_values(&copy->points.sample[copy->points.count++], &curves->points.sample[i], reader);
}

// --- The strand's vertices as combinations of the curve's control points.

typedef enum Basis { BASIS_LINEAR, BASIS_BEZIER, BASIS_BSPLINE, BASIS_CATMULL_ROM } Basis;

static bool is_pinned(const BasisCurves *curves)
{
    return strcmp(curves->wrap, "pinned") == 0;
}

static Basis basis_of(const BasisCurves *curves)
{
    if (strcmp(curves->type, "linear") == 0) return BASIS_LINEAR;
    if (strcmp(curves->basis, "bspline") == 0) return BASIS_BSPLINE;
    return strcmp(curves->basis, "catmullRom") == 0 ? BASIS_CATMULL_ROM : BASIS_BEZIER;
}

// Segments of a cubic curve with `count` control points; 0 if no curve can have that many.
static uint32_t count_cubic(const BasisCurves *curves, Basis basis, uint32_t count)
{
    if (basis == BASIS_BEZIER) return count >= 4 && count % 3 == 1 ? (count - 1) / 3 : 0;
    if (is_pinned(curves)) return count >= 2 ? count - 1 : 0;
    return count >= 4 ? count - 3 : 0;
}

// The basis of a curve with `count` control points: too few of them are a polygon.
static Basis basis_for(const BasisCurves *curves, uint32_t count)
{
    Basis basis = basis_of(curves);
    bool whole = basis == BASIS_LINEAR || count_cubic(curves, basis, count);
    return whole ? basis : BASIS_LINEAR;
}

static uint32_t count_segments(const BasisCurves *curves, uint32_t count)
{
    Basis basis = basis_for(curves, count);
    if (basis != BASIS_LINEAR) return count_cubic(curves, basis, count);
    return count ? count - 1 : 0;
}

// The number of vertices of the strand.
static uint32_t count_vertices(const BasisCurves *curves, uint32_t count, uint32_t per_strand)
{
    Basis basis = basis_for(curves, count);
    if (basis == BASIS_LINEAR) return count;
    if (per_strand) return per_strand;
    uint32_t each = curves->per_segment ? curves->per_segment : basis == BASIS_BEZIER ? 4 : 2;
    return count_segments(curves, count) * each + 1;
}

// A vertex as a weighted sum of 4 control points (indices within the curve), and its place along
// the curve in segments.
typedef struct Blend {
    uint32_t from[4];
    double weight[4], along;
} Blend;

// Weights of the points a, b, c, d of a segment at t in 0 .. 1.
static void find_weights(Basis basis, double t, double w[4])
{
    double u = 1 - t;
    if (basis == BASIS_BEZIER) {
        w[0] = u * u * u, w[1] = 3 * u * u * t, w[2] = 3 * u * t * t, w[3] = t * t * t;
    } else if (basis == BASIS_BSPLINE) {
        w[0] = u * u * u / 6, w[1] = (3 * t * t * t - 6 * t * t + 4) / 6;
        w[2] = (3 * u * u * u - 6 * u * u + 4) / 6, w[3] = t * t * t / 6;
    } else {
        w[0] = -t * u * u / 2, w[1] = (3 * t * t * t - 5 * t * t + 2) / 2;
        w[2] = (3 * u * u * u - 5 * u * u + 2) / 2, w[3] = -u * t * t / 2;
    }
}

// Vertex j of n on a curve of `count` points. A pinned curve has a phantom point 2 p0 - p1 before
// its first point, and likewise one after the last; the weights of phantom points are distributed
// to the two points that define them.
static Blend blend_at(const BasisCurves *curves, uint32_t count, uint32_t j, uint32_t n)
{
    Blend blend = {{0}, {0}, 0};
    Basis basis = basis_for(curves, count);
    if (basis == BASIS_LINEAR) {
        blend = (Blend){{j, j, j, j}, {1, 0, 0, 0}, j};
        return blend;
    }
    uint32_t segments = count_segments(curves, count);
    blend.along = n > 1 ? (double)segments * j / (n - 1) : 0;
    uint32_t segment = (uint32_t)blend.along < segments ? (uint32_t)blend.along : segments - 1;
    find_weights(basis, blend.along - segment, blend.weight);
    bool pinned = basis != BASIS_BEZIER && is_pinned(curves);
    int64_t first = basis == BASIS_BEZIER ? 3 * (int64_t)segment : (int64_t)segment - pinned;
    for (int k = 0; k < 4; ++k) {
        int64_t i = first + k;
        blend.from[k] = (uint32_t)(i < 0 ? 0 : i >= count ? count - 1 : i);
    }
    double *w = blend.weight;
    if (first < 0) w[1] += 2 * w[0], w[2] -= w[0], w[0] = 0;
    if (first + 3 >= count) w[2] += 2 * w[3], w[1] -= w[3], w[3] = 0;
    return blend;
}

// --- Attributes.

// Errors in a text file name the line of the wrong value. In a binary file, the reader already
// stands at the curves.
static void stand_at(Reader *reader, uint32_t line)
{
    if (reader->line) reader->line = line;
}

static void fail_count(Reader *reader, const BasisCurves *curves, int array)
{
    stand_at(reader, curves->array[array].line);
    reader_fail(reader, "%s: %zu numbers, which do not fit the number of curves or points",
                curves->names[array], curves->array[array].count);
}

typedef enum Rate { RATE_CONSTANT, RATE_UNIFORM, RATE_VARYING, RATE_VERTEX, RATES } Rate;

typedef struct Counts {
    uint64_t of[RATES]; // number of values that an array of this rate has
} Counts;

static Counts count_rates(const BasisCurves *curves)
{
    const UsdValues *counts = &curves->array[CURVES_COUNTS];
    Counts rates = {{1, counts->count, 0, 0}};
    for (size_t s = 0; s < counts->count; ++s) {
        uint32_t count = (uint32_t)counts->value[s];
        rates.of[RATE_VERTEX] += count;
        rates.of[RATE_VARYING] += count_segments(curves, count) + 1;
    }
    return rates;
}

// The rate that the file declares, if it fits the number of values; otherwise the first rate that
// fits.
static Rate find_rate(const BasisCurves *curves, int array, const Counts *counts)
{
    static const char *const names[RATES] = {"constant", "uniform", "varying", "vertex"};
    static const Rate guesses[] = {RATE_VERTEX, RATE_UNIFORM, RATE_VARYING, RATE_CONSTANT};
    size_t count = curves->array[array].count / CURVES_WIDTHS[array];
    if (curves->array[array].count % CURVES_WIDTHS[array]) return RATES;
    for (int rate = 0; rate < RATES; ++rate)
        if (strcmp(curves->rate[array], names[rate]) == 0 && counts->of[rate] == count)
            return (Rate)rate;
    for (int i = 0; i < 4; ++i)
        if (counts->of[guesses[i]] == count) return guesses[i];
    return RATES;
}

// The value of an array at a vertex. `start`: indices of the curve's first values, by rate.
static void value_at(const BasisCurves *curves, int array, Rate rate, uint32_t s,
                     const Blend *blend, const uint64_t start[RATES], float *to)
{
    const float *values = curves->array[array].value;
    uint32_t width = CURVES_WIDTHS[array];
    if (rate == RATE_CONSTANT || rate == RATE_UNIFORM) {
        memcpy(to, values + (rate == RATE_UNIFORM ? s : 0) * (size_t)width, width * sizeof *to);
        return;
    }
    uint64_t low = start[RATE_VARYING] + (uint64_t)blend->along;
    double share = blend->along - floor(blend->along);
    for (uint32_t k = 0; k < width; ++k) {
        double sum = 0;
        for (int i = 0; i < 4 && rate == RATE_VERTEX; ++i)
            if (blend->weight[i] != 0)
                sum += blend->weight[i] *
                       (double)values[(start[RATE_VERTEX] + blend->from[i]) * width + k];
        if (rate == RATE_VARYING) sum = (double)values[low * width + k];
        if (rate == RATE_VARYING && share > 0)
            sum += share * ((double)values[(low + 1) * width + k] - sum);
        to[k] = (float)sum;
    }
}

// How often the file has values of an array. RATES if it has none, after an error, or if they do
// not fit, which is noted.
static Rate rate_of(const Reader *reader, BasisCurves *curves, int array)
{
    const UsdValues *values = &curves->array[array];
    if (!values->line || values->count == 0 || !reader_ok(reader)) return RATES;
    Counts counts = count_rates(curves);
    Rate rate = find_rate(curves, array, &counts);
    if (rate == RATES) curves->unfit |= 1u << array;
    return rate;
}

// Values for each vertex. NULL if the file has none, if they do not fit, or after an error.
static float *spread(Reader *reader, BasisCurves *curves, int array, const Strands *strands)
{
    uint32_t width = CURVES_WIDTHS[array];
    Rate rate = rate_of(reader, curves, array);
    if (rate == RATES) return NULL;
    float *to = reader_malloc(reader, (size_t)strands->vertex_count * width, sizeof *to);
    uint64_t start[RATES] = {0};
    for (uint32_t s = 0; to && s < strands->strand_count; ++s) {
        uint32_t count = (uint32_t)curves->array[CURVES_COUNTS].value[s];
        uint32_t first = strands->first[s], n = strands_size(strands, s);
        for (uint32_t j = 0; j < n; ++j) {
            Blend blend = blend_at(curves, count, j, n);
            value_at(curves, array, rate, s, &blend, start, to + (size_t)(first + j) * width);
        }
        start[RATE_VERTEX] += count;
        start[RATE_VARYING] += count_segments(curves, count) + 1;
    }
    return to;
}

// Values for each strand: of curves, or of their roots. NULL as above.
static float *spread_strands(Reader *reader, BasisCurves *curves, int array, const Strands *strands)
{
    const UsdValues *values = &curves->array[array];
    uint32_t width = CURVES_WIDTHS[array];
    Rate rate = rate_of(reader, curves, array);
    if (rate == RATES) return NULL;
    float *to = reader_malloc(reader, (size_t)strands->strand_count * width, sizeof *to);
    size_t at = 0;
    for (uint32_t s = 0; to && s < strands->strand_count; ++s) {
        uint32_t count = (uint32_t)curves->array[CURVES_COUNTS].value[s];
        size_t last = values->count / width - 1; // a curve without points has no root
        memcpy(to + (size_t)s * width, values->value + (at < last ? at : last) * width,
               width * sizeof *to);
        at += rate == RATE_UNIFORM   ? 1
              : rate == RATE_VARYING ? count_segments(curves, count) + 1
              : rate == RATE_VERTEX  ? count
                                     : 0;
    }
    return to;
}

static void set_colors(Reader *reader, BasisCurves *curves, Strands *strands)
{
    float *color = spread(reader, curves, CURVES_COLOR, strands);
    float *opacity = spread(reader, curves, CURVES_OPACITY, strands);
    bool any = color || opacity;
    if (any)
        strands->color =
            reader_malloc(reader, ((size_t)strands->vertex_count + 1), sizeof *strands->color);
    if (any && !strands->color) reader_fail_memory(reader);
    for (uint32_t v = 0; strands->color && v < strands->vertex_count; ++v) {
        for (int k = 0; k < 3; ++k) strands->color[v][k] = color ? color[3 * v + k] : 1;
        strands->color[v][3] = opacity ? opacity[v] : 1;
    }
    free(color);
    free(opacity);
}

// Sets the texture coordinates: of vertices if the file has them, otherwise of strands.
static void set_texture(Reader *reader, BasisCurves *curves, Strands *strands)
{
    Counts counts = count_rates(curves);
    Rate rate = find_rate(curves, CURVES_ST, &counts);
    bool vertices = rate == RATE_VERTEX || rate == RATE_VARYING;
    float *st = (vertices ? spread : spread_strands)(reader, curves, CURVES_ST, strands);
    memcpy(vertices ? (void *)&strands->vertex_uv : (void *)&strands->strand_uv, &st, sizeof st);
    if (vertices) return;
    float *st1 = spread(reader, curves, CURVES_ST1, strands);
    memcpy(&strands->vertex_uv, &st1, sizeof st1);
}

static void set_attributes(Reader *reader, BasisCurves *curves, Strands *strands)
{
    strands->vertex_thickness = spread(reader, curves, CURVES_DIAMETERS, strands);
    set_colors(reader, curves, strands);
    set_texture(reader, curves, strands);
    strands->strand_thickness = spread_strands(reader, curves, CURVES_THICKNESS, strands);
    strands->mobility = spread(reader, curves, CURVES_MOBILITY, strands);
    strands->strand_group = spread_strands(reader, curves, CURVES_GROUP, strands);
    strands->followers = (uint32_t)(curves->followers > 0 ? fminf(curves->followers, 4e9f) : 0);
    strands->follower_radius = curves->follower_radius;
    strands->both_ends_fixed = curves->both_ends_fixed != 0;
    strands->fibre = curves->fibre;
}

// --- Indexed attributes.

static void expand(Reader *reader, BasisCurves *curves, int array)
{
    UsdValues *values = &curves->array[array];
    const UsdValues *indices = &curves->indices[array];
    uint32_t width = CURVES_WIDTHS[array];
    size_t count = values->count / width;
    if (!indices->line || !reader_ok(reader)) return;
    float *all = reader_malloc(reader, indices->count * width, sizeof *all);
    for (size_t i = 0; all && i < indices->count; ++i) {
        float index = indices->value[i];
        if (!(index >= 0 && index < (float)count && index == floorf(index))) {
            curves->unfit |= 1u << array;
            values->line = 0;
            free(all);
            return;
        }
        memcpy(all + i * width, values->value + (size_t)index * width, width * sizeof *all);
    }
    if (!all) return;
    free(values->value);
    *values = (UsdValues){.value = all,
                          .count = indices->count * width,
                          .room = indices->count * width,
                          .line = values->line ? values->line : indices->line};
}

// --- Strands.

bool basis_curves_is_closed(const BasisCurves *curves)
{
    return strcmp(curves->wrap, "periodic") == 0;
}

bool basis_curves_is_known(const BasisCurves *curves)
{
    static const char *const bases[] = {"", "bezier", "bspline", "catmullRom"};
    if (strcmp(curves->type, "linear") == 0) return true;
    if (*curves->type && strcmp(curves->type, "cubic") != 0) return false;
    for (int i = 0; i < 4; ++i)
        if (strcmp(curves->basis, bases[i]) == 0) return true;
    return false;
}

// If the number of points changes over time, only the first sample is kept.
static void keep_first_sample(BasisCurves *curves)
{
    UsdSamples *points = &curves->points;
    for (size_t i = 1; i < points->count && !curves->changes; ++i)
        curves->changes = points->sample[i].count != points->sample[0].count;
    if (!curves->changes) return;
    for (size_t i = 1; i < points->count; ++i) free(points->sample[i].value);
    points->count = points->in_file = 1;
}

// Checks the number of points of each curve and returns how many vertices the curves make.
static uint64_t check_sizes(Reader *reader, BasisCurves *curves, uint32_t per_strand)
{
    const UsdValues *counts = &curves->array[CURVES_COUNTS];
    uint64_t points = curves->points.sample[0].count / 3, used = 0, vertices = 0;
    stand_at(reader, curves->points.sample[0].line);
    if (curves->points.sample[0].count % 3)
        reader_fail(
            reader,
            "points: %zu numbers, which do not fit the curves: expected three for each point",
            curves->points.sample[0].count);
    for (size_t s = 0; s < counts->count && reader_ok(reader); ++s) {
        float size = counts->value[s];
        if (!(size >= 0 && size <= (float)points && size == floorf(size))) {
            fail_count(reader, curves, CURVES_COUNTS);
            break;
        }
        uint32_t count = (uint32_t)size;
        curves->polygons += basis_of(curves) != basis_for(curves, count);
        used += count;
        vertices += count_vertices(curves, count, per_strand);
    }
    stand_at(reader, curves->points.sample[0].line);
    if (reader_ok(reader) && curves->points.sample[0].count != 3 * used)
        reader_fail(
            reader,
            "points: %zu numbers, which do not fit the curves: expected three for each point",
            curves->points.sample[0].count);
    if (reader_ok(reader) && vertices >= UINT32_MAX)
        reader_fail(reader, "too many points: expected fewer than 2^32 - 1");
    return vertices;
}

void basis_curves_make(BasisCurves *curves, Reader *reader, uint32_t per_strand, Strands *strands)
{
    const UsdValues *counts = &curves->array[CURVES_COUNTS];
    uint32_t line = reader->line;
    *strands = (Strands){0};
    if (!reader_ok(reader)) return;
    keep_first_sample(curves);
    uint64_t vertices = check_sizes(reader, curves, per_strand);
    for (int i = CURVES_DIAMETERS; i < CURVES_ARRAYS; ++i) expand(reader, curves, i);
    reader_charge(reader, vertices, sizeof *strands->position);
    reader_charge(reader, counts->count, sizeof *strands->first);
    if (!reader_ok(reader)) return;
    if (strands_create(strands, (uint32_t)counts->count, (uint32_t)vertices, NULL) != RESULT_OK) {
        reader_fail_memory(reader);
        return;
    }
    for (uint32_t s = 0; s < strands->strand_count; ++s)
        strands->first[s + 1] =
            strands->first[s] + count_vertices(curves, (uint32_t)counts->value[s], per_strand);
    set_attributes(reader, curves, strands);
    if (reader_ok(reader)) stand_at(reader, line);
}

// --- Points.

static bool is_identity(double m[4][4])
{
    for (int i = 0; i < 16; ++i)
        if (m[i / 4][i % 4] != (i / 4 == i % 4)) return false;
    return true;
}

void basis_curves_place(const BasisCurves *curves, const Strands *strands, double time,
                        double matrix[4][4], float (*to)[3])
{
    const float *a, *b;
    double share = usd_samples_find(&curves->points, time, &a, &b);
    bool still = is_identity(matrix);
    size_t start = 0;
    for (uint32_t s = 0; s < strands->strand_count; ++s) {
        uint32_t count = (uint32_t)curves->array[CURVES_COUNTS].value[s],
                 n = strands_size(strands, s);
        bool linear = basis_for(curves, count) == BASIS_LINEAR;
        for (uint32_t j = 0; j < n; ++j) {
            Blend blend = blend_at(curves, count, j, n);
            double p[3] = {0, 0, 0};
            for (int i = 0; i < (linear ? 1 : 4); ++i)
                for (int k = 0; k < 3 && blend.weight[i] != 0; ++k) {
                    size_t at = 3 * (start + blend.from[i]) + (size_t)k;
                    double value = (double)a[at];
                    if (share > 0) value += share * ((double)b[at] - value);
                    // A sum with a weight of 1 would turn -0 into 0.
                    p[k] = linear ? value : p[k] + blend.weight[i] * value;
                }
            float *out = to[strands->first[s] + j];
            for (int k = 0; k < 3; ++k)
                out[k] = (float)(still ? p[k]
                                       : p[0] * matrix[0][k] + p[1] * matrix[1][k] +
                                             p[2] * matrix[2][k] + matrix[3][k]);
        }
        start += count;
    }
}

void basis_curves_scale(Strands *strands, double m[4][4])
{
    double volume = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                    m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                    m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    double scale = cbrt(fabs(volume));
    if (fabs(scale - 1) < 1e-9) return;
    strands->follower_radius = (float)(strands->follower_radius * scale);
    strands->fibre.radius *= scale;
    for (uint32_t v = 0; strands->vertex_thickness && v < strands->vertex_count; ++v)
        strands->vertex_thickness[v] = (float)(strands->vertex_thickness[v] * scale);
}
