// SPDX-License-Identifier: MIT
#include "run/export.h"
#include "formats/format.h"
#include "strands/paint.h"
#include "strands/strands.h"
#include "strands/strands_edit.h"

#include <stdlib.h>
#include <string.h>

// --- Widths and colours of curves.

static void set_widths(float *width, const Strands *strands, const SectionParams *params,
                       const Paint *paint)
{
    float radius = paint_radius(params, strands, 0);
    for (uint32_t s = 0; s < strands->strand_count; ++s)
        for (uint32_t first = strands->first[s], j = 0; j < strands_size(strands, s); ++j) {
            float taper =
                1 - (1 - params->tip_ratio) * (float)j / (float)(strands_size(strands, s) - 1);
            width[first + j] =
                2 * radius * (paint->thickness ? paint->thickness[first + j] : taper);
        }
}

static void set_colors(float (*color)[4], const Strands *strands, const SectionParams *params,
                       const Paint *paint)
{
    float own[4] = {0, 0, 0, 1};
    paint_color(params, own);
    for (uint32_t v = 0; v < strands->vertex_count; ++v)
        memcpy(color[v], paint->color ? paint->color[v] : own, sizeof own);
}

// Reduces colours by vertex to one colour for each strand if they do not vary along strands, or to
// one for all strands.
static CurvesRate simplify(float (*color)[4], const Strands *all)
{
    bool constant = true, uniform = true;
    for (uint32_t s = 0; s < all->strand_count; ++s)
        for (uint32_t root = all->first[s], v = root; v < all->first[s + 1]; ++v) {
            uniform = uniform && memcmp(color[v], color[root], sizeof *color) == 0;
            constant = constant && memcmp(color[v], color[0], sizeof *color) == 0;
        }
    if (constant) return CURVES_CONSTANT;
    if (!uniform) return CURVES_VERTEX;
    for (uint32_t s = 0; s < all->strand_count; ++s)
        memmove(color[s], color[all->first[s]], sizeof *color);
    return CURVES_UNIFORM;
}

static Result look_at_section(SceneLook *look, const Section *section, const Strands *strands,
                              size_t first, Error *error)
{
    Paint paint;
    const SectionParams seen = paint_as_seen(&section->params);
    Result result = paint_create(&paint, strands, &seen, error);
    if (result != RESULT_OK) return error_prefix(error, result, "%s: ", section->file);
    set_widths(look->width + first, strands, &seen, &paint);
    set_colors(look->color + first, strands, &seen, &paint);
    paint_destroy(&paint);
    return RESULT_OK;
}

static void destroy_look(SceneLook *look)
{
    free(look->width);
    free(look->color);
    *look = (SceneLook){0};
}

static Result create_look(SceneLook *look, const Scene *scene, const Strands *sections,
                          const Strands *all, Error *error)
{
    size_t vertex = 0;
    *look = (SceneLook){.width = malloc(all->vertex_count * sizeof *look->width + 1),
                        .color = malloc(all->vertex_count * sizeof *look->color + 1)};
    Result result = look->width && look->color
                        ? RESULT_OK
                        : error_set(error, RESULT_FAILED, "no memory for the curves' widths");
    for (uint32_t i = 0; i < scene->section_count && result == RESULT_OK; ++i) {
        result = look_at_section(look, &scene->sections[i], &sections[i], vertex, error);
        vertex += sections[i].vertex_count;
    }
    if (result != RESULT_OK) {
        destroy_look(look);
        return result;
    }
    look->curves = (CurvesLook){.width = look->width,
                                .width_rate = CURVES_VERTEX,
                                .color = (const float(*)[4])look->color,
                                .color_rate = simplify(look->color, all)};
    return RESULT_OK;
}

// --- Opening.

static bool is_npz(const char *text)
{
    const char *suffix = strrchr(text, '.');
    return suffix && strcasecmp(suffix, ".npz") == 0;
}

// Refuses a name without a number if several frames would overwrite each other.
static Result check_name(const Target *target, const char *text, int frame_count, Error *error)
{
    if (target->kind != TARGET_STILL || frame_count == 1 || is_npz(text)) return RESULT_OK;
    return error_set(
        error, RESULT_USAGE,
        "%s: one file name for several frames: expected a frame number in the name (frame_%%04d%s)",
        text, strrchr(text, '.'));
}

Result exporter_check(const char *text, int frame_count, Error *error)
{
    Target target = {0};
    Result result = format_target(&target, text, error);
    THEN(result, check_name(&target, text, frame_count, error));
    target_destroy(&target);
    return result;
}

// Sets the options of a file for the frames first, first + every, ...
static Result describe(Exporter *exporter, const Strands *sections, int frame_count, Error *error)
{
    const Scene *scene = exporter->simulation->scene;
    const RunParams *run = &scene->run;
    if (frames_file_has_look(exporter->kind))
        TRY(create_look(&exporter->look, scene, sections, &exporter->strands, error));
    // .npz stores no frame numbers: its frames are one step apart.
    bool npz = exporter->kind == FORMAT_NPZ,
         animated = npz ? exporter->target.kind == TARGET_STILL && frame_count > 1
                        : exporter->target.kind == TARGET_VIDEO;
    int first = run->first + run->frame_number.value;
    exporter->options = (CurvesOptions){.metres_per_unit = 1,
                                        .animated = animated,
                                        .fps = (double)run->fps / (npz ? run->every : 1),
                                        .first = first,
                                        .last = first + (frame_count - 1) * run->every,
                                        .look = exporter->look.curves};
    if (!exporter->options.animated || frame_count < 1) return RESULT_OK;
    return frames_file_open(&exporter->frames, exporter->kind, exporter->target.before,
                            &exporter->strands, &exporter->options, error);
}

// --- The material of fibres.

// The material that the section was simulated with, otherwise that of its file; zero if it varies
// along strands or over time, which files cannot store.
static Fibre find_fibre(const Section *section, const Strands *strands)
{
    static const char *const names[] = {"youngs_modulus", "poisson", "hair_density", "hair_radius"};
    const SectionParams *params = &section->params;
    if (!section_is_elastic(params)) return strands->fibre;
    bool varies = params->youngs_modulus_along.count || params->hair_radius_along.count;
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i)
        varies = varies || section_tracks_has(&section->tracks, params_find(names[i]));
    const Fibre none = {0};
    return varies ? none : fibre_of(params);
}

// Sets the material if all sections have the same; otherwise it is lost.
static void set_fibre(Exporter *exporter, const Strands *sections, uint32_t count)
{
    const Section *all = exporter->simulation->scene->sections;
    bool same = true, any = false;
    Fibre first = count ? find_fibre(&all[0], &sections[0]) : (Fibre){0};
    for (uint32_t i = 0; i < count; ++i) {
        Fibre fibre = find_fibre(&all[i], &sections[i]);
        same = same && fibre_equals(&fibre, &first);
        any = any || section_is_elastic(&all[i].params);
    }
    exporter->strands.fibre = same ? first : (Fibre){0};
    bool stores = FORMAT_TABLE[exporter->kind]->features & STRANDS_HAS_FIBRE;
    if (stores && any && !fibre_is_known(&exporter->strands.fibre))
        exporter->lost |= STRANDS_HAS_FIBRE;
}

// --- Preparing.

// Finds features of the hair that some or all sections have and the file format cannot store.
static void find_lost(Exporter *exporter, const Strands *sections, uint32_t count)
{
    uint32_t features = 0;
    for (uint32_t i = 0; i < count; ++i) features |= strands_features(&sections[i]);
    exporter->lost =
        features & ~(strands_features(&exporter->strands) & FORMAT_TABLE[exporter->kind]->features);
}

// Appends a section's guides, then its followers in the order of their batches. A follower has the
// look of its guide.
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
    TRY(strands_join(&exporter->strands, sections, count, error));
    if (count > 1) TRY(strands_group_sets(&exporter->strands, sections, count, false, error));
    exporter->kind = format_choose(text, &exporter->strands);
    find_lost(exporter, sections, count);
    set_fibre(exporter, sections, count);
    if (!frames_file_has_look(exporter->kind) && exporter->kind != FORMAT_NPZ) return RESULT_OK;
    return describe(exporter, sections, frame_count, error);
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
    THEN(result, prepare(exporter, text, sections, count, frame_count, error));
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
    exporter->target.offset = simulation->scene->run.frame_number.value;
    THEN(result, check_name(&exporter->target, text, frame_count, error));
    THEN(result, target_prepare(&exporter->target, error));
    THEN(result, (exporter->followers ? prepare_with_followers : prepare)(
                     exporter, text, strands, count, frame_count, error));
    if (result != RESULT_OK) exporter_destroy(exporter);
    return result;
}

void exporter_destroy(Exporter *exporter)
{
    frames_file_discard(&exporter->frames);
    destroy_look(&exporter->look);
    target_destroy(&exporter->target);
    strands_destroy(&exporter->strands);
    *exporter = (Exporter){0};
}

// --- Frames.

// Reorders positions from the order of batches to the order of the file.
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

// Reads the followers' positions. In the file they have the order of their batches.
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
    Result result = frames_file_has_look(exporter->kind)
                        ? frames_file_write_still(exporter->kind, name, &exporter->strands,
                                                  &exporter->options, error)
                        : format_write(name, exporter->kind, &exporter->strands, error);
    free(name);
    return result;
}

Result exporter_write(Exporter *exporter, int frame, Error *error)
{
    TRY(read_positions(exporter, error));
    double origin[3];
    memcpy(origin, exporter->strands.origin, sizeof origin);
    if (!frames_file_has_look(exporter->kind)) { // only scene files have transforms
        strands_give_back_origin(&exporter->strands);
        memcpy(exporter->strands.origin, origin, sizeof origin);
    }
    if (exporter->options.animated)
        return frames_file_add(&exporter->frames, frame + exporter->target.offset,
                               (const float(*)[3])exporter->strands.position, error);
    Result result = write_file(exporter, frame, error);
    exporter->files += result == RESULT_OK;
    return result;
}

Result exporter_finish(Exporter *exporter, Error *error)
{
    if (!exporter->frames.strands) return RESULT_OK;
    Result result = frames_file_finish(&exporter->frames, error);
    exporter->files += result == RESULT_OK;
    return result;
}
