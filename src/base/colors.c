// SPDX-License-Identifier: MIT
#include "base/colors.h"

#include "base/suggest.h"

#include <strings.h>

const ColorName COLOR_NAMES[COLOR_NAME_COUNT] = {
    {"black", "#000000"},
    {"silver", "#c0c0c0"},
    {"gray", "#808080"},
    {"grey", "#808080"},
    {"white", "#ffffff"},
    {"maroon", "#800000"},
    {"red", "#ff0000"},
    {"purple", "#800080"},
    {"fuchsia", "#ff00ff"},
    {"green", "#008000"},
    {"lime", "#00ff00"},
    {"olive", "#808000"},
    {"yellow", "#ffff00"},
    {"navy", "#000080"},
    {"blue", "#0000ff"},
    {"teal", "#008080"},
    {"aqua", "#00ffff"},
    {"raven", "#1c1613"},
    {"dark-brown", "#3b281d"},
    {"brown", "#6b4a36"},
    {"light-brown", "#916b4a"},
    {"chestnut", "#6f3d26"},
    {"auburn", "#80402a"},
    {"ginger", "#b5652f"},
    {"strawberry", "#cf9468"},
    {"dark-blond", "#a08257"},
    {"blond", "#d2b280"},
    {"platinum", "#e6dac0"},
    {"salt-and-pepper", "#8b857e"},
};

const char *colors_find(const char *name, const char **nearest)
{
    const char *names[COLOR_NAME_COUNT];
    for (size_t i = 0; i < COLOR_NAME_COUNT; i++) {
        names[i] = COLOR_NAMES[i].name;
        if (strcasecmp(names[i], name) == 0) return COLOR_NAMES[i].value;
    }
    if (nearest) *nearest = suggest_nearest(name, names, COLOR_NAME_COUNT);
    return NULL;
}
