// SPDX-License-Identifier: MIT
// Named colours, for all places that read a colour.
#pragma once

#include <stdbool.h>
#include <stddef.h>

typedef struct ColorName {
    const char *name;
    const char *css;  // "#6b4a36" (sRGB); NULL if the name exists only for hair
    const char *hair; // apparent colour on a head; NULL: as in CSS
} ColorName;

// The 16 basic colours of CSS (CSS Color Module Level 4, 6.1; "gray" is also "grey"), and colours
// of hair.
enum { COLOR_NAME_COUNT = 29 };
extern const ColorName COLOR_NAMES[COLOR_NAME_COUNT];

// The value of a name (case-insensitive) as "#rrggbb": that of hair (`of_hair`), otherwise that of
// CSS if it has one. NULL if there is no such name.
const char *colors_find(const char *name, bool of_hair);
