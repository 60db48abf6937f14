// SPDX-License-Identifier: MIT
#include "scene/assets.h"
#include "base/quote.h"

#include "base/activity.h"
#include "formats/mesh_read.h"
#include "formats/mesh_sequence.h"
#include "formats/strands_numbered.h"
#include "formats/strands_read.h"
#include "scene/root_distance.h"
#include "strands/paint.h"
#include "strands/strands_edit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static StrandsReadOptions read_options(const Scene *scene, const Section *section)
{
    return (StrandsReadOptions){
        .unit = section->params.unit.automatic ? 0 : section->params.unit.value,
        .up = (UpAxis)section->params.up,
        .strict = scene->run.strict,
        .seed = scene->run.seed,
        .points_per_strand = section->params.points_per_strand,
        .array = section->params.array,
        .objects = section->params.object,
    };
}

// Warns about requests of the file that are not supported.
static void warn_ignored(const Strands *strands, const char *file, FILE *messages)
{
    if (strands->both_ends_fixed)
        fprintf(messages, "%s: the file fixes both ends of its strands; here the tips move\n",
                quote(file).text);
    uint32_t loose = strands_held_elsewhere(strands);
    if (loose)
        fprintf(messages,
                "%s: %u strands have mobility 0 behind vertices that may move; only those next to "
                "the root move with the head\n",
                quote(file).text, loose);
}

static Result take_given(Assets *assets, uint32_t i, const Strands *given, Error *error)
{
    StrandsReport *report = &assets->reports[i];
    *report = (StrandsReport){.kind = FORMAT_KINDS, .unit_used = 1};
    TRY(strands_join(&assets->strands[i], given, 1, error));
    return strands_report_measure(report, given, error);
}

// Prints the look that the file asks for.
static void print_look(const Strands *strands, const Section *section, FILE *messages)
{
    char look[160];
    if (paint_describe(strands, &section->params, look, sizeof look))
        fprintf(messages, "%s: the file's %s\n", quote(section->file).text, look);
}

// Sets a parameter that neither scene nor command line set, if the value is in its range.
static void set_default(Section *section, const char *name, float *to, double value)
{
    const ParamInfo *info = params_find(name);
    if (section->origin[info - PARAM_TABLE] == ORIGIN_DEFAULT && value >= info->minimum &&
        value <= info->maximum)
        *to = (float)value;
}

// The file's material is the default of elastic strands.
static void take_fibre(Section *section, const Strands *strands, FILE *messages)
{
    SectionParams *params = &section->params;
    if (!section_is_elastic(params) || !fibre_is_known(&strands->fibre)) return;
    Fibre fibre = fibre_of(params);
    fibre_fill(&fibre, &strands->fibre);
    set_default(section, "youngs_modulus", &params->youngs_modulus, fibre.youngs_modulus / 1e9);
    set_default(section, "poisson", &params->poisson, fibre.poisson);
    set_default(section, "hair_density", &params->hair_density, fibre.density);
    set_default(section, "hair_radius", &params->hair_radius, fibre.radius * 1e6);
    if (messages)
        fprintf(messages,
                "%s: the file has a material: %.4g GPa, Poisson's ratio %.4g, %.4g kg/m3, radius "
                "%.4g um are used\n",
                quote(section->file).text, (double)params->youngs_modulus, (double)params->poisson,
                (double)params->hair_density, (double)params->hair_radius);
}

// Removes all other groups; the frames keep all their vertices.
static Result pick_group(Strands *strands, StrandsFrames *frames, const Section *section,
                         Error *error)
{
    double group = (double)section->params.group.value;
    uint32_t kept = 0;
    for (uint32_t s = 0; frames->count && s < strands->strand_count; ++s)
        if ((strands->strand_group ? (double)strands->strand_group[s] : 0) == group)
            frames->first_vertex[kept++] = strands->first[s];
    Result result = strands_pick_group(strands, group, error);
    if (result == RESULT_OK) return result;
    return error_prefix(error, result, "%s: --group: ", section->file);
}

// --- Far from the world's zero: all places are relative to Scene.world_origin.

// Whether the scene's places can be moved: those that are formulas or keys stay.
static bool can_recenter(const Scene *scene)
{
    return scene->plays && scene->body_count == 1 && !track_is_given(&scene->eye) &&
           !track_is_given(&scene->target) && !scene->sections[0].given;
}

static void move_back(float point[3], const double origin[3])
{
    for (int k = 0; k < 3; ++k) point[k] = (float)(point[k] - origin[k]);
}

static void move_collider(Collider *collider, const double origin[3])
{
    float *numbers = collider->numbers;
    switch (collider->kind) {
    case COLLIDER_CAPSULE:
        move_back(numbers + 4, origin);
        move_back(numbers, origin);
        break;
    case COLLIDER_SPHERE:
        move_back(numbers, origin);
        break;
    case COLLIDER_GROUND:
        numbers[0] = (float)(numbers[0] - origin[1]);
        break;
    case COLLIDER_PLANE:
        for (int k = 0; k < 3; ++k)
            numbers[3] = (float)(numbers[3] - (double)numbers[k] * origin[k]);
        break;
    case COLLIDER_KINDS:
        break;
    }
}

// Moves the scene's places, once the first section's hair has its origin.
static void recenter(Scene *scene, const Strands *first, FILE *messages)
{
    RunParams *run = &scene->run;
    const double *o = first->origin;
    memcpy(scene->world_origin, o, sizeof scene->world_origin);
    if (o[0] == 0 && o[1] == 0 && o[2] == 0) return;
    if (!run->eye.automatic) move_back(run->eye.value, o);
    if (!run->target.automatic) move_back(run->target.value, o);
    if (!run->floor_height.automatic)
        run->floor_height.value = (float)(run->floor_height.value - o[1]);
    for (uint32_t i = 0; i < scene->light_count; ++i)
        if (scene->lights[i].kind != LIGHT_DIRECTIONAL) move_back(scene->lights[i].position, o);
    for (uint32_t b = 0; b < scene->body_count; ++b) {
        move_back(scene->bodies[b].head.pivot, o);
        for (uint32_t i = 0; i < scene->bodies[b].colliders.count; ++i)
            move_collider(&scene->bodies[b].colliders.list[i], o);
    }
    if (messages)
        fprintf(messages,
                "the hair is %.4g m from the world's zero: places are relative to %g,%g,%g\n",
                sqrt(o[0] * o[0] + o[1] * o[1] + o[2] * o[2]), o[0], o[1], o[2]);
}

// --- Animated hair.

static bool has_default(const Section *section, const char *name)
{
    return section->origin[params_find(name) - PARAM_TABLE] == ORIGIN_DEFAULT;
}

// Whether the section's file is played if it is animated.
static bool may_play(const Scene *scene, const Section *section)
{
    return scene->plays && section->params.hair_frame.automatic &&
           (has_default(section, "algo") || strcmp(section->params.algo, "none") == 0);
}

// The rest pose is that of --hair-frame.
static Result take_frame(Strands *strands, const StrandsFrames *frames, const Section *section,
                         Error *error)
{
    const AutoInt *wanted = &section->params.hair_frame;
    int place = wanted->value - frames->first, count = (int)frames->count;
    if (wanted->automatic) return RESULT_OK;
    if (count == 0)
        return error_set(error, RESULT_USAGE,
                         "%s: --hair-frame has no effect: the file has one frame", section->file);
    if (place < 0 || place >= count)
        return error_set(error, RESULT_USAGE, "%s: --hair-frame %d: the file has frames %d to %d",
                         section->file, wanted->value, frames->first, frames->first + count - 1);
    memcpy(strands->position, frames->position + (size_t)place * strands->vertex_count,
           strands->vertex_count * sizeof *strands->position);
    return RESULT_OK;
}

// Makes a section play its file's frames.
static Result play(Assets *assets, Scene *scene, uint32_t i, FILE *messages, Error *error)
{
    Section *section = &scene->sections[i];
    StrandsFrames *frames = &assets->frames[i];
    const Strands *strands = &assets->strands[i];
    char *none = strdup("none");
    frames->first_vertex = malloc(((size_t)strands->strand_count + 1) * sizeof(uint32_t));
    if (!frames->first_vertex || !none) {
        free(none);
        return error_set(error, RESULT_FAILED, "no memory for %s", section->file);
    }
    memcpy(frames->first_vertex, strands->first,
           ((size_t)strands->strand_count + 1) * sizeof(uint32_t));
    free(section->params.algo);
    section->params.algo = none;
    if (!(frames->fps > 0)) frames->fps = scene->run.fps;
    section->frames = frames;
    if (messages)
        fprintf(
            messages,
            "%s: %u frames from %d on, %.6g a second, are played; --algo NAME simulates instead\n",
            quote(section->file).text, frames->count, frames->first, frames->fps);
    return RESULT_OK;
}

// The run's frames and rate are those of the longest animation that is played.
static void take_length(Scene *scene)
{
    RunParams *run = &scene->run;
    const StrandsFrames *longest = NULL;
    for (uint32_t i = 0; i < scene->section_count; ++i) {
        const StrandsFrames *frames = scene->sections[i].frames;
        if (frames && (!longest || frames->count > longest->count)) longest = frames;
    }
    if (!longest) return;
    if (scene_has_default(scene, "fps") && longest->fps >= 0.001 && longest->fps <= 10000)
        run->fps = longest->fps;
    double frames = (longest->count - 1) * run->fps / (longest->fps * (double)run->speed);
    if (scene_has_default(scene, "frames") && run->speed > 0 && frames < 1e7)
        run->frames = (int)(frames + 1e-6) + 1;
}

// The number of the first frame: that of the hair that is played, otherwise of the mesh.
static Result number_frames(Assets *assets, Scene *scene, Error *error)
{
    RunParams *run = &scene->run;
    for (uint32_t i = scene->section_count; i-- > 0;)
        if (scene->sections[i].frames) assets->first_number = scene->sections[i].frames->first;
    if (!scene->plays) return RESULT_OK;
    if (run->frame_number.automatic)
        run->frame_number = (AutoInt){.value = assets->first_number > 0 ? assets->first_number : 0};
    return scene_number_frames(scene, error);
}

static Result load_section(Assets *assets, Scene *scene, uint32_t i, FILE *messages, bool verbose,
                           Error *error)
{
    const Section *section = &scene->sections[i];
    StrandsReadOptions options = read_options(scene, section);
    options.recenters = i == 0 && can_recenter(scene);
    options.origin = scene->world_origin;
    if (section->given) return take_given(assets, i, section->given, error);
    activity_set("reading hair");
    bool plays = may_play(scene, section), all = plays || !section->params.hair_frame.automatic;
    StrandsFrames *frames = &assets->frames[i];
    Result result = strands_read_any(&assets->strands[i], all ? frames : NULL, section->file,
                                     &options, &assets->reports[i], error);
    activity_set(NULL);
    if (result == RESULT_OK && options.recenters) recenter(scene, &assets->strands[i], messages);
    THEN(result, take_frame(&assets->strands[i], frames, section, error));
    if (!plays || frames->count < 2) strands_frames_destroy(frames);
    if (result == RESULT_OK && frames->count) result = play(assets, scene, i, messages, error);
    if (result == RESULT_OK && !section->params.group.automatic)
        result = pick_group(&assets->strands[i], frames, section, error);
    if (result != RESULT_OK || !messages) return result;
    strands_report_print_mended(&assets->reports[i], section->file, messages);
    warn_ignored(&assets->strands[i], section->file, messages);
    if (!i || !strands_report_same_guess(&assets->reports[i - 1], &assets->reports[i]))
        strands_report_print_guess(&assets->reports[i], section->file, messages);
    print_look(&assets->strands[i], section, messages);
    if (verbose) strands_report_print(&assets->reports[i], section->file, messages);
    return RESULT_OK;
}

// The median distance of the roots from the mesh shows whether the hair belongs to it.
static void warn_apart(const Body *body, FILE *messages)
{
    float apart = body_distance(body);
    if (messages && apart > BODY_APART)
        fprintf(
            messages,
            "%s: half of the roots are more than %.3g mm from the mesh: expected the mesh on which "
            "the hair was groomed (--mesh-rest)\n",
            quote(body->name).text, 1e3 * (double)apart);
}

// A body to be loaded, and the results.
typedef struct BodyLoad {
    Assets *assets;
    const RunParams *run;
    const double *origin; // the scene's
    SceneBody *body;
    Mesh *mesh;
    Body *shape;
    FILE *messages;
} BodyLoad;

// Binds the hair to the mesh, and makes the mesh move the head.
static Result bind_hair(const BodyLoad *load, MeshSequence *sequence, const Mesh *rest,
                        Error *error)
{
    SceneBody *body = load->body;
    const BodyOptions options = {.name = body->params.mesh,
                                 .driven = body->given_mesh && body->given_mesh->deforms,
                                 .cut_distance = load->run->teleport_distance,
                                 .cut_angle_deg = load->run->teleport_angle};
    const RigidTrack *head = &body->head;
    bool tracked = track_is_given(&head->translation) || track_is_given(&head->rotation);
    TRY(body_create(load->shape, sequence, load->mesh, rest, &load->assets->strands[body->first],
                    body->section_count, &options, error));
    warn_apart(load->shape, load->messages);
    body->shape = load->shape;
    body->head.samples = &load->shape->head;
    if (!tracked) body_middle(load->shape, body->head.pivot);
    return RESULT_OK;
}

static Result load_sequence(const BodyLoad *load, const MeshSequenceOptions *options, Error *error)
{
    MeshSequence sequence = {0};
    Mesh rest = {0};
    Result result =
        mesh_sequence_read(&sequence, load->mesh, &rest, load->body->params.mesh, options, error);
    bool deforms = sequence.times.count > 1 || rest.vertex_count > 0;
    if (result == RESULT_OK && sequence.times.count > 1 && load->assets->first_number == 0 &&
        sequence.first > 0 && sequence.first < 1e8)
        load->assets->first_number = (int)(sequence.first + 0.5);
    if (result == RESULT_OK && load->messages && *sequence.note)
        fprintf(load->messages, "%s: %s\n", quote(load->body->params.mesh).text, sequence.note);
    if (result == RESULT_OK && deforms) result = bind_hair(load, &sequence, &rest, error);
    mesh_sequence_destroy(&sequence);
    mesh_destroy(&rest);
    return result;
}

// Prepares a mesh that the caller drives by body_drive: two equal samples stand for the samples to
// come. Vertices may move by up to a quarter of the mesh's longest side.
static Result drive_given(const BodyLoad *load, Error *error)
{
    const Mesh *mesh = load->mesh, none = {0};
    MeshSequence sequence = {.times = {.count = 2, .rate = 1, .linear = true},
                             .vertex_count = mesh->vertex_count};
    size_t size = mesh->vertex_count * sizeof *mesh->position;
    sequence.position = malloc(2 * size);
    if (!sequence.position)
        return error_set(error, RESULT_FAILED, "no memory for a mesh that deforms");
    for (uint32_t i = 0; i < 2; ++i) memcpy(mesh_sequence_at(&sequence, i), mesh->position, size);
    rigid_track_destroy(&load->body->head); // the caller moves the head
    Result result = bind_hair(load, &sequence, &none, error);
    mesh_sequence_destroy(&sequence);
    if (result != RESULT_OK) return result;
    float low[3], high[3];
    mesh_bounds(mesh, low, high);
    for (int k = 0; k < 3; ++k)
        load->shape->margin = fmaxf(load->shape->margin, 0.25f * (high[k] - low[k]));
    return RESULT_OK;
}

static Result take_given_mesh(const BodyLoad *load, Error *error)
{
    const Mesh *given = &load->body->given_mesh->mesh;
    Mesh *mesh = load->mesh;
    TRY(mesh_create(mesh, given->vertex_count, given->triangle_count, error));
    memcpy(mesh->position, given->position, given->vertex_count * sizeof *given->position);
    memcpy(mesh->triangle, given->triangle, given->triangle_count * sizeof *given->triangle);
    mesh_compute_normals(mesh);
    return load->body->given_mesh->deforms ? drive_given(load, error) : RESULT_OK;
}

static Result load_body(const BodyLoad *load, Error *error)
{
    const SceneBody *body = load->body;
    const BodyParams *params = &body->params;
    if (body->given_mesh) return take_given_mesh(load, error);
    if (!*params->mesh) return RESULT_OK;
    const StrandsReport *first = body->section_count ? &load->assets->reports[body->first] : NULL;
    MeshSequenceOptions options = {
        .unit = params->mesh_unit.automatic ? 0 : (double)params->mesh_unit.value,
        .otherwise_unit = first ? (double)first->unit_used : 1,
        .up_z = params->mesh_up == UP_AUTO ? -1 : params->mesh_up == UP_Z,
        .otherwise_up_z = first && first->up_z,
        .rest = params->mesh_rest,
        .objects = params->mesh_object,
        .rate = params->mesh_fps.automatic ? 0 : (double)params->mesh_fps.value,
        .otherwise_rate = (double)load->run->fps,
        .start = (double)params->mesh_start,
        .linear = params->mesh_motion == MESH_LINEAR,
    };
    memcpy(options.origin, load->origin, sizeof options.origin);
    activity_set("reading the mesh");
    if (mesh_sequence_matches(params->mesh)) return load_sequence(load, &options, error);
    float unit = (float)(options.unit > 0 ? options.unit : options.otherwise_unit);
    bool up_z = (options.up_z >= 0 ? options.up_z : options.otherwise_up_z) == 1;
    Result result = mesh_read(load->mesh, params->mesh, unit, up_z, error);
    if (result == RESULT_OK) mesh_take_away(load->mesh, load->origin);
    return strands_read_as_mesh(result, params->mesh, error);
}

Result assets_load(Assets *assets, Scene *scene, FILE *messages, bool verbose, Error *error)
{
    *assets = (Assets){.section_count = scene->section_count, .body_count = scene->body_count};
    assets->strands = calloc((size_t)scene->section_count + 1, sizeof *assets->strands);
    assets->reports = calloc((size_t)scene->section_count + 1, sizeof *assets->reports);
    assets->frames = calloc((size_t)scene->section_count + 1, sizeof *assets->frames);
    assets->meshes = calloc((size_t)scene->body_count + 1, sizeof *assets->meshes);
    assets->bodies = calloc((size_t)scene->body_count + 1, sizeof *assets->bodies);
    if (!assets->strands || !assets->reports || !assets->frames || !assets->meshes ||
        !assets->bodies)
        return error_set(error, RESULT_FAILED, "no memory for %u sections", scene->section_count);
    for (uint32_t i = 0; i < scene->section_count; ++i) {
        TRY(load_section(assets, scene, i, messages, verbose, error));
        take_fibre(&scene->sections[i], &assets->strands[i], messages);
    }
    take_length(scene);
    for (uint32_t b = 0; b < scene->body_count; ++b) {
        const BodyLoad load = {.assets = assets,
                               .run = &scene->run,
                               .origin = scene->world_origin,
                               .body = &scene->bodies[b],
                               .mesh = &assets->meshes[b],
                               .shape = &assets->bodies[b],
                               .messages = messages};
        TRY(load_body(&load, error));
        // A deforming mesh has had its own warning.
        if (messages && assets->meshes[b].triangle_count && !scene->bodies[b].given_mesh &&
            !scene->bodies[b].shape)
            TRY(root_distance_warn(scene, b, &assets->meshes[b], assets->strands,
                                   (double)assets->reports[scene->bodies[b].first].unit_used,
                                   messages, error));
    }
    TRY(number_frames(assets, scene, error));
    if (*scene->run.environment)
        TRY(environment_read(&assets->environment, scene->run.environment,
                             scene->run.environment_background, error));
    return RESULT_OK;
}

void assets_destroy(Assets *assets)
{
    for (uint32_t i = 0; assets->strands && i < assets->section_count; ++i)
        strands_destroy(&assets->strands[i]);
    for (uint32_t i = 0; assets->frames && i < assets->section_count; ++i)
        strands_frames_destroy(&assets->frames[i]);
    for (uint32_t b = 0; assets->meshes && b < assets->body_count; ++b)
        mesh_destroy(&assets->meshes[b]);
    for (uint32_t b = 0; assets->bodies && b < assets->body_count; ++b)
        body_destroy(&assets->bodies[b]);
    free(assets->strands);
    free(assets->reports);
    free(assets->frames);
    free(assets->meshes);
    free(assets->bodies);
    environment_destroy(&assets->environment);
    *assets = (Assets){0};
}

Result assets_check(const Scene *scene, FILE *stream)
{
    Result worst = RESULT_OK;
    for (uint32_t i = 0; i < scene->section_count; ++i) {
        const Section *section = &scene->sections[i];
        StrandsReadOptions options = read_options(scene, section);
        Strands strands;
        StrandsReport report;
        Error error;
        options.strict = false; // report all defects, do not refuse the file
        Result result = strands_read_any(&strands, NULL, section->file, &options, &report, &error);
        if (result == RESULT_OK) {
            strands_report_print(&report, section->file, stream);
            if (!strands_report_is_clean(&report)) result = RESULT_FAILED;
        } else {
            fprintf(stream, "%s\n", error.text);
        }
        strands_destroy(&strands);
        if (result > worst) worst = result;
    }
    return worst;
}
