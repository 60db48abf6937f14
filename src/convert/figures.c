// SPDX-License-Identifier: MIT
#include "convert/figures.h"

#include "base/double3.h"
#include "base/doubles.h"
#include "base/nearest.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *name, *unit, *title;
} KINDS[FIGURE_KINDS] = {
    {"vertices", "", "vertices"},
    {"length", "m", "length, m"},
    {"reach", "", "reach"},
    {"segment", "m", "segment, m"},
    {"turn", "deg", "turn, deg"},
    {"curvature", "1/m", "curvature, 1/m"},
    {"gamma", "", "Gamma"},
    {"curvature_l_gb", "", "curvature * L_gb"},
    {"root_spacing", "m", "root_spacing, m"},
    {"depth_inside", "mm", "depth_inside, mm"},
};

// --- Quantities.

static void subtract(const float a[3], const float b[3], Double3 d)
{
    for (int k = 0; k < 3; k++) d[k] = (double)b[k] - (double)a[k];
}

// The angle between two directions in radians. The arctangent is accurate for small angles, where
// the arc cosine is not.
static double angle(const Double3 a, const Double3 b)
{
    Double3 c;
    double3_cross(a, b, c);
    return atan2(double3_length(c), double3_dot(a, b));
}

static bool is_of_strands(FigureKind kind)
{
    return kind <= FIGURE_REACH || kind == FIGURE_GAMMA;
}

// `l_gb`: the gravito-bending length.
static size_t collect_strands(const Strands *strands, FigureKind kind, double l_gb, double *values)
{
    for (uint32_t s = 0; s < strands->strand_count; s++) {
        Double3 reach;
        double length = strands_length(strands, s);
        subtract(strands->position[strands->first[s]], strands->position[strands->first[s + 1] - 1],
                 reach);
        values[s] = kind == FIGURE_SIZE     ? strands_size(strands, s)
                    : kind == FIGURE_LENGTH ? length
                    : kind == FIGURE_GAMMA  ? pow(length / l_gb, 3)
                                            : double3_length(reach) / length;
    }
    return strands->strand_count;
}

static size_t collect_vertices(const Strands *strands, FigureKind kind, double l_gb, double *values)
{
    static const double deg = 57.29577951308232;
    size_t count = 0;
    for (uint32_t s = 0; s < strands->strand_count; s++)
        for (uint32_t v = strands->first[s]; v + 1 < strands->first[s + 1]; v++) {
            Double3 before, after;
            subtract(strands->position[v], strands->position[v + 1], after);
            if (kind == FIGURE_SEGMENT) {
                values[count++] = double3_length(after);
            } else if (v > strands->first[s]) {
                subtract(strands->position[v - 1], strands->position[v], before);
                double turn = angle(before, after),
                       mean = (double3_length(before) + double3_length(after)) / 2;
                values[count++] = kind == FIGURE_TURN   ? deg * turn
                                  : kind == FIGURE_CURL ? turn / mean * l_gb
                                                        : turn / mean;
            }
        }
    return count;
}

static Result collect_roots(const Strands *strands, double *values, size_t *count, Error *error)
{
    float(*roots)[3] = malloc(strands->strand_count * sizeof *roots + 1);
    Nearest nearest = {0};
    *count = 0;
    if (!roots) return error_set(error, RESULT_FAILED, "no memory to measure roots");
    for (uint32_t s = 0; s < strands->strand_count; s++)
        memcpy(roots[s], strands->position[strands->first[s]], sizeof *roots);
    Result result =
        nearest_create(&nearest, (const float(*)[3])roots, strands->strand_count, error);
    for (uint32_t s = 0; s < strands->strand_count && result == RESULT_OK; s++) {
        Neighbour found = {0};
        if (nearest_find(&nearest, s, &found, 1) == 1) values[(*count)++] = sqrt(found.square);
    }
    nearest_destroy(&nearest);
    free(roots);
    return result;
}

// The depths of the vertices that are inside the mesh, in mm.
static Result collect_depths(Figures *figures, const Strands *strands, const Surface *surface,
                             double *values, size_t *count, Error *error)
{
    *count = 0;
    if (!surface) return RESULT_OK;
    figures->has_mesh = true;
    TRY(strands_find_depth(strands, surface, values, error));
    for (uint32_t s = 0; s < strands->strand_count; s++) {
        bool inside = false;
        for (uint32_t v = strands->first[s]; v < strands->first[s + 1]; v++)
            if (values[v] > 0) inside = true, values[(*count)++] = 1e3 * values[v];
        figures->strands_inside += inside;
    }
    return RESULT_OK;
}

// --- Distributions.

// Sorts `values`.
static Figure summarise(double *values, size_t count)
{
    if (count == 0) return (Figure){0};
    double sum = 0;
    doubles_sort(values, count);
    for (size_t i = 0; i < count; i++) sum += values[i];
    return (Figure){.count = count,
                    .min = values[0],
                    .low = values[(count - 1) / 20],
                    .median = values[(count - 1) / 2],
                    .high = values[(count - 1) * 19 / 20],
                    .max = values[count - 1],
                    .mean = sum / (double)count};
}

// Counts strands by their number of vertices. `sizes` is sorted.
static Result count_sizes(Figures *figures, const double *sizes, size_t count, Error *error)
{
    figures->sizes = malloc(count * sizeof *figures->sizes + 1);
    if (!figures->sizes) return error_set(error, RESULT_FAILED, "no memory to count vertices");
    for (size_t i = 0; i < count; i++) {
        SizeCount *last = figures->sizes + figures->size_count;
        if (i > 0 && sizes[i] == sizes[i - 1])
            last[-1].strands++;
        else
            *last = (SizeCount){(uint32_t)sizes[i], 1}, figures->size_count++;
    }
    return RESULT_OK;
}

static Result measure_kind(Figures *figures, const Strands *strands, const Surface *surface,
                           FigureKind kind, double *values, Error *error)
{
    size_t count = 0;
    double l_gb = figures->gravito_bending_length;
    Result result = RESULT_OK;
    if (is_of_strands(kind))
        count = collect_strands(strands, kind, l_gb, values);
    else if (kind == FIGURE_ROOTS)
        result = collect_roots(strands, values, &count, error);
    else if (kind == FIGURE_DEPTH)
        result = collect_depths(figures, strands, surface, values, &count, error);
    else
        count = collect_vertices(strands, kind, l_gb, values);
    figures->figures[kind] = summarise(values, count);
    if (kind == FIGURE_SIZE) result = count_sizes(figures, values, count, error);
    return result;
}

Result figures_measure(Figures *figures, const Strands *strands, const Surface *surface,
                       Error *error)
{
    *figures = (Figures){.strands = strands->strand_count, .vertices = strands->vertex_count};
    double gravity;
    TRY(fibre_default(&figures->fibre, &gravity, error));
    fibre_fill(&figures->fibre, &strands->fibre);
    figures->gravito_bending_length = fibre_gravito_bending_length(&figures->fibre, gravity);
    strands_bounds(strands, figures->low, figures->high);
    for (int axis = 0; axis < 3; ++axis) {
        figures->low[axis] = (float)(figures->low[axis] + strands->origin[axis]);
        figures->high[axis] = (float)(figures->high[axis] + strands->origin[axis]);
    }
    double *values = malloc(((size_t)strands->vertex_count + 1) * sizeof *values);
    Result result = values ? RESULT_OK
                           : error_set(error, RESULT_FAILED, "no memory to measure %u strands",
                                       strands->strand_count);
    for (int kind = 0; kind < FIGURE_KINDS && result == RESULT_OK; kind++)
        result = measure_kind(figures, strands, surface, (FigureKind)kind, values, error);
    const Figure *length = &figures->figures[FIGURE_LENGTH];
    figures->total_length = length->mean * (double)length->count;
    free(values);
    return result;
}

void figures_destroy(Figures *figures)
{
    free(figures->sizes);
    *figures = (Figures){0};
}

// --- Text and JSON.

// If strands have many different vertex counts, prints at most about MOST_ROWS ranges of equal
// width.
static void print_sizes(const Figures *figures, FILE *stream)
{
    enum { MOST_ROWS = 12, WIDEST = 40 };
    uint32_t low = figures->sizes[0].size, high = figures->sizes[figures->size_count - 1].size;
    uint32_t step = figures->size_count <= MOST_ROWS ? 1 : (high - low) / MOST_ROWS + 1;
    fprintf(stream, "\nvertices      strands\n");
    for (uint32_t i = 0; i < figures->size_count;) {
        uint32_t from =
            step == 1 ? figures->sizes[i].size : low + (figures->sizes[i].size - low) / step * step;
        uint32_t to = from + step - 1 < high ? from + step - 1 : high, strands = 0;
        for (; i < figures->size_count && figures->sizes[i].size <= to; ++i)
            strands += figures->sizes[i].strands;
        int bar = (int)((double)WIDEST * strands / figures->strands + 0.5);
        char range[32];
        snprintf(range, sizeof range, from == to ? "%u" : "%u-%u", from, to);
        fprintf(stream, "%-11s %9u %.*s\n", range, strands, bar,
                "########################################");
    }
}

void figures_print(const Figures *figures, FILE *stream)
{
    fprintf(stream, "%u strands, %u vertices, %.6g m of hair\n", figures->strands,
            figures->vertices, figures->total_length);
    for (int axis = 0; axis < 3; ++axis)
        fprintf(stream, "%c  %.6g .. %.6g m\n", "xyz"[axis], (double)figures -> low[axis],
                (double)figures -> high[axis]);
    fprintf(stream, "\n%-18s %11s %11s %11s %11s %11s %11s\n", "", "min", "5 %", "median", "95 %",
            "max", "mean");
    for (int kind = 0; kind < FIGURE_KINDS; ++kind) {
        const Figure *f = &figures->figures[kind];
        if (kind == FIGURE_DEPTH && !figures->has_mesh) continue;
        fprintf(stream, "%-18s %11.5g %11.5g %11.5g %11.5g %11.5g %11.5g\n", KINDS[kind].title,
                f->min, f->low, f->median, f->high, f->max, f->mean);
    }
    fprintf(stream, "\nL_gb %.4g m (%.4g GPa, radius %.4g um, %.4g kg/m3)\n",
            figures->gravito_bending_length, figures->fibre.youngs_modulus / 1e9,
            figures->fibre.radius * 1e6, figures->fibre.density);
    if (figures->has_mesh)
        fprintf(stream, "\ninside the mesh: %llu of %u vertices, of %u of %u strands\n",
                (unsigned long long)figures->figures[FIGURE_DEPTH].count, figures->vertices,
                figures->strands_inside, figures->strands);
    if (figures->size_count) print_sizes(figures, stream);
}

static json_t *vector_to_json(const float vector[3])
{
    return json_pack("[fff]", (double)vector[0], (double)vector[1], (double)vector[2]);
}

json_t *figures_to_json(const Figures *figures)
{
    json_t *object =
        json_pack("{si si sf sf so so}", "strands", figures->strands, "vertices", figures->vertices,
                  "total_length_m", figures->total_length, "gravito_bending_length_m",
                  figures->gravito_bending_length, "low_m", vector_to_json(figures->low), "high_m",
                  vector_to_json(figures->high));
    for (int kind = 0; kind < FIGURE_KINDS; ++kind) {
        const Figure *f = &figures->figures[kind];
        if (kind == FIGURE_DEPTH && !figures->has_mesh) continue;
        json_object_set_new(object, KINDS[kind].name,
                            json_pack("{ss sI sf sf sf sf sf sf}", "unit", KINDS[kind].unit,
                                      "count", (json_int_t)f->count, "min", f->min, "p5", f->low,
                                      "median", f->median, "p95", f->high, "max", f->max, "mean",
                                      f->mean));
    }
    if (figures->has_mesh)
        json_object_set_new(object, "strands_inside", json_integer(figures->strands_inside));
    json_t *sizes = json_array();
    for (uint32_t i = 0; i < figures->size_count; ++i)
        json_array_append_new(sizes, json_pack("{si si}", "vertices", figures->sizes[i].size,
                                               "strands", figures->sizes[i].strands));
    json_object_set_new(object, "sizes", sizes);
    return object;
}
