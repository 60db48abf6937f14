// SPDX-License-Identifier: MIT
// Reads `.usda`: all visible BasisCurves prims, in the order of the file, with the transforms of
// their parents and, if the caller wants them, all times. Hidden prims are left out and counted.
#include "formats/basis_curves.h"
#include "formats/foreign.h"
#include "formats/format.h"
#include "formats/usd_stage.h"
#include "formats/usd_write.h"
#include "strands/strands_edit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const USD_NAMES[CURVES_ARRAYS] = {
    "curveVertexCounts", "widths",       "primvars:displayColor", "primvars:displayOpacity",
    "primvars:st",       "primvars:st1", "primvars:thickness",    "primvars:mobility",
    "primvars:section"};

// A Material with the attributes of PhysicsCurvesDeformableMaterialAPI, in the file's units.
typedef struct UsdMaterial {
    int prim;
    uint64_t path; // hash
    Fibre fibre;
} UsdMaterial;

// What is made of a prim: curves, or a material if they are NULL.
typedef struct UsdObject {
    BasisCurves *curves;
    UsdMaterial material;
} UsdObject;

typedef struct Usd {
    Reader *reader;
    UsdStage stage;
    FormatWishes wishes;
    UsdMaterial *materials; // [material_count] of fibres
    uint32_t material_count;
    BasisCurves *curves; // [curves_count] only curves that have points
    uint32_t curves_count, left_out, other_curves, meshes;
} Usd;

// --- The schema of curves.

static void *begin_object(void *to, const char *type, int prim)
{
    Usd *usd = to;
    usd->other_curves += strcmp(type, "NurbsCurves") == 0 || strcmp(type, "HermiteCurves") == 0;
    usd->meshes += strcmp(type, "Mesh") == 0;
    bool is_material = strcmp(type, "Material") == 0;
    if (strcmp(type, "BasisCurves") != 0 && !is_material) return NULL;
    UsdObject *object = reader_malloc(usd->reader, 1, sizeof *object);
    if (object) *object = (UsdObject){.material = {.prim = prim, .fibre.poisson = -1}};
    if (!object || is_material) return object;
    object->curves = reader_malloc(usd->reader, 1, sizeof *object->curves);
    if (object->curves) {
        *object->curves = (BasisCurves){
            .names = USD_NAMES, .line = usd->reader->line, .prim = prim, .fibre.poisson = -1};
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

static bool read_attribute(void *to, void *object, const char *name, size_t length, bool samples,
                           char (**rate)[16])
{
    const Usd *usd = to;
    BasisCurves *curves = ((UsdObject *)object)->curves;
    Reader *reader = usd->reader;
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
    for (int i = 0; i < CURVES_ARRAYS; ++i) {
        size_t known = strlen(USD_NAMES[i]);
        if (strncmp(name, USD_NAMES[i], known) != 0) continue;
        bool indices = strncmp(name + known, ":indices", 8) == 0;
        if (known != length && !(indices && known + 8 == length)) continue;
        UsdValues *values = indices ? &curves->indices[i] : &curves->array[i];
        if (samples)
            read_first(reader, values);
        else
            usd_text_read_values(reader, values);
        if (!indices) *rate = &curves->rate[i];
        return true;
    }
    return false;
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

static void add_curves(Usd *usd, BasisCurves *curves)
{
    Reader *reader = usd->reader;
    if (!reader_ok(reader) || curves->points.count == 0 || curves->points.sample[0].count == 0)
        return; // an `over`, or no curves
    if (usd_stage_hides(&usd->stage, curves->prim)) {
        ++usd->left_out;
        return;
    }
    if (usd_stage_instances(&usd->stage, curves->prim))
        reader_fail(reader, "curves of a PointInstancer are not read: %s", USD_FLATTEN);
    BasisCurves *more =
        reader_realloc(reader, usd->curves, ((size_t)usd->curves_count + 1), sizeof *more);
    if (!more) {
        reader_fail_memory(reader);
        return;
    }
    usd->curves = more;
    usd->curves[usd->curves_count++] = *curves;
    *curves = (BasisCurves){0};
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
    if (object->curves) {
        add_curves(to, object->curves);
        basis_curves_destroy(object->curves);
        free(object->curves);
    } else {
        add_material(to, &object->material);
    }
    free(object);
}

static const UsdSchema CURVES = {begin_object, read_attribute, find_number, end_object};

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
    for (uint32_t i = 0; i < usd->curves_count && usd->material_count; ++i) {
        Fibre *fibre = &usd->curves[i].fibre;
        if (!reader_work(usd->reader, 64, 10)) return; // its parents
        UsdMaterial wanted = {.path = usd_stage_find_material(&usd->stage, usd->curves[i].prim)};
        const UsdMaterial *found = bsearch(&wanted, usd->materials, usd->material_count,
                                           sizeof *usd->materials, compare_paths);
        if (!found) continue;
        fibre_fill(fibre, &found->fibre);
        fibre->youngs_modulus *= kilograms;
        fibre->density *= kilograms;
    }
}

// --- Times.

// Without all_frames only the first sample of the points was read, but all samples of the
// transforms. Returns the number of times in the file.
static uint32_t find_times(Usd *usd, FormatSource *source, UsdTimes *times)
{
    for (uint32_t i = 0; i < usd->curves_count; ++i)
        usd_stage_add_times(&usd->stage, usd->curves[i].prim, &usd->curves[i].points, times);
    usd_times_sort(times);
    uint32_t in_file = times->count;
    for (uint32_t i = 0; i < usd->curves_count; ++i)
        if (usd->curves[i].points.in_file > in_file)
            in_file = (uint32_t)usd->curves[i].points.in_file;
    if (usd->wishes.all_frames && times->count > 1) usd_times_even_out(times, usd->reader);
    if (times->evened)
        format_source_note(source,
                           "time samples at unequal intervals: frames are interpolated at equal "
                           "ones, from time code %g to %g",
                           times->time[0], times->time[times->count - 1]);
    return in_file;
}

// --- Strands.

// Writes the positions of all curves at a time, one set after the other.
static void place_all(const Usd *usd, const Strands *sets, double time, float (*to)[3])
{
    for (uint32_t i = 0; i < usd->curves_count && reader_ok(usd->reader); ++i) {
        double matrix[4][4];
        usd_stage_find_matrix(&usd->stage, usd->curves[i].prim, time, matrix);
        if (!reader_work(usd->reader, (uint64_t)sets[i].vertex_count + sets[i].strand_count, 200))
            return;
        basis_curves_place(&usd->curves[i], &sets[i], time, matrix, to);
        to += sets[i].vertex_count;
    }
}

static Result make_source(const Usd *usd, FormatSource *source, const Strands *sets)
{
    Reader *reader = usd->reader;
    Strands all;
    if (strands_join(&all, sets, usd->curves_count, NULL) != RESULT_OK)
        return reader_fail_memory(reader);
    if (format_source_create(source, reader, all.strand_count, all.vertex_count) != RESULT_OK) {
        strands_destroy(&all);
        return reader->result;
    }
    strands_destroy(&source->strands);
    source->strands = all;
    source->vertex_line = reader_malloc(reader, all.vertex_count, sizeof *source->vertex_line);
    if (!source->vertex_line) return reader_fail_memory(reader);
    for (uint32_t i = 0, s = 0, v = 0; i < usd->curves_count; ++i) {
        uint32_t line = usd->curves[i].points.sample[0].line;
        for (uint32_t k = 0; k < sets[i].strand_count; ++k) source->place[s++] = line;
        for (uint32_t k = 0; k < sets[i].vertex_count; ++k) source->vertex_line[v++] = line;
    }
    return RESULT_OK;
}

static Result make_frames(const Usd *usd, FormatSource *source, const Strands *sets,
                          const UsdTimes *times)
{
    Reader *reader = usd->reader;
    size_t each = source->strands.vertex_count;
    source->frames = reader_malloc_frames(reader, times->count, each);
    for (uint32_t f = 0; f < times->count && reader_ok(reader); ++f)
        place_all(usd, sets, times->time[f], source->frames + f * each);
    source->samples = times->count;
    source->first_frame = times->first;
    return reader->result;
}

static Result make_strands(Usd *usd, FormatSource *source, Strands *sets, UsdTimes *times)
{
    Reader *reader = usd->reader;
    uint32_t cubic = 0;
    bind_materials(usd);
    for (uint32_t i = 0; i < usd->curves_count && reader_ok(reader); ++i) {
        basis_curves_make(&usd->curves[i], reader, usd->wishes.points_per_strand, &sets[i]);
        cubic += strcmp(usd->curves[i].type, "linear") != 0;
    }
    if (!reader_ok(reader)) return reader->result;
    source->used_points = cubic > 0;
    uint32_t in_file = find_times(usd, source, times);
    double first = times->count ? times->time[0] : 0;
    TRY(reader->result);
    for (uint32_t i = 0; i < usd->curves_count; ++i) {
        double matrix[4][4];
        usd_stage_find_matrix(&usd->stage, usd->curves[i].prim, first, matrix);
        TRY(reader->result);
        basis_curves_scale(&sets[i], matrix);
    }
    TRY(make_source(usd, source, sets));
    place_all(usd, sets, first, source->strands.position);
    source->samples = in_file;
    if (usd->wishes.all_frames && times->count > 1) return make_frames(usd, source, sets, times);
    return reader->result;
}

static void note_choices(const Usd *usd, FormatSource *source)
{
    uint32_t idle = usd_stage_count_idle(&usd->stage);
    if (usd->left_out)
        format_source_note(source,
                           "%u prims of curves are left out: they are inactive, invisible, "
                           "abstract or of purpose guide or proxy",
                           usd->left_out);
    if (usd->other_curves)
        format_source_note(source, "%u prims of NURBS or Hermite curves are left out",
                           usd->other_curves);
    if (idle) format_source_note(source, "%u transforms without xformOpOrder have no effect", idle);
}

static Result read(FormatSource *source, Reader *reader)
{
    Usd usd = {.reader = reader, .wishes = source->wishes};
    UsdTimes times = {.step = 1};
    usd_stage_read(&usd.stage, reader, &CURVES, &usd);
    note_choices(&usd, source);
    if (reader_ok(reader) && usd.curves_count == 0)
        reader_fail(reader,
                    *source->note ? "no BasisCurves with points (%s)"
                    : usd.meshes  ? "meshes without hair: " FOREIGN_WANTS_HAIR "%s"
                                  : "no BasisCurves with points%s",
                    source->note);
    Strands *sets = reader_calloc(reader, (size_t)usd.curves_count + 1, sizeof *sets);
    if (reader_ok(reader)) make_strands(&usd, source, sets, &times);
    source->unit = usd.stage.unit;
    source->up = usd.stage.up_z ? UP_Z : UP_Y;
    source->fps = usd_stage_rate(&usd.stage) / (times.step > 0 ? times.step : 1);
    for (uint32_t i = 0; sets && i < usd.curves_count; ++i) strands_destroy(&sets[i]);
    free(sets);
    usd_times_destroy(&times);
    free(usd.materials);
    for (uint32_t i = 0; i < usd.curves_count; ++i) basis_curves_destroy(&usd.curves[i]);
    free(usd.curves);
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
