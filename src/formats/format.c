// SPDX-License-Identifier: MIT
#include "formats/format.h"

#include <endian.h>
#include <fnmatch.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define DECLARE(kind, row, word) extern const Format row##_format;
FORMATS(DECLARE)
#undef DECLARE

const Format *const FORMAT_TABLE[FORMAT_KINDS] = {
#define ROW(kind, row, word) [FORMAT_##kind] = &row##_format,
    FORMATS(ROW)
#undef ROW
};

static const char *const WORDS[FORMAT_KINDS] = {
#define WORD(kind, row, word) [FORMAT_##kind] = word,
    FORMATS(WORD)
#undef WORD
};

// --- Choosing.

FormatKind format_detect(const Bytes *bytes)
{
    FormatKind kind = 0;
    while (kind < FORMAT_KINDS && !FORMAT_TABLE[kind]->match(bytes)) ++kind;
    return kind;
}

static bool is_even(const Strands *strands)
{
    for (uint32_t s = 1; s < strands->strand_count; ++s)
        if (strands_size(strands, s) != strands_size(strands, 0)) return false;
    return true;
}

// The format that the name's suffix selects. `strands` must be writable in it, unless NULL.
static FormatKind find_written(const char *name, const Strands *strands)
{
    size_t length = strlen(name);
    for (FormatKind kind = 0; kind < FORMAT_KINDS; ++kind) {
        const Format *format = FORMAT_TABLE[kind];
        size_t suffix = strlen(format->suffix);
        if (format->write && length > suffix &&
            strcasecmp(name + length - suffix, format->suffix) == 0 &&
            !(strands && format->equal_sizes && !is_even(strands)))
            return kind;
    }
    return FORMAT_KINDS;
}

FormatKind format_choose(const char *name, const Strands *strands)
{
    return find_written(name, strands);
}

Result format_target(Target *target, const char *text, Error *error)
{
    FormatKind kind = find_written(text, NULL);
    *target = (Target){0};
    if (kind == FORMAT_KINDS) {
        char suffixes[200];
        format_list_suffixes(suffixes, sizeof suffixes);
        return error_set(error, RESULT_USAGE, "%s: expected a name ending in %s",
                         *text ? text : "the hair file's name is empty", suffixes);
    }
    TRY(target_parse_any(target, text, error));
    if (FORMAT_TABLE[kind]->animated && target->kind == TARGET_STILL) target->kind = TARGET_VIDEO;
    return RESULT_OK;
}

Result format_write(const char *path, FormatKind kind, const Strands *strands, Error *error)
{
    const Format *format = FORMAT_TABLE[kind];
    if (strands->strand_count == 0)
        return error_set(error, RESULT_FAILED, "%s: no strands to write", path);
    if (!format->write)
        return error_set(
            error, RESULT_FAILED,
            "%s: the format %s can be read but not written: expected another suffix or --format",
            path, format->name);
    if (!format->text) TRY(outfile_refuse_terminal(path, error));
    OutFile file;
    TRY(outfile_open(&file, path, error));
    Result result = format->write(&file, strands, error);
    if (result == RESULT_OK) return outfile_commit(&file, error);
    outfile_discard(&file);
    return result;
}

// --- Lists.

static void join(const char *const *words, int count, char *text, size_t size)
{
    text[0] = 0;
    for (int i = 0; i < count; ++i) {
        size_t used = strlen(text);
        snprintf(text + used, size - used, "%s%s",
                 i == 0           ? ""
                 : i == count - 1 ? " or "
                                  : ", ",
                 words[i]);
    }
}

void format_list_suffixes(char *text, size_t size)
{
    const char *suffixes[FORMAT_KINDS] = {0};
    int count = 0;
    for (FormatKind kind = 0; kind < FORMAT_KINDS; ++kind) {
        bool known = !FORMAT_TABLE[kind]->write;
        for (int i = 0; i < count; ++i)
            known = known || strcmp(suffixes[i], FORMAT_TABLE[kind]->suffix) == 0;
        if (!known) suffixes[count++] = FORMAT_TABLE[kind]->suffix;
    }
    join(suffixes, count, text, size);
}

void format_list_names(char *text, size_t size)
{
    const char *names[FORMAT_KINDS];
    int count = 0;
    for (FormatKind kind = 0; kind < FORMAT_KINDS; ++kind)
        names[count++] = FORMAT_TABLE[kind]->name;
    join(names, count, text, size);
}

void format_list_holding(uint32_t features, char *text, size_t size)
{
    const char *words[FORMAT_KINDS];
    int count = 0;
    for (FormatKind kind = 0; kind < FORMAT_KINDS; ++kind)
        if (FORMAT_TABLE[kind]->write && !(features & ~FORMAT_TABLE[kind]->features))
            words[count++] = WORDS[kind];
    join(words, count, text, size);
}

// --- Helpers for the formats' own files.

Result format_source_create(FormatSource *source, Reader *reader, uint32_t strand_count,
                            uint64_t vertex_count)
{
    FormatSource before = *source;
    *source = (FormatSource){.wishes = before.wishes,
                             .used_points = before.used_points,
                             .used_array = before.used_array,
                             .used_objects = before.used_objects,
                             .flaws = before.flaws,
                             .contents = before.contents};
    memcpy(source->note, before.note, sizeof source->note);
    if (vertex_count >= UINT32_MAX)
        return reader_fail(reader, "%llu vertices: expected fewer than 2^32 - 1",
                           (unsigned long long)vertex_count);
    reader_charge(reader, vertex_count, sizeof *source->strands.position);
    reader_charge(reader, strand_count, sizeof *source->strands.first);
    TRY(reader->result);
    Result result = strands_create(&source->strands, strand_count, (uint32_t)vertex_count, NULL);
    source->place = reader_calloc(reader, (size_t)strand_count + 1, sizeof *source->place);
    if (result == RESULT_OK && source->place) return RESULT_OK;
    format_source_destroy(source);
    return reader_fail_memory(reader);
}

void format_source_destroy(FormatSource *source)
{
    strands_destroy(&source->strands);
    free(source->place);
    free(source->vertex_line);
    free(source->frames);
    *source = (FormatSource){0};
}

static void add_note(FormatSource *source, const char *format, va_list arguments)
{
    size_t used = strlen(source->note);
    if (used > 0 && used + 2 < sizeof source->note)
        used += (size_t)sprintf(source->note + used, "; ");
    vsnprintf(source->note + used, sizeof source->note - used, format, arguments);
}

void format_source_note(FormatSource *source, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    add_note(source, format, arguments);
    va_end(arguments);
}

void format_source_flaw(FormatSource *source, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    add_note(source, format, arguments);
    va_end(arguments);
    source->flaws++;
}

// --- Objects of scene files.

void format_copy_path(char to[FORMAT_PATH_SIZE], const char *path)
{
    size_t length = strlen(path), most = FORMAT_PATH_SIZE - 1;
    snprintf(to, FORMAT_PATH_SIZE, "%s", length > most ? path + length - most : path);
}

void format_source_list(FormatSource *source, const char *path, uint32_t strands, const char *why)
{
    FormatContents *contents = &source->contents;
    contents->left_out += why != NULL;
    if (contents->count++ >= FORMAT_OBJECTS) return;
    FormatObject *object = &contents->object[contents->count - 1];
    *object = (FormatObject){.strands = strands, .why = why};
    format_copy_path(object->path, path);
}

void format_source_unread(FormatSource *source, const char *name)
{
    FormatContents *contents = &source->contents;
    size_t used = strlen(contents->unread), length = strlen(name);
    if (length == 0) return;
    for (const char *at = contents->unread; (at = strstr(at, name)); ++at)
        if ((at == contents->unread || at[-1] == ' ') && (!at[length] || at[length] == ',')) return;
    contents->unread_count++;
    if (used + length + 3 > sizeof contents->unread) return;
    sprintf(contents->unread + used, "%s%s", used ? ", " : "", name);
}

// Whether the path, or a name in it, matches the pattern.
static bool matches(const char *pattern, const char *path)
{
    char name[FORMAT_PATH_SIZE];
    if (fnmatch(pattern, path, 0) == 0) return true;
    for (const char *at = path; *at;) {
        at += *at == '/';
        size_t length = strcspn(at, "/");
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        if (fnmatch(pattern, name, 0) == 0) return true;
        at += length;
    }
    return false;
}

bool format_wants_object(const FormatWishes *wishes, const char *path)
{
    bool wants = false, chooses = false;
    for (const char *at = wishes->objects; at && *at;) {
        char pattern[FORMAT_PATH_SIZE];
        size_t length = strcspn(at, ",");
        bool leaves = *at == '!';
        snprintf(pattern, sizeof pattern, "%.*s", (int)length - leaves, at + leaves);
        bool found = matches(pattern, path);
        if (found && leaves) return false;
        wants = wants || found;
        chooses = chooses || !leaves;
        at += length + (at[length] == ',');
    }
    return wants || !chooses;
}

Result format_source_copy(Reader *reader, void *array, uint64_t start, size_t count, size_t width)
{
    float *floats = reader_malloc(reader, (count * width + 1), sizeof *floats);
    if (!floats) return reader_fail_memory(reader);
    reader_copy_floats(reader, start, floats, count * width);
    memcpy(array, &floats, sizeof floats);
    return RESULT_OK;
}

void format_put_u32(FILE *stream, uint32_t value)
{
    value = htole32(value);
    fwrite(&value, 4, 1, stream);
}

void format_put_floats(FILE *stream, const void *floats, size_t count)
{
    const char *at = floats;
    for (size_t i = 0; at && i < count; i++) {
        uint32_t bits;
        memcpy(&bits, at + 4 * i, 4);
        format_put_u32(stream, bits);
    }
}
