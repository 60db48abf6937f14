// SPDX-License-Identifier: MIT
#include "scene/effects.h"
#include "base/quote.h"
#include "scene/fit.h"

#include <stdlib.h>
#include <string.h>

// --- Conditions. `body` is NULL for parameters of the run; `of` and its parameters `section` for
// those of run and bodies.

#define CONDITION(name, holds)                                                                     \
    static bool name(const Scene *scene, const SceneBody *body, const Section *of,                 \
                     const SectionParams *section)                                                 \
    {                                                                                              \
        (void)scene, (void)body, (void)of, (void)section;                                          \
        return holds;                                                                              \
    }
// One that holds for any body where the parameter is the run's.
#define BODY_CONDITION(name, holds)                                                                \
    static bool name##_of(const Scene *scene, const SceneBody *body)                               \
    {                                                                                              \
        (void)scene;                                                                               \
        return holds;                                                                              \
    }                                                                                              \
    CONDITION(name, holds_for(scene, body, name##_of))
static bool writes(const char *output, const char *suffix)
{
    size_t length = strlen(output), own = strlen(suffix);
    return length >= own && strcasecmp(output + length - own, suffix) == 0;
}

static bool reads_any_file(const Scene *scene)
{
    bool any = !scene->section_count;
    for (uint32_t i = 0; i < scene->section_count; ++i) any = any || !scene->sections[i].given;
    return any;
}

static bool holds_for(const Scene *scene, const SceneBody *body,
                      bool (*holds)(const Scene *scene, const SceneBody *body))
{
    bool any = body && holds(scene, body);
    for (uint32_t i = 0; !body && i < scene->body_count; ++i)
        any = any || holds(scene, &scene->bodies[i]);
    return any;
}

// An OBJ or PLY file is a single shape; a pattern names a sequence.
static bool may_deform(const char *mesh)
{
    bool shape = writes(mesh, ".obj") || writes(mesh, ".ply");
    return *mesh && (!shape || strchr(mesh, '%'));
}

CONDITION(reads_files, reads_any_file(scene))
CONDITION(reads_file, !of->given)
BODY_CONDITION(reads_mesh, !body->given_mesh)
// Without a mesh, a head may be fitted to the hair.
BODY_CONDITION(has_head, *body->params.mesh || scene->run.scalp != SCALP_NONE)
BODY_CONDITION(has_colliders,
               body->colliders.count > 0 || (body->params.collide_mesh && has_head_of(scene, body)))
CONDITION(collides, section->collide)
BODY_CONDITION(collides_mesh, body->params.collide_mesh)
BODY_CONDITION(has_mesh, *body->params.mesh)
BODY_CONDITION(has_sequence, may_deform(body->params.mesh))
CONDITION(has_wind, track_is_given(&scene->wind) || scene->run.wind[0] != 0 ||
                        scene->run.wind[1] != 0 || scene->run.wind[2] != 0)
CONDITION(has_gusts, scene->run.gust > 0)
CONDITION(has_shadows, scene->run.shadow != SHADOW_NONE)
CONDITION(guesses_shadows, scene->run.shadow == SHADOW_APPROX)
CONDITION(has_floor, scene->run.floor != FLOOR_NONE)
CONDITION(has_matt_floor, scene->run.floor == FLOOR_PLANE)
CONDITION(has_environment, *scene->run.environment)
CONDITION(has_plain_background, !scene->run.environment_background)
CONDITION(has_sky, !*scene->run.environment)
CONDITION(has_look_lights, !scene->own_lights && !*scene->run.environment)
CONDITION(turns, scene->run.turntable != 0)
CONDITION(frames_hair, scene->run.eye.automatic && !track_is_given(&scene->eye))
CONDITION(knows_jumps, scene->run.teleport != TELEPORT_NONE)
CONDITION(exports, *scene->run.export)
CONDITION(writes_exr, writes(scene->run.output, ".exr"))
CONDITION(sorts, scene->run.oit != OIT_NONE)
CONDITION(has_far_end, scene->run.lod_end > 0)
CONDITION(thins, scene->run.lod_end > 0 || scene->run.lod_width > 0)
CONDITION(follows, section->followers.automatic || section->followers.value != 0)
CONDITION(is_marschner, section->shading == SHADING_MARSCHNER)
CONDITION(is_kajiya, section->shading == SHADING_KAJIYA)
CONDITION(has_tips, section->tip_length > 0)
CONDITION(has_pigment, !section->melanin.automatic)
CONDITION(shows_color, section->transmission.automatic && section->melanin.automatic)
CONDITION(shows_transmission, section->melanin.automatic)
CONDITION(scatters, scene->run.shadow == SHADOW_DOM)
CONDITION(has_grid, scene->run.scatter != SCATTER_NONE)
CONDITION(has_style, section->style > 0 || section_is_elastic(section))
CONDITION(is_smooth, section->smooth > 1)
CONDITION(moves, strcmp(section->algo, "none") != 0)

// The condition of each parameter, and the reason to print if it does not hold.
static const struct {
    const char *names; // names, separated by blanks
    bool (*holds)(const Scene *scene, const SceneBody *body, const Section *of,
                  const SectionParams *section);
    const char *why;
} EFFECTS[] = {
    {"unit up group array points_per_strand", reads_file, "the hair is from an array"},
    {"strict", reads_files, "the hair is from an array"},
    {"mesh_unit mesh_up mesh_rest mesh_fps mesh_start mesh_motion", reads_mesh,
     "the mesh is from an array"},
    {"exr_layers exr_float", writes_exr, "--output is no .exr file"},
    {"collide friction collision_margin", has_colliders,
     "no --colliders, --mesh or --scalp to collide with"},
    {"friction collision_margin", collides, "--no-collide"},
    {"collide_mesh", has_head, "there is no --mesh and no --scalp"},
    {"mesh_unit mesh_up sdf_resolution sdf_cache", has_mesh, "there is no --mesh"},
    {"mesh_color mesh_shading scalp_tint", has_head, "there is no --mesh and no --scalp"},
    {"mesh_rest mesh_fps mesh_start mesh_motion", has_sequence, "--mesh does not deform"},
    {"sdf_resolution sdf_cache", collides_mesh, "--no-collide-mesh"},
    {"rest", has_style, "--style is 0"},
    {"volume", moves, "--algo is none"},
    {"gust gust_period gust_repeat wind_spread wind_shelter", has_wind, "there is no --wind"},
    {"gust_period gust_repeat", has_gusts, "--gust is 0"},
    {"teleport_distance teleport_angle", knows_jumps, "--teleport is none"},
    {"follow follower_radius tip_separation clump", follows, "--followers is 0"},
    {"export_followers", exports, "there is no --export"},
    {"margin", frames_hair, "--eye is given"},
    {"environment_strength environment_turn environment_background", has_environment,
     "there is no --environment"},
    {"background", has_plain_background, "--environment-background is given"},
    {"light_radius", has_look_lights, "the scene or --environment replaces the lights of the look"},
    {"sky ground", has_sky, "--environment is given"},
    {"turn_lights ease_in ease_out", turns, "there is no --turntable"},
    {"shadow_size shadow_strands shadow_opacity", has_shadows, "--shadow is none"},
    {"shadow_spacing", guesses_shadows, "only --shadow approx uses it"},
    {"floor_height", has_floor, "--floor is none"},
    {"floor_color", has_matt_floor, "only --floor plane uses it"},
    {"refraction roughness lobes azimuthal_roughness", is_marschner,
     "only --shading marschner uses it"},
    {"specular1 exponent1 specular2 exponent2", is_kajiya, "only --shading kajiya uses it"},
    {"ambient diffuse", is_kajiya, "only --shading kajiya uses it"},
    {"color", shows_color, "--transmission or --melanin is given"},
    {"transmission", shows_transmission, "--melanin is given"},
    {"scatter scatter_cells scatter_orders scatter_strands", scatters, "--shadow is not dom"},
    {"scatter_cells scatter_orders scatter_strands", has_grid, "--scatter is none"},
    {"tip_color", has_tips, "--tip-length is 0"},
    {"melanin_redness", has_pigment, "--melanin is auto"},
    {"curve", is_smooth, "--smooth is 1"},
    {"lod_start", has_far_end, "--lod-end is 0"},
    {"lod_min", thins, "--lod-end and --lod-width are 0"},
    {"oit_layers", sorts, "--oit is none"},
};

static bool lists(const char *names, const char *name)
{
    size_t length = strlen(name);
    for (const char *at = names; (at = strstr(at, name)); ++at)
        if ((at == names || at[-1] == ' ') && (!at[length] || at[length] == ' ')) return true;
    return false;
}

// Why the parameter has no effect in this element of its scope. Returns NULL if it has an effect.
static const char *find_reason(const ParamInfo *info, const Scene *scene, uint32_t element,
                               char text[80])
{
    const Section *section = info->scope == SCOPE_SECTION ? &scene->sections[element] : NULL;
    const SceneBody *body = section                    ? scene_body_of(scene, element)
                            : info->scope == SCOPE_RUN ? NULL
                                                       : &scene->bodies[element];
    if (section && !params_owned_by(info, section->params.algo)) {
        snprintf(text, 80, "--algo %.40s has no such parameter", section->params.algo);
        return text;
    }
    const SectionParams *params = section ? &section->params : NULL;
    for (size_t i = 0; i < sizeof EFFECTS / sizeof *EFFECTS; ++i)
        if (lists(EFFECTS[i].names, info->name) &&
            !EFFECTS[i].holds(scene, body, section, params)) {
            snprintf(text, 80, "has no effect: %s", EFFECTS[i].why);
            return text;
        }
    return NULL;
}

// Why the parameter has no effect in any section that got its value from `origin`. NULL if it has
// an effect in one of them, or if there are none.
static const char *find_shared_reason(const ParamInfo *info, const Scene *scene, Origin origin,
                                      char text[80])
{
    size_t row = (size_t)(info - PARAM_TABLE);
    const char *reason = NULL;
    for (uint32_t i = 0; i < scene_count(scene, info->scope); ++i) {
        if (scene_origins(scene, info->scope, i)[row] != origin) continue;
        reason = find_reason(info, scene, i, text);
        if (!reason) return NULL;
    }
    return reason;
}

static Result check_framing(const Scene *scene, Error *error)
{
    const RunParams *run = &scene->run;
    bool fits = run->framing == FRAMING_HAIR || run->framing == FRAMING_ALL;
    if (fits && !fit_is_free(scene))
        return error_set(error, RESULT_USAGE,
                         "--framing %s: expected an automatic --eye, and no keys of eye or target",
                         run->framing == FRAMING_ALL ? "all" : "hair");
    return RESULT_OK;
}

Result effects_check(const Scene *scene, Error *error)
{
    char reason[80], flag[80];
    TRY(check_framing(scene, error));
    for (size_t i = 0; i < PARAM_COUNT; ++i) {
        const ParamInfo *info = &PARAM_TABLE[i];
        if (!find_shared_reason(info, scene, ORIGIN_FLAG, reason)) continue;
        snprintf(flag, sizeof flag, "--%s", info->name);
        for (char *at = flag; *at; ++at)
            if (*at == '_') *at = '-';
        return error_set(error, RESULT_USAGE, "%s: %s", flag, reason);
    }
    return RESULT_OK;
}

static bool is_default(const ParamInfo *info, const void *params)
{
    char *text = params_format(info, params);
    bool same = text && strcmp(text, info->default_text) == 0;
    free(text);
    return same;
}

// Where an element's own keys stand in the scene file.
static ElementPlace place_of(const Scene *scene, ParamScope scope, uint32_t element)
{
    return scope == SCOPE_SECTION ? scene_section_place(scene, element)
                                  : scene_body_place(scene, element, "");
}

void effects_warn(const Scene *scene, FILE *stream)
{
    char reason[80];
    for (size_t i = 0; i < PARAM_COUNT; ++i) {
        const ParamInfo *info = &PARAM_TABLE[i];
        uint32_t count = scene_count(scene, info->scope);
        if (count && !is_default(info, scene_params(scene, info->scope, 0)) &&
            find_shared_reason(info, scene, ORIGIN_SHARED_KEY, reason))
            fprintf(stream, "%s: %s: %s\n", quote(scene->file).text, info->name, reason);
        for (uint32_t e = 0; e < count; ++e)
            if (scene_origins(scene, info->scope, e)[i] == ORIGIN_KEY &&
                !is_default(info, scene_params(scene, info->scope, e)) &&
                find_reason(info, scene, e, reason))
                fprintf(stream, "%s: %s.%s: %s\n", quote(scene->file).text,
                        place_of(scene, info->scope, e).text, info->name, reason);
    }
}
