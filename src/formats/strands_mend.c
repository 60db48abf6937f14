// SPDX-License-Identifier: MIT
#include "formats/strands_mend.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double FARTHEST = 1e6;       // metres; its square is far below the largest float32
static const double NEAREST_SHARE = 1e-7; // as a share of the strand's largest coordinate
static const double NEAREST = 1e-9;       // metres; its square is far above the smallest float32

static void note(StrandsReport *report, DefectKind kind, uint64_t place)
{
    Defect *defect = &report->defects[kind];
    if (defect->count == 0 || place < defect->first_place) defect->first_place = place;
    if (defect->count < UINT32_MAX) defect->count++;
}

static uint64_t vertex_place(const FormatSource *source, uint32_t s, uint32_t v)
{
    if (source->vertex_line) return source->vertex_line[v];
    return source->place[s] + (uint64_t)(v - source->strands.first[s]) * source->vertex_stride;
}

static bool is_usable(const float position[3])
{
    for (int i = 0; i < 3; i++)
        if (!(fabs((double)position[i]) <= FARTHEST)) return false;
    return true;
}

// Vertices begin .. end - 1 that are closer than this to their neighbour are merged with it. The
// distance grows with the coordinates, as float32's rounding does.
static double nearest_apart(const Strands *strands, uint32_t begin, uint32_t end)
{
    double largest = 0.0;
    for (uint32_t v = begin; v < end; v++)
        for (int i = 0; i < 3; i++) {
            double reach = fabs((double)strands->position[v][i]);
            if (reach > largest) largest = reach;
        }
    return fmax(NEAREST, NEAREST_SHARE * largest);
}

static bool coincide(const float a[3], const float b[3], double nearest)
{
    double x = (double)b[0] - a[0], y = (double)b[1] - a[1], z = (double)b[2] - a[2];
    return x * x + y * y + z * z <= nearest * nearest;
}

#define MOVE(array, width, mended)                                                                 \
    if (strands->array) memcpy(&strands->array[to], &strands->array[from], sizeof *strands->array);

static void move_vertex(Strands *strands, uint32_t to, uint32_t from)
{
    if (to == from) return;
    memcpy(strands->position[to], strands->position[from], sizeof *strands->position);
    STRANDS_ARRAYS_OF_VERTICES(MOVE)
}

static void move_strand(Strands *strands, uint32_t to, uint32_t from)
{
    if (to == from) return;
    STRANDS_ARRAYS_OF_STRANDS(MOVE)
}
#undef MOVE

// Whether every coordinate of strand s is usable; otherwise notes the defect.
static bool check_coordinates(const FormatSource *source, uint32_t s, uint32_t end,
                              StrandsReport *report)
{
    for (uint32_t v = source->strands.first[s]; v < end; v++) {
        if (is_usable(source->strands.position[v])) continue;
        note(report, DEFECT_NOT_FINITE, vertex_place(source, s, v));
        return false;
    }
    return true;
}

// Moves the vertices of strand s that are kept to index `to` and the following ones. Writes their
// old indices to `kept_from` unless it is NULL. Returns how many were kept; 0 if the whole strand
// is dropped.
static uint32_t mend_strand(FormatSource *source, uint32_t s, uint32_t end, uint32_t to,
                            uint32_t *kept_from, StrandsReport *report)
{
    Strands *strands = &source->strands;
    uint32_t begin = strands->first[s], kept = 1;
    if (source->roots_only && end - begin <= 1) {
        report->empty_roots++;
        return 0;
    }
    if (!check_coordinates(source, s, end, report)) return 0;
    double nearest = nearest_apart(strands, begin, end);
    uint32_t distinct = end > begin, last = begin;
    for (uint32_t v = begin + 1; v < end; v++)
        if (!coincide(strands->position[last], strands->position[v], nearest)) {
            distinct++;
            last = v;
        }
    if (distinct < 2) {
        note(report, DEFECT_TOO_SHORT, source->place[s]);
        return 0;
    }
    if (distinct == end - begin && to == begin && !kept_from) return distinct;
    move_vertex(strands, to, begin);
    if (kept_from) kept_from[to] = begin;
    for (uint32_t v = begin + 1; v < end; v++) {
        if (coincide(strands->position[to + kept - 1], strands->position[v], nearest)) {
            note(report, DEFECT_COINCIDENT, vertex_place(source, s, v));
            continue;
        }
        if (kept_from) kept_from[to + kept] = v;
        move_vertex(strands, to + kept++, v);
    }
    return kept;
}

// Replaces values of an optional array that are not finite. There are `width` floats for each of
// `count` records.
static void mend_values(float *values, size_t count, int width, float replacement,
                        StrandsReport *report, uint64_t place)
{
    for (size_t i = 0; values && i < count * (size_t)width; i++) {
        if (isfinite(values[i])) continue;
        values[i] = replacement;
        note(report, DEFECT_ATTRIBUTE, place);
    }
}

// Defects are reported at the strand's place in the file, because the places of single attribute
// values are not stored.
static void mend_attributes(FormatSource *source, uint32_t s, StrandsReport *report)
{
    Strands *strands = &source->strands;
    uint32_t v = strands->first[s], size = strands->first[s + 1] - v;
    uint64_t place = source->place[s];
#define OF_VERTICES(array, width, mended)                                                          \
    if (strands->array)                                                                            \
        mend_values((float *)&strands->array[v], size, width, mended, report, place);
#define OF_STRANDS(array, width, mended)                                                           \
    if (strands->array) mend_values((float *)&strands->array[s], 1, width, mended, report, place);
    STRANDS_ARRAYS_OF_VERTICES(OF_VERTICES)
    STRANDS_ARRAYS_OF_STRANDS(OF_STRANDS)
#undef OF_VERTICES
#undef OF_STRANDS
}

static Result fail_too_long(const FormatSource *source, uint32_t s, uint32_t size, const char *path,
                            Error *error)
{
    return error_set(error, RESULT_BAD_INPUT,
                     "%s%s%llu: strand %u has %u vertices: expected at most %d", path,
                     source->vertex_line ? ":" : ": byte ", (unsigned long long)source->place[s], s,
                     size, STRANDS_MAX_SIZE);
}

// --- Padding behind the tips, in arrays of equal sizes.

static bool is_zero(const float p[3])
{
    return p[0] == 0 && p[1] == 0 && p[2] == 0;
}

// The end of a strand without the zeros behind its tip, if they are farther from the tip than twice
// the strand's longest segment (by the largest coordinate). `end` if there are none.
static uint32_t find_tip(const Strands *strands, uint32_t begin, uint32_t end)
{
    uint32_t tip = end;
    double longest = 0, jump = 0;
    while (tip > begin && is_zero(strands->position[tip - 1])) --tip;
    if (tip == end || tip < begin + 2) return end;
    for (uint32_t v = begin + 1; v < tip; ++v)
        for (int k = 0; k < 3; ++k)
            longest = fmax(longest, fabs((double)strands->position[v][k] -
                                         (double)strands->position[v - 1][k]));
    for (int k = 0; k < 3; ++k) jump = fmax(jump, fabs((double)strands->position[tip - 1][k]));
    return jump > 2 * longest ? tip : end;
}

// Whether so many strands end with zeros (at least 2, and 1 of 50) that these are padding.
static bool has_zeros(const Strands *strands)
{
    uint32_t padded = 0;
    for (uint32_t s = 0; s < strands->strand_count; s++)
        padded +=
            find_tip(strands, strands->first[s], strands->first[s + 1]) != strands->first[s + 1];
    return padded >= 2 && padded >= strands->strand_count / 50;
}

// The end of strand s, which begins at `begin`, without its padding.
static uint32_t find_end(const FormatSource *source, uint32_t s, uint32_t end, bool zeros,
                         StrandsReport *report)
{
    const Strands *strands = &source->strands;
    uint32_t begin = strands->first[s], tip = zeros ? find_tip(strands, begin, end) : end;
    if (tip < end) note(report, DEFECT_PADDING, vertex_place(source, s, tip));
    while (source->pads && tip > begin && !isfinite(strands->position[tip - 1][0])) --tip;
    return tip > begin ? tip : end;
}

// Mends positions (in metres) in place, so that they keep the promises of strands_read. Counts the
// defects in `report`. `kept_from`, [vertex_count] or NULL, receives the old index of each vertex
// that is kept. Fails (RESULT_BAD_INPUT) only if a strand has too many vertices.
static Result mend(FormatSource *source, const char *path, uint32_t *kept_from,
                   StrandsReport *report, Error *error)
{
    Strands *strands = &source->strands;
    report->defects[DEFECT_OVER_LIMIT] = (Defect){source->over_limit, source->over_limit_line};
    uint64_t unread = source->unread_bytes < UINT32_MAX ? source->unread_bytes : UINT32_MAX;
    report->defects[DEFECT_UNREAD] = (Defect){(uint32_t)unread, source->unread_at};
    uint32_t kept_strands = 0, kept_vertices = 0, begin = 0;
    bool zeros = has_zeros(strands);
    for (uint32_t s = 0; s < strands->strand_count; s++) {
        // Mending is in place: after strand s was moved, first[s + 1] still holds the file's value.
        uint32_t end = strands->first[s + 1];
        strands->first[s] = begin;
        begin = end;
        uint32_t tip = find_end(source, s, end, zeros, report);
        mend_attributes(source, s, report);
        uint32_t size = mend_strand(source, s, tip, kept_vertices, kept_from, report);
        if (size > STRANDS_MAX_SIZE) return fail_too_long(source, s, size, path, error);
        if (size == 0) continue;
        move_strand(strands, kept_strands, s);
        strands->first[kept_strands++] = kept_vertices;
        kept_vertices += size;
    }
    strands->first[kept_strands] = kept_vertices;
    strands->strand_count = kept_strands;
    strands->vertex_count = kept_vertices;
    return RESULT_OK;
}

// Removes the dropped vertices from all frames. Afterwards each frame of source->frames has as many
// vertices as the strands.
static Result mend_frames(FormatSource *source, const char *path, uint32_t file_count,
                          const uint32_t *kept_from, Error *error)
{
    uint32_t count = source->strands.vertex_count;
    for (uint32_t f = 0; f < source->samples; f++) {
        float(*from)[3] = source->frames + (size_t)f * file_count;
        float(*to)[3] = source->frames + (size_t)f * count;
        for (uint32_t v = 0; v < count; v++) {
            if (!is_usable(from[kept_from[v]]))
                return error_set(
                    error, RESULT_BAD_INPUT,
                    "%s: frame %d: a coordinate of vertex %u is NaN, infinite or beyond 1000 km",
                    path, source->first_frame + (int)f, kept_from[v]);
            memmove(to[v], from[kept_from[v]], sizeof *to);
        }
    }
    return RESULT_OK;
}

Result strands_mend(FormatSource *source, const char *path, StrandsReport *report, Error *error)
{
    uint32_t count = source->strands.vertex_count, *kept_from = NULL;
    if (source->strands.followers > STRANDS_MAX_FOLLOWERS)
        return error_set(error, RESULT_BAD_INPUT,
                         "%s: %u followers for each guide: expected at most %d", path,
                         source->strands.followers, STRANDS_MAX_FOLLOWERS);
    if (!(source->strands.follower_radius >= 0 && source->strands.follower_radius <= FARTHEST)) {
        note(report, DEFECT_ATTRIBUTE, count ? source->place[0] : 0);
        source->strands.follower_radius = 0;
    }
    if (!source->frames) return mend(source, path, NULL, report, error);
    kept_from = malloc(((size_t)count + 1) * sizeof *kept_from);
    if (!kept_from) return error_set(error, RESULT_FAILED, "%s: no memory", path);
    Result result = mend(source, path, kept_from, report, error);
    THEN(result, mend_frames(source, path, count, kept_from, error));
    free(kept_from);
    return result;
}

// --- Strands that were not read from a file.

static bool all_finite(const float *values, size_t count)
{
    for (size_t i = 0; values && i < count; i++)
        if (!isfinite(values[i])) return false;
    return true;
}

static bool has_finite_attributes(const Strands *strands, uint32_t s)
{
    uint32_t v = strands->first[s], size = strands_size(strands, s);
    bool finite = true;
#define OF_VERTICES(array, width, mended)                                                          \
    finite = finite && (!strands->array ||                                                         \
                        all_finite((const float *)&strands->array[v], (size_t)size * (width)));
#define OF_STRANDS(array, width, mended)                                                           \
    finite = finite && (!strands->array || all_finite((const float *)&strands->array[s], width));
    STRANDS_ARRAYS_OF_VERTICES(OF_VERTICES)
    STRANDS_ARRAYS_OF_STRANDS(OF_STRANDS)
#undef OF_VERTICES
#undef OF_STRANDS
    return finite;
}

static Result check_strand(const Strands *strands, uint32_t s, const char *name, Error *error)
{
    uint32_t begin = strands->first[s], end = strands->first[s + 1], size = end - begin;
    if (size < 2 || size > STRANDS_MAX_SIZE)
        return error_set(error, RESULT_BAD_INPUT, "%s: strand %u has %u vertices: expected 2 to %d",
                         name, s, size, STRANDS_MAX_SIZE);
    for (uint32_t v = begin; v < end; v++)
        if (!is_usable(strands->position[v]))
            return error_set(
                error, RESULT_BAD_INPUT,
                "%s: strand %u: a coordinate of vertex %u is NaN, infinite or beyond 1000 km", name,
                s, v - begin);
    double nearest = nearest_apart(strands, begin, end);
    for (uint32_t v = begin + 1; v < end; v++)
        if (coincide(strands->position[v - 1], strands->position[v], nearest))
            return error_set(error, RESULT_BAD_INPUT, "%s: strand %u: vertices %u and %u coincide",
                             name, s, v - begin - 1, v - begin);
    if (has_finite_attributes(strands, s)) return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT, "%s: strand %u: an attribute is not finite", name, s);
}

Result strands_check(const Strands *strands, const char *name, Error *error)
{
    for (uint32_t s = 0; s < strands->strand_count; s++) TRY(check_strand(strands, s, name, error));
    return RESULT_OK;
}
