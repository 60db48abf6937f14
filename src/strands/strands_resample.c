// SPDX-License-Identifier: MIT
#include "strands/strands_resample.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CHORDS = 16 };

// --- The curve through the vertices of one strand.

typedef struct Curve {
    const float (*position)[3];
    uint32_t size;
    bool spline;
} Curve;

// Vertex i. Indices -1 and `size` give a mirrored vertex beyond the end.
static void take_vertex(const Curve *curve, int64_t i, double p[3])
{
    int64_t last = (int64_t)curve->size - 1;
    int64_t near = i < 0 ? 0 : i > last ? last : i, far = i < 0 ? 1 : last - 1;
    for (int k = 0; k < 3; k++) {
        p[k] = (double)curve->position[near][k];
        if (i != near) p[k] = 2 * p[k] - (double)curve->position[far][k];
    }
}

static double distance(const double a[3], const double b[3])
{
    double x = b[0] - a[0], y = b[1] - a[1], z = b[2] - a[2];
    return sqrt(x * x + y * y + z * z);
}

// Catmull-Rom spline by Barry and Goldman's pyramid. The knots t_i are centripetal: their distances
// are the square roots of the distances of the vertices.
//   A_i = ((t_{i+1} - t) P_i + (t - t_i) P_{i+1}) / (t_{i+1} - t_i),       i = 0, 1, 2
//   B_i = ((t_{i+2} - t) A_i + (t - t_i) A_{i+1}) / (t_{i+2} - t_i),       i = 0, 1
//   C   = ((t_2 - t) B_0 + (t - t_1) B_1) / (t_2 - t_1)                    t_1 <= t <= t_2
static void evaluate_spline(const Curve *curve, uint32_t segment, double share, double point[3])
{
    double p[4][3], t[4] = {0};
    for (int i = 0; i < 4; i++) take_vertex(curve, (int64_t)segment + i - 1, p[i]);
    for (int i = 1; i < 4; i++) t[i] = t[i - 1] + sqrt(distance(p[i - 1], p[i]));
    double at = t[1] + share * (t[2] - t[1]);
    for (int level = 1; level <= 3; level++) {
        int span = level == 3 ? 1 : level, from = level == 3 ? 1 : 0;
        for (int i = 0; i < 4 - level; i++)
            for (int k = 0; k < 3; k++) {
                double left = t[from + i], right = t[from + i + span];
                p[i][k] = ((right - at) * p[i][k] + (at - left) * p[i + 1][k]) / (right - left);
            }
    }
    memcpy(point, p[0], sizeof p[0]);
}

static void evaluate(const Curve *curve, uint32_t segment, double share, double point[3])
{
    bool distinct = memcmp(curve->position[segment], curve->position[segment + 1],
                           sizeof *curve->position) != 0;
    if (curve->spline && distinct) {
        evaluate_spline(curve, segment, share, point);
        // Next to coincident vertices the spline is undefined; then interpolate linearly.
        if (isfinite(point[0]) && isfinite(point[1]) && isfinite(point[2])) return;
    }
    const float *a = curve->position[segment], *b = curve->position[segment + 1];
    for (int k = 0; k < 3; k++) point[k] = a[k] + share * ((double)b[k] - a[k]);
}

// --- Arc lengths: the length from the root to the end of each chord.

static uint32_t chords_a_segment(const Curve *curve)
{
    return curve->spline ? CHORDS : 1;
}

static void measure(const Curve *curve, double *lengths)
{
    uint32_t chords = chords_a_segment(curve);
    double before[3], point[3], length = 0;
    evaluate(curve, 0, 0, before);
    for (uint32_t i = 0; i < (curve->size - 1) * chords; i++) {
        evaluate(curve, i / chords, (i % chords + 1.0) / chords, point);
        lengths[i] = length += distance(before, point);
        memcpy(before, point, sizeof point);
    }
}

// Converts a length from the root to a place in segments: 2.25 is a quarter along the third
// segment. The search begins at `chord`, which is updated, so that successive calls are fast.
static double find_place(const Curve *curve, const double *lengths, double length, uint32_t *chord)
{
    uint32_t chords = chords_a_segment(curve), last = (curve->size - 1) * chords - 1;
    while (*chord < last && lengths[*chord] < length) ++*chord;
    double begin = *chord ? lengths[*chord - 1] : 0, span = lengths[*chord] - begin;
    double share = span > 0 ? fmin(fmax((length - begin) / span, 0), 1) : 0;
    return (*chord + share) / chords;
}

// --- Resampling one strand.

static void mix(float *to, const float *from, int width, double place)
{
    uint32_t i = (uint32_t)place;
    double share = place - i;
    for (int k = 0; k < width; k++) {
        double a = (double)from[(size_t)i * width + k];
        to[k] =
            (float)(share > 0 ? a + share * ((double)from[(size_t)(i + 1) * width + k] - a) : a);
    }
}

static void mix_vertex(Strands *to, uint32_t v, const Strands *from, uint32_t root, double place)
{
    if (from->mobility) to->mobility[v] = from->mobility[root + (uint32_t)ceil(place)];
    if (from->vertex_uv) mix(to->vertex_uv[v], from->vertex_uv[root], 2, place);
    if (from->vertex_thickness)
        mix(&to->vertex_thickness[v], &from->vertex_thickness[root], 1, place);
    if (from->color) mix(to->color[v], from->color[root], 4, place);
}

static void resample_strand(Strands *to, const Strands *from, uint32_t s, bool spline,
                            double *lengths)
{
    uint32_t root = from->first[s], first = to->first[s], count = strands_size(to, s), chord = 0;
    Curve curve = {(const float(*)[3])from->position + root, strands_size(from, s), spline};
    measure(&curve, lengths);
    double length = lengths[(curve.size - 1) * chords_a_segment(&curve) - 1];
    for (uint32_t j = 0; j < count; j++) {
        double place = find_place(&curve, lengths, length * j / (count - 1), &chord), point[3];
        if (j == 0 || j == count - 1) {
            place = j ? curve.size - 1 : 0;
            memcpy(to->position[first + j], curve.position[(uint32_t)place], sizeof(float[3]));
        } else {
            uint32_t segment = place < curve.size - 1 ? (uint32_t)place : curve.size - 2;
            evaluate(&curve, segment, place - segment, point);
            for (int k = 0; k < 3; k++) to->position[first + j][k] = (float)point[k];
        }
        mix_vertex(to, first + j, from, root, place);
    }
}

// --- Resampling all strands.

static double count_wanted(const Strands *strands, uint32_t s, const ResampleOptions *options)
{
    if (options->count) return options->count;
    // Half an ulp of a float32 length must not add a vertex.
    return fmax(2, ceil(strands_length(strands, s) / options->spacing * (1 - 1e-7)) + 1);
}

static Result make_room(Strands *to, const Strands *from, const ResampleOptions *options,
                        Error *error)
{
    double all = 0;
    for (uint32_t s = 0; s < from->strand_count; s++) {
        double count = count_wanted(from, s, options);
        if (count > STRANDS_MAX_SIZE)
            return error_set(error, RESULT_FAILED,
                             "strand %u would have %.0f vertices: expected at most %d", s, count,
                             STRANDS_MAX_SIZE);
        all += count;
    }
    if (all >= UINT32_MAX)
        return error_set(error, RESULT_FAILED, "%.0f vertices: expected fewer than 2^32 - 1", all);
    TRY(strands_create(to, from->strand_count, (uint32_t)all, error));
    for (uint32_t s = 0; s < from->strand_count; s++)
        to->first[s + 1] = to->first[s] + (uint32_t)count_wanted(from, s, options);
    bool good = true;
#define ALLOCATE(array, width, mended)                                                             \
    if (from->array)                                                                               \
        good = (to->array = malloc(((size_t)to->vertex_count + 1) * sizeof *to->array)) && good;
    STRANDS_ARRAYS_OF_VERTICES(ALLOCATE)
#undef ALLOCATE
    return good ? RESULT_OK : error_set(error, RESULT_FAILED, "no memory to resample strands");
}

// Moves the arrays that hold one value a strand.
static void move_the_rest(Strands *to, Strands *from)
{
#define MOVE(array, width, mended) to->array = from->array, from->array = NULL;
    STRANDS_ARRAYS_OF_STRANDS(MOVE)
#undef MOVE
    to->followers = from->followers;
    to->follower_radius = from->follower_radius;
    to->both_ends_fixed = from->both_ends_fixed;
    to->fibre = from->fibre;
    to->relative_widths = from->relative_widths;
    memcpy(to->origin, from->origin, sizeof to->origin);
}

Result strands_resample(Strands *strands, const ResampleOptions *options, Error *error)
{
    Strands to = {0};
    uint32_t longest = 0;
    for (uint32_t s = 0; s < strands->strand_count; s++)
        if (strands_size(strands, s) > longest) longest = strands_size(strands, s);
    double *lengths = malloc(((size_t)longest + 1) * CHORDS * sizeof *lengths);
    Result result = lengths ? make_room(&to, strands, options, error)
                            : error_set(error, RESULT_FAILED, "no memory to resample strands");
    for (uint32_t s = 0; s < strands->strand_count && result == RESULT_OK; s++)
        resample_strand(&to, strands, s, options->spline, lengths);
    free(lengths);
    if (result != RESULT_OK) {
        strands_destroy(&to);
        return result;
    }
    move_the_rest(&to, strands);
    strands_destroy(strands);
    *strands = to;
    return RESULT_OK;
}
