// SPDX-License-Identifier: MIT
// Reads `.usda`: lists the BasisCurves prims, with the transforms of their parents, their samples
// and attributes, also those that a parent hands down. scene_hair.h decides what is read.
#include "formats/foreign.h"
#include "formats/scene_hair.h"
#include "formats/usd_stage.h"
#include "formats/usd_write.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const USD_NAMES[CURVES_ARRAYS] = {
    "curveVertexCounts", "widths",       "primvars:displayColor", "primvars:displayOpacity",
    "primvars:st",       "primvars:st1", "primvars:thickness",    "primvars:mobility",
    "primvars:section"};

// Other names under which programs write the arrays; of two that a prim has, the earlier one here
// counts only if the name above is missing.
static const struct {
    const char *name;
    CurvesArray array;
    float scale; // 2 for radii
} OTHER_NAMES[] = {
    {"primvars:widths", CURVES_DIAMETERS, 1},
    {"primvars:width", CURVES_DIAMETERS, 1},
    {"primvars:pscale", CURVES_DIAMETERS, 2},
    {"primvars:radius", CURVES_DIAMETERS, 2},
    {"primvars:Cd", CURVES_COLOR, 1},
    {"primvars:Alpha", CURVES_OPACITY, 1},
    {"primvars:uv", CURVES_ST, 1},
    {"primvars:groom_group_id", CURVES_GROUP, 1},
};

// A Material with the attributes of PhysicsCurvesDeformableMaterialAPI, in the file's units.
typedef struct UsdMaterial {
    int prim;
    uint64_t path; // hash
    Fibre fibre;
} UsdMaterial;

// What is made of a prim: curves, or a material if they are NULL. The curves of a group (Xform,
// Scope and the like) are only the arrays that it hands down.
typedef struct UsdObject {
    BasisCurves *curves;
    bool group, foreign;
    const char *name;              // of a prim that holds no curves; NULL for others
    uint32_t other[CURVES_ARRAYS]; // 1 + the number of the other name that gave the array
    UsdMaterial material;
} UsdObject;

// What a group hands down.
typedef struct UsdGroup {
    int prim;
    BasisCurves curves;
} UsdGroup;

typedef struct Usd {
    Reader *reader;
    UsdStage stage;
    FormatWishes wishes;
    FormatSource *source;
    SceneHair hair;
    UsdMaterial *materials; // [material_count] of fibres
    uint32_t material_count, group_count, meshes;
    UsdGroup *groups; // [group_count]
} Usd;

// --- The schema of curves.

// What prims that hold no curves are called in the list of a file's objects; NULL: they hold
// nothing.
static const char *name_of(const char *type)
{
    static const char *const names[][2] = {{"Mesh", "a mesh"},
                                           {"Points", "points"},
                                           {"Camera", "a camera"},
                                           {"NurbsPatch", "a surface"},
                                           {"PointInstancer", "instances"}};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i)
        if (strcmp(type, names[i][0]) == 0) return names[i][1];
    size_t length = strlen(type);
    return length > 5 && strcmp(type + length - 5, "Light") == 0 ? "a light" : NULL;
}

static void *begin_object(void *to, const char *type, int prim)
{
    Usd *usd = to;
    bool foreign = strcmp(type, "NurbsCurves") == 0 || strcmp(type, "HermiteCurves") == 0;
    bool is_curves = strcmp(type, "BasisCurves") == 0 || foreign;
    bool is_material = strcmp(type, "Material") == 0;
    bool is_group = !*type || strcmp(type, "Xform") == 0 || strcmp(type, "Scope") == 0 ||
                    strcmp(type, "SkelRoot") == 0;
    usd->meshes += strcmp(type, "Mesh") == 0;
    const char *name = name_of(type);
    if (!is_curves && !is_material && !is_group && !name) return NULL;
    UsdObject *object = reader_malloc(usd->reader, 1, sizeof *object);
    if (object)
        *object = (UsdObject){.group = is_group,
                              .foreign = foreign,
                              .name = name,
                              .material = {.prim = prim, .fibre.poisson = -1}};
    if (!object || is_material || name) return object;
    object->curves = reader_malloc(usd->reader, 1, sizeof *object->curves);
    if (object->curves) {
        *object->curves =
            (BasisCurves){.names = USD_NAMES, .line = usd->reader->line, .fibre.poisson = -1};
        return object;
    }
    free(object);
    return NULL;
}

// Reads the first sample of an attribute that is not animated.
static void read_first(Reader *reader, UsdValues *only)
{
    UsdSamples samples = {0};
    usd_samples_read(&samples, reader, true, false);
    if (samples.count) {
        free(only->value);
        *only = samples.sample[0];
        samples.count = 0;
    }
    usd_samples_destroy(&samples);
}

// The numbers of points of the curves, at the first sample; notes whether they change.
static void read_counts(Reader *reader, BasisCurves *curves)
{
    UsdSamples samples = {0};
    UsdValues *only = &curves->array[CURVES_COUNTS];
    usd_samples_read(&samples, reader, true, true);
    for (size_t i = 1; i < samples.count; ++i) {
        const UsdValues *a = &samples.sample[0], *b = &samples.sample[i];
        curves->changes = curves->changes || a->count != b->count ||
                          memcmp(a->value, b->value, a->count * sizeof *a->value) != 0;
    }
    if (samples.count) {
        free(only->value);
        *only = samples.sample[0];
        samples.sample[0] = (UsdValues){0};
    }
    usd_samples_destroy(&samples);
}

// Numbers that no material can have count as not given, as in Newton.
static double number_above(Reader *reader, double least, double most)
{
    double number = (double)usd_text_read_float(reader);
    return number > least && number <= most && isfinite(number) ? number : least;
}

static bool read_material(Reader *reader, Fibre *fibre, const char *name, bool samples)
{
    if (samples || usd_text_peek(reader, false) == 'N') return false; // None
    if (strcmp(name, "physics:youngsModulus") == 0)
        fibre->youngs_modulus = number_above(reader, 0, HUGE_VAL);
    else if (strcmp(name, "physics:density") == 0)
        fibre->density = number_above(reader, 0, HUGE_VAL);
    else if (strcmp(name, "physics:poissonsRatio") == 0)
        fibre->poisson = number_above(reader, -1, 0.5);
    else
        return false;
    return true;
}

// One thickness for all curves; thicknesses of single curves, segments or points are not used.
static void read_thickness(Reader *reader, Fibre *fibre)
{
    UsdValues values = {0};
    usd_text_read_values(reader, &values);
    if (values.count == 1 && values.value[0] > 0 && isfinite(values.value[0]))
        fibre->radius = (double)values.value[0] / 2;
    free(values.value);
}

// Whether the name (with `length` characters before ".timeSamples") is that of an array, or of its
// indices.
static bool is_array(const char *array, const char *name, size_t length, bool *indices)
{
    size_t known = strlen(array);
    if (strncmp(name, array, known) != 0) return false;
    *indices = known + 8 == length && strncmp(name + known, ":indices", 8) == 0;
    return known == length || *indices;
}

// Finds the array that has this name, or this other name.
static bool find_array(const UsdObject *object, const char *name, size_t length, bool *indices,
                       int *array, uint32_t *other)
{
    *other = 0;
    for (*array = 0; *array < CURVES_ARRAYS; ++*array)
        if (is_array(USD_NAMES[*array], name, length, indices)) return true;
    for (uint32_t i = 0; i < sizeof OTHER_NAMES / sizeof *OTHER_NAMES; ++i) {
        *array = (int)OTHER_NAMES[i].array;
        *other = i + 1;
        bool taken = object->curves->array[*array].line && object->other[*array] != *other;
        if (is_array(OTHER_NAMES[i].name, name, length, indices)) return !taken;
    }
    return false;
}

static bool read_array(const Usd *usd, UsdObject *object, const char *name, size_t length,
                       bool samples, char (**rate)[16])
{
    BasisCurves *curves = object->curves;
    bool indices;
    int array;
    uint32_t other;
    if (!find_array(object, name, length, &indices, &array, &other)) {
        bool known = strncmp(name, "primvars:", 9) != 0 || strncmp(name, "primvars:skel:", 14) == 0;
        if (!known && !object->group) format_source_unread(usd->source, name);
        return false;
    }
    UsdValues *values = indices ? &curves->indices[array] : &curves->array[array];
    if (samples)
        read_first(usd->reader, values);
    else
        usd_text_read_values(usd->reader, values);
    if (!indices) *rate = &curves->rate[array];
    object->other[array] = other;
    float scale = other && !indices ? OTHER_NAMES[other - 1].scale : 1;
    for (size_t i = 0; i < values->count && scale != 1; ++i) values->value[i] *= scale;
    return true;
}

static bool read_attribute(void *to, void *object, const char *name, size_t length, bool samples,
                           char (**rate)[16])
{
    const Usd *usd = to;
    BasisCurves *curves = ((UsdObject *)object)->curves;
    Reader *reader = usd->reader;
    if (((UsdObject *)object)->name) return false;
    if (!curves)
        return read_material(reader, &((UsdObject *)object)->material.fibre, name, samples);
    if (strcmp(name, "physics:thicknesses") == 0) {
        read_thickness(reader, &curves->fibre);
        return true;
    }
    struct {
        const char *name;
        char *text;
    } words[] = {{"type", curves->type}, {"basis", curves->basis}, {"wrap", curves->wrap}};
    for (int i = 0; i < 3; ++i)
        if (strcmp(name, words[i].name) == 0) {
            usd_text_read_string(reader, words[i].text);
            return true;
        }
    if (length == 6 && strncmp(name, "points", 6) == 0) {
        usd_samples_read(&curves->points, reader, samples, usd->wishes.all_frames);
        return true;
    }
    if (strncmp(name, "curveVertexCounts", length) == 0 && length == 17 && samples) {
        read_counts(reader, curves);
        return true;
    }
    return read_array(usd, object, name, length, samples, rate);
}

static float *find_number(void *object, const char *word)
{
    BasisCurves *curves = ((UsdObject *)object)->curves;
    if (!curves) return NULL;
    return strcmp(word, "followers") == 0        ? &curves->followers
           : strcmp(word, "followerRadius") == 0 ? &curves->follower_radius
           : strcmp(word, "bothEndsFixed") == 0  ? &curves->both_ends_fixed
                                                 : NULL;
}

static void set_why(const Usd *usd, SceneObject *object)
{
    const UsdStage *stage = &usd->stage;
    object->skinned = usd_stage_skins(stage, object->node) && !object->curves.points.timed;
    object->why = usd_stage_lacks(stage, object->node)       ? SCENE_ABSENT
                  : usd_stage_hides(stage, object->node)     ? SCENE_HIDDEN
                  : usd_stage_instances(stage, object->node) ? SCENE_SCATTERED
                                                             : SCENE_READ;
}

static void add_curves(Usd *usd, UsdObject *object, int prim)
{
    BasisCurves *curves = object->curves;
    SceneObject *added = scene_hair_add(&usd->hair, usd->stage.path, curves);
    if (!added) return;
    if (object->foreign) strcpy(added->curves.type, "foreign");
    *curves = (BasisCurves){0};
    added->node = prim;
    if (added->curves.points.count) added->place = added->curves.points.sample[0].line;
    set_why(usd, added);
    // NURBS and Hermite curves count whether they have points or not.
    if (object->foreign && added->why == SCENE_READ) added->why = SCENE_FOREIGN;
}

// Keeps the arrays of a group that are constant, and so hold for all that is below it
// (UsdGeomPrimvarsAPI::FindPrimvarWithInheritance).
static void add_group(Usd *usd, BasisCurves *curves, int prim)
{
    bool any = false;
    for (int i = CURVES_DIAMETERS; i < CURVES_ARRAYS; ++i)
        any = any || (curves->array[i].count &&
                      (!*curves->rate[i] || strcmp(curves->rate[i], "constant") == 0));
    if (!any || !reader_ok(usd->reader)) return;
    UsdGroup *more =
        reader_realloc(usd->reader, usd->groups, (uint64_t)usd->group_count + 1, sizeof *more);
    if (!more) return;
    usd->groups = more;
    usd->groups[usd->group_count++] = (UsdGroup){prim, *curves};
    *curves = (BasisCurves){0};
}

static const UsdGroup *find_group(const Usd *usd, int prim)
{
    for (uint32_t i = 0; i < usd->group_count; ++i)
        if (usd->groups[i].prim == prim) return &usd->groups[i];
    return NULL;
}

// Gives the curves the constant primvars of their nearest parents.
static void hand_down(Usd *usd, SceneObject *object)
{
    Reader *reader = usd->reader;
    for (int p = usd->stage.prim[object->node].parent; p >= 0; p = usd->stage.prim[p].parent) {
        if (!reader_work(reader, usd->group_count, 3)) return;
        const UsdGroup *group = find_group(usd, p);
        for (int i = CURVES_DIAMETERS; group && i < CURVES_ARRAYS; ++i) {
            const UsdValues *from = &group->curves.array[i];
            UsdValues *to = &object->curves.array[i];
            const char *rate = group->curves.rate[i];
            if (to->line || !from->count || (*rate && strcmp(rate, "constant") != 0)) continue;
            float *value = reader_malloc(reader, from->count, sizeof *value);
            if (!value) return;
            memcpy(value, from->value, from->count * sizeof *value);
            *to = *from;
            to->value = value;
            to->room = to->count;
            strcpy(object->curves.rate[i], "constant");
        }
    }
}

static void add_material(Usd *usd, const UsdMaterial *material)
{
    if (!reader_ok(usd->reader) || !fibre_is_known(&material->fibre)) return;
    UsdMaterial *more =
        reader_realloc(usd->reader, usd->materials, (size_t)usd->material_count + 1, sizeof *more);
    if (!more) {
        reader_fail_memory(usd->reader);
        return;
    }
    usd->materials = more;
    usd->materials[usd->material_count] = *material;
    usd->materials[usd->material_count++].path = usd->stage.prim[material->prim].path;
}

static void end_object(void *to, void *ended)
{
    UsdObject *object = ended;
    if (object->name) {
        format_source_list(((Usd *)to)->source, ((Usd *)to)->stage.path, 0, object->name);
    } else if (object->curves) {
        (object->group ? add_group(to, object->curves, object->material.prim)
                       : add_curves(to, object, object->material.prim));
        basis_curves_destroy(object->curves);
        free(object->curves);
    } else {
        add_material(to, &object->material);
    }
    free(object);
}

// The curves of a prim that another one repeats; a prim with points of its own keeps them.
static void repeat_object(void *to, int of, int prim, const char *path)
{
    Usd *usd = to;
    int from = -1;
    if (!reader_work(usd->reader, usd->hair.count, 3)) return;
    for (uint32_t i = 0; i < usd->hair.count; ++i) {
        SceneObject *object = &usd->hair.object[i];
        if (object->node == prim && object->curves.points.count) return;
        if (object->node == of && object->curves.points.count) from = (int)i;
    }
    if (from < 0) return;
    BasisCurves copy;
    basis_curves_copy(&copy, &usd->hair.object[from].curves, usd->reader);
    SceneObject *added = scene_hair_add(&usd->hair, path, &copy);
    if (!added) {
        basis_curves_destroy(&copy);
        return;
    }
    added->node = prim;
    added->place = usd->hair.object[from].place;
    set_why(usd, added);
}

static const UsdSchema CURVES = {"BasisCurves", begin_object, read_attribute,
                                 find_number,   end_object,   repeat_object};

// --- Materials.

static int compare_paths(const void *a, const void *b)
{
    uint64_t x = ((const UsdMaterial *)a)->path, y = ((const UsdMaterial *)b)->path;
    return (x > y) - (x < y);
}

// Gives the curves the materials that are bound to them.
static void bind_materials(Usd *usd)
{
    double kilograms = usd->stage.mass_unit > 0 ? (double)usd->stage.mass_unit : 1;
    if (usd->material_count)
        qsort(usd->materials, usd->material_count, sizeof *usd->materials, compare_paths);
    for (uint32_t i = 0; i < usd->hair.count && usd->material_count; ++i) {
        Fibre *fibre = &usd->hair.object[i].curves.fibre;
        if (!reader_work(usd->reader, 64, 10)) return; // its parents
        UsdMaterial wanted = {.path =
                                  usd_stage_find_material(&usd->stage, usd->hair.object[i].node)};
        const UsdMaterial *found = bsearch(&wanted, usd->materials, usd->material_count,
                                           sizeof *usd->materials, compare_paths);
        if (!found) continue;
        fibre_fill(fibre, &found->fibre);
        fibre->youngs_modulus *= kilograms;
        fibre->density *= kilograms;
    }
}

// --- Times.

// Without all_frames only the first frame of the points was read, but all samples of the
// transforms.
static void find_times(void *to, SceneHair *hair, FormatSource *source)
{
    Usd *usd = to;
    UsdTimes times = {.step = 1};
    size_t in_file = 0;
    for (uint32_t i = 0; i < hair->count; ++i) {
        const SceneObject *object = &hair->object[i];
        if (object->why != SCENE_READ) continue;
        usd_stage_add_times(&usd->stage, object->node, &object->curves.points, &times);
        if (object->curves.points.in_file > in_file) in_file = object->curves.points.in_file;
    }
    usd_times_sort(&times);
    if (times.count > in_file) in_file = times.count;
    if (hair->wishes.all_frames && times.count > 1) usd_times_even_out(&times, usd->reader);
    if (times.evened)
        format_source_note(source,
                           "time samples at unequal intervals: frames are interpolated at equal "
                           "ones, from time code %g to %g",
                           times.time[0], times.time[times.count - 1]);
    source->samples = hair->wishes.all_frames && times.count > 1 ? times.count : (uint32_t)in_file;
    source->first_frame = times.first;
    source->fps = usd_stage_rate(&usd->stage) / (times.step > 0 ? times.step : 1);
    hair->time = times.time;
    hair->time_count = times.count;
}

static void find_matrix(void *to, int node, double time, double matrix[4][4])
{
    usd_stage_find_matrix(&((Usd *)to)->stage, node, time, matrix);
}

static void note_stage(const Usd *usd, FormatSource *source)
{
    uint32_t idle = usd_stage_count_idle(&usd->stage), empty = usd_stage_count_empty(&usd->stage);
    uint32_t arcs = usd->stage.skipped_arcs;
    if (idle)
        format_source_note(source, "%u transform%s without xformOpOrder %s no effect", idle,
                           idle == 1 ? "" : "s", idle == 1 ? "has" : "have");
    if (empty)
        format_source_flaw(source, "%u operation%s of xformOpOrder %s no value: no effect", empty,
                           empty == 1 ? "" : "s", empty == 1 ? "has" : "have");
    if (arcs)
        format_source_flaw(source,
                           "%u reference%s, inherits, variants or the like of prims that hold no "
                           "hair are not read",
                           arcs, arcs == 1 ? "" : "s");
}

static Result read(FormatSource *source, Reader *reader)
{
    Usd usd = {.reader = reader, .wishes = source->wishes, .source = source};
    usd.hair = (SceneHair){.reader = reader,
                           .wishes = source->wishes,
                           .file = &usd,
                           .find_matrix = find_matrix,
                           .find_times = find_times};
    source->used_objects = true;
    usd_stage_read(&usd.stage, reader, &CURVES, &usd);
    for (uint32_t i = 0; i < usd.hair.count && usd.group_count && reader_ok(reader); ++i)
        hand_down(&usd, &usd.hair.object[i]);
    if (reader_ok(reader)) bind_materials(&usd);
    if (reader_ok(reader)) note_stage(&usd, source);
    if (reader_ok(reader))
        scene_hair_make(&usd.hair, source,
                        usd.meshes ? "meshes without hair: " FOREIGN_WANTS_HAIR
                                   : "no BasisCurves with points");
    source->unit = usd.stage.unit;
    source->up = usd.stage.up_z ? UP_Z : UP_Y;
    scene_hair_destroy(&usd.hair);
    for (uint32_t i = 0; i < usd.group_count; ++i) basis_curves_destroy(&usd.groups[i].curves);
    free(usd.groups);
    free(usd.materials);
    usd_stage_destroy(&usd.stage);
    return reader->result;
}

const Format usd_format = {
    .name = "USD (.usda)",
    .suffix = ".usda",
    .features = UINT32_MAX,
    .text = true,
    .animated = true,
    .match = usd_stage_matches,
    .read = read,
    .write = usd_write_strands,
};
