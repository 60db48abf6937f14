// SPDX-License-Identifier: MIT
#include "base/quote.h"
#include "base/utf8.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { PIECE_BYTES = 8 };

// Writes the quoted form of the character at `text`. `length` receives its bytes in the text.
// Returns the number of bytes written.
static size_t write_piece(char piece[PIECE_BYTES], const char *text, size_t left, size_t *length)
{
    static const char NAMED[] = "\nn\rr\tt";
    *length = utf8_visible(text, left);
    if (*length) {
        memcpy(piece, text, *length);
        return *length;
    }
    *length = 1;
    for (size_t i = 0; NAMED[i]; i += 2)
        if (*text == NAMED[i]) return (size_t)sprintf(piece, "\\%c", NAMED[i + 1]);
    return (size_t)sprintf(piece, "\\x%02x", (unsigned char)*text);
}

static size_t count_bytes(const char *text, size_t size)
{
    char piece[PIECE_BYTES];
    size_t total = 0, length;
    for (size_t at = 0; at < size; at += length)
        total += write_piece(piece, text + at, size - at, &length);
    return total;
}

void quote_line(char *line, size_t size, const char *text)
{
    static const char DOTS[] = "...";
    size_t all = strlen(text), total = count_bytes(text, all), length, done = 0, used = 0;
    size_t room = size - 1;
    // The room before the dots, and the offset in the quoted text where the part after them begins.
    bool fits = total <= room;
    size_t before = fits ? total : (room - strlen(DOTS)) / 2,
           behind = fits ? total : total - (room - strlen(DOTS) - before);
    bool cut = false;
    for (size_t at = 0; at < all; at += length) {
        char piece[PIECE_BYTES];
        size_t bytes = write_piece(piece, text + at, all - at, &length);
        bool first = !cut && done + bytes <= before;
        if (!first && !cut) {
            memcpy(line + used, DOTS, strlen(DOTS));
            used += strlen(DOTS);
            cut = true;
        }
        if (first || done >= behind) {
            memcpy(line + used, piece, bytes);
            used += bytes;
        }
        done += bytes;
    }
    line[used] = 0;
}

Quoted quote(const char *text)
{
    Quoted quoted = {{0}};
    quote_line(quoted.text, sizeof quoted.text, text);
    return quoted;
}
