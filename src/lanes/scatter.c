// SPDX-License-Identifier: MIT
#include "lanes/scatter.h"

#include <stdlib.h>
#include <string.h>

void lane_scatter_destroy(LaneScatter *scatter)
{
    free(scatter->hair);
    light_grid_destroy(&scatter->grid);
    light_blocks_destroy(&scatter->blocks);
    fibre_kinds_destroy(&scatter->kinds);
    *scatter = (LaneScatter){0};
}

static Result open_hair(LaneScatter *scatter, const BackendFrame *frame,
                        const MappedCaster *casters, Error *error)
{
    uint32_t count = frame->hair_count;
    if (scatter->room < count) {
        GridHair *hair = realloc(scatter->hair, count * sizeof *hair);
        if (!hair) return error_set(error, RESULT_FAILED, "no memory for %u batches", count);
        scatter->hair = hair;
        scatter->room = count;
    }
    for (uint32_t i = 0; i < count; ++i) scatter->hair[i] = (GridHair){.caster = casters[i]};
    return RESULT_OK;
}

static Result find_kinds(LaneScatter *scatter, const BackendFrame *frame, Error *error)
{
    bool know = true;
    for (uint32_t i = 0; i < frame->hair_count; ++i)
        know &= fibre_kinds_know(&scatter->kinds, frame->hair[i].look);
    if (!know) {
        fibre_kinds_destroy(&scatter->kinds);
        scatter->any = false;
    }
    for (uint32_t i = 0; i < frame->hair_count; ++i)
        TRY(fibre_kinds_find(&scatter->kinds, frame->hair[i].look, &scatter->hair[i].kind, error));
    return RESULT_OK;
}

Result lane_scatter_draw(LaneScatter *scatter, const ScatterOptions *options,
                         const BackendFrame *frame, const MappedCaster *casters,
                         const LaneShadow *shadow, bool *shown, Error *error)
{
    const DrawParams *draw = &frame->drawing->whole;
    *shown = false;
    if (!scatter_is_wanted(options, frame)) return RESULT_OK;
    TRY(open_hair(scatter, frame, casters, error));
    TRY(find_kinds(scatter, frame, error));
    GridScene scene = scatter_scene(options, frame, &shadow->params);
    scene.hair = scatter->hair, scene.hair_count = frame->hair_count;
    scene.shadow = shadow;
    scene.kinds = scatter->kinds.lobes, scene.kind_count = scatter->kinds.count;
    scatter->blocks.mesh = scatter_mesh(frame);
    if (scatter->blocks.mesh.triangle_count) scene.blocks = &scatter->blocks;
    bool solved = scatter->any && scatter->shadow_version == shadow->version &&
                  scatter->count == frame->hair_count && scatter_same_lights(&scatter->drawn, draw);
    scatter->any = false;
    if (!solved) TRY(light_grid_solve(&scatter->grid, &scene, error));
    TRY(light_grid_prepare(&scatter->grid, &scene, error));
    scatter->any = true;
    scatter->count = frame->hair_count;
    scatter->shadow_version = shadow->version;
    scatter->drawn = *draw;
    *shown = true;
    return RESULT_OK;
}
