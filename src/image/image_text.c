// SPDX-License-Identifier: MIT
#include "image/image_text.h"

#include "base/utf8.h"

#include <stdlib.h>
#include <string.h>

// Section 11.3.4.2 of the PNG specification, restricted to ASCII.
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

static void clean(char *text)
{
    const char *end = text + strlen(text);
    for (char *at = text; *at;) {
        size_t size = utf8_length(at, (size_t)(end - at));
        if (size == 0)
            *at++ = '?';
        else if (((unsigned char)*at < ' ' && *at != '\n') || *at == 0x7f)
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

// Finds or adds the text with this key; a new one is empty. NULL if memory is short.
static ImageText *find_or_add(ImageTexts *texts, const char *key)
{
    ImageText *text = find(texts, key);
    if (text) return text;
    ImageText *list = realloc(texts->list, (texts->count + 1) * sizeof *list);
    if (!list) return NULL;
    texts->list = list;
    text = &list[texts->count++];
    *text = (ImageText){.value = NULL};
    memcpy(text->key, key, strlen(key) + 1);
    return text;
}

Result image_texts_set(ImageTexts *texts, const char *key, const char *value, Error *error)
{
    if (!image_texts_is_key(key))
        return error_set(
            error, RESULT_FAILED,
            "the name of an image's text: expected 1 to 79 characters that PNG allows");
    char *copy = strdup(value);
    ImageText *text = copy ? find_or_add(texts, key) : NULL;
    if (!text) {
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
