// SPDX-License-Identifier: MIT
#include "strands/strands_edit.h"

#include "base/random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- Order and smoothness.

static void swap(void *a, void *b, size_t size)
{
    char kept[sizeof(float[4])];
    memcpy(kept, a, size);
    memcpy(a, b, size);
    memcpy(b, kept, size);
}

void strands_reverse(Strands *strands)
{
    for (uint32_t s = 0; s < strands->strand_count; s++)
        for (uint32_t a = strands->first[s], b = strands->first[s + 1] - 1; a < b; a++, b--) {
            swap(strands->position[a], strands->position[b], sizeof *strands->position);
            if (strands->vertex_uv)
                swap(strands->vertex_uv[a], strands->vertex_uv[b], sizeof *strands->vertex_uv);
            if (strands->vertex_thickness)
                swap(&strands->vertex_thickness[a], &strands->vertex_thickness[b], sizeof(float));
            if (strands->color) swap(strands->color[a], strands->color[b], sizeof *strands->color);
        }
}

static void smooth_once(float (*position)[3], uint32_t size)
{
    float before[3];
    memcpy(before, position[0], sizeof before);
    for (uint32_t v = 1; v + 1 < size; v++)
        for (int i = 0; i < 3; i++) {
            float here = position[v][i];
            position[v][i] = (float)(0.25 * before[i] + 0.5 * here + 0.25 * position[v + 1][i]);
            before[i] = here;
        }
}

void strands_smooth(Strands *strands, uint32_t passes)
{
    for (uint32_t s = 0; s < strands->strand_count; s++)
        for (uint32_t pass = 0; pass < passes; pass++)
            smooth_once(strands->position + strands->first[s], strands_size(strands, s));
}

// --- Similarities.

StrandsMove strands_move_none(void)
{
    return (StrandsMove){.scale = 1, .rotation = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}

StrandsMove strands_move_rotation(int axis, double angle_deg)
{
    static const double turn = 6.283185307179586;
    StrandsMove move = strands_move_none();
    double quarters = angle_deg / 90, c = cos(angle_deg * turn / 360),
           s = sin(angle_deg * turn / 360);
    // Round at multiples of 90 degrees, so that these turns are exact.
    if (quarters == rint(quarters)) c = rint(c), s = rint(s);
    int a = (axis + 1) % 3, b = (axis + 2) % 3;
    move.rotation[a][a] = move.rotation[b][b] = c;
    move.rotation[a][b] = -s;
    move.rotation[b][a] = s;
    return move;
}

// Skips factors that are 0, because adding 0 would turn -0 into 0.
static double turned(const double row[3], const float p[3])
{
    double sum = -0.0;
    for (int i = 0; i < 3; i++)
        if (row[i] != 0) sum += row[i] * p[i];
    return sum;
}

static void scale_sizes(Strands *strands, double scale)
{
    for (uint32_t v = 0; strands->vertex_thickness && v < strands->vertex_count; v++)
        strands->vertex_thickness[v] = (float)(strands->vertex_thickness[v] * scale);
    strands->follower_radius = (float)(strands->follower_radius * scale);
}

void strands_move(Strands *strands, const StrandsMove *move)
{
    for (uint32_t v = 0; v < strands->vertex_count; v++) {
        float p[3];
        memcpy(p, strands->position[v], sizeof p);
        for (int i = 0; i < 3; i++) {
            double x = move->scale * turned(move->rotation[i], p);
            if (move->translation[i] != 0) x += move->translation[i];
            strands->position[v][i] = (float)x;
        }
    }
    const double o[3] = {strands->origin[0], strands->origin[1], strands->origin[2]};
    for (int i = 0; i < 3; i++)
        strands->origin[i] =
            move->scale * (move->rotation[i][0] * o[0] + move->rotation[i][1] * o[1] +
                           move->rotation[i][2] * o[2]);
    scale_sizes(strands, move->scale);
}

bool strands_are_far(const Strands *strands)
{
    return strands->origin[0] != 0 || strands->origin[1] != 0 || strands->origin[2] != 0;
}

void strands_find_origin(const Strands *strands, double metres, bool up_z, double origin[3])
{
    const double *o = strands->origin;
    origin[0] = o[0] / metres;
    origin[1] = (up_z ? -o[2] : o[1]) / metres;
    origin[2] = (up_z ? o[1] : o[2]) / metres;
}

void strands_give_back_origin(Strands *strands)
{
    for (uint32_t v = 0; strands_are_far(strands) && v < strands->vertex_count; v++)
        for (int i = 0; i < 3; i++)
            strands->position[v][i] = (float)(strands->position[v][i] + strands->origin[i]);
    memset(strands->origin, 0, sizeof strands->origin);
}

void strands_to_unit(Strands *strands, double metres, bool up_z)
{
    for (uint32_t v = 0; v < strands->vertex_count; v++) {
        const float *p = strands->position[v];
        double y = up_z ? -(double)p[2] : (double)p[1], z = up_z ? (double)p[1] : (double)p[2];
        float to[3] = {(float)(p[0] / metres), (float)(y / metres), (float)(z / metres)};
        memcpy(strands->position[v], to, sizeof to);
    }
    scale_sizes(strands, 1 / metres);
    strands->unit = metres;
    strands->up_z = up_z;
}

// --- Selecting and ordering strands.

// Allocates in `to`, whose counts are set, each optional array that all of the sets have.
static bool allocate_arrays(Strands *to, const Strands *sets, uint32_t count)
{
    bool good = true, all;
#define ALLOCATE(array, room)                                                                      \
    all = count > 0;                                                                               \
    for (uint32_t i = 0; i < count; ++i) all = all && sets[i].array;                               \
    if (all) good = (to->array = malloc(((size_t)(room) + 1) * sizeof *to->array)) && good;
#define OF_VERTICES(array, width, mended) ALLOCATE(array, to->vertex_count)
#define OF_STRANDS(array, width, mended)  ALLOCATE(array, to->strand_count)
    STRANDS_ARRAYS_OF_VERTICES(OF_VERTICES)
    STRANDS_ARRAYS_OF_STRANDS(OF_STRANDS)
#undef OF_VERTICES
#undef OF_STRANDS
#undef ALLOCATE
    return good;
}

// Copies strand s of `from` to strand t of `to`. first[t] must be set, and `from` must have every
// array that `to` has.
static void copy_strand(Strands *to, uint32_t t, const Strands *from, uint32_t s)
{
    uint32_t a = to->first[t], b = from->first[s], size = strands_size(from, s);
    to->first[t + 1] = a + size;
    memcpy(to->position + a, from->position + b, size * sizeof *to->position);
#define COPY(array, at, source, count)                                                             \
    if (to->array) memcpy(&to->array[at], &from->array[source], (count) * sizeof *to->array);
#define OF_VERTICES(array, width, mended) COPY(array, a, b, size)
#define OF_STRANDS(array, width, mended)  COPY(array, t, s, 1)
    STRANDS_ARRAYS_OF_VERTICES(OF_VERTICES)
    STRANDS_ARRAYS_OF_STRANDS(OF_STRANDS)
#undef OF_VERTICES
#undef OF_STRANDS
#undef COPY
}

Result strands_pick(Strands *strands, const uint32_t *which, uint32_t count, Error *error)
{
    Strands other;
    uint64_t vertices = 0;
    for (uint32_t i = 0; i < count; i++) vertices += strands_size(strands, which[i]);
    if (vertices >= UINT32_MAX)
        return error_set(error, RESULT_FAILED, "too many vertices: expected fewer than 2^32 - 1");
    TRY(strands_create(&other, count, (uint32_t)vertices, error));
    if (!allocate_arrays(&other, strands, 1)) {
        strands_destroy(&other);
        return error_set(error, RESULT_FAILED, "no memory to pick %u strands", count);
    }
    for (uint32_t i = 0; i < count; i++) copy_strand(&other, i, strands, which[i]);
    other.followers = strands->followers;
    other.follower_radius = strands->follower_radius;
    other.both_ends_fixed = strands->both_ends_fixed;
    other.fibre = strands->fibre;
    other.relative_widths = strands->relative_widths;
    memcpy(other.origin, strands->origin, sizeof other.origin);
    strands_destroy(strands);
    *strands = other;
    return RESULT_OK;
}

static int compare_numbers(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

Result strands_thin(Strands *strands, double share, uint32_t seed, Error *error)
{
    uint32_t *order = malloc(((size_t)strands->strand_count + 1) * sizeof *order);
    if (!order)
        return error_set(error, RESULT_FAILED, "no memory to pick %u strands",
                         strands->strand_count);
    uint32_t count = (uint32_t)(share * strands->strand_count + 0.5);
    if (count == 0 && strands->strand_count) count = 1;
    Random random = random_create(seed, 0x7468696e); // "thin"
    random_permutation(&random, order, strands->strand_count);
    qsort(order, count, sizeof *order, compare_numbers);
    Result result = strands_pick(strands, order, count, error);
    free(order);
    return result;
}

Result strands_shuffle(Strands *strands, uint32_t seed, Error *error)
{
    uint32_t *order = malloc(((size_t)strands->strand_count + 1) * sizeof *order);
    if (!order)
        return error_set(error, RESULT_FAILED, "no memory to reorder %u strands",
                         strands->strand_count);
    Random random = random_create(seed, 0x73687566666c65); // "shuffle"
    random_permutation(&random, order, strands->strand_count);
    Result result = strands_pick(strands, order, strands->strand_count, error);
    free(order);
    return result;
}

// --- Joining sets.

Result strands_join(Strands *all, const Strands *sets, uint32_t count, Error *error)
{
    uint64_t strands = 0, vertices = 0;
    bool same = count > 0, fixed = count > 0, one_fibre = count > 0;
    *all = (Strands){0};
    for (uint32_t i = 0; i < count; ++i) {
        strands += sets[i].strand_count;
        vertices += sets[i].vertex_count;
        same = same && sets[i].followers == sets[0].followers &&
               sets[i].follower_radius == sets[0].follower_radius;
        fixed = fixed && sets[i].both_ends_fixed;
        one_fibre = one_fibre && fibre_equals(&sets[i].fibre, &sets[0].fibre);
    }
    if (strands >= UINT32_MAX || vertices >= UINT32_MAX)
        return error_set(error, RESULT_FAILED,
                         "too many strands or vertices: expected fewer than 2^32 - 1");
    TRY(strands_create(all, (uint32_t)strands, (uint32_t)vertices, error));
    if (!allocate_arrays(all, sets, count)) {
        strands_destroy(all);
        return error_set(error, RESULT_FAILED, "no memory for %llu strands",
                         (unsigned long long)strands);
    }
    for (uint32_t i = 0, to = 0; i < count; ++i)
        for (uint32_t s = 0; s < sets[i].strand_count; ++s) copy_strand(all, to++, &sets[i], s);
    all->followers = same ? sets[0].followers : 0;
    all->follower_radius = same ? sets[0].follower_radius : 0.0f;
    all->both_ends_fixed = fixed;
    if (one_fibre) all->fibre = sets[0].fibre;
    if (count) memcpy(all->origin, sets[0].origin, sizeof all->origin);
    for (uint32_t i = 0; i < count; ++i)
        all->relative_widths = all->relative_widths || sets[i].relative_widths;
    return RESULT_OK;
}

// --- Groups.

Result strands_group_sets(Strands *all, const Strands *sets, uint32_t count, bool inner,
                          Error *error)
{
    double first = 0;
    free(all->strand_group);
    all->strand_group = malloc(((size_t)all->strand_count + 1) * sizeof *all->strand_group);
    if (!all->strand_group)
        return error_set(error, RESULT_FAILED, "no memory for groups of strands");
    for (uint32_t i = 0, s = 0; i < count; ++i) {
        double most = 0;
        for (uint32_t k = 0; k < sets[i].strand_count; ++k) {
            double own = inner && sets[i].strand_group ? (double)sets[i].strand_group[k] : 0;
            most = fmax(most, own);
            all->strand_group[s++] = (float)(first + own);
        }
        if (first + most > STRANDS_MOST_GROUP)
            return error_set(error, RESULT_FAILED,
                             "a group of strands has the number %.0f: expected at most %d",
                             first + most, STRANDS_MOST_GROUP);
        first += most + 1;
    }
    return RESULT_OK;
}

Result strands_pick_group(Strands *strands, double group, Error *error)
{
    uint32_t count = 0, *which = malloc(((size_t)strands->strand_count + 1) * sizeof *which);
    float low = INFINITY, high = 0;
    if (!which) return error_set(error, RESULT_FAILED, "no memory to pick strands");
    for (uint32_t s = 0; s < strands->strand_count; ++s) {
        float own = strands->strand_group ? strands->strand_group[s] : 0;
        low = fminf(low, own), high = fmaxf(high, own);
        if ((double)own == group) which[count++] = s;
    }
    Result result = count
                        ? strands_pick(strands, which, count, error)
                        : error_set(error, RESULT_BAD_INPUT,
                                    "no strand belongs to group %g: expected a group from %g to %g",
                                    group, (double)low, (double)high);
    free(which);
    return result;
}
