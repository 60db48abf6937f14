// SPDX-License-Identifier: MIT
#include "draw/hair_scatter.h"

#include <stdlib.h>
#include <string.h>

void hair_scatter_create(HairScatter *scatter, const GpuLimits *limits,
                         const HairScatterOptions *options)
{
    *scatter = (HairScatter){
        .options = *options, .limits = limits, .passes = {.programs = {.limits = limits}}};
}

static void forget_room(HairScatter *scatter)
{
    for (uint32_t i = 0; i < scatter->room; ++i) gpu_buffer_destroy(&scatter->seen[i].left);
    free(scatter->hair);
    free(scatter->seen);
    free(scatter->mapped);
    scatter->hair = NULL, scatter->seen = NULL, scatter->mapped = NULL;
    scatter->room = 0;
}

void hair_scatter_destroy(HairScatter *scatter)
{
    forget_room(scatter);
    light_grid_destroy(&scatter->grid);
    light_passes_destroy(&scatter->passes);
    light_dual_destroy(&scatter->dual);
    light_blocks_destroy(&scatter->blocks);
    for (int k = 0; k < scatter->kind_count; ++k) fibre_lobes_destroy(&scatter->kinds[k]);
    *scatter = (HairScatter){0};
}

static Result make_room(HairScatter *scatter, uint32_t count, Error *error)
{
    if (scatter->room >= count) return RESULT_OK;
    forget_room(scatter);
    scatter->hair = calloc(count, sizeof *scatter->hair);
    scatter->seen = calloc(count, sizeof *scatter->seen);
    scatter->mapped = calloc(4 * (size_t)count, sizeof *scatter->mapped);
    scatter->room = scatter->hair && scatter->seen && scatter->mapped ? count : 0;
    return scatter->room ? RESULT_OK
                         : error_set(error, RESULT_FAILED, "no memory for %u batches", count);
}

// --- Kinds of fibres.

// The kind of fibres of this look; those that are too many share the last one.
static Result find_kind(HairScatter *scatter, Drawing *drawing, const Look *look, int *kind,
                        Error *error)
{
    FibreTable table;
    const float *color = look->mean_color;
    for (*kind = 0; *kind < scatter->kind_count; ++*kind)
        if (scatter->kind_table[*kind] == look->scatter &&
            fibre_lobes_match(&scatter->kinds[*kind], &look->material, color))
            return RESULT_OK;
    if (*kind == LIGHT_GRID_KINDS) {
        --*kind;
        return RESULT_OK;
    }
    TRY(scatter_tables_read(&drawing->scatter, look->scatter, &table, error));
    if (!fibre_lobes_create(&scatter->kinds[*kind], table, &look->material, color))
        return error_set(error, RESULT_FAILED, "no memory for a table of marschner shading");
    scatter->kind_table[*kind] = look->scatter;
    ++scatter->kind_count;
    return RESULT_OK;
}

// --- Buffers.

static void *map(HairScatter *scatter, const GpuBuffer *buffer, GLbitfield access)
{
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    void *data = glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)buffer->size, access);
    if (data) scatter->mapped[scatter->mapped_count++] = buffer->buffer;
    return data;
}

static void unmap_all(HairScatter *scatter)
{
    while (scatter->mapped_count) {
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, scatter->mapped[--scatter->mapped_count]);
        glUnmapBuffer(GL_SHADER_STORAGE_BUFFER);
    }
}

enum { SEEN_BYTES = 3 * sizeof(float) }; // of a point: linear RGB

static Result reserve_seen(HairScatter *scatter, uint32_t i, const ShadowCaster *caster,
                           size_t points, Error *error)
{
    GpuBuffer *seen = &scatter->seen[i].left;
    scatter->seen[i].batch = caster->batch;
    if (seen->size == SEEN_BYTES * (int64_t)points) return RESULT_OK;
    scatter->any = false;
    gpu_buffer_destroy(seen);
    return gpu_buffer_create(seen, scatter->limits, "light among hair",
                             SEEN_BYTES * (int64_t)points, NULL, GL_RGB32F, error);
}

// What shadow maps were made of, and found: copies of it, or the buffers.
static bool map_shadows(HairScatter *scatter, const HairShadowCpu *cpu, const HairBatch *batch,
                        uint32_t i, GridHair *hair)
{
    hair->caster.order = cpu->casters[i].order;
    if (cpu->copies) {
        hair->caster.position = cpu->casters[i].position;
        hair->caster.paint = cpu->casters[i].paint;
        hair->left = cpu->left[i];
    } else {
        hair->caster.position = map(scatter, &batch->position, GL_MAP_READ_BIT);
        hair->left = map(scatter, &cpu->lights[i].left, GL_MAP_READ_BIT);
        if (batch->paint.buffer) hair->caster.paint = map(scatter, &batch->paint, GL_MAP_READ_BIT);
    }
    return hair->caster.position && hair->left && (hair->caster.paint || !batch->paint.buffer);
}

// `cpu` NULL: hair stays with the GPU.
static Result map_hair(HairScatter *scatter, Drawing *drawing, const ShadowCaster *caster,
                       const HairShadowCpu *cpu, uint32_t i, Error *error)
{
    const HairBatch *batch = caster->batch;
    GridHair *hair = &scatter->hair[i];
    *hair = (GridHair){.points = (size_t)hair_slots(batch) * look_points(&caster->look, batch)};
    hair->caster.material = look_material(&caster->look, batch);
    TRY(find_kind(scatter, drawing, &caster->look, &hair->kind, error));
    bool shows = caster->look.features & LOOK_MARSCHNER;
    if (shows) TRY(reserve_seen(scatter, i, caster, hair->points, error));
    if (!cpu) return RESULT_OK;
    bool good = map_shadows(scatter, cpu, batch, i, hair);
    if (scatter->options.scatter == SCATTER_DUAL && hair->left)
        hair->behind = hair->left + (size_t)cpu->maps * hair->points;
    if (shows)
        hair->seen =
            map(scatter, &scatter->seen[i].left, GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT);
    if (!good || (shows && !hair->seen))
        return error_set(error, RESULT_FAILED, "cannot read hair's positions for its light");
    return RESULT_OK;
}

// --- What is asked for.

static bool is_wanted(const HairScatter *scatter, const HairScatterScene *scene)
{
    bool any = false;
    for (uint32_t i = 0; i < scene->casters.count; ++i)
        any |= (scene->casters.list[i].look.features & LOOK_MARSCHNER) != 0;
    return any &&
           (scatter->options.scatter != SCATTER_NONE || light_scene_has_sky(&scene->drawing->draw));
}

static bool same_lights(const DrawParams *a, const DrawParams *b)
{
    return a->light_count == b->light_count &&
           memcmp(a->light_place, b->light_place, sizeof a->light_place) == 0 &&
           memcmp(a->light_color, b->light_color, sizeof a->light_color) == 0 &&
           memcmp(a->light_axis, b->light_axis, sizeof a->light_axis) == 0 &&
           memcmp(a->light_cone, b->light_cone, sizeof a->light_cone) == 0 &&
           memcmp(a->sky, b->sky, sizeof a->sky) == 0 &&
           memcmp(a->ground, b->ground, sizeof a->ground) == 0;
}

static GridScene make_scene(HairScatter *scatter, const Shadows *shadows,
                            const HairScatterScene *scene)
{
    const HairScatterOptions *options = &scatter->options;
    GridScene grid = {.hair = scatter->hair,
                      .hair_count = scatter->count,
                      .kinds = scatter->kinds,
                      .kind_count = scatter->kind_count,
                      .draw = &scene->drawing->draw,
                      .cells = options->cells,
                      .suns = options->scatter == SCATTER_GRID,
                      .orders = options->scatter == SCATTER_NONE ? 0 : options->orders};
    for (int k = 0; k < 3; ++k) grid.to_eye[k] = scene->view->view[k][2];
    for (int l = 0; l < MAX_LIGHTS; ++l) grid.map_of[l] = -1;
    for (int m = 0; m < shadows->params.maps; ++m)
        grid.map_of[(int)shadows->params.place[m][0]] = m;
    if (scene->mesh) {
        scatter->blocks.mesh = *scene->mesh;
        grid.blocks = &scatter->blocks;
    }
    return grid;
}

static void forget_kinds(HairScatter *scatter)
{
    for (int k = 0; k < scatter->kind_count; ++k) fibre_lobes_destroy(&scatter->kinds[k]);
    scatter->kind_count = 0;
}

// Other looks than those of the last image.
static bool kinds_changed(const HairScatter *scatter, const HairScatterScene *scene)
{
    for (uint32_t i = 0; i < scene->casters.count; ++i) {
        const Look *look = &scene->casters.list[i].look;
        bool known = false;
        for (int k = 0; k < scatter->kind_count; ++k)
            known |= scatter->kind_table[k] == look->scatter &&
                     fibre_lobes_match(&scatter->kinds[k], &look->material, look->mean_color);
        if (!known) return true;
    }
    return false;
}

// By the processor. `solved`: the light is there, and only where it is seen from has changed.
static Result find_by_processor(HairScatter *scatter, const GridScene *grid, bool solved,
                                Error *error)
{
    bool in_cells = grid->suns || light_scene_has_sky(grid->draw);
    if (in_cells && !solved) TRY(light_grid_solve(&scatter->grid, grid, error));
    if (in_cells) TRY(light_grid_gather(&scatter->grid, grid, error));
    return scatter->options.scatter == SCATTER_DUAL
               ? light_dual_find(&scatter->dual, grid, in_cells, error)
               : RESULT_OK;
}

static Result find_by_shaders(HairScatter *scatter, const GridScene *grid, ShadowCasters casters,
                              bool solved, Error *error)
{
    if (!solved) TRY(light_passes_solve(&scatter->passes, grid, casters, error));
    return light_passes_gather(&scatter->passes, grid, casters, scatter->seen, error);
}

static Result find_light(HairScatter *scatter, const Shadows *shadows,
                         const HairScatterScene *scene, Error *error)
{
    const HairShadowCpu *cpu = shadows->hair.by_processor ? &shadows->hair.cpu : NULL;
    Result result = RESULT_OK;
    if (kinds_changed(scatter, scene)) {
        forget_kinds(scatter);
        scatter->any = false;
    }
    scatter->mapped_count = 0;
    scatter->count = scene->casters.count;
    if (cpu) glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    for (uint32_t i = 0; i < scatter->count && result == RESULT_OK; ++i)
        result = map_hair(scatter, scene->drawing, &scene->casters.list[i], cpu, i, error);
    GridScene grid = make_scene(scatter, shadows, scene);
    bool solved = scatter->any && scatter->shadow_version == shadows->version &&
                  same_lights(&scatter->drawn, &scene->drawing->draw);
    if (cpu)
        THEN(result, find_by_processor(scatter, &grid, solved, error));
    else
        THEN(result, find_by_shaders(scatter, &grid, scene->casters, solved, error));
    unmap_all(scatter);
    scatter->any = result == RESULT_OK;
    scatter->solved = !solved;
    scatter->shadow_version = shadows->version;
    scatter->drawn = scene->drawing->draw;
    memcpy(scatter->to_eye, grid.to_eye, sizeof scatter->to_eye);
    return result;
}

// Whether the light that the last image saw is that of this one.
static bool is_seen(const HairScatter *scatter, const Shadows *shadows,
                    const HairScatterScene *scene)
{
    const DrawParams *draw = &scene->drawing->draw;
    for (int k = 0; k < 3; ++k)
        if (scatter->to_eye[k] != scene->view->view[k][2]) return false;
    return scatter->any && scatter->shadow_version == shadows->version &&
           scatter->count == scene->casters.count && same_lights(&scatter->drawn, draw) &&
           memcmp(scatter->drawn.eye, draw->eye, sizeof draw->eye) == 0 &&
           !kinds_changed(scatter, scene);
}

Result hair_scatter_begin(HairScatter *scatter, const Shadows *shadows,
                          const HairScatterScene *scene, Error *error)
{
    if (shadows->hair.by_processor || !is_wanted(scatter, scene) ||
        shadows_show(shadows, scene->shadow))
        return RESULT_OK;
    const GridScene grid = {.draw = &scene->drawing->draw};
    return light_passes_begin(&scatter->passes, &grid, scene->casters, error);
}

Result hair_scatter_draw(HairScatter *scatter, Shadows *shadows, const HairScatterScene *scene,
                         GpuTimer *timer, Error *error)
{
    const ParticleLight *lights;
    uint32_t count;
    scatter->solved = 0;
    if (!is_wanted(scatter, scene) ||
        (shadows->hair.by_processor && !hair_shadow_lights(&shadows->hair, &lights, &count)))
        return RESULT_OK;
    if (!is_seen(scatter, shadows, scene)) {
        TRY(make_room(scatter, scene->casters.count, error));
        gpu_timer_begin(timer, "draw_scatter");
        Result result = find_light(scatter, shadows, scene, error);
        gpu_timer_end(timer);
        TRY(result);
    }
    for (uint32_t i = 0; i < scene->drawing->item_count; ++i) {
        Look *look = &scene->drawing->looks[i];
        if (!(look->features & LOOK_MARSCHNER)) continue;
        look->features |= LOOK_SCATTERED;
        look->scattered = scatter->seen;
        look->batches = scene->casters.count;
    }
    return RESULT_OK;
}
