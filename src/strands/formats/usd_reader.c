// SPDX-License-Identifier: MIT
#include "strands/formats/usd_reader.h"
#include "strands/formats/usd_curves.h"
#include "strands/strands_join.h"

#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 64 };

bool usd_reader_matches(const Bytes *bytes)
{
    return bytes->size >= 5 && memcmp(bytes->data, "#usda", 5) == 0;
}

// --- Prims.

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
        size_t known = strlen(USD_ARRAY_NAMES[i]);
        if (strncmp(name, USD_ARRAY_NAMES[i], known) != 0) continue;
        if (strcmp(name + known, ":indices") == 0)
            reader_fail(reader, "%s: indexed primvars are not read", USD_ARRAY_NAMES[i]);
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

// What tractrix itself puts into customData; the rest is passed over.
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
    usd_curves_make(&sets[usd->count++], reader, curves);
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
    usd_curves_destroy(&curves);
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

static Result join(Usd *usd, StrandsSource *source)
{
    Reader *reader = usd->reader;
    Strands all;
    if (strands_join(&all, usd->sets, usd->count, NULL) != RESULT_OK)
        return reader_fail_memory(reader);
    if (strands_source_create(source, reader, all.strand_count, all.vertex_count) == RESULT_OK) {
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

Result usd_reader_read(StrandsSource *source, Reader *reader)
{
    Usd usd = {.reader = reader, .unit = 0.01f}; // what USD takes for granted
    read_layer(&usd);
    read_prims(&usd);
    if (reader->at < reader->size) reader_fail(reader, "a byte 0 within the text");
    if (reader_ok(reader) && usd.count == 0) reader_fail(reader, "no BasisCurves with points");
    if (reader_ok(reader) && !(usd.unit > 0)) reader_fail(reader, "metersPerUnit is not above 0");
    if (reader_ok(reader)) join(&usd, source);
    source->unit = usd.unit;
    source->up_z = usd.up_z;
    source->samples = usd.samples;
    for (uint32_t i = 0; i < usd.count; ++i) strands_destroy(&usd.sets[i]);
    free(usd.sets);
    free(usd.line);
    return reader->result;
}
