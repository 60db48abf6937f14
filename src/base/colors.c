// SPDX-License-Identifier: MIT
#include "base/colors.h"

#include <strings.h>

// Hair colours are means over a head in the studio light, not colours of highlights. All lie
// between what opaque fibres still reflect and what fibres without pigment reflect (docs/look.md).
const ColorName COLOR_NAMES[COLOR_NAME_COUNT] = {
    {"black", "#000000", "#262220"},
    {"silver", "#c0c0c0", "#8f8d89"},
    {"gray", "#808080", "#7c7974"},
    {"grey", "#808080", "#7c7974"},
    {"white", "#ffffff", "#9c9a96"},
    {"maroon", "#800000", NULL},
    {"red", "#ff0000", "#823f27"},
    {"purple", "#800080", NULL},
    {"fuchsia", "#ff00ff", NULL},
    {"green", "#008000", NULL},
    {"lime", "#00ff00", NULL},
    {"olive", "#808000", NULL},
    {"yellow", "#ffff00", NULL},
    {"navy", "#000080", NULL},
    {"blue", "#0000ff", NULL},
    {"teal", "#008080", NULL},
    {"aqua", "#00ffff", NULL},
    {"raven", NULL, "#212122"},
    {"dark-brown", NULL, "#3b2a21"},
    {"brown", NULL, "#5c4434"},
    {"light-brown", NULL, "#785b43"},
    {"chestnut", NULL, "#5f3a2a"},
    {"auburn", NULL, "#693527"},
    {"ginger", NULL, "#9a5833"},
    {"strawberry", NULL, "#9c7153"},
    {"dark-blond", NULL, "#8a7150"},
    {"blond", NULL, "#9c845c"},
    {"platinum", NULL, "#9c9480"},
    {"salt-and-pepper", NULL, "#6f6b66"},
};

const char *colors_find(const char *name, bool of_hair)
{
    for (size_t i = 0; i < COLOR_NAME_COUNT; i++) {
        const ColorName *color = &COLOR_NAMES[i];
        if (strcasecmp(color->name, name) != 0) continue;
        return color->hair && (of_hair || !color->css) ? color->hair : color->css;
    }
    return NULL;
}
