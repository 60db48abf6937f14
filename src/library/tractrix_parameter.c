// SPDX-License-Identifier: MIT
#include "library/library.h"

#include <stdlib.h>
#include <string.h>

// Parameters that only concern the program, which writes files, chooses devices and prints.
static const char *const OTHERS[] = {
    "check",        "output",      "size",          "depth",
    "exr_layers",   "exr_float",   "first",         "last",
    "every",        "part",        "contact_sheet", "caption",
    "cache",        "from_cache",  "export",        "export_followers",
    "resume",       "allow_paths", "stats",         "quiet",
    "verbose",      "sdf_cache",   "backend",       "device",
    "list_devices", "platform",    "software",      "require_hardware",
    "frame_number",
};

static const char *const LIVE[] = {
    "gravity", "wind",   "gust", "gust_period", "gust_repeat", "wind_spread",
    "eye",     "target", "fov",  "camera_up",   "sky",         "ground",
};

// Parameters of drawing alone: renderers are made anew when they change.
static const char *const LOOKS[] = {
    "aov",
    "ambient",
    "azimuthal_roughness",
    "background",
    "color",
    "color_variation",
    "cone_angle",
    "diffuse",
    "environment_strength",
    "environment_turn",
    "exponent1",
    "exponent2",
    "exposure",
    "floor_color",
    "lobes",
    "lod_end",
    "lod_min",
    "lod_start",
    "lod_width",
    "melanin",
    "melanin_redness",
    "mesh_color",
    "mesh_shading",
    "opacity",
    "refraction",
    "roughness",
    "samples",
    "scalp_tint",
    "scatter",
    "scatter_cells",
    "scatter_orders",
    "scatter_strands",
    "shading",
    "shadow",
    "shadow_opacity",
    "shadow_size",
    "shadow_spacing",
    "shadow_strands",
    "specular1",
    "specular2",
    "tip_color",
    "tip_length",
    "tone_map",
    "transmission",
    "warmth_variation",
};

static const char *const KINDS[] = {
    [PARAM_BOOL] = "bool",           [PARAM_INT] = "int",
    [PARAM_UINT] = "uint",           [PARAM_FLOAT] = "float",
    [PARAM_PROFILE] = "profile",     [PARAM_RATE] = "rate",
    [PARAM_TURN] = "turn",           [PARAM_VEC3] = "vec3",
    [PARAM_COLOR] = "color",         [PARAM_BACKGROUND] = "background",
    [PARAM_AUTO_INT] = "auto_int",   [PARAM_AUTO_FLOAT] = "auto_float",
    [PARAM_AUTO_VEC3] = "auto_vec3", [PARAM_AUTO_COLOR] = "auto_color",
    [PARAM_UNIT] = "unit",           [PARAM_SIZE] = "size",
    [PARAM_PART] = "part",           [PARAM_CHOICE] = "choice",
    [PARAM_TEXT] = "text",           [PARAM_PATH] = "path",
};

enum { ROWS = SCENE_PARAMS, MOST_CHOICES = 128 };

static struct {
    TractrixParameter row[ROWS];
    const ParamInfo *info[ROWS];
    char choices[ROWS][MOST_CHOICES];
    size_t count;
} table;

static bool lists(const char *const *names, size_t count, const char *name)
{
    for (size_t i = 0; i < count; ++i)
        if (strcmp(names[i], name) == 0) return true;
    return false;
}

static void join(char *text, const char *const *words)
{
    size_t length = 0;
    for (size_t i = 0; words[i]; ++i)
        length +=
            (size_t)snprintf(text + length, MOST_CHOICES - length, "%s%s", i ? " " : "", words[i]);
}

static void make_table(void)
{
    for (size_t i = 0; i < PARAM_COUNT; ++i) {
        const ParamInfo *info = &PARAM_TABLE[i];
        if (lists(OTHERS, sizeof OTHERS / sizeof *OTHERS, info->name)) continue;
        join(table.choices[table.count], info->choices);
        table.info[table.count] = info;
        table.row[table.count] = (TractrixParameter){
            .name = info->name,
            .kind = KINDS[info->kind],
            .unit = info->unit,
            .help = info->help,
            .default_text = info->default_text,
            .choices = table.choices[table.count],
            .owner = info->owner,
            .minimum = info->minimum,
            .maximum = info->maximum,
            .of_section = info->scope == SCOPE_SECTION,
            .live = library_is_live(info),
        };
        ++table.count;
    }
}

static void prepare(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, make_table);
}

bool library_is_live(const ParamInfo *info)
{
    return library_is_look(info) || lists(LIVE, sizeof LIVE / sizeof *LIVE, info->name);
}

bool library_is_look(const ParamInfo *info)
{
    return lists(LOOKS, sizeof LOOKS / sizeof *LOOKS, info->name);
}

const ParamInfo *library_parameter(const char *name)
{
    const ParamInfo *info = name ? params_find(name) : NULL;
    prepare();
    for (size_t i = 0; info && i < table.count; ++i)
        if (table.info[i] == info) return info;
    return NULL;
}

const TractrixParameter *tractrix_parameter(size_t index)
{
    LIBRARY_CALL;
    prepare();
    return index < table.count ? &table.row[index] : NULL;
}
