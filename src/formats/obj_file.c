// SPDX-License-Identifier: MIT
// Wavefront OBJ with lines: `v` statements are vertices, each `l` statement is a strand from root
// to tip.
#include "formats/foreign.h"
#include "formats/format.h"

#include "formats/obj.h"

#include <stdlib.h>
#include <string.h>

// --- Reading: the first pass counts, the second one stores.

typedef struct Obj {
    Reader *reader;
    FormatSource *source;
    float (*position)[3];                     // [vertices]
    uint32_t *line;                           // [vertices] line in the file
    uint64_t vertices, lines, corners, faces; // in the file
    bool pairs;                               // each `l` has two corners
    uint32_t read;                            // vertices read so far
    uint32_t strands, used;                   // so far; `used` counts corners
    int64_t last;                             // vertex where the last `l` ended; -1 if none
} Obj;

static void count_statements(Obj *obj)
{
    Reader counter = *obj->reader;
    ObjStatement statement;
    char word[256];
    while (obj_next_statement(&counter, &statement)) {
        obj->vertices += statement == OBJ_VERTEX;
        obj->lines += statement == OBJ_LINE;
        obj->faces += statement == OBJ_FACE;
        uint64_t before = obj->corners;
        while (statement == OBJ_LINE && obj_goes_on(&counter) &&
               reader_read_word(&counter, word, sizeof word))
            obj->corners++;
        if (statement == OBJ_LINE && obj->corners != before + 2) obj->pairs = false;
        reader_skip_line(&counter);
    }
}

static void read_vertex(Obj *obj)
{
    Reader *reader = obj->reader;
    obj->line[obj->read] = reader->line;
    for (int i = 0; i < 3; i++)
        obj->position[obj->read][i] = reader_read_number(reader, "a vertex's coordinate");
    obj->read++;
}

// The index (from 0) of the vertex that a corner refers to.
static uint32_t read_corner(Obj *obj)
{
    Reader *reader = obj->reader, before = *reader;
    ObjCorner corner = {0};
    if (!reader_ok(reader)) return 0;
    if (obj_take_corner(reader, &corner)) {
        int64_t index = corner.vertex + (corner.vertex < 0 ? (int64_t)obj->read + 1 : 0);
        if (index >= 1 && index <= obj->read) return (uint32_t)index - 1;
    }
    *reader = before;
    reader_fail_expected(reader, "the number of a vertex that is defined before this line");
    return 0;
}

static void add_corner(Obj *obj, uint32_t vertex)
{
    memcpy(obj->source->strands.position[obj->used], obj->position[vertex], sizeof(float[3]));
    obj->source->vertex_line[obj->used++] = obj->line[vertex];
}

static void read_line(Obj *obj)
{
    Strands *strands = &obj->source->strands;
    uint32_t corners = 0, line = obj->reader->line;
    while (obj_goes_on(obj->reader)) {
        uint32_t vertex = read_corner(obj);
        if (!reader_ok(obj->reader)) return;
        if (corners++ == 0) {
            if (obj->strands > 0 && vertex == obj->last) continue;
            obj->source->place[obj->strands++] = line;
        }
        add_corner(obj, vertex);
        obj->last = vertex;
        strands->first[obj->strands] = obj->used;
    }
    if (corners < 2)
        reader_fail(obj->reader, "a line of %u vertices: expected at least 2", corners);
}

// --- Edges. If each `l` names two vertices, they are edges, in any order and direction, if no
// vertex has more than two. Each chain is a strand; the end with the lower number is its root.

typedef struct Edges {
    uint32_t (*end)[2]; // [count] of each `l`
    int64_t (*next)[2]; // [vertices] neighbours; -1: none
    uint8_t *seen;      // [vertices]
    uint32_t count;
} Edges;

static void read_edges(Obj *obj, Edges *edges)
{
    Reader *reader = obj->reader;
    ObjStatement statement;
    while (obj_next_statement(reader, &statement)) {
        if (statement == OBJ_VERTEX) read_vertex(obj);
        if (statement == OBJ_LINE) {
            edges->end[edges->count][0] = read_corner(obj);
            edges->end[edges->count][1] = read_corner(obj);
            edges->count++;
        }
        reader_skip_line(reader);
    }
}

// Whether no vertex has more than two edges, and none leads back to its own vertex.
static bool link_edges(const Obj *obj, const Edges *edges)
{
    for (uint64_t v = 0; v < obj->vertices; ++v) edges->next[v][0] = edges->next[v][1] = -1;
    for (uint32_t i = 0; i < edges->count; ++i)
        for (int k = 0; k < 2; ++k) {
            int64_t *next = edges->next[edges->end[i][k]];
            uint32_t other = edges->end[i][!k];
            if (next[1] >= 0 || next[0] == other || other == edges->end[i][k]) return false;
            next[next[0] >= 0] = other;
        }
    return true;
}

static void add_chain(Obj *obj, const Edges *edges, uint32_t root)
{
    Strands *strands = &obj->source->strands;
    int64_t before = -1, at = root;
    obj->source->place[obj->strands++] = obj->line[root];
    while (at >= 0) {
        const int64_t *next = edges->next[at];
        int64_t after = before >= 0 && next[0] == before ? next[1] : next[0];
        if (before >= 0 && next[1] == before) after = next[0];
        if (before >= 0 && next[1] < 0) after = -1; // the tip
        edges->seen[at] = 1;
        add_corner(obj, (uint32_t)at);
        before = at;
        at = after;
    }
    strands->first[obj->strands] = obj->used;
}

// Reads a file of edges as chains. False if it is none: then nothing is read.
static bool read_chains(Obj *obj)
{
    Reader *reader = obj->reader, before = *reader;
    Edges edges = {.end = reader_malloc(reader, obj->lines, sizeof *edges.end),
                   .next = reader_malloc(reader, obj->vertices, sizeof *edges.next),
                   .seen = reader_calloc(reader, obj->vertices, 1)};
    bool good = edges.end && edges.next && edges.seen;
    if (good) read_edges(obj, &edges);
    good = good && reader_ok(reader) && link_edges(obj, &edges);
    for (uint32_t v = 0; v < obj->vertices && good; ++v)
        if (!edges.seen[v] && edges.next[v][0] >= 0 && edges.next[v][1] < 0)
            add_chain(obj, &edges, v);
    for (uint64_t v = 0; v < obj->vertices && good; ++v) // none may be closed
        good = edges.seen[v] || edges.next[v][0] < 0;
    if (!good && reader_ok(reader)) {
        before.memory = reader->memory;
        before.work = reader->work;
        *reader = before;
        obj->read = obj->strands = obj->used = 0;
    }
    free(edges.end);
    free(edges.next);
    free(edges.seen);
    return good || !reader_ok(reader);
}

static void read_statements(Obj *obj)
{
    if (obj->pairs && read_chains(obj)) return;
    ObjStatement statement;
    while (obj_next_statement(obj->reader, &statement)) {
        if (statement == OBJ_VERTEX) read_vertex(obj);
        if (statement == OBJ_LINE) read_line(obj);
        reader_skip_line(obj->reader);
    }
}

static Result make_room(Obj *obj)
{
    Reader *reader = obj->reader;
    if (obj->lines == 0 && obj->faces > 0)
        return reader_fail(reader,
                           "a mesh of %llu vertices and %llu faces, not hair: " FOREIGN_WANTS_HAIR
                           "; tractrix-gen fur grows hair on a mesh",
                           (unsigned long long)obj->vertices, (unsigned long long)obj->faces);
    if (obj->lines == 0)
        return reader_fail(
            reader,
            "a Wavefront file of %llu vertices without lines (l) and faces: expected "
            "a line for each strand, which lists its vertices from root to tip",
            (unsigned long long)obj->vertices);
    if (obj->vertices >= UINT32_MAX || obj->lines >= UINT32_MAX)
        return reader_fail(reader, "too many vertices or lines: expected fewer than 2^32 - 1");
    TRY(format_source_create(obj->source, reader, (uint32_t)obj->lines, obj->corners));
    obj->position = reader_malloc(obj->reader, obj->vertices, sizeof *obj->position);
    obj->line = reader_malloc(obj->reader, obj->vertices, sizeof *obj->line);
    obj->source->vertex_line =
        reader_calloc(obj->reader, obj->corners + 1, sizeof *obj->source->vertex_line);
    bool good = obj->position && obj->line && obj->source->vertex_line;
    return good ? RESULT_OK : reader_fail_memory(reader);
}

// Reads `v` and `l` statements and ignores all others. Indices count from 1, or from the last
// vertex if negative; corners are v or v/t. Some programs write each edge as an `l` statement of
// its own: see above. Otherwise an `l` that begins at the vertex where the previous one ended
// continues its strand.
// Vertices that no `l` uses are ignored.
static Result read(FormatSource *source, Reader *reader)
{
    Obj obj = {.reader = reader, .source = source, .last = -1, .pairs = true};
    reader->continuation = true;
    count_statements(&obj);
    if (make_room(&obj) == RESULT_OK) {
        read_statements(&obj);
        source->strands.strand_count = obj.strands;
        source->strands.vertex_count = obj.used;
    }
    free(obj.position);
    free(obj.line);
    return reader->result;
}

// --- Writing.

static Result write(OutFile *file, const Strands *strands, Error *error)
{
    (void)error;
    FILE *stream = file->stream;
    fprintf(stream, "# %u strands, %u vertices\no hair\n", strands->strand_count,
            strands->vertex_count);
    for (uint32_t v = 0; v < strands->vertex_count; v++)
        obj_put_line(stream, "v", strands->position[v], 3);
    for (uint32_t s = 0; s < strands->strand_count; s++) {
        fputc('l', stream);
        for (uint32_t v = strands->first[s]; v < strands->first[s + 1]; v++)
            fprintf(stream, " %u", v + 1);
        fputc('\n', stream);
    }
    return RESULT_OK;
}

const Format obj_format = {
    .name = "Wavefront lines",
    .suffix = ".obj",
    .text = true,
    .match = obj_matches,
    .read = read,
    .write = write,
};
