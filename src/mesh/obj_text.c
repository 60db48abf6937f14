// SPDX-License-Identifier: MIT
#include "mesh/obj_text.h"

#include "base/decimal.h"

#include <stdlib.h>
#include <string.h>

static const char *const WORDS[OBJ_OTHER] = {"v", "vt", "vn", "l", "f"};

bool obj_text_matches(const Bytes *bytes)
{
    static const char *const others[] = {"vp", "o", "g", "s", "mtllib", "usemtl"};
    const char *text = (const char *)bytes->data;
    text += strspn(text, " \t\r\n");
    if (*text == '#') return strncmp(text, "#usda", 5) != 0;
    size_t length = strcspn(text, " \t\r\n");
    for (size_t i = 0; i < OBJ_OTHER + sizeof others / sizeof *others; i++) {
        const char *word = i < OBJ_OTHER ? WORDS[i] : others[i - OBJ_OTHER];
        if (strlen(word) == length && strncmp(text, word, length) == 0) return true;
    }
    return false;
}

bool obj_text_next(Reader *reader, ObjStatement *statement)
{
    if (reader_ended(reader)) return false;
    int word = 0;
    while (word < OBJ_OTHER && !reader_take(reader, WORDS[word])) word++;
    *statement = (ObjStatement)word;
    return true;
}

bool obj_text_goes_on(Reader *reader)
{
    return !reader_line_ended(reader) && reader->data[reader->at] != '#';
}

// A whole number other than 0 at *text, which is moved behind it; 0 if there is none.
static int64_t scan_index(const char **text)
{
    char *end;
    if (**text != '-' && !(**text >= '0' && **text <= '9')) return 0;
    long long value = strtoll(*text, &end, 10);
    *text = end;
    return llabs(value) <= UINT32_MAX ? value : 0;
}

static bool parse_corner(const char *text, ObjCorner *corner)
{
    *corner = (ObjCorner){.vertex = scan_index(&text)};
    if (corner->vertex == 0) return false;
    if (*text == '/') {
        text++;
        bool textured = *text != '/' && *text != 0;
        if (textured && (corner->uv = scan_index(&text)) == 0) return false;
        if (*text == '/') {
            text++;
            if ((corner->normal = scan_index(&text)) == 0) return false;
        }
    }
    return *text == 0;
}

bool obj_text_take_corner(Reader *reader, ObjCorner *corner)
{
    Reader before = *reader;
    char text[64];
    if (reader_read_word(reader, text, sizeof text) && parse_corner(text, corner)) return true;
    *reader = before;
    return false;
}

void obj_text_put(FILE *stream, const char *word, const float *numbers, int count)
{
    fputs(word, stream);
    for (int i = 0; i < count; i++) decimal_put(stream, " ", numbers[i]);
    fputc('\n', stream);
}
