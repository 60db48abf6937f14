// SPDX-License-Identifier: MIT
#include "scene/assets.h"
#include "base/quote.h"

#include "base/activity.h"
#include "mesh/obj.h"

#include <stdlib.h>

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

// What a file asks for and this program does not do.
static void warn_ignored(const Strands *strands, const char *file, FILE *messages)
{
    if (strands->both_ends_fixed)
        fprintf(messages, "%s: the file fixes both ends of its strands; here the tips move\n",
                quote(file).text);
}

static Result load_section(Assets *assets, const Scene *scene, uint32_t i, FILE *messages,
                           bool verbose, Error *error)
{
    const Section *section = &scene->sections[i];
    const StrandsReadOptions options = read_options(scene, section);
    activity_set("reading hair");
    Result result =
        strands_read(&assets->strands[i], section->file, &options, &assets->reports[i], error);
    activity_set(NULL);
    if (result != RESULT_OK || !messages) return result;
    strands_report_print_mended(&assets->reports[i], section->file, messages);
    warn_ignored(&assets->strands[i], section->file, messages);
    if (!i || !strands_report_same_guess(&assets->reports[i - 1], &assets->reports[i]))
        strands_report_print_guess(&assets->reports[i], section->file, messages);
    if (verbose) strands_report_print(&assets->reports[i], section->file, messages);
    return RESULT_OK;
}

static Result load_mesh(Assets *assets, const Scene *scene, Error *error)
{
    if (!*scene->run.mesh) return RESULT_OK;
    float unit = scene->run.mesh_unit.value;
    if (scene->run.mesh_unit.automatic)
        unit = assets->section_count ? assets->reports[0].unit_used : 1;
    bool up_z = scene->run.mesh_up == UP_Z;
    if (scene->run.mesh_up == UP_AUTO) up_z = assets->section_count && assets->reports[0].up_z;
    assets->has_mesh = true;
    activity_set("reading the mesh");
    return obj_read_mesh(&assets->mesh, scene->run.mesh, unit, up_z, error);
}

Result assets_load(Assets *assets, const Scene *scene, FILE *messages, bool verbose, Error *error)
{
    *assets = (Assets){.section_count = scene->section_count};
    assets->strands = calloc((size_t)scene->section_count + 1, sizeof *assets->strands);
    assets->reports = calloc((size_t)scene->section_count + 1, sizeof *assets->reports);
    if (!assets->strands || !assets->reports)
        return error_set(error, RESULT_FAILED, "no memory for %u sections", scene->section_count);
    for (uint32_t i = 0; i < scene->section_count; ++i)
        TRY(load_section(assets, scene, i, messages, verbose, error));
    return load_mesh(assets, scene, error);
}

void assets_destroy(Assets *assets)
{
    for (uint32_t i = 0; assets->strands && i < assets->section_count; ++i)
        strands_destroy(&assets->strands[i]);
    free(assets->strands);
    free(assets->reports);
    mesh_destroy(&assets->mesh);
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
        options.strict = false; // everything is reported
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
