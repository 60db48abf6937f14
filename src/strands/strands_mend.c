// SPDX-License-Identifier: MIT
#include "strands/strands_mend.h"

#include <math.h>
#include <string.h>

static const double FARTHEST = 1e6;       // metres; squares of it are far from float32's limits
static const double NEAREST_SHARE = 1e-7; // of the strand's largest coordinate
static const double NEAREST = 1e-9;       // metres; its square is far above float32's smallest

// --- Conversion.

// DirectX's XMMatrixRotationRollPitchYaw(x, y, z), which AMD's loader uses: about z, then x, then
// y.
static void make_rotation(const double angle[3], double r[3][3])
{
    double cx = cos(angle[0]), sx = sin(angle[0]), cy = cos(angle[1]), sy = sin(angle[1]);
    double cz = cos(angle[2]), sz = sin(angle[2]);
    double rotation[3][3] = {
        {cy * cz + sy * sx * sz, sy * sx * cz - cy * sz, sy * cx},
        {cx * sz, cx * cz, -sx},
        {cy * sx * sz - sy * cz, sy * sz + cy * sx * cz, cy * cx},
    };
    memcpy(r, rotation, sizeof rotation);
}

void strands_convert(StrandsSource *source, double unit, bool up_z)
{
    Strands *strands = &source->strands;
    double rotation[3][3], scale = source->scale != 0.0 ? source->scale : 1.0;
    make_rotation(source->rotation, rotation);
    bool rotated =
        source->rotation[0] != 0.0 || source->rotation[1] != 0.0 || source->rotation[2] != 0.0;
    for (uint32_t v = 0; v < strands->vertex_count; v++) {
        float *position = strands->position[v];
        double p[3] = {position[0] * scale, position[1] * scale, position[2] * scale};
        double q[3] = {p[0], p[1], p[2]};
        for (int i = 0; i < 3 && rotated; i++)
            q[i] = rotation[i][0] * p[0] + rotation[i][1] * p[1] + rotation[i][2] * p[2];
        // Adding 0 would turn -0 into 0.
        for (int i = 0; i < 3; i++)
            if (source->translation[i] != 0.0) q[i] += source->translation[i];
        position[0] = (float)(q[0] * unit);
        position[1] = (float)((up_z ? q[2] : q[1]) * unit);
        position[2] = (float)((up_z ? -q[1] : q[2]) * unit);
    }
    for (uint32_t v = 0; strands->vertex_thickness && v < strands->vertex_count; v++)
        strands->vertex_thickness[v] = (float)(strands->vertex_thickness[v] * unit * fabs(scale));
    strands->follower_radius = (float)(strands->follower_radius * unit * fabs(scale));
}

// --- Mending.

static void note(StrandsReport *report, DefectKind kind, uint64_t place)
{
    Defect *defect = &report->defects[kind];
    if (defect->count == 0 || place < defect->first_place) defect->first_place = place;
    if (defect->count < UINT32_MAX) defect->count++;
}

static uint64_t vertex_place(const StrandsSource *source, uint32_t s, uint32_t v)
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

// Distance below which neighbours among the vertices begin .. end - 1 count as one.
static double nearest_apart(const Strands *strands, uint32_t begin, uint32_t end)
{
    double largest = 0.0;
    for (uint32_t v = begin; v < end; v++)
        for (int i = 0; i < 3; i++) largest = fmax(largest, fabs((double)strands->position[v][i]));
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

// Whether every coordinate of strand s is usable; notes the defect if not.
static bool check_coordinates(const StrandsSource *source, uint32_t s, uint32_t end,
                              StrandsReport *report)
{
    for (uint32_t v = source->strands.first[s]; v < end; v++) {
        if (is_usable(source->strands.position[v])) continue;
        note(report, DEFECT_NOT_FINITE, vertex_place(source, s, v));
        return false;
    }
    return true;
}

// Moves the vertices of strand s that are to stay to `to` and on. Returns how many they are, 0 for
// a strand to drop.
static uint32_t mend_strand(StrandsSource *source, uint32_t s, uint32_t end, uint32_t to,
                            StrandsReport *report)
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
    move_vertex(strands, to, begin);
    for (uint32_t v = begin + 1; v < end; v++) {
        if (coincide(strands->position[to + kept - 1], strands->position[v], nearest))
            note(report, DEFECT_COINCIDENT, vertex_place(source, s, v));
        else
            move_vertex(strands, to + kept++, v);
    }
    return kept;
}

// Values of an optional array that are not finite; `width` floats for each of `count` records.
static void mend_values(float *values, size_t count, int width, float replacement,
                        StrandsReport *report, uint64_t place)
{
    for (size_t i = 0; values && i < count * (size_t)width; i++) {
        if (isfinite(values[i])) continue;
        values[i] = replacement;
        note(report, DEFECT_ATTRIBUTE, place);
    }
}

// The place is that of the strand: an attribute's own is not kept.
static void mend_attributes(StrandsSource *source, uint32_t s, StrandsReport *report)
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

static Result fail_too_long(const StrandsSource *source, uint32_t s, uint32_t size,
                            const char *path, Error *error)
{
    return error_set(error, RESULT_BAD_INPUT,
                     "%s%s%llu: strand %u has %u vertices, at most %d work", path,
                     source->vertex_line ? ":" : ": byte ", (unsigned long long)source->place[s], s,
                     size, STRANDS_MAX_SIZE);
}

Result strands_mend(StrandsSource *source, const char *path, StrandsReport *report, Error *error)
{
    Strands *strands = &source->strands;
    report->defects[DEFECT_OVER_LIMIT] = (Defect){source->over_limit, source->over_limit_line};
    uint64_t unread = source->unread_bytes < UINT32_MAX ? source->unread_bytes : UINT32_MAX;
    report->defects[DEFECT_UNREAD] = (Defect){(uint32_t)unread, source->unread_at};
    uint32_t kept_strands = 0, kept_vertices = 0, begin = 0;
    for (uint32_t s = 0; s < strands->strand_count; s++) {
        // Mending goes in place: first[s + 1] is still the file's when strand s has been moved.
        uint32_t end = strands->first[s + 1];
        strands->first[s] = begin;
        begin = end;
        mend_attributes(source, s, report);
        uint32_t size = mend_strand(source, s, end, kept_vertices, report);
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
