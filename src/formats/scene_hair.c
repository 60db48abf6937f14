// SPDX-License-Identifier: MIT
#include "formats/scene_hair.h"

#include "formats/abc_write.h"
#include "strands/strands_edit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

SceneObject *scene_hair_add(SceneHair *hair, const char *path, const BasisCurves *curves)
{
    if (hair->count == hair->room) {
        uint32_t room = 2 * hair->room + 4;
        SceneObject *more = reader_realloc(hair->reader, hair->object, room, sizeof *more);
        if (!more) return NULL;
        hair->object = more;
        hair->room = room;
    }
    SceneObject *object = &hair->object[hair->count++];
    *object = (SceneObject){.curves = *curves};
    format_copy_path(object->path, path);
    return object;
}

void scene_hair_destroy(SceneHair *hair)
{
    for (uint32_t i = 0; i < hair->count; ++i) {
        basis_curves_destroy(&hair->object[i].curves);
        free(hair->object[i].guide);
    }
    free(hair->object);
    free(hair->time);
    hair->object = NULL;
    hair->time = NULL;
    hair->count = hair->room = hair->time_count = 0;
}

// --- The policy.

static uint32_t count_why(const SceneHair *hair, SceneWhy why)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < hair->count; ++i) count += hair->object[i].why == why;
    return count;
}

// Decides what the curves alone say.
static void decide(const SceneHair *hair, SceneObject *object)
{
    const BasisCurves *curves = &object->curves;
    if (object->why != SCENE_READ) return;
    if (curves->points.count == 0 || curves->points.sample[0].count == 0)
        object->why = SCENE_EMPTY;
    else if (!format_wants_object(&hair->wishes, object->path))
        object->why = SCENE_UNWANTED;
    else
        object->why = basis_curves_is_closed(curves)  ? SCENE_CLOSED
                      : basis_curves_is_known(curves) ? SCENE_READ
                                                      : SCENE_FOREIGN;
}

// Whether all hair is hidden, so that hidden objects are read.
static bool show_hidden(SceneHair *hair)
{
    if (count_why(hair, SCENE_READ) || !count_why(hair, SCENE_HIDDEN)) return false;
    for (uint32_t i = 0; i < hair->count; ++i) {
        if (hair->object[i].why != SCENE_HIDDEN) continue;
        hair->object[i].why = SCENE_READ;
        decide(hair, &hair->object[i]);
    }
    return count_why(hair, SCENE_READ);
}

static const char *describe(SceneWhy why)
{
    static const char *const words[SCENE_WHYS] = {
        [SCENE_READ] = "",
        [SCENE_EMPTY] = "no points",
        [SCENE_UNWANTED] = "not chosen",
        [SCENE_ABSENT] = "inactive or abstract",
        [SCENE_HIDDEN] = "hidden, or of purpose guide or proxy",
        [SCENE_CLOSED] = "closed curves",
        [SCENE_FOREIGN] = "NURBS or Hermite curves, or of an unknown basis",
        [SCENE_SCATTERED] = "instances of a PointInstancer",
        [SCENE_DAMAGED] = "its arrays do not fit",
    };
    return words[why];
}

static const char *plural(uint32_t count)
{
    return count == 1 ? "" : "s";
}

// `damage`: of the first object whose arrays do not fit, with the file's name.
static void note_left_out(const SceneHair *hair, FormatSource *source, const Error *damage)
{
    const char *detail = *damage->text ? damage->text + strlen(hair->reader->path) + 1 : "";
    for (SceneWhy why = SCENE_ABSENT; why < SCENE_WHYS; ++why) {
        uint32_t count = count_why(hair, why);
        if (!count) continue;
        (why >= SCENE_CLOSED ? format_source_flaw : format_source_note)(
            source, "%u object%s of curves left out (%s%s%s)", count, plural(count), describe(why),
            why == SCENE_DAMAGED ? ":" : "", why == SCENE_DAMAGED ? detail : "");
    }
}

static void note_objects(const SceneHair *hair, FormatSource *source)
{
    uint32_t polygons = 0, changing = 0, skinned = 0;
    for (uint32_t i = 0; i < hair->count; ++i) {
        const SceneObject *object = &hair->object[i];
        const BasisCurves *curves = &object->curves;
        if (object->why != SCENE_READ) continue;
        polygons += curves->polygons;
        changing += curves->changes;
        skinned += object->skinned;
        for (int k = 0; k < CURVES_ARRAYS; ++k)
            if (curves->unfit & 1u << k)
                format_source_flaw(source,
                                   "%s: %s: %zu numbers, which do not fit the number of curves or "
                                   "points: not read",
                                   object->path, curves->names[k], curves->array[k].count);
    }
    if (polygons)
        format_source_flaw(source,
                           "%u cubic curve%s of too few points for whole segments: read as the "
                           "polygon%s of the points",
                           polygons, plural(polygons), plural(polygons));
    if (changing)
        format_source_flaw(source,
                           "the numbers of points of %u object%s change: only the first sample is "
                           "read",
                           changing, plural(changing));
    if (skinned)
        format_source_flaw(source,
                           "a skeleton (UsdSkel) moves %u object%s of curves: read as they lie "
                           "without it; bake the points for the motion",
                           skinned, plural(skinned));
}

// --- Making strands.

// The strands of an object. Damage is no failure of the reader: the object is left out.
static void make_object(SceneHair *hair, SceneObject *object, Strands *strands, Error *damage)
{
    Reader *reader = hair->reader, inner = *reader;
    Error error = {""};
    inner.error = &error;
    if (inner.line)
        inner.line = object->curves.line;
    else
        inner.at = (size_t)object->place;
    basis_curves_make(&object->curves, &inner, hair->wishes.points_per_strand, strands);
    if (reader_ok(&inner) && object->guide && object->guide_count != 1 &&
        object->guide_count != strands->strand_count)
        reader_fail(&inner, "groom_guide: %zu numbers: expected %u, one for each curve",
                    object->guide_count, strands->strand_count);
    reader->memory = inner.memory;
    reader->placed = inner.placed;
    reader->work = inner.work;
    if (reader_ok(&inner)) return;
    strands_destroy(strands);
    if (inner.result != RESULT_BAD_INPUT) {
        reader->result = inner.result;
        if (reader->error) *reader->error = error;
        return;
    }
    object->why = SCENE_DAMAGED;
    if (!*damage->text) *damage = error;
}

static bool is_guide(const SceneObject *object, uint32_t s)
{
    uint32_t i = object->guide_count == 1 ? 0 : s;
    return i < object->guide_count && object->guide[i] != 0;
}

// The objects that are read, with their strands.
typedef struct Made {
    SceneHair *hair;
    FormatSource *source;
    SceneObject **object; // [count]
    Strands *sets;        // [count]
    uint32_t count;
    uint32_t *which, kept; // the strands that are kept: all but guides beside others
    uint32_t *first;       // the first vertex of each strand before guides were left out
    float (*room)[3];
} Made;

static void make_all(Made *made, Error *damage)
{
    SceneHair *hair = made->hair;
    for (uint32_t i = 0; i < hair->count && reader_ok(hair->reader); ++i) {
        SceneObject *object = &hair->object[i];
        if (object->why != SCENE_READ) continue;
        make_object(hair, object, &made->sets[made->count], damage);
        if (object->why == SCENE_READ) made->object[made->count++] = object;
    }
}

// Unreal's widths are in centimetres. If all objects have Unreal's widths, the unit of widths is
// theirs. Otherwise Unreal's widths are dropped: the others are in the unit of the positions.
static void unite_widths(Made *made)
{
    SceneHair *hair = made->hair;
    uint32_t centimetres = 0;
    for (uint32_t i = 0; i < made->count; ++i) {
        centimetres += made->object[i]->centimetres;
        hair->features |= strands_features(&made->sets[i]);
    }
    for (uint32_t i = 0; i < made->count; ++i) {
        double matrix[4][4];
        if (made->object[i]->centimetres) {
            if (centimetres == made->count) continue;
            free(made->sets[i].vertex_thickness);
            made->sets[i].vertex_thickness = NULL;
        }
        hair->find_matrix(hair->file, made->object[i]->node, hair->time_count ? hair->time[0] : 0,
                          matrix);
        if (!reader_ok(hair->reader)) return;
        basis_curves_scale(&made->sets[i], matrix);
    }
    made->source->thickness_unit = centimetres == made->count ? ABC_GROOM_UNIT : 0;
}

// Without groups in the file, each object is a group, in their order. If only some have groups,
// those stay separate, and each of the others is a group, too.
static Result set_groups(const Made *made, Strands *all)
{
    uint32_t grouped = 0;
    for (uint32_t i = 0; i < made->count; ++i) grouped += made->sets[i].strand_group != NULL;
    if (made->count < 2 || grouped == made->count) return RESULT_OK;
    return strands_group_sets(all, made->sets, made->count, grouped > 0, NULL);
}

// Joins the sets, and finds the strands that are kept: all but the guides, or all if there are only
// guides.
static Result join(Made *made, Strands *all)
{
    Reader *reader = made->hair->reader;
    if (strands_join(all, made->sets, made->count, NULL) != RESULT_OK ||
        set_groups(made, all) != RESULT_OK)
        return reader_fail_memory(reader);
    made->hair->features &= ~strands_features(all);
    made->which = reader_malloc(reader, (uint64_t)all->strand_count + 1, sizeof *made->which);
    made->first = reader_malloc(reader, (uint64_t)all->strand_count + 1, sizeof *made->first);
    made->room = reader_malloc(reader, (uint64_t)all->vertex_count + 1, sizeof *made->room);
    TRY(reader->result);
    memcpy(made->first, all->first, ((size_t)all->strand_count + 1) * sizeof *all->first);
    for (uint32_t i = 0, s = 0; i < made->count; ++i)
        for (uint32_t k = 0; k < made->sets[i].strand_count; ++k, ++s)
            if (!is_guide(made->object[i], k)) made->which[made->kept++] = s;
    uint32_t guides = all->strand_count - made->kept;
    if (made->kept == 0)
        for (; made->kept < all->strand_count; ++made->kept) made->which[made->kept] = made->kept;
    else if (guides)
        format_source_note(made->source, "%u guide%s left out (groom_guide)", guides,
                           plural(guides));
    if (made->kept < all->strand_count &&
        strands_pick(all, made->which, made->kept, NULL) != RESULT_OK)
        return reader_fail_memory(reader);
    return RESULT_OK;
}

// The matrix of an object to the world without the origin.
static void find_matrix(const SceneHair *hair, int node, double time, double matrix[4][4])
{
    hair->find_matrix(hair->file, node, time, matrix);
    for (int k = 0; k < 3; ++k) matrix[3][k] -= hair->origin[k];
}

// Float32 has steps of 1/16384 from here on, in the file's unit.
static const double FAR = 1000;

// Hair that is far from the world's zero is placed relative to its first point, in whole units.
static void find_origin(Made *made)
{
    SceneHair *hair = made->hair;
    const BasisCurves *curves = &made->object[0]->curves;
    const float *first = curves->points.sample[0].value;
    double m[4][4], p[3];
    hair->find_matrix(hair->file, made->object[0]->node, hair->time_count ? hair->time[0] : 0, m);
    for (int k = 0; k < 3; ++k)
        p[k] = (double)first[0] * m[0][k] + (double)first[1] * m[1][k] +
               (double)first[2] * m[2][k] + m[3][k];
    bool far = fmax(fabs(p[0]), fmax(fabs(p[1]), fabs(p[2]))) > FAR;
    for (int k = 0; k < 3 && far; ++k)
        if (fabs(p[k]) < 1e15) hair->origin[k] = round(p[k]);
}

// Writes the positions of the kept strands at a time to `to`.
static void place_all(const Made *made, double time, float (*to)[3])
{
    const SceneHair *hair = made->hair;
    const Strands *kept = &made->source->strands;
    float(*at)[3] = made->room;
    for (uint32_t i = 0; i < made->count; ++i) {
        const Strands *set = &made->sets[i];
        double matrix[4][4];
        find_matrix(hair, made->object[i]->node, time, matrix);
        if (!reader_work(hair->reader, (uint64_t)set->vertex_count + set->strand_count, 200))
            return;
        basis_curves_place(&made->object[i]->curves, set, time, matrix, at);
        at += set->vertex_count;
    }
    for (uint32_t s = 0; s < kept->strand_count; ++s)
        memcpy(to[kept->first[s]], made->room[made->first[made->which[s]]],
               strands_size(kept, s) * sizeof *to);
}

static Result set_places(const Made *made)
{
    Reader *reader = made->hair->reader;
    FormatSource *source = made->source;
    const Strands *strands = &source->strands;
    if (reader->line) {
        source->vertex_line =
            reader_malloc(reader, strands->vertex_count, sizeof *source->vertex_line);
        if (!source->vertex_line) return reader->result;
    }
    uint32_t set = 0, end = made->sets[0].strand_count;
    for (uint32_t s = 0; s < strands->strand_count; ++s) {
        while (made->which[s] >= end) end += made->sets[++set].strand_count;
        const SceneObject *object = made->object[set];
        source->place[s] = object->place;
        for (uint32_t v = strands->first[s]; reader->line && v < strands->first[s + 1]; ++v)
            source->vertex_line[v] = (uint32_t)object->place;
    }
    return RESULT_OK;
}

static Result make_frames(const Made *made)
{
    const SceneHair *hair = made->hair;
    FormatSource *source = made->source;
    place_all(made, hair->time_count ? hair->time[0] : 0, source->strands.position);
    if (!hair->wishes.all_frames || hair->time_count < 2) return hair->reader->result;
    size_t each = source->strands.vertex_count;
    source->frames = reader_malloc_frames(hair->reader, hair->time_count, each);
    for (uint32_t f = 0; f < hair->time_count && reader_ok(hair->reader); ++f)
        place_all(made, hair->time[f], source->frames + f * each);
    return hair->reader->result;
}

static Result make_source(Made *made)
{
    SceneHair *hair = made->hair;
    FormatSource *source = made->source;
    Strands all = {0};
    hair->find_times(hair->file, hair, source);
    TRY(hair->reader->result);
    const FormatSource times = *source;
    unite_widths(made);
    const double widths = source->thickness_unit;
    Result result = join(made, &all);
    THEN(result, hair->reader->result);
    THEN(result, format_source_create(source, hair->reader, all.strand_count, all.vertex_count));
    if (result != RESULT_OK) {
        strands_destroy(&all);
        return result;
    }
    strands_destroy(&source->strands);
    source->strands = all;
    source->samples = times.samples;
    source->fps = times.fps;
    source->first_frame = times.first_frame;
    source->thickness_unit = widths;
    find_origin(made);
    memcpy(source->origin, hair->origin, sizeof source->origin);
    TRY(set_places(made));
    TRY(make_frames(made));
    return RESULT_OK;
}

// Lists the objects with their strands. Groups are those that set_groups made.
static void list_objects(const Made *made)
{
    const SceneHair *hair = made->hair;
    for (uint32_t i = 0, k = 0; i < hair->count; ++i) {
        const SceneObject *object = &hair->object[i];
        bool read = object->why == SCENE_READ && k < made->count;
        if (object->why == SCENE_EMPTY) continue;
        format_source_list(made->source, object->path, read ? made->sets[k].strand_count : 0,
                           read ? NULL : describe(object->why));
        k += read;
    }
}

static Result refuse(const SceneHair *hair, FormatSource *source, const Error *damage,
                     const char *otherwise)
{
    Reader *reader = hair->reader;
    if (*damage->text) { // it names the place
        reader->result = RESULT_BAD_INPUT;
        if (reader->error) *reader->error = *damage;
        return reader->result;
    }
    if (!reader->line) reader->at = 0;
    if (*source->note)
        return reader_fail(reader, "no curves that can be read (%s): expected hair", source->note);
    return reader_fail(reader, "%s", otherwise);
}

Result scene_hair_make(SceneHair *hair, FormatSource *source, const char *otherwise)
{
    Reader *reader = hair->reader;
    Made made = {.hair = hair, .source = source};
    Error damage = {""};
    for (uint32_t i = 0; i < hair->count; ++i) decide(hair, &hair->object[i]);
    bool shown = show_hidden(hair);
    made.object = reader_calloc(reader, (uint64_t)hair->count + 1, sizeof *made.object);
    made.sets = reader_calloc(reader, (uint64_t)hair->count + 1, sizeof *made.sets);
    if (reader_ok(reader)) make_all(&made, &damage);
    if (reader_ok(reader)) {
        note_left_out(hair, source, &damage);
        note_objects(hair, source);
        if (shown) format_source_note(source, "all curves are hidden: they are read all the same");
        if (made.count == 0) refuse(hair, source, &damage, otherwise);
    }
    for (uint32_t i = 0; i < made.count; ++i)
        source->used_points =
            source->used_points || strcmp(made.object[i]->curves.type, "linear") != 0;
    if (reader_ok(reader)) make_source(&made);
    if (reader_ok(reader)) list_objects(&made);
    if (reader_ok(reader) && hair->features) {
        char names[300];
        strands_features_describe(hair->features, names, sizeof names);
        format_source_flaw(source, "left out, since not all objects have it: %s", names);
    }
    for (uint32_t i = 0; made.sets && i < hair->count; ++i) strands_destroy(&made.sets[i]);
    free(made.sets);
    free(made.object);
    free(made.which);
    free(made.first);
    free(made.room);
    return reader->result;
}
