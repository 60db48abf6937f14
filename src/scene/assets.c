// SPDX-License-Identifier: MIT
#include "scene/assets.h"
#include "base/quote.h"

#include "base/activity.h"
#include "mesh/mesh_read.h"
#include "mesh/mesh_sequence.h"
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
    };
}

// Warns about requests of the file that are not supported.
static void warn_ignored(const Strands *strands, const char *file, FILE *messages)
{
    if (strands->both_ends_fixed)
        fprintf(messages, "%s: the file fixes both ends of its strands; here the tips move\n",
                quote(file).text);
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

static Result pick_group(Strands *strands, const Section *section, Error *error)
{
    Result result = strands_pick_group(strands, (double)section->params.group.value, error);
    if (result == RESULT_OK) return result;
    return error_prefix(error, result, "%s: --group: ", section->file);
}

static Result load_section(Assets *assets, const Scene *scene, uint32_t i, FILE *messages,
                           bool verbose, Error *error)
{
    const Section *section = &scene->sections[i];
    const StrandsReadOptions options = read_options(scene, section);
    if (section->given) return take_given(assets, i, section->given, error);
    activity_set("reading hair");
    Result result =
        strands_read(&assets->strands[i], section->file, &options, &assets->reports[i], error);
    activity_set(NULL);
    if (result == RESULT_OK && !section->params.group.automatic)
        result = pick_group(&assets->strands[i], section, error);
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
        fprintf(messages,
                "%s: half of the roots are more than %.3g mm from the mesh (is it the one that the "
                "hair was groomed on? --mesh-rest)\n",
                quote(body->name).text, 1e3 * (double)apart);
}

// Binds the hair to the mesh, and makes the mesh move the head.
static Result bind_hair(Assets *assets, Scene *scene, MeshSequence *sequence, const Mesh *rest,
                        FILE *messages, Error *error)
{
    const RunParams *run = &scene->run;
    const BodyOptions options = {.name = run->mesh,
                                 .driven = scene->given_mesh && scene->given_mesh->deforms,
                                 .cut_distance = run->teleport_distance,
                                 .cut_angle_deg = run->teleport_angle};
    const RigidTrack *head = &scene->head;
    bool tracked = head->translation.count || head->rotation.count ||
                   head->translation_formula[0].text || head->rotation_formula[0].text;
    assets->body = calloc(1, sizeof *assets->body);
    if (!assets->body) return error_set(error, RESULT_FAILED, "no memory for %s", run->mesh);
    TRY(body_create(assets->body, sequence, &assets->mesh, rest, assets->strands,
                    assets->section_count, &options, error));
    warn_apart(assets->body, messages);
    scene->body = assets->body;
    scene->head.samples = &assets->body->head;
    if (!tracked) body_middle(assets->body, scene->head.pivot);
    return RESULT_OK;
}

static Result load_sequence(Assets *assets, Scene *scene, const MeshSequenceOptions *options,
                            FILE *messages, Error *error)
{
    MeshSequence sequence = {0};
    Mesh rest = {0};
    Result result =
        mesh_sequence_read(&sequence, &assets->mesh, &rest, scene->run.mesh, options, error);
    bool deforms = sequence.times.count > 1 || rest.vertex_count > 0;
    if (result == RESULT_OK && deforms)
        result = bind_hair(assets, scene, &sequence, &rest, messages, error);
    mesh_sequence_destroy(&sequence);
    mesh_destroy(&rest);
    return result;
}

// Prepares a mesh that the caller drives by body_drive: two equal samples stand for the samples to
// come. Vertices may move by up to a quarter of the mesh's longest side.
static Result drive_given(Assets *assets, Scene *scene, FILE *messages, Error *error)
{
    const Mesh *mesh = &assets->mesh, none = {0};
    MeshSequence sequence = {.times = {.count = 2, .rate = 1, .linear = true},
                             .vertex_count = mesh->vertex_count};
    size_t size = mesh->vertex_count * sizeof *mesh->position;
    sequence.position = malloc(2 * size);
    if (!sequence.position)
        return error_set(error, RESULT_FAILED, "no memory for a mesh that deforms");
    for (uint32_t i = 0; i < 2; ++i) memcpy(mesh_sequence_at(&sequence, i), mesh->position, size);
    rigid_track_destroy(&scene->head); // the caller moves the head
    Result result = bind_hair(assets, scene, &sequence, &none, messages, error);
    mesh_sequence_destroy(&sequence);
    if (result != RESULT_OK) return result;
    float low[3], high[3];
    mesh_bounds(mesh, low, high);
    for (int k = 0; k < 3; ++k)
        assets->body->margin = fmaxf(assets->body->margin, 0.25f * (high[k] - low[k]));
    return RESULT_OK;
}

static Result take_given_mesh(Assets *assets, Scene *scene, FILE *messages, Error *error)
{
    const Mesh *given = &scene->given_mesh->mesh;
    assets->has_mesh = true;
    TRY(mesh_create(&assets->mesh, given->vertex_count, given->triangle_count, error));
    memcpy(assets->mesh.position, given->position, given->vertex_count * sizeof *given->position);
    memcpy(assets->mesh.triangle, given->triangle, given->triangle_count * sizeof *given->triangle);
    mesh_compute_normals(&assets->mesh);
    return scene->given_mesh->deforms ? drive_given(assets, scene, messages, error) : RESULT_OK;
}

static Result load_mesh(Assets *assets, Scene *scene, FILE *messages, Error *error)
{
    const RunParams *run = &scene->run;
    if (scene->given_mesh) return take_given_mesh(assets, scene, messages, error);
    if (!*run->mesh) return RESULT_OK;
    const StrandsReport *first = assets->section_count ? &assets->reports[0] : NULL;
    MeshSequenceOptions options = {
        .unit = run->mesh_unit.automatic ? 0 : (double)run->mesh_unit.value,
        .otherwise_unit = first ? (double)first->unit_used : 1,
        .up_z = run->mesh_up == UP_AUTO ? -1 : run->mesh_up == UP_Z,
        .otherwise_up_z = first && first->up_z,
        .rest = run->mesh_rest,
        .rate = run->mesh_fps.automatic ? 0 : (double)run->mesh_fps.value,
        .otherwise_rate = (double)run->fps,
        .start = (double)run->mesh_start,
        .linear = run->mesh_motion == MESH_LINEAR,
    };
    assets->has_mesh = true;
    activity_set("reading the mesh");
    if (mesh_sequence_matches(run->mesh))
        return load_sequence(assets, scene, &options, messages, error);
    float unit = (float)(options.unit > 0 ? options.unit : options.otherwise_unit);
    bool up_z = (options.up_z >= 0 ? options.up_z : options.otherwise_up_z) == 1;
    return mesh_read(&assets->mesh, run->mesh, unit, up_z, error);
}

Result assets_load(Assets *assets, Scene *scene, FILE *messages, bool verbose, Error *error)
{
    *assets = (Assets){.section_count = scene->section_count};
    assets->strands = calloc((size_t)scene->section_count + 1, sizeof *assets->strands);
    assets->reports = calloc((size_t)scene->section_count + 1, sizeof *assets->reports);
    if (!assets->strands || !assets->reports)
        return error_set(error, RESULT_FAILED, "no memory for %u sections", scene->section_count);
    for (uint32_t i = 0; i < scene->section_count; ++i)
        TRY(load_section(assets, scene, i, messages, verbose, error));
    if (*scene->run.environment)
        TRY(environment_read(&assets->environment, scene->run.environment, error));
    return load_mesh(assets, scene, messages, error);
}

void assets_destroy(Assets *assets)
{
    for (uint32_t i = 0; assets->strands && i < assets->section_count; ++i)
        strands_destroy(&assets->strands[i]);
    free(assets->strands);
    free(assets->reports);
    mesh_destroy(&assets->mesh);
    environment_destroy(&assets->environment);
    if (assets->body) body_destroy(assets->body);
    free(assets->body);
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
        Result result = strands_read(&strands, section->file, &options, &report, &error);
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
