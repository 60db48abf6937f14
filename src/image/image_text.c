// SPDX-License-Identifier: MIT
#include "image/image_text.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

// Section 11.3.4.2 of the PNG specification, and ASCII only.
bool image_texts_is_key(const char *key)
{
    size_t length = strlen(key);
    if (length == 0 || length >= IMAGE_TEXT_KEY_BYTES) return false;
    for (size_t i = 0; i < length; ++i) {
        if (key[i] < ' ' || key[i] > '~') return false;
        if (key[i] == ' ' && (i == 0 || i + 1 == length || key[i - 1] == ' ')) return false;
    }
    return true;
}

// How many bytes of UTF-8 stand at `at` for one letter, RFC 3629; 0: it is none.
static size_t letter_size(const uint8_t *at)
{
    static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    size_t size = at[0] < 0x80       ? 1
                  : at[0] >> 5 == 6  ? 2
                  : at[0] >> 4 == 14 ? 3
                  : at[0] >> 3 == 30 ? 4
                                     : 0;
    uint32_t code = size > 1 ? at[0] & (0x7fu >> size) : at[0];
    for (size_t i = 1; i < size; ++i) {
        if (at[i] >> 6 != 2) return 0;
        code = code << 6 | (at[i] & 0x3f);
    }
    bool is_half = code >= 0xd800 && code < 0xe000; // of a pair in UTF-16
    return code < least[size] || code > 0x10ffff || is_half ? 0 : size;
}

static void clean(char *text)
{
    for (uint8_t *at = (uint8_t *)text; *at;) {
        size_t size = letter_size(at);
        if (size == 0)
            *at++ = '?';
        else if ((*at < ' ' && *at != '\n') || *at == 0x7f)
            *at++ = ' ';
        else
            at += size;
    }
}

static ImageText *find(const ImageTexts *texts, const char *key)
{
    for (size_t i = 0; i < texts->count; ++i)
        if (strcmp(texts->list[i].key, key) == 0) return &texts->list[i];
    return NULL;
}

Result image_texts_set(ImageTexts *texts, const char *key, const char *value, Error *error)
{
    if (!image_texts_is_key(key))
        return error_set(error, RESULT_FAILED, "an image's text of this name cannot be written");
    ImageText *text = find(texts, key);
    char *copy = strdup(value);
    if (copy && !text) {
        ImageText *list = realloc(texts->list, (texts->count + 1) * sizeof *list);
        if (list) {
            texts->list = list;
            text = &list[texts->count++];
            *text = (ImageText){.value = NULL};
            memcpy(text->key, key, strlen(key) + 1);
        }
    }
    if (!copy || !text) {
        free(copy);
        return error_set(error, RESULT_FAILED, "no memory for the texts of an image");
    }
    clean(copy);
    free(text->value);
    text->value = copy;
    return RESULT_OK;
}

const char *image_texts_find(const ImageTexts *texts, const char *key)
{
    const ImageText *text = find(texts, key);
    return text ? text->value : NULL;
}

Result image_texts_copy(ImageTexts *texts, const ImageTexts *from, Error *error)
{
    *texts = (ImageTexts){0};
    for (size_t i = 0; from && i < from->count; ++i)
        TRY(image_texts_set(texts, from->list[i].key, from->list[i].value, error));
    return RESULT_OK;
}

void image_texts_destroy(ImageTexts *texts)
{
    for (size_t i = 0; i < texts->count; ++i) free(texts->list[i].value);
    free(texts->list);
    *texts = (ImageTexts){0};
}
