// SPDX-License-Identifier: MIT
// Reads `.usda`: all BasisCurves prims of type linear, by their points' value or first time sample.
// Layers, prims and properties of other kinds are ignored. Attributes have one value, or one
// for each strand or vertex, as their number shows; of several prims those are kept that all
// have. Fails at a transform of curves or above them, at cubic or periodic curves and at indexed
// primvars, since passing over these would give other hair.
#include "strands/formats/format.h"
#include "strands/formats/usd_text.h"
#include "strands/formats/usd_write.h"
#include "strands/strands_edit.h"

#include <stdlib.h>
#include <string.h>

// --- A BasisCurves prim as it stands in the file, and the strands that it is.

typedef enum UsdArray {
    USD_COUNTS,
    USD_POINTS,
    USD_WIDTHS,
    USD_COLOR,
    USD_OPACITY,
    USD_ST,
    USD_ST1,
    USD_THICKNESS,
    USD_MOBILITY,
    USD_ARRAYS
} UsdArray;

// Their attributes' names.
static const char *const ARRAY_NAMES[USD_ARRAYS] = {
    "curveVertexCounts",       "points",      "widths",       "primvars:displayColor",
    "primvars:displayOpacity", "primvars:st", "primvars:st1", "primvars:thickness",
    "primvars:mobility"};

typedef struct UsdCurves {
    UsdValues array[USD_ARRAYS];
    char type[USD_WORD_SIZE], wrap[USD_WORD_SIZE];
    uint32_t line; // of the prim
    float followers, follower_radius, both_ends_fixed;
} UsdCurves;

static void fail_count(Reader *reader, const UsdCurves *curves, int array)
{
    reader->line = curves->array[array].line;
    reader_fail(reader, "%s: %zu numbers for these curves", ARRAY_NAMES[array],
                curves->array[array].count);
}

// UsdValues of `width` floats, one for each vertex: as they are, or those of the strand, or the
// only one. NULL if there are none.
static float *spread(Reader *reader, const UsdCurves *curves, int array, const Strands *strands,
                     size_t width)
{
    const UsdValues *values = &curves->array[array];
    size_t count = values->count / width;
    bool each = count == strands->vertex_count, uniform = count == strands->strand_count;
    if (!values->line || values->count == 0 || !reader_ok(reader)) return NULL;
    if (values->count % width != 0 || !(each || uniform || count == 1)) {
        fail_count(reader, curves, array);
        return NULL;
    }
    float *spread = malloc(strands->vertex_count * width * sizeof *spread + 1);
    if (!spread) reader_fail_memory(reader);
    for (uint32_t s = 0; spread && s < strands->strand_count; ++s)
        for (uint32_t v = strands->first[s]; v < strands->first[s + 1]; ++v)
            memcpy(spread + v * width,
                   values->value + (each      ? v
                                    : uniform ? s
                                              : 0) *
                                       width,
                   width * sizeof *spread);
    return spread;
}

// The values themselves, of which there must be `count`.
static void *keep(Reader *reader, UsdCurves *curves, int array, size_t count)
{
    UsdValues *values = &curves->array[array];
    if (!values->line || values->count == 0 || !reader_ok(reader)) return NULL;
    if (values->count != count) fail_count(reader, curves, array);
    void *kept = values->value;
    values->value = NULL;
    return kept;
}

static void set_colors(Reader *reader, const UsdCurves *curves, Strands *strands)
{
    float *color = spread(reader, curves, USD_COLOR, strands, 3);
    float *opacity = spread(reader, curves, USD_OPACITY, strands, 1);
    bool any = color || opacity;
    if (any) strands->color = malloc(((size_t)strands->vertex_count + 1) * sizeof *strands->color);
    if (any && !strands->color) reader_fail_memory(reader);
    for (uint32_t v = 0; strands->color && v < strands->vertex_count; ++v) {
        for (int k = 0; k < 3; ++k) strands->color[v][k] = color ? color[3 * v + k] : 1;
        strands->color[v][3] = opacity ? opacity[v] : 1;
    }
    free(color);
    free(opacity);
}

static void set_attributes(Reader *reader, UsdCurves *curves, Strands *strands)
{
    size_t strand_count = strands->strand_count, vertices = strands->vertex_count;
    strands->vertex_thickness = spread(reader, curves, USD_WIDTHS, strands, 1);
    set_colors(reader, curves, strands);
    if (curves->array[USD_ST].count == 2 * vertices)
        strands->vertex_uv = keep(reader, curves, USD_ST, 2 * vertices);
    else
        strands->strand_uv = keep(reader, curves, USD_ST, 2 * strand_count);
    if (!strands->vertex_uv) strands->vertex_uv = keep(reader, curves, USD_ST1, 2 * vertices);
    strands->strand_thickness = keep(reader, curves, USD_THICKNESS, strand_count);
    strands->mobility = keep(reader, curves, USD_MOBILITY, vertices);
    strands->followers = (uint32_t)(curves->followers > 0 ? curves->followers : 0);
    strands->follower_radius = curves->follower_radius;
    strands->both_ends_fixed = curves->both_ends_fixed != 0;
}

static void set_sizes(Reader *reader, const UsdCurves *curves, Strands *strands)
{
    const UsdValues *counts = &curves->array[USD_COUNTS];
    uint64_t vertices = 0;
    for (size_t s = 0; s < counts->count && reader_ok(reader); ++s) {
        float size = counts->value[s];
        if (!(size >= 0 && size <= strands->vertex_count && size == (float)(uint32_t)size))
            fail_count(reader, curves, USD_COUNTS);
        if (reader_ok(reader)) vertices += (uint64_t)size;
        strands->first[s + 1] = (uint32_t)vertices;
        if (vertices > strands->vertex_count) break;
    }
    if (vertices != strands->vertex_count) fail_count(reader, curves, USD_POINTS);
}

static void check_kind(Reader *reader, const UsdCurves *curves)
{
    reader->line = curves->line;
    if (strcmp(curves->type, "linear") != 0)
        reader_fail(reader, "curves of type %s: only linear ones are read",
                    *curves->type ? curves->type : "cubic");
    if (strcmp(curves->wrap, "periodic") == 0)
        reader_fail(reader, "periodic curves: strands have ends");
}

// The strands of curves that have points; arrays move into them. Fails the reader, at the array's
// line, where an array's size does not fit the curves. The strands may be destroyed in either case.
static Result make_strands(Strands *strands, Reader *reader, UsdCurves *curves)
{
    const UsdValues *points = &curves->array[USD_POINTS];
    uint32_t line = reader->line;
    *strands = (Strands){0};
    check_kind(reader, curves);
    if (points->count % 3 || points->count >= UINT32_MAX ||
        curves->array[USD_COUNTS].count >= UINT32_MAX)
        fail_count(reader, curves, USD_POINTS);
    if (!reader_ok(reader)) return reader->result;
    if (strands_create(strands, (uint32_t)curves->array[USD_COUNTS].count,
                       (uint32_t)(points->count / 3), NULL) != RESULT_OK)
        return reader_fail_memory(reader);
    memcpy(strands->position, points->value, points->count * sizeof(float));
    set_sizes(reader, curves, strands);
    if (reader_ok(reader)) set_attributes(reader, curves, strands);
    if (reader_ok(reader)) reader->line = line;
    return reader->result;
}

static void curves_destroy(UsdCurves *curves)
{
    for (int i = 0; i < USD_ARRAYS; ++i) free(curves->array[i].value);
    *curves = (UsdCurves){0};
}

// --- Prims.

enum { DEEPEST = 64 };

typedef struct Usd {
    Reader *reader;
    Strands *sets;           // [count] of each prim
    uint32_t *line;          // [count] of its points
    uint32_t count, samples; // of prims; of the times of any of their attributes
    float unit;
    bool up_z;
} Usd;

static void read_property_value(Usd *usd, UsdCurves *curves, const char *name)
{
    Reader *reader = usd->reader;
    size_t length = strcspn(name, ".");
    bool samples = strcmp(name + length, ".timeSamples") == 0;
    if (curves && strcmp(name, "type") == 0) {
        usd_text_read_string(reader, curves->type);
        return;
    }
    if (curves && strcmp(name, "wrap") == 0) {
        usd_text_read_string(reader, curves->wrap);
        return;
    }
    for (int i = 0; curves && i < USD_ARRAYS; ++i) {
        size_t known = strlen(ARRAY_NAMES[i]);
        if (strncmp(name, ARRAY_NAMES[i], known) != 0) continue;
        if (strcmp(name + known, ":indices") == 0)
            reader_fail(reader, "%s: indexed primvars are not read", ARRAY_NAMES[i]);
        if (known != length || (name[length] && !samples)) continue;
        uint32_t count = samples ? usd_text_read_samples(reader, &curves->array[i]) : 0;
        if (count > usd->samples) usd->samples = count;
        if (!samples) usd_text_read_values(reader, &curves->array[i]);
        return;
    }
    usd_text_skip_value(reader);
}

// "uniform token[] name = value (metadata)"; the name is the last word. Returns whether it moves
// what is below.
static bool read_property(Usd *usd, UsdCurves *curves, char name[USD_WORD_SIZE])
{
    Reader *reader = usd->reader;
    char c = usd_text_peek(reader, true);
    while (c && c != '=' && c != '(' && c != '}' && c != '\n' && reader_ok(reader)) {
        if (c == '"')
            usd_text_skip_value(reader); // variantSet "name" = ...
        else
            usd_text_read_type(reader, name);
        c = usd_text_peek(reader, true);
    }
    if (usd_text_take(reader, '=')) read_property_value(usd, curves, name);
    if (usd_text_peek(reader, true) == '(') usd_text_skip_value(reader);
    return strncmp(name, "xformOp:", 8) == 0;
}

// What tractrix itself puts into customData; the rest is ignored.
static void read_metadata(Reader *reader, UsdCurves *curves)
{
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
    } while (depth > 0 && reader_ok(reader));
}

static void add_curves(Usd *usd, UsdCurves *curves)
{
    Reader *reader = usd->reader;
    if (!reader_ok(reader) || curves->array[USD_POINTS].count == 0) return; // an `over`, or empty
    Strands *sets = realloc(usd->sets, ((size_t)usd->count + 1) * sizeof *sets);
    if (sets) usd->sets = sets;
    uint32_t *lines = realloc(usd->line, ((size_t)usd->count + 1) * sizeof *lines);
    if (lines) usd->line = lines;
    if (!sets || !lines) {
        reader_fail_memory(reader);
        return;
    }
    lines[usd->count] = curves->array[USD_POINTS].line;
    make_strands(&sets[usd->count++], reader, curves);
}

static void read_prim(Usd *usd, int depth);

static bool begins_prim(const char *word)
{
    return strcmp(word, "def") == 0 || strcmp(word, "over") == 0 || strcmp(word, "class") == 0;
}

static void read_body(Usd *usd, UsdCurves *curves, int depth)
{
    Reader *reader = usd->reader;
    uint32_t before = usd->count, moved = 0;
    usd_text_expect(reader, '{');
    while (reader_ok(reader) && !usd_text_take(reader, '}')) {
        char word[USD_WORD_SIZE];
        uint32_t line = reader->line;
        usd_text_read_type(reader, word);
        if (begins_prim(word))
            read_prim(usd, depth + 1);
        else if (read_property(usd, curves, word))
            moved = line;
    }
    if (curves) add_curves(usd, curves);
    if (!moved || usd->count == before) return;
    reader->line = moved;
    reader_fail(reader, "curves with a transform: only untransformed ones are read");
}

static void read_prim(Usd *usd, int depth)
{
    Reader *reader = usd->reader;
    UsdCurves curves = {.line = reader->line};
    char type[USD_WORD_SIZE] = "", name[USD_WORD_SIZE];
    if (depth > DEEPEST) reader_fail(reader, "prims more than %d deep", DEEPEST);
    if (usd_text_peek(reader, false) != '"') usd_text_read_word(reader, type);
    if (usd_text_peek(reader, false) == '"')
        usd_text_read_string(reader, name);
    else
        reader_fail(reader, "expected a prim's name");
    if (usd_text_peek(reader, false) == '(') read_metadata(reader, &curves);
    if (reader_ok(reader)) read_body(usd, strcmp(type, "BasisCurves") ? NULL : &curves, depth);
    curves_destroy(&curves);
}

// --- The layer.

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
        if (!usd_text_take(reader, '=')) continue; // "prepend"
        if (strcmp(word, "metersPerUnit") == 0)
            usd->unit = usd_text_read_float(reader);
        else if (strcmp(word, "upAxis") == 0 && usd_text_peek(reader, false) == '"')
            usd_text_read_string(reader, word), usd->up_z = strcmp(word, "Z") == 0;
        else
            usd_text_skip_value(reader);
    }
}

static void read_prims(Usd *usd)
{
    Reader *reader = usd->reader;
    char word[USD_WORD_SIZE];
    while (reader_ok(reader) && usd_text_peek(reader, false)) {
        usd_text_read_word(reader, word);
        if (begins_prim(word))
            read_prim(usd, 0);
        else if (usd_text_take(reader, '=')) // reorder rootPrims = ...
            usd_text_skip_value(reader);
    }
}

static Result join(Usd *usd, FormatSource *source)
{
    Reader *reader = usd->reader;
    Strands all;
    if (strands_join(&all, usd->sets, usd->count, NULL) != RESULT_OK)
        return reader_fail_memory(reader);
    if (format_source_create(source, reader, all.strand_count, all.vertex_count) == RESULT_OK) {
        strands_destroy(&source->strands);
        source->strands = all;
        source->vertex_line = malloc(all.vertex_count * sizeof *source->vertex_line + 1);
        if (!source->vertex_line) return reader_fail_memory(reader);
        for (uint32_t i = 0, s = 0, v = 0; i < usd->count; ++i) {
            for (uint32_t k = 0; k < usd->sets[i].strand_count; ++k)
                source->place[s++] = usd->line[i];
            for (uint32_t k = 0; k < usd->sets[i].vertex_count; ++k)
                source->vertex_line[v++] = usd->line[i];
        }
    } else {
        strands_destroy(&all);
    }
    return reader->result;
}

static Result read(FormatSource *source, Reader *reader)
{
    Usd usd = {.reader = reader, .unit = 0.01f}; // what USD takes for granted
    read_layer(&usd);
    read_prims(&usd);
    if (reader->at < reader->size) reader_fail(reader, "a byte 0 within the text");
    if (reader_ok(reader) && usd.count == 0) reader_fail(reader, "no BasisCurves with points");
    if (reader_ok(reader) && !(usd.unit > 0)) reader_fail(reader, "metersPerUnit is not above 0");
    if (reader_ok(reader)) join(&usd, source);
    source->unit = usd.unit;
    source->up = usd.up_z ? UP_Z : UP_Y;
    source->samples = usd.samples;
    for (uint32_t i = 0; i < usd.count; ++i) strands_destroy(&usd.sets[i]);
    free(usd.sets);
    free(usd.line);
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
