// SPDX-License-Identifier: MIT
#include "scene/scene.h"

#include <string.h>

enum { TURN_SECONDS = 6, TURN_FPS = 30 };

// A flag also replaces the keys or formulas that the scene file gives for the parameter.
static void drop_track(Scene *scene, const char *name)
{
    const struct {
        const char *name;
        Track *track;
    } tracks[] = {{"gravity", &scene->gravity},
                  {"wind", &scene->wind},
                  {"eye", &scene->eye},
                  {"target", &scene->target},
                  {"fov", &scene->fov}};
    for (size_t i = 0; i < sizeof tracks / sizeof tracks[0]; i++) {
        if (strcmp(name, tracks[i].name) == 0) track_destroy(tracks[i].track);
    }
}

// Sets a parameter of the run. An invalid value changes nothing.
static Result set_run(Scene *scene, const ParamInfo *info, const char *text, Error *error)
{
    TRY(params_parse(info, &scene->run, text, error));
    drop_track(scene, info->name);
    scene->origin[info - PARAM_TABLE] = ORIGIN_FLAG;
    return RESULT_OK;
}

// What is refused changes nothing.
static Result set_body(SceneBody *body, const ParamInfo *info, const char *text, Error *error)
{
    bool shapes = strcmp(info->name, "colliders") == 0;
    Colliders colliders = {0};
    Result result = shapes ? colliders_parse(&colliders, text, error) : RESULT_OK;
    THEN(result, params_parse(info, &body->params, text, error));
    if (result != RESULT_OK) {
        colliders_destroy(&colliders);
        return result;
    }
    body->origin[info - PARAM_TABLE] = ORIGIN_FLAG;
    if (!shapes) return RESULT_OK;
    colliders_destroy(&body->colliders);
    body->colliders = colliders;
    return RESULT_OK;
}

static Result set_section(Section *section, const ParamInfo *info, const char *text, Error *error)
{
    TRY(params_parse(info, &section->params, text, error));
    section_tracks_drop(&section->tracks, info);
    section->origin[info - PARAM_TABLE] = ORIGIN_FLAG;
    return RESULT_OK;
}

Result scene_set(Scene *scene, int section, const ParamInfo *info, const char *text, Error *error)
{
    if (info->scope == SCOPE_RUN) return set_run(scene, info, text, error);
    for (uint32_t i = 0; info->scope == SCOPE_BODY && i < scene->body_count; i++)
        TRY(set_body(&scene->bodies[i], info, text, error));
    if (info->scope == SCOPE_BODY) return RESULT_OK;
    if (section >= 0) return set_section(&scene->sections[section], info, text, error);
    for (uint32_t i = 0; i < scene->section_count; i++)
        TRY(set_section(&scene->sections[i], info, text, error));
    return RESULT_OK;
}

bool scene_has_default(const Scene *scene, const char *name)
{
    return scene->origin[params_find(name) - PARAM_TABLE] == ORIGIN_DEFAULT;
}

Result scene_choose_turn(Scene *scene, Error *error)
{
    RunParams *run = &scene->run;
    if (run->turntable == 0 || !scene_has_default(scene, "frames") ||
        !scene_has_default(scene, "fps"))
        return RESULT_OK;
    if (scene_has_default(scene, "sim_rate") && scene_has_default(scene, "speed"))
        TRY(params_parse(params_find("sim_rate"), run, params_find("fps")->default_text, error));
    run->frames = TURN_SECONDS * TURN_FPS;
    run->fps = TURN_FPS;
    return RESULT_OK;
}
