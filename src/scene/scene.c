// SPDX-License-Identifier: MIT
#include "scene/scene.h"

#include "scene/axes.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

// --- Lights.

typedef struct LightSet {
    // Directions are unit vectors in the camera's frame: x right, y up, z towards the camera.
    Light lights[3];
    uint32_t count;
    bool turned; // turned with the automatic camera if it does not look along -z
} LightSet;

static const LightSet LOOK_LIGHTS[] = {
    // A key light from above left, a rim light from behind right, and a fill light that lifts black
    // shadows.
    [LOOK_STUDIO] =
        {{{.direction = {-0.48f, 0.64f, 0.6f}, .color = {1, 1, 1}, .intensity = 1, .shadow = true},
          {.direction = {0.64f, 0.48f, -0.6f},
           .color = {1, 1, 1},
           .intensity = 0.5f,
           .shadow = true},
          {.direction = {0.8f, 0, 0.6f}, .color = {1, 1, 1}, .intensity = 0.35f, .shadow = true}},
         3,
         true},
    // A light over the camera's left shoulder, and a weaker one from the right that lifts black
    // shadows.
    [LOOK_PLAIN] =
        {{{.direction = {-0.48f, 0.64f, 0.6f}, .color = {1, 1, 1}, .intensity = 1, .shadow = true},
          {.direction = {0.8f, 0, 0.6f}, .color = {1, 1, 1}, .intensity = 0.35f}},
         2,
         false},
};

void scene_set_lights(Scene *scene)
{
    const LightSet *set = &LOOK_LIGHTS[scene->run.look];
    Axes axes;
    if (scene->own_lights) return;
    if (*scene->run.environment) {
        scene->light_count = 0;
        return;
    }
    scene->light_count = set->count;
    memcpy(scene->lights, set->lights, sizeof set->lights);
    for (uint32_t i = 0; i < set->count; ++i) scene->lights[i].radius = scene->run.light_radius;
    if (!set->turned || !scene->run.eye.automatic || track_is_given(&scene->eye)) return;
    axes_find(&axes, scene->run.camera_up);
    for (uint32_t i = 0; i < set->count; ++i) {
        const float *d = set->lights[i].direction;
        for (int k = 0; k < 3; ++k)
            scene->lights[i].direction[k] =
                d[0] * axes.right[k] + d[1] * axes.top[k] + d[2] * axes.back[k];
    }
}

void scene_destroy(Scene *scene)
{
    for (uint32_t i = 0; i < scene->section_count; i++) {
        free(scene->sections[i].file);
        params_destroy_section(&scene->sections[i].params);
        section_tracks_destroy(&scene->sections[i].tracks);
    }
    free(scene->sections);
    free(scene->file);
    params_destroy_run(&scene->run);
    for (uint32_t i = 0; i < SCENE_MAX_BODIES; i++) {
        params_destroy_body(&scene->bodies[i].params);
        rigid_track_destroy(&scene->bodies[i].head);
        colliders_destroy(&scene->bodies[i].colliders);
    }
    track_destroy(&scene->gravity);
    track_destroy(&scene->wind);
    track_destroy(&scene->eye);
    track_destroy(&scene->target);
    track_destroy(&scene->fov);
    *scene = (Scene){0};
}

Result scene_add_section(Scene *scene, const char *file, const SectionParams *params, Error *error)
{
    if (scene->section_count == SCENE_MAX_SECTIONS)
        return error_set(error, RESULT_USAGE, "too many hair files: expected at most %d",
                         SCENE_MAX_SECTIONS);
    Section section = {.file = strdup(file)};
    Section *sections =
        realloc(scene->sections, (scene->section_count + (size_t)1) * sizeof sections[0]);
    if (sections) scene->sections = sections;
    if (!section.file || !sections) {
        free(section.file);
        return error_set(error, RESULT_FAILED, "out of memory");
    }
    Result result = params_copy_section(&section.params, params, error);
    if (result != RESULT_OK) {
        free(section.file);
        return result;
    }
    SceneBody *body = &scene->bodies[scene->body_count - 1];
    if (!body->section_count) body->first = scene->section_count;
    ++body->section_count;
    sections[scene->section_count++] = section;
    return RESULT_OK;
}

// --- Elements.

uint32_t scene_count(const Scene *scene, ParamScope scope)
{
    return scope == SCOPE_RUN ? 1 : scope == SCOPE_BODY ? scene->body_count : scene->section_count;
}

void *scene_params(const Scene *scene, ParamScope scope, uint32_t element)
{
    Scene *of = (Scene *)scene;
    return scope == SCOPE_RUN    ? (void *)&of->run
           : scope == SCOPE_BODY ? (void *)&of->bodies[element].params
                                 : &of->sections[element].params;
}

uint8_t *scene_origins(const Scene *scene, ParamScope scope, uint32_t element)
{
    Scene *of = (Scene *)scene;
    return scope == SCOPE_RUN    ? of->origin
           : scope == SCOPE_BODY ? of->bodies[element].origin
                                 : of->sections[element].origin;
}

const SceneBody *scene_body_of(const Scene *scene, uint32_t section)
{
    const SceneBody *body = scene->bodies;
    while (section >= body->first + body->section_count) ++body;
    return body;
}

ElementPlace scene_body_place(const Scene *scene, uint32_t body, const char *then)
{
    ElementPlace place = {""};
    if (scene->lists_bodies) snprintf(place.text, sizeof place.text, "bodies[%u]%s", body, then);
    return place;
}

ElementPlace scene_section_place(const Scene *scene, uint32_t section)
{
    const SceneBody *body = scene_body_of(scene, section);
    ElementPlace place = scene_body_place(scene, (uint32_t)(body - scene->bodies), ".");
    size_t length = strlen(place.text);
    snprintf(place.text + length, sizeof place.text - length, "sections[%u]",
             section - body->first);
    return place;
}

// --- Defaults that give way to other values.

// How the parameter got its value.
static Origin origin_of(const Section *section, const char *name)
{
    return (Origin)section->origin[params_find(name) - PARAM_TABLE];
}

// Resets a parameter, with its track, that another one replaces.
static void drop_transmission(Section *section)
{
    section->params.transmission = (AutoVec3){.automatic = true};
    section_tracks_drop(&section->tracks, params_find("transmission"));
}

static void drop_melanin(Section *section)
{
    section->params.melanin = (AutoFloat){.automatic = true};
    section_tracks_drop(&section->tracks, params_find("melanin"));
}

static void settle_section(Section *section)
{
    SectionParams *params = &section->params;
    Origin color = origin_of(section, "color"), crossed = origin_of(section, "transmission"),
           melanin = origin_of(section, "melanin"), of_file = origin_of(section, "file_colors"),
           opacity = origin_of(section, "file_opacity");
    if (color > crossed) drop_transmission(section);
    if (color > melanin || crossed > melanin) drop_melanin(section);
    bool refused = !params->file_colors && of_file > opacity;
    if (color > of_file || crossed > of_file || melanin > of_file) params->file_colors = false;
    if (refused || origin_of(section, "opacity") > opacity) params->file_opacity = false;
}

// Elastic strands keep their shape without springs.
static void settle_style(Section *section)
{
    if (section_is_elastic(&section->params) && origin_of(section, "style") == ORIGIN_DEFAULT)
        section->params.style = 0;
}

bool section_is_elastic(const SectionParams *params)
{
    return strcmp(params->algo, "rod") == 0 && strcmp(params->variant, "particles") != 0;
}

void scene_settle(Scene *scene)
{
    for (uint32_t i = 0; i < scene->section_count; ++i) {
        settle_section(&scene->sections[i]);
        settle_style(&scene->sections[i]);
    }
}

// --- Presets.

// The defaults in params.def are those of the studio look and of normal quality.
static const struct {
    const char *preset, *word, *name, *value;
} PRESETS[] = {
    {"look", "plain", "scalp", "none"},           {"look", "plain", "followers", "-1"},
    {"look", "plain", "follow", "offset"},        {"look", "plain", "shading", "kajiya"},
    {"look", "plain", "roughness", "8"},          {"look", "plain", "color", "#6b4a36"},
    {"look", "plain", "scatter", "none"},         {"look", "plain", "opacity", "0.6"},
    {"look", "plain", "color_variation", "0.35"}, {"look", "plain", "shadow", "none"},
    {"look", "plain", "shadow_opacity", "0.33"},  {"look", "plain", "sky", "#ffffff"},
    {"look", "plain", "ground", "#ffffff"},       {"look", "plain", "exposure", "0"},
    {"look", "plain", "tone_map", "none"},        {"look", "plain", "mesh_color", "#b08d78"},
    {"look", "plain", "scalp_tint", "0"},         {"look", "plain", "mesh_shading", "matt"},
    {"look", "plain", "background", "#20242b"},   {"look", "plain", "smooth", "1"},
    {"look", "plain", "shadow_size", "256"},      {"quality", "draft", "lod_width", "1"},
    {"quality", "draft", "smooth", "1"},          {"quality", "draft", "shadow_size", "256"},
    {"quality", "draft", "scatter_cells", "16"},  {"quality", "final", "shadow", "dom"},
    {"quality", "final", "shadow_size", "512"},   {"quality", "final", "samples", "2"},
    {"quality", "final", "smooth", "3"},          {"quality", "final", "scatter_cells", "48"},
};

static Result apply_preset(const char *preset, const char *word, ParamScope scope, void *params,
                           Error *error)
{
    RunParams unused = {0};
    if (!word) return RESULT_OK;
    Result result =
        params_parse(params_find(preset), scope == SCOPE_RUN ? params : &unused, word, error);
    if (result != RESULT_OK) return error_prefix(error, result, "--%s: ", preset);
    for (size_t i = 0; i < sizeof PRESETS / sizeof *PRESETS; ++i) {
        if (strcmp(PRESETS[i].preset, preset) != 0 || strcmp(PRESETS[i].word, word) != 0) continue;
        const ParamInfo *info = params_find(PRESETS[i].name);
        assert(info);
        if (info->scope == scope) TRY(params_parse(info, params, PRESETS[i].value, error));
    }
    return RESULT_OK;
}

Result scene_apply_presets(const Presets *presets, ParamScope scope, void *params, Error *error)
{
    TRY(apply_preset("look", presets->look, scope, params, error));
    return apply_preset("quality", presets->quality, scope, params, error);
}

// Applies a row of PRESETS to the run or the sections, unless the parameter was set otherwise.
static Result apply_row(Scene *scene, const char *name, const char *value, Error *error)
{
    const ParamInfo *info = params_find(name);
    size_t row = (size_t)(info - PARAM_TABLE);
    for (uint32_t i = 0; i < scene_count(scene, info->scope); ++i)
        if (scene_origins(scene, info->scope, i)[row] == ORIGIN_DEFAULT)
            TRY(params_parse(info, scene_params(scene, info->scope, i), value, error));
    return RESULT_OK;
}

// Whether the row does not apply to scene files, which state themselves what the scene contains.
static bool is_for_files(const Scene *scene, size_t i)
{
    return scene->file && strcmp(PRESETS[i].name, "scalp") == 0;
}

Result scene_set_preset(Scene *scene, const ParamInfo *info, const char *word, Error *error)
{
    static const char *const ORDER[] = {"look", "quality"};
    const size_t count = sizeof PRESETS / sizeof *PRESETS;
    TRY(params_parse(info, &scene->run, word, error));
    scene->origin[info - PARAM_TABLE] = ORIGIN_FLAG;
    const int words[] = {scene->run.look, scene->run.quality};
    for (size_t i = 0; i < count; ++i)
        if (!is_for_files(scene, i))
            TRY(apply_row(scene, PRESETS[i].name, params_find(PRESETS[i].name)->default_text,
                          error));
    for (size_t k = 0; k < 2; ++k)
        for (size_t i = 0; i < count; ++i)
            if (!is_for_files(scene, i) && strcmp(PRESETS[i].preset, ORDER[k]) == 0 &&
                strcmp(PRESETS[i].word, params_find(ORDER[k])->choices[words[k]]) == 0)
                TRY(apply_row(scene, PRESETS[i].name, PRESETS[i].value, error));
    return RESULT_OK;
}

Result scene_create_as(Scene *scene, const Presets *presets, Error *error)
{
    *scene = (Scene){0};
    TRY(params_create_run(&scene->run, error));
    TRY(params_create_body(&scene->bodies[0].params, error));
    scene->body_count = 1;
    TRY(scene_apply_presets(presets, SCOPE_RUN, &scene->run, error));
    scene_set_lights(scene);
    return RESULT_OK;
}

Result scene_create(Scene *scene, Error *error)
{
    return scene_create_as(scene, &(Presets){0}, error);
}
