// SPDX-License-Identifier: MIT
// Reads `.usda`: all BasisCurves prims that are drawn, in the order of the file, with the
// transforms of their parents and, if they are wanted, all times. Prims that are inactive,
// invisible, abstract (class, over) or of purpose guide or proxy are left out and counted. What
// would bring in other files or choose among versions (sublayers, references, variants, ...) is
// refused, since passing over it would give other hair.
#include "strands/formats/basis_curves.h"
#include "strands/formats/format.h"
#include "strands/formats/usd_text.h"
#include "strands/formats/usd_transform.h"
#include "strands/formats/usd_write.h"
#include "strands/strands_edit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 64 };

static const char *const USD_NAMES[CURVES_ARRAYS] = {
    "curveVertexCounts", "widths",       "primvars:displayColor", "primvars:displayOpacity",
    "primvars:st",       "primvars:st1", "primvars:thickness",    "primvars:mobility",
    "primvars:section"};

typedef struct UsdPrim {
    int parent; // -1: none
    UsdTransform transform;
    bool hidden, abstract, instancer;
} UsdPrim;

typedef struct Usd {
    Reader *reader;
    FormatWishes wishes;
    UsdPrim *prim; // [prim_count]
    int prim_count;
    BasisCurves *curves; // [curves_count] with points
    uint32_t curves_count, left_out, other_curves;
    float unit;
    double codes_per_second, frames_per_second; // 0: the file does not say
    bool up_z;
} Usd;

static const char FLATTEN[] = "expected one layer: usdcat --flatten FILE -o flat.usda";

// --- Properties.

static void read_samples(Usd *usd, BasisCurves *curves, UsdValues *only, bool points)
{
    Reader *reader = usd->reader;
    double time, last = -INFINITY;
    usd_text_expect(reader, '{');
    for (size_t count = 0; usd_text_next_sample(reader, &time); ++count) {
        if (time <= last)
            reader_fail(reader, "the time sample %g does not lie behind the one before it", time);
        last = time;
        if (points) curves->time_count = count + 1;
        if (count > 0 && !(points && usd->wishes.all_frames)) {
            usd_text_skip_value(reader);
            continue;
        }
        UsdValues values = {.time = time};
        usd_text_read_values(reader, &values);
        if (!points) {
            free(only->value);
            *only = values;
            continue;
        }
        UsdValues *more = realloc(curves->points, (curves->sample_count + 1) * sizeof *more);
        if (!more) {
            free(values.value);
            reader_fail_memory(reader);
            return;
        }
        curves->points = more;
        curves->points[curves->sample_count++] = values;
    }
}

static void read_points(Usd *usd, BasisCurves *curves, bool samples)
{
    if (curves->timed && !samples) { // samples win over the default
        usd_text_skip_value(usd->reader);
        return;
    }
    for (size_t i = 0; i < curves->sample_count; ++i) free(curves->points[i].value);
    curves->sample_count = 0;
    curves->timed = samples;
    if (samples) {
        read_samples(usd, curves, NULL, true);
        return;
    }
    UsdValues *one = realloc(curves->points, sizeof *one);
    if (!one) {
        reader_fail_memory(usd->reader);
        return;
    }
    *one = (UsdValues){0};
    curves->points = one;
    curves->sample_count = 1;
    usd_text_read_values(usd->reader, one);
}

// Returns which array the property is, or -1.
static int read_curves_value(Usd *usd, BasisCurves *curves, const char *name, size_t length,
                             bool samples)
{
    Reader *reader = usd->reader;
    struct {
        const char *name;
        char *text;
    } words[] = {{"type", curves->type}, {"basis", curves->basis}, {"wrap", curves->wrap}};
    for (int i = 0; i < 3; ++i)
        if (strcmp(name, words[i].name) == 0) {
            usd_text_read_string(reader, words[i].text);
            return CURVES_ARRAYS;
        }
    if (length == 6 && strncmp(name, "points", 6) == 0) {
        read_points(usd, curves, samples);
        return CURVES_ARRAYS;
    }
    for (int i = 0; i < CURVES_ARRAYS; ++i) {
        size_t known = strlen(USD_NAMES[i]);
        if (strncmp(name, USD_NAMES[i], known) != 0) continue;
        bool indices = strncmp(name + known, ":indices", 8) == 0;
        if (known != length && !(indices && known + 8 == length)) continue;
        UsdValues *to = indices ? &curves->indices[i] : &curves->array[i];
        if (samples)
            read_samples(usd, curves, to, false);
        else
            usd_text_read_values(reader, to);
        return indices ? CURVES_ARRAYS : i;
    }
    return -1;
}

static bool is_shown(const char *name, const char *word)
{
    if (strcmp(name, "visibility") == 0) return strcmp(word, "invisible") != 0;
    return strcmp(word, "guide") != 0 && strcmp(word, "proxy") != 0;
}

static int read_property_value(Usd *usd, int prim, BasisCurves *curves, const char *name)
{
    Reader *reader = usd->reader;
    size_t length = strcspn(name, ".");
    bool samples = strcmp(name + length, ".timeSamples") == 0;
    char word[USD_WORD_SIZE];
    if (name[length] && !samples) { // .connect
        usd_text_skip_value(reader);
    } else if (strncmp(name, "xformOp:", 8) == 0) {
        snprintf(word, sizeof word, "%.*s", (int)length, name);
        usd_transform_read_op(&usd->prim[prim].transform, reader, word, samples);
    } else if (strcmp(name, "xformOpOrder") == 0) {
        usd_transform_read_order(&usd->prim[prim].transform, reader);
    } else if ((strcmp(name, "visibility") == 0 || strcmp(name, "purpose") == 0) &&
               usd_text_peek(reader, false) == '"') {
        usd_text_read_string(reader, word);
        if (!is_shown(name, word)) usd->prim[prim].hidden = true;
    } else {
        int array = curves ? read_curves_value(usd, curves, name, length, samples) : -1;
        if (array < 0) usd_text_skip_value(reader);
        return array;
    }
    return -1;
}

// (interpolation = "vertex" ...)
static void read_rate(Reader *reader, char rate[16])
{
    char word[USD_WORD_SIZE];
    usd_text_expect(reader, '(');
    while (reader_ok(reader) && !usd_text_take(reader, ')')) {
        if (!usd_text_is_letter(usd_text_peek(reader, false))) {
            usd_text_skip_value(reader);
            continue;
        }
        usd_text_read_word(reader, word);
        if (!usd_text_take(reader, '=')) continue;
        if (strcmp(word, "interpolation") == 0) {
            usd_text_read_string(reader, word);
            snprintf(rate, 16, "%.15s", word);
        } else {
            usd_text_skip_value(reader);
        }
    }
}

// "uniform token[] name = value (metadata)"; the name is the last word.
static void read_property(Usd *usd, int prim, BasisCurves *curves, char name[USD_WORD_SIZE])
{
    Reader *reader = usd->reader;
    int array = -1;
    if (strcmp(name, "variantSet") == 0) reader_fail(reader, "variants are not read: %s", FLATTEN);
    char c = usd_text_peek(reader, true);
    while (c && c != '=' && c != '(' && c != '}' && c != '\n' && reader_ok(reader)) {
        if (c == '"')
            usd_text_skip_value(reader);
        else
            usd_text_read_type(reader, name);
        c = usd_text_peek(reader, true);
    }
    if (usd_text_take(reader, '=')) array = read_property_value(usd, prim, curves, name);
    if (usd_text_peek(reader, true) != '(') return;
    if (curves && array >= 0 && array < CURVES_ARRAYS)
        read_rate(reader, curves->rate[array]);
    else
        usd_text_skip_value(reader);
}

// --- Metadata of a prim.

// Whether what comes is None or empty brackets; it is stepped over.
static bool skip_empty(Reader *reader)
{
    size_t at = reader->at + 1;
    char c = usd_text_peek(reader, false);
    at = reader->at + 1;
    while (c == '[' && reader->data[at] && strchr(" \t\r\n", reader->data[at])) ++at;
    bool empty = (c == '[' && reader->data[at] == ']') ||
                 strncmp((const char *)reader->data + reader->at, "None", 4) == 0;
    usd_text_skip_value(reader);
    return empty;
}

static bool composes(const char *word)
{
    static const char *const arcs[] = {"references", "payload", "inherits", "specializes",
                                       "variantSets"};
    for (size_t i = 0; i < sizeof arcs / sizeof *arcs; ++i)
        if (strcmp(word, arcs[i]) == 0) return true;
    return false;
}

// What tractrix itself puts into customData, whether the prim is active, and what would compose it
// with others; the rest is ignored.
static void read_metadata(Usd *usd, int prim, BasisCurves *curves)
{
    Reader *reader = usd->reader;
    char word[USD_WORD_SIZE];
    int depth = 0;
    do {
        char c = usd_text_peek(reader, false);
        if (!c) break;
        depth += (c == '(' || c == '{' || c == '[') - (c == ')' || c == '}' || c == ']');
        if (!usd_text_is_letter(c)) {
            if (c == '"' || c == '\'' || c == '@' || c == '<')
                usd_text_skip_value(reader);
            else
                usd_text_step(reader);
            continue;
        }
        usd_text_read_word(reader, word);
        float *to = strcmp(word, "followers") == 0        ? &curves->followers
                    : strcmp(word, "followerRadius") == 0 ? &curves->follower_radius
                    : strcmp(word, "bothEndsFixed") == 0  ? &curves->both_ends_fixed
                                                          : NULL;
        if (to && usd_text_take(reader, '=')) *to = usd_text_read_float(reader);
        if (to || depth != 1 || usd_text_peek(reader, true) != '=') continue;
        if (strcmp(word, "active") == 0) {
            usd_text_take(reader, '=');
            usd_text_read_word(reader, word);
            if (strcmp(word, "false") == 0 || strcmp(word, "0") == 0) usd->prim[prim].hidden = true;
        } else if (composes(word)) {
            uint32_t line = reader->line;
            usd_text_take(reader, '=');
            if (skip_empty(reader)) continue;
            reader->line = line;
            reader_fail(reader, "%s are not read: %s", word, FLATTEN);
        }
    } while (depth > 0 && reader_ok(reader));
}

// --- Prims.

static void add_curves(Usd *usd, BasisCurves *curves)
{
    Reader *reader = usd->reader;
    if (!reader_ok(reader) || curves->sample_count == 0 || curves->points[0].count == 0)
        return; // an `over`, or empty
    bool hidden = false, instancer = false;
    for (int p = curves->prim; p >= 0; p = usd->prim[p].parent) {
        hidden = hidden || usd->prim[p].hidden || usd->prim[p].abstract;
        instancer = instancer || usd->prim[p].instancer;
    }
    if (hidden) {
        ++usd->left_out;
        return;
    }
    if (instancer) reader_fail(reader, "curves of a PointInstancer are not read: %s", FLATTEN);
    BasisCurves *more = realloc(usd->curves, ((size_t)usd->curves_count + 1) * sizeof *more);
    if (!more) {
        reader_fail_memory(reader);
        return;
    }
    usd->curves = more;
    usd->curves[usd->curves_count++] = *curves;
    *curves = (BasisCurves){0};
}

static void read_prim(Usd *usd, const char *specifier, int parent, int depth);

static bool begins_prim(const char *word)
{
    return strcmp(word, "def") == 0 || strcmp(word, "over") == 0 || strcmp(word, "class") == 0;
}

static void read_body(Usd *usd, int prim, BasisCurves *curves, int depth)
{
    Reader *reader = usd->reader;
    usd_text_expect(reader, '{');
    while (reader_ok(reader) && !usd_text_take(reader, '}')) {
        char word[USD_WORD_SIZE];
        usd_text_read_type(reader, word);
        if (begins_prim(word))
            read_prim(usd, word, prim, depth + 1);
        else
            read_property(usd, prim, curves, word);
    }
}

static int add_prim(Usd *usd, int parent)
{
    UsdPrim *more = realloc(usd->prim, ((size_t)usd->prim_count + 1) * sizeof *more);
    if (!more) {
        reader_fail_memory(usd->reader);
        return -1;
    }
    usd->prim = more;
    usd->prim[usd->prim_count] = (UsdPrim){.parent = parent};
    return usd->prim_count++;
}

static void read_prim(Usd *usd, const char *specifier, int parent, int depth)
{
    Reader *reader = usd->reader;
    BasisCurves curves = {.names = USD_NAMES, .line = reader->line};
    char type[USD_WORD_SIZE] = "", name[USD_WORD_SIZE];
    if (depth > DEEPEST) reader_fail(reader, "prims more than %d deep", DEEPEST);
    int prim = add_prim(usd, parent);
    if (prim < 0) return;
    usd->prim[prim].abstract = strcmp(specifier, "def") != 0;
    if (usd_text_peek(reader, false) != '"') usd_text_read_word(reader, type);
    if (usd_text_peek(reader, false) == '"')
        usd_text_read_string(reader, name);
    else
        reader_fail(reader, "expected a prim's name");
    bool ours = strcmp(type, "BasisCurves") == 0;
    usd->prim[prim].instancer = strcmp(type, "PointInstancer") == 0;
    usd->other_curves += strcmp(type, "NurbsCurves") == 0 || strcmp(type, "HermiteCurves") == 0;
    curves.prim = prim;
    if (usd_text_peek(reader, false) == '(') read_metadata(usd, prim, &curves);
    if (reader_ok(reader)) read_body(usd, prim, ours ? &curves : NULL, depth);
    if (ours) add_curves(usd, &curves);
    basis_curves_destroy(&curves);
}

// --- The layer.

static void read_layer_value(Usd *usd, const char *name)
{
    Reader *reader = usd->reader;
    char word[USD_WORD_SIZE];
    uint32_t line = reader->line;
    double *rate = strcmp(name, "timeCodesPerSecond") == 0 ? &usd->codes_per_second
                   : strcmp(name, "framesPerSecond") == 0  ? &usd->frames_per_second
                                                           : NULL;
    if (rate) {
        *rate = (double)usd_text_read_float(reader);
    } else if (strcmp(name, "metersPerUnit") == 0) {
        usd->unit = usd_text_read_float(reader);
    } else if (strcmp(name, "upAxis") == 0 && usd_text_peek(reader, false) == '"') {
        usd_text_read_string(reader, word);
        usd->up_z = strcmp(word, "Z") == 0;
    } else if (strcmp(name, "subLayers") == 0) {
        if (skip_empty(reader)) return;
        reader->line = line;
        reader_fail(reader, "subLayers are not read: %s", FLATTEN);
    } else {
        usd_text_skip_value(reader);
    }
}

static void read_layer(Usd *usd)
{
    Reader *reader = usd->reader;
    char word[USD_WORD_SIZE];
    if (!usd_text_take(reader, '(')) return;
    while (reader_ok(reader) && !usd_text_take(reader, ')')) {
        char c = usd_text_here(reader);
        if (c == '"' || c == '\'') {
            usd_text_read_string(reader, word);
            continue;
        }
        usd_text_read_word(reader, word);
        if (usd_text_take(reader, '=')) read_layer_value(usd, word); // else "prepend"
    }
}

static void read_prims(Usd *usd)
{
    Reader *reader = usd->reader;
    char word[USD_WORD_SIZE];
    while (reader_ok(reader) && usd_text_peek(reader, false)) {
        usd_text_read_word(reader, word);
        if (begins_prim(word))
            read_prim(usd, word, -1, 0);
        else if (usd_text_take(reader, '=')) // reorder rootPrims = ...
            usd_text_skip_value(reader);
    }
}

// --- Times.

typedef struct Times {
    double *time; // [count] rising; those at which the hair is looked at
    uint32_t count, in_file;
    int first;   // number of the first frame
    double step; // time codes from frame to frame
} Times;

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// All times of curves and of what moves them, to `times` unless it is NULL. Returns how many.
static size_t gather_times(const Usd *usd, double *times)
{
    size_t count = 0;
    for (uint32_t i = 0; i < usd->curves_count; ++i) {
        const BasisCurves *curves = &usd->curves[i];
        for (size_t k = 0; curves->timed && k < curves->sample_count; ++k, ++count)
            if (times) times[count] = curves->points[k].time;
        for (int p = curves->prim; p >= 0; p = usd->prim[p].parent)
            for (size_t op = 0; op < usd->prim[p].transform.op_count; ++op) {
                const UsdTrack *track = &usd->prim[p].transform.op[op].track;
                for (size_t k = 0; track->timed && k < track->count; ++k, ++count)
                    if (times) times[count] = track->time[k];
            }
    }
    return count;
}

// Times that are not evenly spaced become all whole time codes between the first and the last.
static void even_out(Times *times, FormatSource *source)
{
    double first = times->time[0], last = times->time[times->count - 1];
    double step = (last - first) / (times->count - 1);
    bool even = true;
    for (uint32_t i = 1; i < times->count; ++i)
        even = even && fabs(times->time[i] - times->time[i - 1] - step) <= 1e-6 * step;
    times->step = step;
    bool whole = even && fabs(step - 1) < 1e-9 && first == floor(first);
    times->first = whole && first >= 0 && first < 1e7 ? (int)first : 0;
    double from = ceil(first), count = floor(last) - from + 1;
    if (even || !(count >= 2 && count <= 1e6)) return;
    double *codes = malloc((size_t)count * sizeof *codes);
    if (!codes) return;
    for (uint32_t i = 0; i < (uint32_t)count; ++i) codes[i] = from + i;
    format_source_note(source,
                       "time samples at uneven distances: frames are the time codes %g to %g", from,
                       floor(last));
    free(times->time);
    *times = (Times){codes, (uint32_t)count, times->in_file, from >= 0 ? (int)from : 0, 1};
}

// Without all_frames only the first of the curves' samples are there, but all of the transforms'.
static Result find_times(const Usd *usd, FormatSource *source, Times *times)
{
    size_t count = gather_times(usd, NULL);
    *times = (Times){.time = malloc((count + 1) * sizeof *times->time), .step = 1};
    if (!times->time) return reader_fail_memory(usd->reader);
    gather_times(usd, times->time);
    qsort(times->time, count, sizeof *times->time, compare_doubles);
    for (size_t i = 0; i < count; ++i)
        if (i == 0 || times->time[i] > times->time[times->count - 1])
            times->time[times->count++] = times->time[i];
    times->in_file = times->count;
    for (uint32_t i = 0; i < usd->curves_count; ++i)
        if (usd->curves[i].time_count > times->in_file)
            times->in_file = (uint32_t)usd->curves[i].time_count;
    if (times->count == 0) times->time[0] = 0;
    if (usd->wishes.all_frames && times->count > 1) even_out(times, source);
    return RESULT_OK;
}

// --- Strands.

static void find_matrix(const Usd *usd, int prim, double time, double matrix[4][4])
{
    bool reset;
    usd_transform_evaluate(&usd->prim[prim].transform, usd->reader, time, matrix, &reset);
    for (int p = usd->prim[prim].parent; p >= 0 && !reset && reader_ok(usd->reader);
         p = usd->prim[p].parent) {
        double above[4][4];
        usd_transform_evaluate(&usd->prim[p].transform, usd->reader, time, above, &reset);
        usd_transform_multiply(matrix, matrix, above);
    }
}

// All curves at a time, one behind the other.
static void place_all(const Usd *usd, const Strands *sets, double time, float (*to)[3])
{
    for (uint32_t i = 0; i < usd->curves_count && reader_ok(usd->reader); ++i) {
        double matrix[4][4];
        find_matrix(usd, usd->curves[i].prim, time, matrix);
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
    source->vertex_line = malloc(all.vertex_count * sizeof *source->vertex_line + 1);
    if (!source->vertex_line) return reader_fail_memory(reader);
    for (uint32_t i = 0, s = 0, v = 0; i < usd->curves_count; ++i) {
        uint32_t line = usd->curves[i].points[0].line;
        for (uint32_t k = 0; k < sets[i].strand_count; ++k) source->place[s++] = line;
        for (uint32_t k = 0; k < sets[i].vertex_count; ++k) source->vertex_line[v++] = line;
    }
    return RESULT_OK;
}

static Result make_frames(const Usd *usd, FormatSource *source, const Strands *sets,
                          const Times *times)
{
    Reader *reader = usd->reader;
    size_t each = source->strands.vertex_count;
    double most = 64.0 * ((double)reader->size + 1e6), size = 12.0 * (double)each * times->count;
    if (size > most)
        return reader_fail(reader,
                           "%u frames of %zu vertices need %.0f MB: more than 64 times the "
                           "file",
                           times->count, each, size / 1e6);
    source->frames = malloc(each * times->count * sizeof *source->frames + 1);
    if (!source->frames) return reader_fail_memory(reader);
    for (uint32_t f = 0; f < times->count && reader_ok(reader); ++f)
        place_all(usd, sets, times->time[f], source->frames + f * each);
    source->samples = times->count;
    source->first_frame = times->first;
    return reader->result;
}

static Result make_strands(Usd *usd, FormatSource *source, Strands *sets, Times *times)
{
    Reader *reader = usd->reader;
    uint32_t cubic = 0;
    for (uint32_t i = 0; i < usd->curves_count && reader_ok(reader); ++i) {
        basis_curves_make(&usd->curves[i], reader, usd->wishes.points_per_strand, &sets[i]);
        cubic += strcmp(usd->curves[i].type, "linear") != 0;
    }
    if (!reader_ok(reader)) return reader->result;
    source->used_points = cubic > 0;
    TRY(find_times(usd, source, times));
    for (uint32_t i = 0; i < usd->curves_count; ++i) {
        double matrix[4][4];
        find_matrix(usd, usd->curves[i].prim, times->time[0], matrix);
        TRY(reader->result);
        basis_curves_scale(&sets[i], matrix);
    }
    TRY(make_source(usd, source, sets));
    place_all(usd, sets, times->time[0], source->strands.position);
    source->samples = times->in_file;
    if (usd->wishes.all_frames && times->count > 1) return make_frames(usd, source, sets, times);
    return reader->result;
}

static void note_choices(const Usd *usd, FormatSource *source)
{
    uint32_t idle = 0;
    for (int p = 0; p < usd->prim_count; ++p)
        idle += usd->prim[p].transform.op_count && !usd->prim[p].transform.line;
    if (usd->left_out)
        format_source_note(source,
                           "left out: %u prims of curves that are inactive, invisible, abstract or "
                           "of purpose guide or proxy",
                           usd->left_out);
    if (usd->other_curves)
        format_source_note(source, "left out: %u prims of NURBS or Hermite curves",
                           usd->other_curves);
    if (idle) format_source_note(source, "%u transforms without xformOpOrder have no effect", idle);
}

static void destroy(Usd *usd)
{
    for (int i = 0; i < usd->prim_count; ++i) usd_transform_destroy(&usd->prim[i].transform);
    for (uint32_t i = 0; i < usd->curves_count; ++i) basis_curves_destroy(&usd->curves[i]);
    free(usd->prim);
    free(usd->curves);
}

static Result read(FormatSource *source, Reader *reader)
{
    Usd usd = {.reader = reader, .wishes = source->wishes, .unit = 0.01f}; // USD's default
    Times times = {0};
    read_layer(&usd);
    read_prims(&usd);
    if (reader->at < reader->size) reader_fail(reader, "a byte 0 within the text");
    note_choices(&usd, source);
    if (reader_ok(reader) && usd.curves_count == 0)
        reader_fail(reader,
                    *source->note ? "no BasisCurves with points (%s)"
                                  : "no BasisCurves with points%s",
                    source->note);
    if (reader_ok(reader) && !(usd.unit > 0)) reader_fail(reader, "metersPerUnit is not above 0");
    Strands *sets = calloc((size_t)usd.curves_count + 1, sizeof *sets);
    if (!sets) reader_fail_memory(reader);
    if (reader_ok(reader)) make_strands(&usd, source, sets, &times);
    double codes = usd.codes_per_second > 0    ? usd.codes_per_second
                   : usd.frames_per_second > 0 ? usd.frames_per_second
                                               : 24; // USD's default
    source->unit = usd.unit;
    source->up = usd.up_z ? UP_Z : UP_Y;
    source->fps = codes / (times.step > 0 ? times.step : 1);
    for (uint32_t i = 0; sets && i < usd.curves_count; ++i) strands_destroy(&sets[i]);
    free(sets);
    free(times.time);
    destroy(&usd);
    return reader->result;
}

static bool match(const Bytes *bytes)
{
    return bytes->size >= 5 && memcmp(bytes->data, "#usda", 5) == 0;
}

const Format usd_format = {
    .name = "USD (.usda)",
    .suffix = ".usda",
    .features = UINT32_MAX,
    .text = true,
    .animated = true,
    .match = match,
    .read = read,
    .write = usd_write_strands,
};
