// SPDX-License-Identifier: MIT
// Texts stored with an image, by key, such as "Renderer" -> "llvmpipe (LLVM 15.0.6, 256 bits)".
// They become text chunks of PNG files.
#pragma once

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>

enum { IMAGE_TEXT_KEY_BYTES = 80 }; // with the zero; PNG's limit

typedef struct ImageText {
    char key[IMAGE_TEXT_KEY_BYTES]; // 1 to 79 ASCII characters; single spaces, only inside
    char *value;                    // UTF-8, owned
} ImageText;

// A list in the order of setting. A zeroed struct is an empty list and may be destroyed.
typedef struct ImageTexts {
    ImageText *list;
    size_t count;
} ImageTexts;

// Whether a key has the form above.
bool image_texts_is_key(const char *key);

// Sets the value of a key. Control characters other than newline become spaces, and each byte that
// is not UTF-8 becomes a question mark. RESULT_FAILED when memory is short or the key is invalid.
Result image_texts_set(ImageTexts *texts, const char *key, const char *value, Error *error);

// The value, NULL if there is none; valid until the next change.
const char *image_texts_find(const ImageTexts *texts, const char *key);

Result image_texts_copy(ImageTexts *texts, const ImageTexts *from, Error *error);
void image_texts_destroy(ImageTexts *texts);
