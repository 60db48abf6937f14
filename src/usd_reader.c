// SPDX-License-Identifier: MIT
#include "usd_reader.h"

#include "strands_join.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 64, WORD_SIZE = 128 };

bool usd_reader_matches(const Bytes *bytes)
{
    return bytes->size >= 5 && memcmp(bytes->data, "#usda", 5) == 0;
}

// --- Words and values. The data ends with a zero.

static char here(const Reader *reader)
{
    return reader_ok(reader) ? (char)reader->data[reader->at] : 0;
}

static void step(Reader *reader)
{
    reader->line += here(reader) == '\n';
    reader->at += here(reader) != 0;
}

// The next character that is neither blank nor comment, 0 at the end; with `line` not beyond it.
static char peek(Reader *reader, bool line)
{
    for (;;) {
        char c = here(reader);
        if (c == '#')
            while (here(reader) && here(reader) != '\n') step(reader);
        else if (c == ' ' || c == '\t' || c == '\r' || c == ';' || (c == '\n' && !line))
            step(reader);
        else
            return c;
    }
}

static bool take(Reader *reader, char wanted)
{
    if (peek(reader, false) != wanted) return false;
    step(reader);
    return true;
}

static void expect(Reader *reader, char wanted)
{
    if (!reader_ok(reader) || take(reader, wanted)) return;
    reader_fail(reader, here(reader) ? "expected '%c'" : "expected '%c', got the end of the file",
                wanted);
}

static bool is_letter(char c)
{
    return isalnum((unsigned char)c) || (c && strchr("_:.+-", c)) || (c & 0x80);
}

// A name or a number, with `brackets` a type; cut if it is too long to be one that is known.
static void read_text(Reader *reader, char word[WORD_SIZE], bool brackets)
{
    size_t length = 0;
    char c = peek(reader, false);
    for (; is_letter(c) || (brackets && (c == '[' || c == ']')); c = here(reader)) {
        if (length < WORD_SIZE - 1) word[length++] = c;
        step(reader);
    }
    word[length] = 0;
    if (length == 0 && reader_ok(reader))
        reader_fail(reader, c ? "unexpected '%c'" : "the file ends within a prim", c);
}

static void read_word(Reader *reader, char word[WORD_SIZE])
{
    read_text(reader, word, false);
}

// A string in its quotes, 'x', "x" or with three of either; the first characters to `text`.
static void read_string(Reader *reader, char text[WORD_SIZE])
{
    char quote = peek(reader, false);
    text[0] = 0;
    if (quote != '"' && quote != '\'') {
        if (reader_ok(reader)) reader_fail(reader, "expected a string");
        return;
    }
    const uint8_t *at = reader->data + reader->at;
    int marks = at[1] == quote && at[2] == quote ? 3 : 1, found = 0;
    size_t length = 0;
    for (int i = 0; i < marks; ++i) step(reader);
    while (found < marks && here(reader)) {
        char c = here(reader);
        found = c == quote ? found + 1 : 0;
        if (c == '\\') step(reader);
        if (found == 0 && length < WORD_SIZE - 1) text[length++] = c;
        step(reader);
    }
    text[length] = 0;
    if (found < marks) reader_fail(reader, "a string without an end");
}

// Whatever value comes: brackets with all that is in them, a string, a path, an asset, a word.
static void skip_value(Reader *reader)
{
    char text[WORD_SIZE], c = peek(reader, false);
    int depth = 0;
    do {
        c = peek(reader, false);
        char end = c == '<' ? '>' : c == '@' ? '@' : 0;
        if (c == '"' || c == '\'') {
            read_string(reader, text);
        } else if (end) {
            do step(reader);
            while (here(reader) && here(reader) != end);
            step(reader);
        } else if (c && strchr("([{", c)) {
            ++depth, step(reader);
        } else if (c && strchr(")]}", c)) {
            --depth, step(reader);
        } else if (c && depth > 0) {
            step(reader);
        } else {
            read_word(reader, text);
        }
    } while (depth > 0 && reader_ok(reader) && here(reader));
    if (depth > 0) reader_fail(reader, "brackets without an end");
}

static float read_float(Reader *reader)
{
    char text[WORD_SIZE], *end;
    Reader before = *reader;
    read_word(reader, text);
    if (!reader->locale) reader->locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (!reader->locale) return (float)reader_fail_memory(reader);
    float value = strtof_l(text, &end, reader->locale);
    before.locale = reader->locale;
    if (!reader_ok(reader) || (end != text && !*end)) return value;
    *reader = before;
    reader_fail(reader, "expected a number, got '%.40s'", text);
    return 0;
}

// --- Arrays: all numbers between brackets, however they are grouped.

typedef struct Values {
    float *value;
    size_t count, room;
    uint32_t line; // 0: there are none
} Values;

static bool add_value(Reader *reader, Values *values, float value)
{
    if (values->count == values->room) {
        size_t room = 2 * values->room + 1024;
        float *more = realloc(values->value, room * sizeof *more);
        if (!more) return reader_fail_memory(reader) == RESULT_OK;
        values->value = more;
        values->room = room;
    }
    values->value[values->count++] = value;
    return true;
}

static void read_values(Reader *reader, Values *values)
{
    values->count = 0;
    if (peek(reader, false) != '[') { // None
        skip_value(reader);
        return;
    }
    step(reader);
    values->line = reader->line;
    while (!take(reader, ']') && reader_ok(reader)) {
        char c = here(reader);
        if (c == '(' || c == ')' || c == ',')
            step(reader);
        else
            add_value(reader, values, read_float(reader));
    }
}

// { time: value, ... }: the first of them. Returns how many there are.
static uint32_t read_samples(Reader *reader, Values *values)
{
    uint32_t count = 0;
    expect(reader, '{');
    while (reader_ok(reader) && !take(reader, '}')) {
        while (here(reader) && here(reader) != ':' && here(reader) != '\n') step(reader);
        expect(reader, ':');
        if (count++ == 0)
            read_values(reader, values);
        else
            skip_value(reader);
        take(reader, ',');
    }
    return count;
}

// --- Prims.

enum { COUNTS, POINTS, WIDTHS, COLOR, OPACITY, ST, ST1, THICKNESS, MOBILITY, ARRAYS };

static const char *const ARRAY_NAMES[ARRAYS] = {
    "curveVertexCounts",       "points",      "widths",       "primvars:displayColor",
    "primvars:displayOpacity", "primvars:st", "primvars:st1", "primvars:thickness",
    "primvars:mobility"};

typedef struct Curves {
    Values array[ARRAYS];
    char type[WORD_SIZE], wrap[WORD_SIZE];
    uint32_t line; // of the prim
    float followers, follower_radius, both_ends_fixed;
} Curves;

typedef struct Usd {
    Reader *reader;
    Strands *sets;           // [count] of each prim
    uint32_t *line;          // [count] of its points
    uint32_t count, samples; // of prims; of the times of any of their attributes
    float unit;
    bool up_z;
} Usd;

static void read_property_value(Usd *usd, Curves *curves, const char *name)
{
    Reader *reader = usd->reader;
    size_t length = strcspn(name, ".");
    bool samples = strcmp(name + length, ".timeSamples") == 0;
    if (curves && strcmp(name, "type") == 0) {
        read_string(reader, curves->type);
        return;
    }
    if (curves && strcmp(name, "wrap") == 0) {
        read_string(reader, curves->wrap);
        return;
    }
    for (int i = 0; curves && i < ARRAYS; ++i) {
        size_t known = strlen(ARRAY_NAMES[i]);
        if (strncmp(name, ARRAY_NAMES[i], known) != 0) continue;
        if (strcmp(name + known, ":indices") == 0)
            reader_fail(reader, "%s: indexed primvars are not read", ARRAY_NAMES[i]);
        if (known != length || (name[length] && !samples)) continue;
        uint32_t count = samples ? read_samples(reader, &curves->array[i]) : 0;
        if (count > usd->samples) usd->samples = count;
        if (!samples) read_values(reader, &curves->array[i]);
        return;
    }
    skip_value(reader);
}

// "uniform token[] name = value (metadata)"; the name is the last word. Returns whether it moves
// what is below.
static bool read_property(Usd *usd, Curves *curves, char name[WORD_SIZE])
{
    Reader *reader = usd->reader;
    char c = peek(reader, true);
    while (c && c != '=' && c != '(' && c != '}' && c != '\n' && reader_ok(reader)) {
        if (c == '"')
            skip_value(reader); // variantSet "name" = ...
        else
            read_text(reader, name, true);
        c = peek(reader, true);
    }
    if (take(reader, '=')) read_property_value(usd, curves, name);
    if (peek(reader, true) == '(') skip_value(reader);
    return strncmp(name, "xformOp:", 8) == 0;
}

// What tractrix itself puts into customData; the rest is passed over.
static void read_metadata(Reader *reader, Curves *curves)
{
    char word[WORD_SIZE];
    int depth = 0;
    do {
        char c = peek(reader, false);
        if (!c) break;
        depth += (c == '(' || c == '{' || c == '[') - (c == ')' || c == '}' || c == ']');
        if (!is_letter(c)) {
            if (c == '"' || c == '\'' || c == '@' || c == '<')
                skip_value(reader);
            else
                step(reader);
            continue;
        }
        read_word(reader, word);
        float *to = strcmp(word, "followers") == 0        ? &curves->followers
                    : strcmp(word, "followerRadius") == 0 ? &curves->follower_radius
                    : strcmp(word, "bothEndsFixed") == 0  ? &curves->both_ends_fixed
                                                          : NULL;
        if (to && take(reader, '=')) *to = read_float(reader);
    } while (depth > 0 && reader_ok(reader));
}

// --- From a prim to strands.

static void fail_count(Reader *reader, const Curves *curves, int array)
{
    reader->line = curves->array[array].line;
    reader_fail(reader, "%s: %zu numbers for these curves", ARRAY_NAMES[array],
                curves->array[array].count);
}

// Values of `width` floats, one for each vertex: as they are, or those of the strand, or the only
// one. NULL if there are none.
static float *spread(Reader *reader, const Curves *curves, int array, const Strands *strands,
                     size_t width)
{
    const Values *values = &curves->array[array];
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

// The values themselves, of which there must be so many.
static void *keep(Reader *reader, Curves *curves, int array, size_t count)
{
    Values *values = &curves->array[array];
    if (!values->line || values->count == 0 || !reader_ok(reader)) return NULL;
    if (values->count != count) fail_count(reader, curves, array);
    void *kept = values->value;
    values->value = NULL;
    return kept;
}

static void set_colors(Reader *reader, const Curves *curves, Strands *strands)
{
    float *color = spread(reader, curves, COLOR, strands, 3);
    float *opacity = spread(reader, curves, OPACITY, strands, 1);
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

static void set_attributes(Reader *reader, Curves *curves, Strands *strands)
{
    size_t strand_count = strands->strand_count, vertices = strands->vertex_count;
    strands->vertex_thickness = spread(reader, curves, WIDTHS, strands, 1);
    set_colors(reader, curves, strands);
    if (curves->array[ST].count == 2 * vertices)
        strands->vertex_uv = keep(reader, curves, ST, 2 * vertices);
    else
        strands->strand_uv = keep(reader, curves, ST, 2 * strand_count);
    if (!strands->vertex_uv) strands->vertex_uv = keep(reader, curves, ST1, 2 * vertices);
    strands->strand_thickness = keep(reader, curves, THICKNESS, strand_count);
    strands->mobility = keep(reader, curves, MOBILITY, vertices);
    strands->followers = (uint32_t)(curves->followers > 0 ? curves->followers : 0);
    strands->follower_radius = curves->follower_radius;
    strands->both_ends_fixed = curves->both_ends_fixed != 0;
}

static void set_sizes(Reader *reader, const Curves *curves, Strands *strands)
{
    const Values *counts = &curves->array[COUNTS];
    uint64_t vertices = 0;
    for (size_t s = 0; s < counts->count && reader_ok(reader); ++s) {
        float size = counts->value[s];
        if (!(size >= 0 && size <= strands->vertex_count && size == (float)(uint32_t)size))
            fail_count(reader, curves, COUNTS);
        if (reader_ok(reader)) vertices += (uint64_t)size;
        strands->first[s + 1] = (uint32_t)vertices;
        if (vertices > strands->vertex_count) break;
    }
    if (vertices != strands->vertex_count) fail_count(reader, curves, POINTS);
}

static void check_kind(Reader *reader, const Curves *curves)
{
    reader->line = curves->line;
    if (strcmp(curves->type, "linear") != 0)
        reader_fail(reader, "curves of type %s: only linear ones are read",
                    *curves->type ? curves->type : "cubic");
    if (strcmp(curves->wrap, "periodic") == 0)
        reader_fail(reader, "periodic curves: strands have ends");
}

static void add_curves(Usd *usd, Curves *curves)
{
    Reader *reader = usd->reader;
    const Values *points = &curves->array[POINTS];
    uint32_t line = reader->line;
    if (!reader_ok(reader) || points->count == 0) return; // an `over`, or empty
    check_kind(reader, curves);
    if (points->count % 3 || points->count >= UINT32_MAX ||
        curves->array[COUNTS].count >= UINT32_MAX)
        fail_count(reader, curves, POINTS);
    Strands *sets = realloc(usd->sets, ((size_t)usd->count + 1) * sizeof *sets);
    if (sets) usd->sets = sets;
    uint32_t *lines = realloc(usd->line, ((size_t)usd->count + 1) * sizeof *lines);
    if (lines) usd->line = lines;
    if (!sets || !lines) reader_fail_memory(reader);
    if (!reader_ok(reader)) return;
    Strands *strands = &sets[usd->count];
    lines[usd->count++] = points->line;
    if (strands_create(strands, (uint32_t)curves->array[COUNTS].count,
                       (uint32_t)(points->count / 3), NULL) != RESULT_OK)
        reader_fail_memory(reader);
    else
        memcpy(strands->position, points->value, points->count * sizeof(float));
    if (reader_ok(reader)) set_sizes(reader, curves, strands);
    if (reader_ok(reader)) set_attributes(reader, curves, strands);
    if (reader_ok(reader)) reader->line = line;
}

static void read_prim(Usd *usd, int depth);

static bool begins_prim(const char *word)
{
    return strcmp(word, "def") == 0 || strcmp(word, "over") == 0 || strcmp(word, "class") == 0;
}

static void read_body(Usd *usd, Curves *curves, int depth)
{
    Reader *reader = usd->reader;
    uint32_t before = usd->count, moved = 0;
    expect(reader, '{');
    while (reader_ok(reader) && !take(reader, '}')) {
        char word[WORD_SIZE];
        uint32_t line = reader->line;
        read_text(reader, word, true);
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
    Curves curves = {.line = reader->line};
    char type[WORD_SIZE] = "", name[WORD_SIZE];
    if (depth > DEEPEST) reader_fail(reader, "prims more than %d deep", DEEPEST);
    if (peek(reader, false) != '"') read_word(reader, type);
    if (peek(reader, false) == '"')
        read_string(reader, name);
    else
        reader_fail(reader, "expected a prim's name");
    if (peek(reader, false) == '(') read_metadata(reader, &curves);
    if (reader_ok(reader)) read_body(usd, strcmp(type, "BasisCurves") ? NULL : &curves, depth);
    for (int i = 0; i < ARRAYS; ++i) free(curves.array[i].value);
}

// --- The layer.

static void read_layer(Usd *usd)
{
    Reader *reader = usd->reader;
    char word[WORD_SIZE];
    if (!take(reader, '(')) return;
    while (reader_ok(reader) && !take(reader, ')')) {
        char c = here(reader);
        if (c == '"' || c == '\'') {
            read_string(reader, word);
            continue;
        }
        read_word(reader, word);
        if (!take(reader, '=')) continue; // "prepend"
        if (strcmp(word, "metersPerUnit") == 0)
            usd->unit = read_float(reader);
        else if (strcmp(word, "upAxis") == 0 && peek(reader, false) == '"')
            read_string(reader, word), usd->up_z = strcmp(word, "Z") == 0;
        else
            skip_value(reader);
    }
}

static void read_prims(Usd *usd)
{
    Reader *reader = usd->reader;
    char word[WORD_SIZE];
    while (reader_ok(reader) && peek(reader, false)) {
        read_word(reader, word);
        if (begins_prim(word))
            read_prim(usd, 0);
        else if (take(reader, '=')) // reorder rootPrims = ...
            skip_value(reader);
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
