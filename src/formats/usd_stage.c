// SPDX-License-Identifier: MIT
#include "formats/usd_stage.h"
#include "base/rate.h"

#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 64 };

const char USD_FLATTEN[] = "expected one layer: usdcat --flatten FILE -o flat.usda";

// --- Paths, as hashes: 64-bit FNV-1a (Fowler, Noll, Vo) of "/Hair/Fibre".

static const uint64_t NO_PATH = 0xcbf29ce484222325u;

static uint64_t add_character(uint64_t path, char c)
{
    return (path ^ (uint8_t)c) * 0x100000001b3u;
}

static uint64_t add_name(uint64_t path, const char *name)
{
    path = add_character(path, '/');
    for (; *name; ++name) path = add_character(path, *name);
    return path;
}

// Reads the first path of a relationship, </A/B> or [</A/B>, ...]; 0 if there is none.
static uint64_t read_path(Reader *reader)
{
    Reader before = *reader;
    uint64_t path = NO_PATH;
    usd_text_take(reader, '[');
    bool found = usd_text_peek(reader, false) == '<';
    if (found) usd_text_step(reader);
    while (found && usd_text_here(reader) && usd_text_here(reader) != '>') {
        path = add_character(path, usd_text_here(reader));
        usd_text_step(reader);
    }
    if (reader_ok(reader)) *reader = before;
    usd_text_skip_value(reader);
    return found ? path : 0;
}

// --- Properties.

static bool is_shown(const char *name, const char *word)
{
    if (strcmp(name, "visibility") == 0) return strcmp(word, "invisible") != 0;
    return strcmp(word, "guide") != 0 && strcmp(word, "proxy") != 0;
}

static void read_property_value(UsdStage *stage, int prim, void *object, const char *name,
                                char (**rate)[16])
{
    Reader *reader = stage->reader;
    size_t length = strcspn(name, ".");
    bool samples = strcmp(name + length, ".timeSamples") == 0;
    char word[USD_WORD_SIZE];
    if (name[length] && !samples) { // such as .connect
        usd_text_skip_value(reader);
    } else if (strncmp(name, "xformOp:", 8) == 0) {
        snprintf(word, sizeof word, "%.*s", (int)length, name);
        usd_transform_read_op(&stage->prim[prim].transform, reader, word, samples);
    } else if (strcmp(name, "xformOpOrder") == 0) {
        usd_transform_read_order(&stage->prim[prim].transform, reader);
    } else if (strcmp(name, "material:binding:physics") == 0) {
        stage->prim[prim].bound[USD_FOR_PHYSICS] = read_path(reader);
    } else if (strcmp(name, "material:binding") == 0) {
        stage->prim[prim].bound[USD_FOR_ALL] = read_path(reader);
    } else if (strcmp(name, "visibility.timeSamples") == 0) {
        bool shown = false;
        double time;
        usd_text_expect(reader, '{');
        while (usd_text_next_sample(reader, &time)) {
            usd_text_read_string(reader, word);
            shown = shown || is_shown("visibility", word);
        }
        stage->prim[prim].hidden = !shown;
    } else if ((strcmp(name, "visibility") == 0 || strcmp(name, "purpose") == 0) &&
               usd_text_peek(reader, false) == '"') {
        usd_text_read_string(reader, word);
        if (!is_shown(name, word)) stage->prim[prim].hidden = true;
    } else if (!object || !stage->schema->read(stage->to, object, name, length, samples, rate)) {
        usd_text_skip_value(reader);
    }
}

// Reads (interpolation = "vertex" ...).
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

// Remembers that an arc of the prim is not followed.
static void set_arc(UsdStage *stage, int prim, const char *word, uint32_t line)
{
    if (stage->prim[prim].arc) return;
    stage->prim[prim].arc = word;
    stage->prim[prim].arc_line = line;
}

// Reads "uniform token[] name = value (metadata)"; the last word before the equals sign is the
// name.
static void read_property(UsdStage *stage, int prim, void *object, char name[USD_WORD_SIZE])
{
    Reader *reader = stage->reader;
    char(*rate)[16] = NULL;
    if (strcmp(name, "variantSet") == 0) {
        set_arc(stage, prim, "variants", reader->line);
        usd_text_skip_value(reader); // its name
        usd_text_take(reader, '=');
        usd_text_skip_value(reader);
        return;
    }
    char c = usd_text_peek(reader, true);
    while (c && c != '=' && c != '(' && c != '}' && c != '\n' && reader_ok(reader)) {
        if (c == '"' || c == '<') // a0.mapper[ <path> ]
            usd_text_skip_value(reader);
        else
            usd_text_read_type(reader, name);
        c = usd_text_peek(reader, true);
    }
    // Joints may be given on a parent, too.
    if (strncmp(name, "primvars:skel:jointIndices", 26) == 0) stage->prim[prim].skinned = true;
    if (usd_text_take(reader, '=')) read_property_value(stage, prim, object, name, &rate);
    char after = usd_text_peek(reader, true);
    if (after == '(' && rate)
        read_rate(reader, *rate);
    else if (after == '(')
        usd_text_skip_value(reader);
    if (usd_text_peek(reader, true) == '{')
        usd_text_skip_value(reader); // of a relationship's target
}

// --- Metadata of a prim.

// Skips a value, and returns whether it was None or empty brackets.
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

// The word of an arc; NULL for other metadata.
static const char *find_arc(const char *word)
{
    static const char *const arcs[] = {"references", "payload", "inherits", "specializes",
                                       "variantSets"};
    for (size_t i = 0; i < sizeof arcs / sizeof *arcs; ++i)
        if (strcmp(word, arcs[i]) == 0) return arcs[i];
    return NULL;
}

// Reads the value of an arc. If it is one path within the layer, returns its hash, otherwise 0.
static uint64_t read_source(Reader *reader)
{
    Reader before = *reader;
    bool list = usd_text_take(reader, '[');
    uint64_t path = usd_text_peek(reader, false) == '<' ? read_path(reader) : 0;
    bool one = path && (!list || usd_text_take(reader, ']'));
    if (one || !reader_ok(reader)) return path;
    *reader = before;
    usd_text_skip_value(reader);
    return 0;
}

static void add_arc(UsdStage *stage, int prim, uint64_t source, const char *word, uint32_t line,
                    uint32_t depth, const char *path)
{
    UsdArc *more =
        reader_realloc(stage->reader, stage->arc, (uint64_t)stage->arc_count + 1, sizeof *more);
    if (!more) return;
    stage->arc = more;
    UsdArc *arc = &more[stage->arc_count++];
    *arc = (UsdArc){.prim = prim, .source = source, .word = word, .line = line, .depth = depth};
    snprintf(arc->path, sizeof arc->path, "%s", path);
}

static void read_arc(UsdStage *stage, int prim, const char *word)
{
    Reader *reader = stage->reader, before = *reader;
    uint32_t line = reader->line;
    if (skip_empty(reader)) return;
    *reader = before;
    bool follows = strcmp(word, "variantSets") != 0 && strcmp(word, "payload") != 0;
    uint64_t source = follows ? read_source(reader) : 0;
    if (source)
        add_arc(stage, prim, source, word, line, 0, stage->path);
    else
        set_arc(stage, prim, word, line);
    if (!follows) usd_text_skip_value(reader);
}

// Reads the numbers of customData that the schema asks for, whether the prim is active, and arcs to
// other prims; ignores the rest.
static void read_metadata(UsdStage *stage, int prim, void *object)
{
    Reader *reader = stage->reader;
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
        bool asks = object && stage->schema->find_number;
        float *to = asks ? stage->schema->find_number(object, word) : NULL;
        if (to && usd_text_take(reader, '=')) *to = usd_text_read_float(reader);
        if (to || depth != 1 || usd_text_peek(reader, true) != '=') continue;
        if (strcmp(word, "active") == 0) {
            usd_text_take(reader, '=');
            usd_text_read_word(reader, word);
            if (strcmp(word, "false") == 0 || strcmp(word, "0") == 0)
                stage->prim[prim].absent = true;
        } else if (find_arc(word)) {
            usd_text_take(reader, '=');
            read_arc(stage, prim, find_arc(word));
        }
    } while (depth > 0 && reader_ok(reader));
}

// --- Prims.

static void read_prim(UsdStage *stage, const char *specifier, int parent, int depth);

static bool begins_prim(const char *word)
{
    return strcmp(word, "def") == 0 || strcmp(word, "over") == 0 || strcmp(word, "class") == 0;
}

static void read_body(UsdStage *stage, int prim, void *object, int depth)
{
    Reader *reader = stage->reader;
    usd_text_expect(reader, '{');
    while (reader_ok(reader) && !usd_text_take(reader, '}')) {
        char word[USD_WORD_SIZE];
        usd_text_read_type(reader, word);
        if (begins_prim(word))
            read_prim(stage, word, prim, depth + 1);
        else
            read_property(stage, prim, object, word);
    }
}

// Whether a prim of this type, or what is below it, may be what the schema reads.
static bool may_hold(const UsdSchema *schema, const char *type)
{
    static const char *const types[] = {"", "Xform", "Scope", "SkelRoot", "PointInstancer"};
    for (size_t i = 0; i < sizeof types / sizeof *types; ++i)
        if (strcmp(type, types[i]) == 0) return true;
    return strcmp(type, schema->type) == 0;
}

static int add_prim(UsdStage *stage, int parent)
{
    UsdPrim *more =
        reader_realloc(stage->reader, stage->prim, (uint64_t)stage->prim_count + 1, sizeof *more);
    if (!more) return -1;
    stage->prim = more;
    stage->prim[stage->prim_count] = (UsdPrim){.parent = parent};
    return stage->prim_count++;
}

static void read_prim(UsdStage *stage, const char *specifier, int parent, int depth)
{
    Reader *reader = stage->reader;
    char type[USD_WORD_SIZE] = "", name[USD_WORD_SIZE] = "";
    if (depth > DEEPEST) reader_fail(reader, "prims are nested more than %d deep", DEEPEST);
    int prim = add_prim(stage, parent);
    if (prim < 0) return;
    stage->prim[prim].absent = strcmp(specifier, "def") != 0;
    if (usd_text_peek(reader, false) != '"') usd_text_read_word(reader, type);
    void *object = reader_ok(reader) ? stage->schema->begin(stage->to, type, prim) : NULL;
    if (usd_text_peek(reader, false) == '"')
        usd_text_read_string(reader, name);
    else
        reader_fail(reader, "expected a prim's name");
    size_t above = strlen(stage->path);
    snprintf(stage->path + above, sizeof stage->path - above, "/%.*s", USD_WORD_SIZE, name);
    stage->prim[prim].path = add_name(parent < 0 ? NO_PATH : stage->prim[parent].path, name);
    snprintf(stage->prim[prim].name, sizeof stage->prim[prim].name, "%.31s", name);
    stage->prim[prim].instancer = strcmp(type, "PointInstancer") == 0;
    stage->prim[prim].sealed =
        (parent >= 0 && stage->prim[parent].sealed) || !may_hold(stage->schema, type);
    if (usd_text_peek(reader, false) == '(') read_metadata(stage, prim, object);
    if (reader_ok(reader)) read_body(stage, prim, object, depth);
    if (object) stage->schema->end(stage->to, object);
    stage->path[above] = 0;
}

// --- Arcs within the layer.

enum { DEEPEST_ARC = 8 };

static int find_prim(UsdStage *stage, uint64_t path, int originals)
{
    if (!reader_work(stage->reader, (uint64_t)originals, 3)) return -1;
    for (int i = 0; i < originals; ++i)
        if (stage->prim[i].path == path) return i;
    return -1;
}

// Gives a prim the arcs of another one.
static void copy_arcs(UsdStage *stage, int of, int prim, const char *path, const UsdArc *from,
                      uint32_t arcs)
{
    for (uint32_t i = 0; i < arcs && reader_work(stage->reader, 1, 5); ++i)
        if (stage->arc[i].prim == of)
            add_arc(stage, prim, stage->arc[i].source, stage->arc[i].word, stage->arc[i].line,
                    from->depth + 1, path);
}

// A copy of a prim and of the arcs that it has. `path`: its own.
static int copy_prim(UsdStage *stage, int of, int parent, const char *path, const UsdArc *from,
                     uint32_t arcs)
{
    int prim = add_prim(stage, parent);
    if (prim < 0) return -1;
    stage->prim[prim] = stage->prim[of];
    stage->prim[prim].parent = parent;
    stage->prim[prim].world = NULL;
    stage->prim[prim].copy = true;
    stage->prim[prim].timed = false;
    copy_arcs(stage, of, prim, path, from, arcs);
    return prim;
}

// Repeats everything below the prim `of` below the prim `to`.
static void repeat_below(UsdStage *stage, int of, int to, const char *path, const UsdArc *from,
                         uint32_t arcs, int originals)
{
    for (int i = of + 1; i < originals && reader_ok(stage->reader); ++i) {
        if (stage->prim[i].parent < of) break; // prims below a prim follow it
        if (stage->prim[i].parent != of) continue;
        char longer[USD_PATH_SIZE];
        snprintf(longer, sizeof longer, "%.200s/%s", path, stage->prim[i].name);
        int prim = copy_prim(stage, i, to, longer, from, arcs);
        if (prim < 0) return;
        stage->schema->repeat(stage->to, i, prim, longer);
        repeat_below(stage, i, prim, longer, from, arcs, originals);
    }
}

// The prim has the source's properties where it has none itself.
static void inherit(UsdPrim *prim, const UsdPrim *source)
{
    if (!prim->transform.line && !prim->transform.op_count && source->transform.line) {
        usd_transform_destroy(&prim->transform);
        prim->transform = source->transform;
        prim->copy = true;
    }
    prim->hidden = prim->hidden || source->hidden;
    prim->skinned = prim->skinned || source->skinned;
    prim->instancer = prim->instancer || source->instancer;
    for (int purpose = 0; purpose < USD_PURPOSES; ++purpose)
        if (!prim->bound[purpose]) prim->bound[purpose] = source->bound[purpose];
    if (source->arc && !prim->arc) prim->arc = source->arc, prim->arc_line = source->arc_line;
}

static void follow_arcs(UsdStage *stage, int originals)
{
    Reader *reader = stage->reader;
    uint32_t arcs = stage->arc_count; // those of the file
    for (uint32_t i = 0; i < stage->arc_count && reader_ok(reader); ++i) {
        const UsdArc arc = stage->arc[i];
        if (stage->prim[arc.prim].sealed) {
            stage->skipped_arcs++;
            continue;
        }
        int of = find_prim(stage, arc.source, originals);
        int above = arc.prim;
        while (above >= 0 && above != of) above = stage->prim[above].parent;
        reader->line = arc.line;
        if (of < 0) {
            set_arc(stage, arc.prim, arc.word, arc.line);
            continue;
        }
        if (above == of || arc.depth >= DEEPEST_ARC) {
            reader_fail(reader, "%s: a prim that repeats itself, or arcs more than %d deep",
                        arc.path, DEEPEST_ARC);
            return;
        }
        inherit(&stage->prim[arc.prim], &stage->prim[of]);
        copy_arcs(stage, of, arc.prim, arc.path, &arc, arcs);
        stage->schema->repeat(stage->to, of, arc.prim, arc.path);
        repeat_below(stage, of, arc.prim, arc.path, &arc, arcs, originals);
    }
}

// Arcs that were not followed are refused where they could bring what the schema reads.
static void check_arcs(UsdStage *stage)
{
    for (int i = 0; i < stage->prim_count && reader_ok(stage->reader); ++i) {
        const UsdPrim *prim = &stage->prim[i];
        if (!prim->arc) continue;
        if (prim->sealed || usd_stage_lacks(stage, i)) {
            stage->skipped_arcs++;
            continue;
        }
        stage->reader->line = prim->arc_line;
        reader_fail(stage->reader, "%s are not read: %s", prim->arc, USD_FLATTEN);
    }
}

// --- The layer.

static void read_layer_value(UsdStage *stage, const char *name)
{
    Reader *reader = stage->reader;
    char word[USD_WORD_SIZE];
    uint32_t line = reader->line;
    double *rate = strcmp(name, "timeCodesPerSecond") == 0 ? &stage->codes_per_second
                   : strcmp(name, "framesPerSecond") == 0  ? &stage->frames_per_second
                                                           : NULL;
    if (rate) {
        *rate = rate_snap(usd_text_read_double(reader));
    } else if (strcmp(name, "metersPerUnit") == 0) {
        stage->unit = usd_text_read_float(reader);
    } else if (strcmp(name, "kilogramsPerUnit") == 0) {
        stage->mass_unit = usd_text_read_float(reader);
    } else if (strcmp(name, "upAxis") == 0 && usd_text_peek(reader, false) == '"') {
        usd_text_read_string(reader, word);
        stage->up_z = strcmp(word, "Z") == 0;
    } else if (strcmp(name, "subLayers") == 0) {
        if (skip_empty(reader)) return;
        reader->line = line;
        reader_fail(reader, "subLayers are not read: %s", USD_FLATTEN);
    } else {
        usd_text_skip_value(reader);
    }
}

static void read_layer(UsdStage *stage)
{
    Reader *reader = stage->reader;
    char word[USD_WORD_SIZE];
    if (!usd_text_take(reader, '(')) return;
    while (reader_ok(reader) && !usd_text_take(reader, ')')) {
        char c = usd_text_here(reader);
        if (c == '"' || c == '\'') {
            usd_text_read_string(reader, word);
            continue;
        }
        usd_text_read_word(reader, word);
        // Otherwise a list edit such as "prepend"
        if (usd_text_take(reader, '=')) read_layer_value(stage, word);
    }
}

static void read_prims(UsdStage *stage)
{
    Reader *reader = stage->reader;
    char word[USD_WORD_SIZE];
    while (reader_ok(reader) && usd_text_peek(reader, false)) {
        usd_text_read_word(reader, word);
        if (begins_prim(word))
            read_prim(stage, word, -1, 0);
        else if (usd_text_take(reader, '=')) // reorder rootPrims = ...
            usd_text_skip_value(reader);
    }
}

bool usd_stage_matches(const Bytes *bytes)
{
    return bytes->size >= 5 && memcmp(bytes->data, "#usda", 5) == 0;
}

Result usd_stage_read(UsdStage *stage, Reader *reader, const UsdSchema *schema, void *to)
{
    *stage =
        // USD's defaults
        (UsdStage){.reader = reader, .schema = schema, .to = to, .unit = 0.01f, .mass_unit = 1};
    read_layer(stage);
    read_prims(stage);
    if (reader->at < reader->size) reader_fail(reader, "a zero byte: expected text");
    if (reader_ok(reader) && !(stage->unit > 0))
        reader_fail(reader, "metersPerUnit: expected a number above 0");
    uint32_t line = reader->line;
    if (reader_ok(reader)) follow_arcs(stage, stage->prim_count);
    if (reader_ok(reader)) check_arcs(stage);
    if (reader_ok(reader)) reader->line = line;
    return reader->result;
}

void usd_stage_destroy(UsdStage *stage)
{
    for (int i = 0; i < stage->prim_count; ++i) {
        UsdTransform *transform = &stage->prim[i].transform;
        if (stage->prim[i].copy)
            free(transform->named);
        else
            usd_transform_destroy(transform);
        free(stage->prim[i].world);
    }
    free(stage->prim);
    free(stage->arc);
    *stage = (UsdStage){0};
}

// --- Queries.

double usd_stage_rate(const UsdStage *stage)
{
    return stage->codes_per_second > 0    ? stage->codes_per_second
           : stage->frames_per_second > 0 ? stage->frames_per_second
                                          : 24; // USD's default
}

// Whether a prim or a parent has it.
#define ANY_ABOVE(member)                                                                          \
    bool any = false;                                                                              \
    for (int p = prim; p >= 0; p = stage->prim[p].parent) any = any || stage->prim[p].member;      \
    return any

bool usd_stage_hides(const UsdStage *stage, int prim)
{
    ANY_ABOVE(hidden);
}

bool usd_stage_lacks(const UsdStage *stage, int prim)
{
    ANY_ABOVE(absent);
}

bool usd_stage_instances(const UsdStage *stage, int prim)
{
    ANY_ABOVE(instancer);
}

bool usd_stage_skins(const UsdStage *stage, int prim)
{
    ANY_ABOVE(skinned);
}
#undef ANY_ABOVE

uint64_t usd_stage_find_material(const UsdStage *stage, int prim)
{
    for (int purpose = 0; purpose < USD_PURPOSES; ++purpose)
        for (int p = prim; p >= 0; p = stage->prim[p].parent)
            if (stage->prim[p].bound[purpose]) return stage->prim[p].bound[purpose];
    return 0;
}

uint32_t usd_stage_count_idle(const UsdStage *stage)
{
    uint32_t idle = 0;
    for (int p = 0; p < stage->prim_count; ++p)
        idle += stage->prim[p].transform.op_count && !stage->prim[p].transform.line;
    return idle;
}

uint32_t usd_stage_count_empty(const UsdStage *stage)
{
    uint32_t empty = 0;
    for (int p = 0; p < stage->prim_count; ++p)
        if (!stage->prim[p].copy && !usd_stage_lacks(stage, p))
            empty += usd_transform_count_empty(&stage->prim[p].transform);
    return empty;
}

// The prim's place in the world at a time; NULL after an error. Remembers it, since many curves and
// meshes lie below one transform.
static UsdWorld *find_world(const UsdStage *stage, int p, double time)
{
    Reader *reader = stage->reader;
    UsdPrim *prim = &stage->prim[p];
    UsdWorld *world = prim->world;
    if (world && (world->still || world->time == time)) return world;
    if (!world) world = prim->world = reader_malloc(reader, 1, sizeof *world);
    if (!world) return NULL;
    bool reset;
    usd_transform_evaluate(&prim->transform, reader, time, world->matrix, &reset);
    world->time = time;
    world->still = prim->transform.still;
    if (reset || prim->parent < 0) return world;
    UsdWorld *above = reader_ok(reader) ? find_world(stage, prim->parent, time) : NULL;
    if (!above) return NULL;
    usd_transform_multiply(world->matrix, world->matrix, above->matrix);
    world->still = world->still && above->still;
    return world;
}

void usd_stage_find_matrix(const UsdStage *stage, int prim, double time, double matrix[4][4])
{
    reader_work(stage->reader, 64, 10); // its parents
    const UsdWorld *world = reader_ok(stage->reader) ? find_world(stage, prim, time) : NULL;
    if (world)
        memcpy(matrix, world->matrix, sizeof world->matrix);
    else
        memset(matrix, 0, 16 * sizeof(double));
}

void usd_stage_add_times(UsdStage *stage, int prim, const UsdSamples *samples, UsdTimes *times)
{
    for (size_t k = 0; samples->timed && k < samples->count; ++k)
        usd_times_add(times, stage->reader, samples->sample[k].time);
    for (int p = prim; p >= 0 && !stage->prim[p].timed; p = stage->prim[p].parent) {
        stage->prim[p].timed = true;
        for (size_t op = 0; op < stage->prim[p].transform.op_count; ++op) {
            const UsdTrack *track = &stage->prim[p].transform.op[op].track;
            for (size_t k = 0; track->timed && k < track->count; ++k)
                usd_times_add(times, stage->reader, track->time[k]);
        }
    }
}
