// SPDX-License-Identifier: MIT
// The colours that have a name, wherever a colour is read.
#pragma once

#include <stddef.h>

typedef struct ColorName {
    const char *name, *value; // "brown", "#6b4a36" (sRGB)
} ColorName;

// The 16 basic colours of CSS (CSS Color Module Level 4, 6.1; "gray" is also "grey"), then colours
// of hair as one sees them on a head.
enum { COLOR_NAME_COUNT = 29 };
extern const ColorName COLOR_NAMES[COLOR_NAME_COUNT];

// The value of a name, in any case, as "#rrggbb"; NULL: there is no such name, and *nearest, if not
// NULL, is one that is near or NULL.
const char *colors_find(const char *name, const char **nearest);
