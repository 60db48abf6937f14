// SPDX-License-Identifier: MIT
#include "run/export.h"
#include "strands/formats/format.h"
#include "strands/strands.h"
#include "strands/strands_edit.h"

#include <stdlib.h>
#include <string.h>

// Where `frame_count` frames of one name would overwrite each other.
static Result check_name(const Target *target, const char *text, int frame_count, Error *error)
{
    if (target->kind != TARGET_STILL || frame_count == 1) return RESULT_OK;
    return error_set(error, RESULT_USAGE,
                     "%s: one name for several frames, put the frame number into it: frame_%%04d%s",
                     text, strrchr(text, '.'));
}

// The options of a USD file for frames first, first + every, ...
static Result describe_usd(Exporter *exporter, const Strands *sections, int frame_count,
                           Error *error)
{
    const Scene *scene = exporter->simulation->scene;
    const RunParams *run = &scene->run;
    Result result = scene_look_create(&exporter->look, scene, sections, &exporter->strands, error);
    if (result != RESULT_OK) return result;
    exporter->options = (UsdOptions){.metres_per_unit = 1,
                                     .animated = exporter->target.kind == TARGET_VIDEO,
                                     .fps = (double)run->fps,
                                     .first = run->first,
                                     .last = run->first + (frame_count - 1) * run->every,
                                     .look = exporter->look.usd};
    if (!exporter->options.animated || frame_count < 1) return RESULT_OK;
    return usd_writer_open(&exporter->usd, exporter->target.before, &exporter->strands,
                           &exporter->options, error);
}

// What some or all sections have and the files will not.
static void find_lost(Exporter *exporter, const Strands *sections, uint32_t count)
{
    uint32_t features = 0;
    for (uint32_t i = 0; i < count; ++i) features |= strands_features(&sections[i]);
    exporter->lost =
        features & ~(strands_features(&exporter->strands) & FORMAT_TABLE[exporter->kind]->features);
}

// A section's guides and, behind them in the order of their batches, its followers, which have
// their guides' looks.
static Result add_followers(Strands *all, const Strands *guides, const Hair *followers,
                            Error *error)
{
    uint32_t count = guides->strand_count;
    for (uint32_t i = 0; i < followers->batch_count; ++i)
        count += followers->batches[i].strand_count;
    Result result = strands_join(all, guides, 1, error);
    if (result != RESULT_OK || count == guides->strand_count) return result;
    uint32_t *which = malloc(count * sizeof *which), *at = which;
    if (!which) return error_set(error, RESULT_FAILED, "no memory for a hair file");
    for (uint32_t s = 0; s < guides->strand_count; ++s) *at++ = s;
    for (uint32_t i = 0; i < followers->batch_count; ++i)
        for (uint32_t s = 0; s < followers->batches[i].strand_count; ++s)
            *at++ = followers->batches[i].strand[s];
    result = strands_pick(all, which, count, error);
    free(which);
    all->followers = 0;
    all->follower_radius = 0;
    return result;
}

static Result prepare(Exporter *exporter, const char *text, const Strands *sections, uint32_t count,
                      int frame_count, Error *error)
{
    Result result = strands_join(&exporter->strands, sections, count, error);
    if (result != RESULT_OK) return result;
    exporter->kind = format_choose(text, &exporter->strands);
    find_lost(exporter, sections, count);
    if (exporter->kind != FORMAT_USD) return RESULT_OK;
    return describe_usd(exporter, sections, frame_count, error);
}

static Result prepare_with_followers(Exporter *exporter, const char *text, const Strands *strands,
                                     uint32_t count, int frame_count, Error *error)
{
    Strands *sections = calloc((size_t)count + 1, sizeof *sections);
    Result result =
        sections ? RESULT_OK : error_set(error, RESULT_FAILED, "no memory for %u sections", count);
    for (uint32_t i = 0; i < count && result == RESULT_OK; ++i)
        result = add_followers(&sections[i], &strands[i],
                               &exporter->simulation->sections[i].follow.hair, error);
    if (result == RESULT_OK) result = prepare(exporter, text, sections, count, frame_count, error);
    for (uint32_t i = 0; sections && i < count; ++i) strands_destroy(&sections[i]);
    free(sections);
    return result;
}

Result exporter_create(Exporter *exporter, const char *text, int frame_count,
                       const Simulation *simulation, const Strands *strands, Error *error)
{
    *exporter =
        (Exporter){.simulation = simulation, .followers = simulation->scene->run.export_followers};
    uint32_t count = simulation->scene->section_count;
    Result result = format_target(&exporter->target, text, error);
    if (result == RESULT_OK) result = check_name(&exporter->target, text, frame_count, error);
    if (result == RESULT_OK) result = target_prepare(&exporter->target, error);
    if (result == RESULT_OK)
        result = (exporter->followers ? prepare_with_followers : prepare)(
            exporter, text, strands, count, frame_count, error);
    if (result != RESULT_OK) exporter_destroy(exporter);
    return result;
}

void exporter_destroy(Exporter *exporter)
{
    usd_writer_discard(&exporter->usd);
    scene_look_destroy(&exporter->look);
    target_destroy(&exporter->target);
    strands_destroy(&exporter->strands);
    *exporter = (Exporter){0};
}

// ---

// From the order of the batches to that of the file.
static void put_section(Strands *strands, uint32_t first_strand, const Hair *hair,
                        const float (*positions)[3])
{
    for (uint32_t i = 0; i < hair->batch_count; ++i) {
        const HairBatch *batch = &hair->batches[i];
        for (uint32_t s = 0; s < batch->strand_count; ++s) {
            uint32_t to = strands->first[first_strand + batch->strand[s]];
            memcpy(strands->position[to], positions, batch->vertex_count * sizeof *positions);
            positions += batch->vertex_count;
        }
    }
}

// Their order in the file is that of their batches.
static Result read_followers(Exporter *exporter, uint32_t section, uint32_t *first_strand,
                             Error *error)
{
    const Hair *hair = &exporter->simulation->sections[section].follow.hair;
    uint32_t first = exporter->strands.first[*first_strand];
    for (uint32_t i = 0; i < hair->batch_count; ++i) *first_strand += hair->batches[i].strand_count;
    return hair_read_positions(hair, exporter->strands.position + first, error);
}

static Result read_positions(Exporter *exporter, Error *error)
{
    const Simulation *simulation = exporter->simulation;
    uint32_t first_strand = 0;
    Result result = RESULT_OK;
    for (uint32_t i = 0; i < simulation->scene->section_count && result == RESULT_OK; ++i) {
        const Hair *hair = &simulation->sections[i].hair;
        float(*positions)[3] = malloc(hair->particle_count * sizeof *positions + 1);
        if (!positions) return error_set(error, RESULT_FAILED, "no memory for a hair file");
        result = hair_read_positions(hair, positions, error);
        if (result == RESULT_OK)
            put_section(&exporter->strands, first_strand, hair, (const float(*)[3])positions);
        free(positions);
        first_strand += hair->strand_count;
        if (exporter->followers && result == RESULT_OK)
            result = read_followers(exporter, i, &first_strand, error);
    }
    return result;
}

static Result write_file(const Exporter *exporter, int frame, Error *error)
{
    char *name = target_name_frame(&exporter->target, frame);
    if (!name) return error_set(error, RESULT_FAILED, "no memory for the name of frame %d", frame);
    Result result = exporter->kind == FORMAT_USD
                        ? usd_write_still(name, &exporter->strands, &exporter->options, error)
                        : format_write(name, exporter->kind, &exporter->strands, error);
    free(name);
    return result;
}

Result exporter_write(Exporter *exporter, int frame, Error *error)
{
    Result result = read_positions(exporter, error);
    if (result != RESULT_OK) return result;
    if (exporter->options.animated)
        return usd_writer_add(&exporter->usd, frame, (const float(*)[3])exporter->strands.position,
                              error);
    result = write_file(exporter, frame, error);
    exporter->files += result == RESULT_OK;
    return result;
}

Result exporter_finish(Exporter *exporter, Error *error)
{
    if (!exporter->usd.strands) return RESULT_OK;
    Result result = usd_writer_finish(&exporter->usd, error);
    exporter->files += result == RESULT_OK;
    return result;
}
