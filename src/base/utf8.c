// SPDX-License-Identifier: MIT
#include "base/utf8.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

// Like utf8_length; also sets the code point.
static size_t decode(const char *text, size_t size, uint32_t *code)
{
    static const uint32_t LEAST[] = {0, 0, 0x80, 0x800, 0x10000};
    const unsigned char *byte = (const unsigned char *)text;
    if (size == 0) return 0;
    *code = byte[0];
    if (byte[0] < 0x80) return 1;
    size_t length = byte[0] >= 0xf0 ? 4 : byte[0] >= 0xe0 ? 3 : 2;
    if (byte[0] < 0xc0 || byte[0] >= 0xf8 || length > size) return 0;
    *code = byte[0] & (0x7fu >> length);
    for (size_t i = 1; i < length; ++i) {
        if ((byte[i] & 0xc0) != 0x80) return 0;
        *code = *code << 6 | (byte[i] & 0x3f);
    }
    bool surrogate = *code >= 0xd800 && *code < 0xe000;
    return *code >= LEAST[length] && *code <= 0x10ffff && !surrogate ? length : 0;
}

size_t utf8_length(const char *text, size_t size)
{
    uint32_t code;
    return decode(text, size, &code);
}

size_t utf8_visible(const char *text, size_t size)
{
    static const uint32_t HIDDEN[][2] = {{0, 0x1f},        {0x7f, 0x9f},     {0x200e, 0x200f},
                                         {0x2028, 0x202e}, {0x2066, 0x2069}, {0xfeff, 0xfeff}};
    uint32_t code;
    size_t length = decode(text, size, &code);
    for (size_t i = 0; length && i < sizeof HIDDEN / sizeof *HIDDEN; ++i)
        if (code >= HIDDEN[i][0] && code <= HIDDEN[i][1]) return 0;
    return length;
}

char *utf8_clean(const char *text, size_t size)
{
    char *clean = malloc(3 * size + 1), *to = clean;
    if (!clean) return NULL;
    for (size_t i = 0; i < size;) {
        size_t length = text[i] ? utf8_length(text + i, size - i) : 0;
        memcpy(to, length ? text + i : "\xef\xbf\xbd", length ? length : 3);
        to += length ? length : 3;
        i += length ? length : 1;
    }
    *to = 0;
    return clean;
}
