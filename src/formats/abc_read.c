// SPDX-License-Identifier: MIT
// Reads `.abc`, Alembic's Ogawa files: lists the objects of curves, with the transforms above them,
// their samples and the attributes of AbcGeom, of Unreal's groom schema (groom_...) and of Houdini
// (Cd, pscale, width). scene_hair.h decides what is read.
#include "formats/abc_write.h"
#include "formats/alembic.h"
#include "formats/foreign.h"
#include "formats/scene_hair.h"

#include <stdlib.h>
#include <string.h>

static const char *const NAMES[CURVES_ARRAYS] = {"nVertices", "width",    "groom_color",
                                                 "opacity",   "uv",       "st1",
                                                 "thickness", "mobility", "groom_group_id"};

// Values of AbcGeom's CurveType and BasisType.
static const char *const TYPES[] = {"cubic", "linear"};
static const char *const BASES[] = {"none", "bezier", "bspline", "catmullRom", "hermite", "power"};

typedef struct Abc {
    Alembic alembic;
    SceneHair hair;
    FormatSource *source;
    uint32_t meshes;
} Abc;

// Takes over `number`, `stride` numbers an item, of which `width` from `offset` on are kept.
static UsdValues to_values(Reader *reader, double *number, size_t count, uint32_t stride,
                           uint32_t offset, uint32_t width)
{
    UsdValues values = {0};
    size_t items = count / stride;
    if (number) values.value = reader_malloc(reader, items * width, sizeof *values.value);
    for (size_t i = 0; values.value && i < items; ++i)
        for (uint32_t k = 0; k < width; ++k)
            values.value[i * width + k] = (float)number[i * stride + offset + k];
    if (values.value) values.count = values.room = items * width, values.line = 1;
    return values;
}

// --- Attributes.

// The sources of the arrays, in the order in which they count. `more`: another number of components
// that is understood; colours of four have the opacity.
static const struct Source {
    const char *name;
    CurvesArray array;
    uint32_t more;
    bool arbitrary, centimetres;
    float scale; // 2 for radii
} SOURCES[] = {
    {"width", CURVES_DIAMETERS, 0, false, false, 1},
    {"width", CURVES_DIAMETERS, 0, true, false, 1},
    {"widths", CURVES_DIAMETERS, 0, true, false, 1},
    {"groom_width", CURVES_DIAMETERS, 0, true, true, 1},
    {"pscale", CURVES_DIAMETERS, 0, true, false, 2},
    {"radius", CURVES_DIAMETERS, 0, true, false, 2},
    {"uv", CURVES_ST, 3, false, false, 1},
    {"groom_root_uv", CURVES_ST, 3, true, false, 1},
    {"uv", CURVES_ST, 3, true, false, 1},
    {"groom_color", CURVES_COLOR, 4, true, false, 1},
    {"Cd", CURVES_COLOR, 4, true, false, 1},
    {"displayColor", CURVES_COLOR, 4, true, false, 1},
    {"opacity", CURVES_OPACITY, 0, true, false, 1},
    {"Alpha", CURVES_OPACITY, 0, true, false, 1},
    {"displayOpacity", CURVES_OPACITY, 0, true, false, 1},
    {"st1", CURVES_ST1, 3, true, false, 1},
    {"thickness", CURVES_THICKNESS, 0, true, false, 1},
    {"mobility", CURVES_MOBILITY, 0, true, false, 1},
    {"groom_group_id", CURVES_GROUP, 0, true, false, 1},
};

static bool read_source(Abc *abc, SceneObject *object, const OgawaProperties *of,
                        const struct Source *source)
{
    Ogawa *file = &abc->alembic.file;
    UsdValues *values = &object->curves.array[source->array];
    uint32_t width = CURVES_WIDTHS[source->array], extent = ogawa_extent(file, of, source->name);
    uint32_t stride = extent == source->more && extent ? extent : width;
    size_t count;
    if (extent == 0 || values->line) return false;
    double *number = ogawa_parameter(file, of, source->name, stride, &count);
    *values = to_values(file->reader, number, count, stride, 0, width);
    for (size_t i = 0; i < values->count && source->scale != 1; ++i)
        values->value[i] *= source->scale;
    UsdValues *opacity = &object->curves.array[CURVES_OPACITY];
    if (number && source->array == CURVES_COLOR && stride == 4 && !opacity->line)
        *opacity = to_values(file->reader, number, count, 4, 3, 1);
    free(number);
    return values->line != 0;
}

// Groups by the names of groom_group_name, numbered in the order in which they appear.
static void read_group_names(Abc *abc, SceneObject *object, const OgawaProperties *arbitrary)
{
    Ogawa *file = &abc->alembic.file;
    const OgawaProperty *property = ogawa_find(arbitrary, "groom_group_name");
    UsdValues *groups = &object->curves.array[CURVES_GROUP];
    if (!property || groups->line) return;
    OgawaProperties inner = {0};
    const OgawaProperty *indices = NULL;
    if (property->compound) {
        inner = ogawa_compound(file, arbitrary, "groom_group_name");
        property = ogawa_find(&inner, ".vals");
        indices = ogawa_find(&inner, ".indices");
    }
    size_t count = 0, wanted = 0;
    char *texts = property ? ogawa_texts(file, property, &count) : NULL;
    double *index = texts && indices ? ogawa_numbers(file, indices, 0, &wanted) : NULL;
    const char **text = texts ? reader_malloc(file->reader, count, sizeof *text) : NULL;
    float *number = text ? reader_malloc(file->reader, count, sizeof *number) : NULL;
    if (!index) wanted = count;
    if (number) groups->value = reader_malloc(file->reader, wanted, sizeof *groups->value);
    float next = 0;
    const char *at = texts;
    for (size_t i = 0; groups->value && i < count; at += strlen(at) + 1, ++i) {
        text[i] = at;
        number[i] = -1;
        if (!reader_work(file->reader, i + 1, 5)) break;
        for (size_t k = 0; k < i && number[i] < 0; ++k)
            if (strcmp(text[k], at) == 0) number[i] = number[k];
        if (number[i] < 0) number[i] = next++;
    }
    for (size_t i = 0; groups->value && reader_ok(file->reader) && i < wanted; ++i) {
        size_t k = index ? index[i] >= 0 && index[i] < (double)count ? (size_t)index[i] : 0 : i;
        groups->value[groups->count++] = number[k];
    }
    groups->line = groups->count > 0;
    groups->room = groups->count;
    free(number);
    free(text);
    free(texts);
    free(index);
    ogawa_free(&inner);
}

static bool is_known(const char *name, bool arbitrary)
{
    static const char *const others[] = {"followers", "followerRadius", "bothEndsFixed",
                                         "groom_guide", "groom_group_name"},
                             *const own[] = {
                                 "P",          "nVertices", "curveBasisAndType", ".selfBnds",
                                 ".childBnds", "N",         ".arbGeomParams",    ".userProperties"};
    for (size_t i = 0; i < sizeof SOURCES / sizeof *SOURCES; ++i)
        if (SOURCES[i].arbitrary == arbitrary && strcmp(SOURCES[i].name, name) == 0) return true;
    for (size_t i = 0; arbitrary && i < sizeof others / sizeof *others; ++i)
        if (strcmp(others[i], name) == 0) return true;
    for (size_t i = 0; !arbitrary && i < sizeof own / sizeof *own; ++i)
        if (strcmp(own[i], name) == 0) return true;
    // The schema's version and name say nothing about a strand.
    return arbitrary && strncmp(name, "groom_version", 13) == 0;
}

static void list_unread(Abc *abc, const OgawaProperties *properties, bool arbitrary)
{
    for (uint32_t i = 0; i < properties->count; ++i)
        if (!is_known(properties->property[i].name, arbitrary))
            format_source_unread(abc->source, properties->property[i].name);
}

static void read_attributes(Abc *abc, SceneObject *object, const OgawaProperties *own)
{
    Ogawa *file = &abc->alembic.file;
    BasisCurves *curves = &object->curves;
    OgawaProperties arbitrary = ogawa_compound(file, own, ".arbGeomParams");
    for (size_t i = 0; i < sizeof SOURCES / sizeof *SOURCES; ++i)
        if (read_source(abc, object, SOURCES[i].arbitrary ? &arbitrary : own, &SOURCES[i]))
            object->centimetres = object->centimetres || SOURCES[i].centimetres;
    read_group_names(abc, object, &arbitrary);
    static const char *const wishes[] = {"followers", "followerRadius", "bothEndsFixed"};
    float *to[] = {&curves->followers, &curves->follower_radius, &curves->both_ends_fixed};
    size_t count;
    for (int i = 0; i < 3; ++i) {
        double *number = ogawa_parameter(file, &arbitrary, wishes[i], 1, &count);
        if (number && count == 1) *to[i] = (float)number[0];
        free(number);
    }
    object->guide = ogawa_parameter(file, &arbitrary, "groom_guide", 1, &object->guide_count);
    list_unread(abc, own, false);
    list_unread(abc, &arbitrary, true);
    ogawa_free(&arbitrary);
}

// --- Objects.

static void read_kind(Abc *abc, BasisCurves *curves, const OgawaProperties *own)
{
    Ogawa *file = &abc->alembic.file;
    const OgawaProperty *kind = ogawa_find(own, "curveBasisAndType");
    size_t count = 0;
    double *byte = kind && kind->samples ? ogawa_numbers(file, kind, 0, &count) : NULL;
    uint32_t type = count > 2 ? (uint32_t)byte[0] : 1, wrap = count > 2 ? (uint32_t)byte[1] : 0;
    uint32_t basis = count > 2 ? (uint32_t)byte[2] : 0;
    free(byte);
    // Type 2 has a variable order: NURBS.
    snprintf(curves->type, sizeof curves->type, "%s", type < 2 ? TYPES[type] : "nurbs");
    if (type != 1)
        snprintf(curves->basis, sizeof curves->basis, "%s",
                 basis < sizeof BASES / sizeof *BASES ? BASES[basis] : "unknown");
    // Only curves other than Bezier are pinned, so that hair begins at its first point, and get one
    // vertex for each control point.
    snprintf(curves->wrap, sizeof curves->wrap, "%s",
             wrap         ? "periodic"
             : basis == 1 ? ""
                          : "pinned");
    curves->per_segment = basis == 1 ? 0 : 1;
}

// Reads the positions of the first frame, or of all samples if the caller wants all frames.
static void read_points(Abc *abc, SceneObject *object, const OgawaProperty *position)
{
    Ogawa *file = &abc->alembic.file;
    UsdSamples *points = &object->curves.points;
    uint32_t samples = position->last && !object->curves.changes ? position->samples : 1;
    OgawaFrames frames = ogawa_frames(file, position->sampling, samples);
    bool whole =
        frames.count == samples; // otherwise the first frame is no sample, or not the first
    uint32_t read = abc->hair.wishes.all_frames || !whole ? samples : 1;
    points->timed = samples > 1;
    points->in_file = samples;
    points->sample = reader_calloc(file->reader, (size_t)read + 1, sizeof *points->sample);
    for (uint32_t i = 0; i < read && reader_ok(file->reader); ++i) {
        size_t count;
        double *number = ogawa_numbers(file, position, i, &count);
        points->sample[points->count++] = to_values(file->reader, number, count, 1, 0, 1);
        points->sample[i].time = ogawa_time(file, position->sampling, i);
        free(number);
    }
}

static void read_curves(Abc *abc, int i)
{
    Ogawa *file = &abc->alembic.file;
    const OgawaObject *in_file = &file->object[i];
    BasisCurves none = {.names = NAMES};
    SceneObject *object = scene_hair_add(&abc->hair, in_file->path, &none);
    if (!object) return;
    OgawaProperties own = ogawa_compound(file, &in_file->own, ".geom");
    const OgawaProperty *position = ogawa_find(&own, "P"), *sizes = ogawa_find(&own, "nVertices");
    object->node = i;
    object->place = file->reader->at = (size_t)in_file->group;
    object->why = abc->alembic.hidden[i] ? SCENE_HIDDEN : SCENE_READ;
    if (!position || !sizes || position->extent != 3 || !position->samples || !sizes->samples) {
        object->why = SCENE_EMPTY;
    } else {
        const struct Source counts = {"nVertices", CURVES_COUNTS, 0, false, false, 1};
        object->curves.changes = sizes->last != 0;
        read_source(abc, object, &own, &counts);
        read_kind(abc, &object->curves, &own);
        read_points(abc, object, position);
        read_attributes(abc, object, &own);
    }
    file->reader->at = (size_t)in_file->group;
    ogawa_free(&own);
}

// What other objects are called in the list of a file's objects; NULL: they hold nothing.
static const char *name_of(const char *schema)
{
    static const struct {
        const char *schema, *name;
    } names[] = {{"AbcGeom_PolyMesh", "a mesh"},         {"AbcGeom_SubD", "a mesh"},
                 {"AbcGeom_NuPatch", "a NURBS surface"}, {"AbcGeom_Points", "points"},
                 {"AbcGeom_Camera", "a camera"},         {"AbcGeom_Light", "a light"}};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i)
        if (strncmp(schema, names[i].schema, strlen(names[i].schema)) == 0) return names[i].name;
    return NULL;
}

static void read_all(Abc *abc)
{
    Ogawa *file = &abc->alembic.file;
    for (int i = 0; i < file->count && reader_ok(file->reader); ++i) {
        const char *schema = file->object[i].schema, *name = name_of(schema);
        abc->meshes += name && strcmp(name, "a mesh") == 0;
        if (name) format_source_list(abc->source, file->object[i].path, 0, name);
        if (strncmp(schema, "AbcGeom_Curve", 13) == 0) read_curves(abc, i);
    }
}

// --- Times.

// The frames are those of the object with the most samples.
static OgawaFrames find_frames(const Abc *abc)
{
    uint32_t most = 0, sampling = 0;
    for (uint32_t i = 0; i < abc->hair.count; ++i) {
        const SceneObject *object = &abc->hair.object[i];
        const Ogawa *file = &abc->alembic.file;
        if (object->why != SCENE_READ) continue;
        uint32_t samples = (uint32_t)object->curves.points.in_file, of = 0;
        OgawaProperties own =
            ogawa_compound((Ogawa *)file, &file->object[object->node].own, ".geom");
        const OgawaProperty *position = ogawa_find(&own, "P");
        if (position) of = position->sampling;
        ogawa_free(&own);
        alembic_longest(&abc->alembic, object->node, &of, &samples);
        if (samples > most) most = samples, sampling = of;
    }
    return ogawa_frames(&abc->alembic.file, sampling, most);
}

static void find_times(void *to, SceneHair *hair, FormatSource *source)
{
    Abc *abc = to;
    const Ogawa *file = &abc->alembic.file;
    const OgawaFrames frames = find_frames(abc);
    uint32_t count = hair->wishes.all_frames && frames.count > 1 ? frames.count : 1;
    bool even = true, own = frames.count == frames.samples;
    hair->time = reader_malloc(hair->reader, count, sizeof *hair->time);
    if (!hair->time || !reader_work(hair->reader, count, 20)) return;
    for (uint32_t i = 0; i < count; ++i) {
        hair->time[i] = frames.count > 1 ? ogawa_frame_time(file, &frames, i) : frames.start;
        even = even && (!own || hair->time[i] == ogawa_time(file, frames.sampling, i));
    }
    double first = frames.count > 1 ? hair->time[0] * frames.rate : 0;
    hair->time_count = count;
    source->samples = frames.count > 1 ? frames.count : 0;
    source->fps = frames.rate;
    source->first_frame = first > 0 && first < 1e7 ? (int)(first + 0.5) : 0;
    if (!even && count > 1)
        format_source_note(source,
                           "samples at unequal intervals: frames are interpolated between them");
}

static void find_matrix(void *to, int node, double time, double matrix[4][4])
{
    alembic_matrix(&((Abc *)to)->alembic, node, time, matrix);
}

static Result read(FormatSource *source, Reader *reader)
{
    Abc *abc = reader_calloc(reader, 1, sizeof *abc);
    if (!abc) return reader_fail_memory(reader);
    abc->source = source;
    abc->hair = (SceneHair){.reader = reader,
                            .wishes = source->wishes,
                            .file = abc,
                            .find_matrix = find_matrix,
                            .find_times = find_times};
    source->used_objects = true;
    if (alembic_open(&abc->alembic, reader) == RESULT_OK) read_all(abc);
    if (reader_ok(reader) && abc->alembic.file.lost_instances)
        format_source_flaw(source, "%u instances of objects that the file does not have",
                           abc->alembic.file.lost_instances);
    if (reader_ok(reader))
        scene_hair_make(&abc->hair, source,
                        abc->meshes ? "meshes without hair: " FOREIGN_WANTS_HAIR
                                    : "no curves: expected hair");
    if (reader_ok(reader)) {
        source->unit = (float)abc->alembic.file.unit;
        source->up = abc->alembic.file.up_z < 0 ? UP_AUTO : abc->alembic.file.up_z ? UP_Z : UP_Y;
    }
    scene_hair_destroy(&abc->hair);
    alembic_close(&abc->alembic);
    free(abc);
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
