// SPDX-License-Identifier: MIT
// The colours that have a name, wherever a colour is read.
#pragma once

#include <stdbool.h>
#include <stddef.h>

typedef struct ColorName {
    const char *name;
    const char *css;  // "#6b4a36" (sRGB); NULL: hair has it alone
    const char *hair; // of hair, as one sees it on a head; NULL: as CSS has it
} ColorName;

// The 16 basic colours of CSS (CSS Color Module Level 4, 6.1; "gray" is also "grey"), and colours
// of hair.
enum { COLOR_NAME_COUNT = 29 };
extern const ColorName COLOR_NAMES[COLOR_NAME_COUNT];

// The value of a name, in any case, as "#rrggbb": of hair (`of_hair`), or else as CSS has it if it
// does. NULL: there is no such name, and *nearest, if not NULL, is one that is near or NULL.
const char *colors_find(const char *name, bool of_hair, const char **nearest);
