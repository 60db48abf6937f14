// SPDX-License-Identifier: MIT
// Reads `.abc`, Alembic's Ogawa files: all visible curves, in the order of the file, with the
// transforms above them and, if the caller wants them, all samples. Reads the attributes of AbcGeom
// and of Unreal's groom schema (groom_...). Unreal's guides are left out if the file has other
// strands.
#include "formats/abc_write.h"
#include "formats/alembic.h"
#include "formats/basis_curves.h"
#include "formats/foreign.h"
#include "formats/format.h"
#include "strands/strands_edit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const NAMES[CURVES_ARRAYS] = {"nVertices", "width",    "groom_color",
                                                 "opacity",   "uv",       "st1",
                                                 "thickness", "mobility", "groom_group_id"};

// Values of AbcGeom's CurveType and BasisType.
static const char *const TYPES[] = {"cubic", "linear"};
static const char *const BASES[] = {"", "bezier", "bspline", "catmullRom"};

// The curves of one object.
typedef struct AbcCurves {
    BasisCurves curves;
    OgawaProperties own; // properties of ".geom"
    int object;
    // The time sampling of the positions and the transforms above them that has the most samples.
    uint32_t sampling, samples;
    // [guide_count] 1 for each strand that is one of Unreal's guides. If guide_count is 1, the
    // number applies to all strands.
    double *guide;
    size_t guide_count; // number for all
    bool centimetres;   // widths are Unreal's: always in centimetres, whatever the file's unit
} AbcCurves;

typedef struct Abc {
    Alembic alembic;
    AbcCurves *set; // [count]
    // `meshes` and `hidden` count objects that are left out, `guides` strands that are left out.
    uint32_t count, meshes, hidden, guides;
    bool all_frames, lost_widths;
} Abc;

static UsdValues to_values(Reader *reader, double *number, size_t count)
{
    UsdValues values = {0};
    if (number) values.value = reader_malloc(reader, count, sizeof *values.value);
    if (number && !values.value) reader_fail_memory(reader);
    for (size_t i = 0; values.value && i < count; ++i) values.value[i] = (float)number[i];
    if (values.value) values.count = values.room = count, values.line = 1;
    free(number);
    return values;
}

static bool read_array(Abc *abc, const OgawaProperties *of, const char *name, CurvesArray array,
                       AbcCurves *set)
{
    size_t count;
    if (set->curves.array[array].line) return false;
    double *number = ogawa_parameter(&abc->alembic.file, of, name, CURVES_WIDTHS[array], &count);
    set->curves.array[array] = to_values(abc->alembic.file.reader, number, count);
    return set->curves.array[array].line != 0;
}

// Fills each array from the first source in the table that the file has. The properties of Unreal's
// schema are arbitrary geometry parameters.
static void read_attributes(Abc *abc, AbcCurves *set)
{
    static const struct {
        const char *name;
        CurvesArray array;
        bool arbitrary, centimetres;
    } sources[] = {
        {"width", CURVES_DIAMETERS, false, false},
        {"groom_width", CURVES_DIAMETERS, true, true},
        {"uv", CURVES_ST, false, false},
        {"groom_root_uv", CURVES_ST, true, false},
        {"groom_color", CURVES_COLOR, true, false},
        {"opacity", CURVES_OPACITY, true, false},
        {"st1", CURVES_ST1, true, false},
        {"thickness", CURVES_THICKNESS, true, false},
        {"mobility", CURVES_MOBILITY, true, false},
        {"groom_group_id", CURVES_GROUP, true, false},
    };
    OgawaProperties arbitrary = ogawa_compound(&abc->alembic.file, &set->own, ".arbGeomParams");
    for (size_t i = 0; i < sizeof sources / sizeof *sources; ++i)
        if (read_array(abc, sources[i].arbitrary ? &arbitrary : &set->own, sources[i].name,
                       sources[i].array, set))
            set->centimetres = set->centimetres || sources[i].centimetres;
    static const char *const wishes[] = {"followers", "followerRadius", "bothEndsFixed"};
    float *to[] = {&set->curves.followers, &set->curves.follower_radius,
                   &set->curves.both_ends_fixed};
    size_t count;
    for (int i = 0; i < 3; ++i) {
        double *number = ogawa_parameter(&abc->alembic.file, &arbitrary, wishes[i], 1, &count);
        if (number && count == 1) *to[i] = (float)number[0];
        free(number);
    }
    set->guide =
        ogawa_parameter(&abc->alembic.file, &arbitrary, "groom_guide", 1, &set->guide_count);
    ogawa_free(&arbitrary);
}

static void read_kind(Abc *abc, AbcCurves *set)
{
    Reader *reader = abc->alembic.file.reader;
    const OgawaProperty *kind = ogawa_find(&set->own, "curveBasisAndType");
    const char *path = abc->alembic.file.object[set->object].path;
    size_t count = 0;
    double *byte =
        kind && kind->samples ? ogawa_numbers(&abc->alembic.file, kind, 0, &count) : NULL;
    uint32_t type = count > 2 ? (uint32_t)byte[0] : 1, wrap = count > 2 ? (uint32_t)byte[1] : 0;
    uint32_t basis = count > 2 ? (uint32_t)byte[2] : 0;
    free(byte);
    if (!reader_ok(reader)) return;
    if (type > 1 || wrap || (type == 0 && (basis == 0 || basis > 3))) {
        reader_fail(reader,
                    "%s: closed curves, or curves of type %u and basis %u: expected open curves: "
                    "linear, Bezier, B-spline or Catmull-Rom",
                    path, type, basis);
        return;
    }
    strcpy(set->curves.type, TYPES[type]);
    strcpy(set->curves.basis, type ? "" : BASES[basis]);
    // Only curves other than Bezier are pinned, so that hair begins at its first point, and get one
    // vertex for each control point.
    strcpy(set->curves.wrap, basis == 1 ? "" : "pinned");
    set->curves.per_segment = basis == 1 ? 0 : 1;
}

// Reads the positions of the first sample, or of all samples if the caller wants all frames.
static void read_points(Abc *abc, AbcCurves *set, const OgawaProperty *position)
{
    Reader *reader = abc->alembic.file.reader;
    uint32_t samples = position->last ? position->samples : 1, read = abc->all_frames ? samples : 1;
    BasisCurves *curves = &set->curves;
    set->samples = samples;
    set->sampling = position->sampling;
    alembic_longest(&abc->alembic, set->object, &set->sampling, &set->samples);
    curves->points.timed = samples > 1;
    curves->points.in_file = samples;
    curves->points.sample = reader_calloc(reader, (size_t)read + 1, sizeof *curves->points.sample);
    for (uint32_t i = 0; i < read && reader_ok(reader); ++i) {
        size_t count;
        double *number = ogawa_numbers(&abc->alembic.file, position, i, &count);
        curves->points.sample[curves->points.count++] = to_values(reader, number, count);
        curves->points.sample[i].time = ogawa_time(&abc->alembic.file, position->sampling, i);
    }
}

static void read_curves(Abc *abc, AbcCurves *set)
{
    Reader *reader = abc->alembic.file.reader;
    const OgawaObject *object = &abc->alembic.file.object[set->object];
    set->own = ogawa_compound(&abc->alembic.file, &object->own, ".geom");
    reader->at = (size_t)object->group;
    const OgawaProperty *position = ogawa_find(&set->own, "P");
    const OgawaProperty *sizes = ogawa_find(&set->own, "nVertices");
    if (!position || !sizes || position->extent != 3 || !position->samples || !sizes->samples)
        reader_fail(reader, "%s: no positions: expected P and nVertices", object->path);
    else if (sizes->last)
        reader_fail(
            reader,
            "%s: the curves' numbers of points change: expected the same numbers in all samples",
            object->path);
    if (!reader_ok(reader)) return;
    read_array(abc, &set->own, "nVertices", CURVES_COUNTS, set);
    read_kind(abc, set);
    read_points(abc, set, position);
    read_attributes(abc, set);
    reader->at = (size_t)object->group;
}

static void read_all(Abc *abc)
{
    Reader *reader = abc->alembic.file.reader;
    abc->set = reader_calloc(reader, (size_t)abc->alembic.file.count + 1, sizeof *abc->set);
    for (int i = 0; i < abc->alembic.file.count && reader_ok(reader); ++i) {
        const char *schema = abc->alembic.file.object[i].schema;
        abc->meshes += strncmp(schema, "AbcGeom_PolyMesh", 16) == 0;
        if (strncmp(schema, "AbcGeom_Curve", 13) != 0) continue;
        if (abc->alembic.hidden[i]) {
            ++abc->hidden;
            continue;
        }
        AbcCurves *set = &abc->set[abc->count++];
        set->object = i;
        set->curves.names = NAMES;
        read_curves(abc, set);
    }
}

// --- Times.

// The times of the frames: those of the object with the most samples.
typedef struct Times {
    uint32_t sampling, count;
} Times;

static Times find_times(const Abc *abc)
{
    Times times = {0, 0};
    for (uint32_t i = 0; i < abc->count; ++i)
        if (abc->set[i].samples > times.count)
            times = (Times){abc->set[i].sampling, abc->set[i].samples};
    return times;
}

static double time_of(const Abc *abc, Times times, uint32_t i)
{
    return times.count > 1 ? ogawa_even_time(&abc->alembic.file, times.sampling, times.count, i)
                           : 0;
}

static void describe_times(const Abc *abc, Times times, FormatSource *source)
{
    double rate = ogawa_rate(&abc->alembic.file, times.sampling, times.count);
    double first = times.count > 1 ? time_of(abc, times, 0) * rate : 0;
    bool even = reader_work(abc->alembic.file.reader, times.count, 20);
    for (uint32_t i = 0; even && i < times.count && times.count > 1; ++i)
        even = even && time_of(abc, times, i) == ogawa_time(&abc->alembic.file, times.sampling, i);
    source->samples = times.count > 1 ? times.count : 0;
    source->fps = rate;
    source->first_frame = first > 0 && first < 1e7 ? (int)(first + 0.5) : 0;
    if (!even && abc->all_frames && reader_ok(abc->alembic.file.reader))
        format_source_note(source,
                           "samples at unequal intervals: frames are interpolated between them");
}

// --- Strands.

static bool is_guide(const AbcCurves *set, uint32_t s)
{
    uint32_t i = set->guide_count == 1 ? 0 : s;
    return i < set->guide_count && set->guide[i] != 0;
}

// Joins the sets. `which` receives the numbers of the strands that are kept: all but the guides, or
// all if there are only guides.
static Result join(Abc *abc, const Strands *sets, Strands *all, uint32_t **which, uint32_t *kept)
{
    Reader *reader = abc->alembic.file.reader;
    if (strands_join(all, sets, abc->count, NULL) != RESULT_OK) return reader_fail_memory(reader);
    *which = reader_malloc(reader, ((size_t)all->strand_count + 1), sizeof **which);
    if (!*which) return reader_fail_memory(reader);
    *kept = 0;
    for (uint32_t i = 0, s = 0; i < abc->count; ++i)
        for (uint32_t k = 0; k < sets[i].strand_count; ++k, ++s)
            if (!is_guide(&abc->set[i], k)) (*which)[(*kept)++] = s;
    abc->guides = *kept ? all->strand_count - *kept : 0;
    if (*kept == 0)
        for (; *kept < all->strand_count; ++*kept) (*which)[*kept] = *kept;
    return RESULT_OK;
}

// Writes the positions of the kept strands at a time to `to`. `room` holds all vertices, and
// first[s] is the first vertex of strand s there.
static void place_all(const Abc *abc, const Strands *sets, const Strands *kept,
                      const uint32_t *which, const uint32_t *first, double time, float (*room)[3],
                      float (*to)[3])
{
    Reader *reader = abc->alembic.file.reader;
    float(*at)[3] = room;
    for (uint32_t i = 0; i < abc->count; ++i) {
        double matrix[4][4];
        if (!reader_work(reader, (uint64_t)sets[i].vertex_count + sets[i].strand_count, 200))
            return;
        alembic_matrix(&abc->alembic, abc->set[i].object, time, matrix);
        basis_curves_place(&abc->set[i].curves, &sets[i], time, matrix, at);
        at += sets[i].vertex_count;
    }
    for (uint32_t s = 0; s < kept->strand_count; ++s)
        memcpy(to[kept->first[s]], room[first[which[s]]], strands_size(kept, s) * sizeof *to);
}

static Result make_frames(const Abc *abc, FormatSource *source, const Strands *sets, Times times,
                          const uint32_t *which, const uint32_t *first, float (*room)[3])
{
    Reader *reader = abc->alembic.file.reader;
    Strands *kept = &source->strands;
    place_all(abc, sets, kept, which, first, time_of(abc, times, 0), room, kept->position);
    if (!abc->all_frames || times.count < 2) return RESULT_OK;
    size_t each = kept->vertex_count;
    source->frames = reader_malloc_frames(reader, times.count, each);
    for (uint32_t f = 0; f < times.count && reader_ok(reader); ++f)
        place_all(abc, sets, kept, which, first, time_of(abc, times, f), room,
                  source->frames + f * each);
    return RESULT_OK;
}

static Result make_source(Abc *abc, FormatSource *source, const Strands *sets, Times times)
{
    Reader *reader = abc->alembic.file.reader;
    Strands all = {0};
    uint32_t *which = NULL, *first = NULL, kept = 0;
    float(*room)[3] = NULL;
    Result result = join(abc, sets, &all, &which, &kept);
    if (result == RESULT_OK) {
        first = reader_malloc(reader, ((size_t)all.strand_count + 1), sizeof *first);
        room = reader_malloc(reader, ((size_t)all.vertex_count + 1), sizeof *room);
        if (!first || !room) result = reader_fail_memory(reader);
    }
    if (result == RESULT_OK)
        memcpy(first, all.first, ((size_t)all.strand_count + 1) * sizeof *first);
    if (result == RESULT_OK && kept < all.strand_count &&
        strands_pick(&all, which, kept, NULL) != RESULT_OK)
        result = reader_fail_memory(reader);
    THEN(result, format_source_create(source, reader, all.strand_count, all.vertex_count));
    if (result == RESULT_OK) {
        strands_destroy(&source->strands);
        source->strands = all;
        all = (Strands){0};
        for (uint32_t s = 0; s < kept; ++s) source->place[s] = reader->at;
        describe_times(abc, times, source);
    }
    THEN(result, make_frames(abc, source, sets, times, which, first, room));
    strands_destroy(&all);
    free(which);
    free(first);
    free(room);
    return result;
}

// Unreal's widths are in centimetres. If all objects have Unreal's widths, returns the metres of
// their unit. Otherwise drops Unreal's widths and returns 0: the other widths are in the unit of
// the positions.
static double unite_widths(const Abc *abc, Strands *sets, double time)
{
    uint32_t centimetres = 0;
    for (uint32_t i = 0; i < abc->count; ++i) centimetres += abc->set[i].centimetres;
    for (uint32_t i = 0; i < abc->count; ++i) {
        double matrix[4][4];
        if (abc->set[i].centimetres) {
            if (centimetres == abc->count) continue;
            free(sets[i].vertex_thickness);
            sets[i].vertex_thickness = NULL;
        }
        alembic_matrix(&abc->alembic, abc->set[i].object, time, matrix);
        basis_curves_scale(&sets[i], matrix);
    }
    return centimetres == abc->count ? ABC_GROOM_UNIT : 0;
}

static void check_guides(Reader *reader, const AbcCurves *set, uint32_t strands)
{
    if (set->guide && set->guide_count != 1 && set->guide_count != strands)
        reader_fail(reader, "groom_guide: %zu numbers: expected %u, one for each curve",
                    set->guide_count, strands);
}

static Result make_strands(Abc *abc, FormatSource *source, Strands *sets)
{
    Reader *reader = abc->alembic.file.reader;
    uint32_t cubic = 0;
    for (uint32_t i = 0; i < abc->count && reader_ok(reader); ++i) {
        BasisCurves *curves = &abc->set[i].curves;
        reader->at = (size_t)abc->alembic.file.object[abc->set[i].object].group;
        basis_curves_make(curves, reader, source->wishes.points_per_strand, &sets[i]);
        if (reader_ok(reader)) check_guides(reader, &abc->set[i], sets[i].strand_count);
        cubic += strcmp(curves->type, "linear") != 0;
        abc->lost_widths = abc->lost_widths || sets[i].vertex_thickness;
    }
    TRY(reader->result);
    source->used_points = cubic > 0;
    Times times = find_times(abc);
    double unit = unite_widths(abc, sets, time_of(abc, times, 0));
    TRY(make_source(abc, source, sets, times));
    source->thickness_unit = unit;
    abc->lost_widths = abc->lost_widths && !source->strands.vertex_thickness;
    return RESULT_OK;
}

static void note_choices(const Abc *abc, FormatSource *source)
{
    if (abc->hidden)
        format_source_note(source, "%u hidden objects of curves are left out", abc->hidden);
    if (abc->guides)
        format_source_note(source, "%u guides are left out (groom_guide)", abc->guides);
    if (abc->lost_widths)
        format_source_note(source,
                           "widths are left out: expected width or groom_width in all objects");
}

static void destroy(Abc *abc)
{
    for (uint32_t i = 0; i < abc->count; ++i) {
        basis_curves_destroy(&abc->set[i].curves);
        ogawa_free(&abc->set[i].own);
        free(abc->set[i].guide);
    }
    free(abc->set);
    alembic_close(&abc->alembic);
}

static Result read(FormatSource *source, Reader *reader)
{
    Abc abc = {.all_frames = source->wishes.all_frames};
    Strands *sets = NULL;
    if (alembic_open(&abc.alembic, reader) == RESULT_OK) read_all(&abc);
    if (reader_ok(reader) && abc.count == 0) {
        reader->at = 0;
        reader_fail(reader, abc.hidden   ? "all curves are hidden: expected visible curves"
                            : abc.meshes ? "meshes without hair: " FOREIGN_WANTS_HAIR
                                         : "no curves: expected hair");
    }
    if (reader_ok(reader)) sets = reader_calloc(reader, (size_t)abc.count + 1, sizeof *sets);
    if (reader_ok(reader) && !sets) reader_fail_memory(reader);
    if (reader_ok(reader)) make_strands(&abc, source, sets);
    if (reader_ok(reader)) {
        source->unit = (float)abc.alembic.file.unit;
        source->up = abc.alembic.file.up_z < 0 ? UP_AUTO : abc.alembic.file.up_z ? UP_Z : UP_Y;
        note_choices(&abc, source);
    }
    for (uint32_t i = 0; sets && i < abc.count; ++i) strands_destroy(&sets[i]);
    free(sets);
    destroy(&abc);
    return reader->result;
}

const Format abc_format = {
    .name = "Alembic (.abc)",
    .suffix = ".abc",
    .features = ~(uint32_t)STRANDS_HAS_FIBRE,
    .animated = true,
    .match = ogawa_matches,
    .read = read,
    .write = abc_write_strands,
};
