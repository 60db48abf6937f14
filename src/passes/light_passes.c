// SPDX-License-Identifier: MIT
#include "passes/light_passes.h"

#include "gpu/gpu_uniforms.h"

#include "glsl/kernel/onto.h"

#include <stdlib.h>
#include <string.h>

_Static_assert(LIGHT_ORDINATES == ORDINATES && LIGHT_LANES == ORDINATE_LANES &&
                   LIGHT_CLASSES == TANGENTS && LIGHT_SQUARES == ORDINATE_SQUARES &&
                   LIGHT_KINDS == LIGHT_GRID_KINDS,
               "numbers of the grid");

static const int64_t SUMS_MOST = 128 << 20; // bytes; sums for more cells are made in turns

void light_passes_destroy(LightPasses *passes)
{
    GpuBuffer *const buffers[] = {
        &passes->box,
        &passes->slots,
        &passes->cells,
        &passes->state,
        &passes->sums,
        &passes->planes,
        &passes->depth,
        &passes->source,
        &passes->sent,
        &passes->order,
        &passes->total,
        &passes->light,
        &passes->tables,
        &passes->walls,
        &passes->onto,
        &passes->faces,
        &passes->kinds[FIELD_FIRST].buffer,
        &passes->kinds[FIELD_SCATTER].buffer,
        &passes->kinds[FIELD_GATHER].buffer,
        &passes->kinds[FIELD_CONE].buffer,
    };
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; ++i) gpu_buffer_destroy(buffers[i]);
    light_pass_destroy(&passes->programs);
    late_read_destroy(&passes->box_read);
    late_read_destroy(&passes->counts_read);
    light_field_destroy(&passes->field);
    *passes = (LightPasses){0};
}

// --- Uploads.

static Result upload(LightPasses *passes, GpuBuffer *buffer, const char *what, const void *data,
                     size_t size, GLenum format, Error *error)
{
    gpu_buffer_destroy(buffer);
    return gpu_buffer_create(buffer, passes->programs.limits, what, (int64_t)size, data, format,
                             error);
}

static Result upload_classes(LightPasses *passes, Error *error)
{
    if (passes->tables.buffer) return RESULT_OK;
    float tables[LIGHT_TABLES_COUNT];
    ordinates_prepare();
    memcpy(tables, TANGENT_SINE, sizeof TANGENT_SINE);
    memcpy(tables + LIGHT_TANGENT_AT, TANGENT, sizeof TANGENT);
    for (size_t i = 0; i < sizeof TANGENT_NEAREST; ++i)
        tables[LIGHT_NEAREST_AT + i] = ((const uint8_t *)TANGENT_NEAREST)[i];
    return upload(passes, &passes->tables, "classes of tangents", tables, sizeof tables, GL_R32F,
                  error);
}

// Uploads a table of all kinds of hair (`bytes` for each), if it has changed.
static Result upload_kinds(LightPasses *passes, const GridScene *scene, FieldTable table,
                           size_t bytes, Error *error)
{
    KindTable *mine = &passes->kinds[table];
    const GridKind *kinds = passes->field.kinds;
    KindTableMade made = {.kinds = scene->kind_count, .lights = passes->field.lights};
    for (int k = 0; k < made.kinds; ++k) made.made[k] = kinds[k].made[table];
    if (mine->buffer.buffer && memcmp(&made, &mine->made, sizeof made) == 0) return RESULT_OK;
    TRY(upload(passes, &mine->buffer, "fibre table", NULL, bytes * (size_t)made.kinds,
               table == FIELD_CONE ? GL_RGBA32F : GL_R32F, error));
    for (int k = 0; k < made.kinds && bytes; ++k)
        gpu_buffer_write(&mine->buffer, (int64_t)bytes * k, light_field_table(&kinds[k], table),
                         (int64_t)bytes);
    mine->made = made;
    return RESULT_OK;
}

static Result upload_tables(LightPasses *passes, const GridScene *scene, Error *error)
{
    LightField *field = &passes->field;
    TRY(light_field_make_first(field, scene, error));
    TRY(light_field_make_scatter(field, scene, NULL, 0, error));
    TRY(upload_kinds(passes, scene, FIELD_FIRST,
                     (size_t)field->lights * sizeof *field->kinds->first, error));
    return upload_kinds(passes, scene, FIELD_SCATTER, TANGENTS * sizeof *field->kinds->scatter,
                        error);
}

// Uploads the mesh's walls between cells.
static Result upload_walls(LightPasses *passes, const GridScene *scene, Error *error)
{
    LightField *field = &passes->field;
    const int *n = field->lattice.count;
    size_t cells = ((size_t)n[0] + 2) * ((size_t)n[1] + 2) * ((size_t)n[2] + 2);
    TRY(light_field_find_walls(field, scene, error));
    return field->walled ? upload(passes, &passes->walls, "the mesh among hair", field->walls,
                                  3 * cells * sizeof *field->walls, GL_R32F, error)
                         : RESULT_OK;
}

static void set_lights(const LightField *field, const GridScene *scene, LightParams *params)
{
    for (int l = 0; l < field->lights; ++l) {
        const float *place = scene->draw->light_place[l];
        memcpy(params->way[l], field->to_light[l], sizeof field->to_light[l]);
        if (place[3] != 0) light_lattice_turn(&field->lattice, place, params->way[l]);
        params->way[l][3] = (float)scene->map_of[l];
    }
}

static void set_eye(const LightField *field, const GridScene *scene, LightParams *params)
{
    light_lattice_turn(&field->lattice, scene->draw->eye, params->eye);
    light_lattice_turn(&field->lattice, scene->to_eye, params->eye_axis);
    params->eye[3] = light_field_opacity(scene);
    params->eye_axis[3] = (float)light_field_nearest(&field->lattice, scene->to_eye);
    for (int k = 0; k < scene->kind_count; ++k)
        memcpy(params->albedo[k], scene->kinds[k].albedo[SCATTER_INCLINATIONS - 1],
               3 * sizeof(float));
}

// The number of cells of a slice including a border of one cell, for the axis whose slices are
// largest.
static int count_plane(const LightLattice *lattice)
{
    int most = 0;
    for (int k = 0; k < 3; ++k) {
        int plane = (lattice->count[(k + 1) % 3] + 2) * (lattice->count[(k + 2) % 3] + 2);
        most = plane > most ? plane : most;
    }
    return most;
}

static void set_params(const LightPasses *passes, const GridScene *scene)
{
    const LightField *field = &passes->field;
    const LightLattice *lattice = &field->lattice;
    LightParams params = {.pieces = (uint)field->pieces,
                          .step = light_field_step(scene),
                          .lights = (uint)field->lights,
                          .classes = (uint)(scene->kind_count * TANGENTS),
                          .room = (uint)passes->active,
                          .plane = (uint)count_plane(lattice),
                          .walled = passes->lights_skin ? 2 : field->walled,
                          .tinted = field->tinted};
    for (int k = 0; k < 3; ++k) {
        memcpy(params.turn[k], lattice->turn[k], sizeof lattice->turn[k]);
        params.low[k] = lattice->low[k];
        params.count[k] = (uint)lattice->count[k];
        for (int d = 0; d < ORDINATES; ++d) {
            params.ordinate[d][k] = ORDINATE[k][d];
            params.around[d][k] =
                field->around[(d / ORDINATE_LANES * 3 + k) * ORDINATE_LANES + d % ORDINATE_LANES];
        }
    }
    params.turn[0][3] = light_field_strand(field, scene);
    params.low[3] = lattice->side;
    params.count[3] = (uint)light_lattice_cells(lattice);
    set_lights(field, scene, &params);
    set_eye(field, scene, &params);
    gpu_uniforms_set(BIND_LIGHT, &params, sizeof params);
}

// --- Cells with hair.

Result light_passes_begin(LightPasses *passes, const GridScene *scene, ShadowCasters casters,
                          Error *error)
{
    const GLint none[LIGHT_BOX_WORDS] = {INT32_MAX, INT32_MAX, INT32_MAX, INT32_MIN,
                                         INT32_MIN, INT32_MIN, 0};
    TRY(upload_classes(passes, error));
    light_field_find_turn(&passes->field, scene);
    LightParams params = {.step = 1}; // the box of all strands
    for (int k = 0; k < 3; ++k)
        memcpy(params.turn[k], passes->field.lattice.turn[k], 3 * sizeof(float));
    gpu_uniforms_set(BIND_LIGHT, &params, sizeof params);
    gpu_buffer_destroy(&passes->box);
    TRY(gpu_buffer_create(&passes->box, passes->programs.limits, "the box of hair", sizeof none,
                          none, 0, error));
    TRY(light_pass_use(&passes->programs, LIGHT_PASS_BOX, 0, error));
    gpu_buffer_bind_storage(&passes->box, BIND_LIGHT_BOX_OUT);
    for (uint32_t i = 0; i < casters.count; ++i)
        light_pass_run_hair(&passes->programs, &casters.list[i], params.step,
                            casters.list[i].batch->vertex_count, LIGHT_PART_VERTICES);
    TRY(late_read_begin(&passes->box_read, "the box of hair", sizeof none, error));
    late_read_buffer(&passes->box_read, 0, &passes->box, sizeof none);
    late_read_send(&passes->box_read);
    return RESULT_OK;
}

static Result take_box(LightPasses *passes, float box[LIGHT_BOX_WORDS], Error *error)
{
    const void *bytes;
    GLint words[LIGHT_BOX_WORDS];
    TRY(late_read_open(&passes->box_read, "the box of hair", &bytes, error));
    memcpy(words, bytes, sizeof words);
    late_read_close(&passes->box_read);
    for (int k = 0; k < LIGHT_BOX_WORDS; ++k) box[k] = hair_shadow_unordered(words[k]);
    return RESULT_OK;
}

// Counts the cells with hair and their neighbours. Waits for the result to allocate buffers.
static Result count_slots(LightPasses *passes, const GridScene *scene, ShadowCasters casters,
                          Error *error)
{
    const int cells = (int)light_lattice_cells(&passes->field.lattice);
    const void *bytes;
    uint32_t counts[2];
    TRY(gpu_buffer_reserve(&passes->slots, passes->programs.limits, "cells of light",
                           4 * (int64_t)cells, 0, error));
    TRY(gpu_buffer_reserve(&passes->state, passes->programs.limits, "cells of light",
                           sizeof(LightState) + LIGHT_MOST * ORDINATES * sizeof(vec4), 0, error));
    gpu_buffer_clear(&passes->slots, 0);
    gpu_buffer_clear(&passes->state, 0);
    gpu_buffer_bind_storage(&passes->slots, BIND_LIGHT_SLOTS_OUT);
    gpu_buffer_bind_storage(&passes->state, BIND_LIGHT_STATE_OUT);
    TRY(light_pass_use(&passes->programs, LIGHT_PASS_MARK, 0, error));
    for (uint32_t i = 0; i < casters.count; ++i)
        light_pass_run_hair(&passes->programs, &casters.list[i], light_field_step(scene),
                            casters.list[i].batch->vertex_count - 1, LIGHT_PART_SEGMENTS);
    light_pass_end();
    if (passes->field.walled) gpu_buffer_bind_texture(&passes->walls, BIND_LIGHT_WALLS);
    for (LightPass pass = LIGHT_PASS_HAIR_SLOTS; pass <= LIGHT_PASS_BESIDE_SLOTS; ++pass) {
        TRY(light_pass_use(&passes->programs, pass, 0, error));
        light_pass_run_cells(&passes->programs, pass, cells);
    }
    TRY(late_read_begin(&passes->counts_read, "cells of light", sizeof counts, error));
    late_read_buffer(&passes->counts_read, 0, &passes->state, sizeof counts);
    late_read_send(&passes->counts_read);
    TRY(late_read_open(&passes->counts_read, "cells of light", &bytes, error));
    memcpy(counts, bytes, sizeof counts);
    late_read_close(&passes->counts_read);
    passes->filled = (int)counts[0];
    passes->active = (int)(counts[0] + counts[1]);
    return RESULT_OK;
}

static Result make_room(LightPasses *passes, Error *error)
{
    const struct {
        GpuBuffer *buffer;
        int64_t slots, bytes;
        GLenum format;
    } rooms[] = {
        {&passes->cells, passes->active, sizeof(LightCell), 0},
        {&passes->depth, passes->filled, ORDINATES * 4, 0},
        {&passes->source, passes->active, GRID_WIDE * 4, 0},
        {&passes->sent, passes->lights_skin ? passes->active : 0, GRID_WIDE * 4, 0},
        {&passes->order, passes->active, GRID_WIDE * 4, 0},
        {&passes->total, passes->active, GRID_WIDE * 4, 0},
        {&passes->light, passes->active, ORDINATES * 16, GL_RGBA32F},
        {&passes->planes, 2 * ORDINATES, (int64_t)count_plane(&passes->field.lattice) * 16, 0},
    };
    for (size_t i = 0; i < sizeof rooms / sizeof *rooms; ++i)
        if (rooms[i].buffer->size < rooms[i].slots * rooms[i].bytes)
            TRY(gpu_buffer_reserve(rooms[i].buffer, passes->programs.limits, "light among hair",
                                   rooms[i].slots * rooms[i].bytes * 5 / 4 / 16 * 16,
                                   rooms[i].format, error));
    gpu_buffer_clear(&passes->cells, 0);
    return RESULT_OK;
}

// --- Contents of cells.

// Adds up a quantity of all hair in the cells of a range of slots: the light that arrives from a
// light or, if `light` < 0, the areas.
static Result add_items(LightPasses *passes, const GridScene *scene, ShadowCasters casters,
                        LightPass pass, int light, const int range[2], Error *error)
{
    for (uint32_t i = 0; i < casters.count; ++i) {
        TRY(light_pass_use(&passes->programs, pass, hair_shadow_variant(&casters.list[i]), error));
        glUniform1i(0, scene->hair[i].kind);
        if (light >= 0) glUniform1i(1, light);
        glUniform2i(2, range[0], range[1]);
        light_pass_run_hair(&passes->programs, &casters.list[i], light_field_step(scene),
                            casters.list[i].batch->vertex_count - 1, LIGHT_PART_SEGMENTS);
    }
    light_pass_end();
    return RESULT_OK;
}

static Result fill_range(LightPasses *passes, const GridScene *scene, ShadowCasters casters,
                         const int range[2], Error *error)
{
    gpu_buffer_clear(&passes->sums, 0);
    gpu_buffer_bind_storage(&passes->sums, BIND_LIGHT_SUMS_OUT);
    TRY(add_items(passes, scene, casters, LIGHT_PASS_AREAS, -1, range, error));
    for (int l = 0; l < passes->field.lights; ++l)
        TRY(add_items(passes, scene, casters,
                      scene->map_of[l] < 0                 ? LIGHT_PASS_LIT_ALL
                      : scene->draw->light_color[l][3] > 0 ? LIGHT_PASS_LIT_WIDE
                                                           : LIGHT_PASS_LIT,
                      l, range, error));
    TRY(light_pass_use(&passes->programs, LIGHT_PASS_FILL, 0, error));
    glUniform2i(2, range[0], range[1]);
    light_pass_run_cells(&passes->programs, LIGHT_PASS_FILL, range[1] - range[0]);
    return RESULT_OK;
}

static Result fill_cells(LightPasses *passes, const GridScene *scene, ShadowCasters casters,
                         Error *error)
{
    const LightField *field = &passes->field;
    int64_t slot = (int64_t)8 * (1 + field->lights) * scene->kind_count * TANGENTS,
            most = passes->most_sums ? passes->most_sums : SUMS_MOST;
    if (most > passes->programs.limits->storage_block)
        most = passes->programs.limits->storage_block;
    int turn = (int)(most / slot);
    if (turn > passes->filled) turn = passes->filled;
    gpu_buffer_bind_storage(&passes->cells, BIND_LIGHT_CELLS_OUT);
    gpu_buffer_bind_storage(&passes->depth, BIND_LIGHT_DEPTH_OUT);
    gpu_buffer_bind_storage(&passes->source, BIND_LIGHT_SOURCE_OUT);
    gpu_buffer_bind_texture(&passes->tables, BIND_LIGHT_TABLES);
    gpu_buffer_bind_texture(&passes->kinds[FIELD_FIRST].buffer, BIND_LIGHT_FIRST);
    gpu_buffer_bind_texture(&passes->kinds[FIELD_SCATTER].buffer, BIND_LIGHT_SCATTER);
    if (field->walled) gpu_buffer_bind_texture(&passes->walls, BIND_LIGHT_WALLS);
    TRY(light_pass_use(&passes->programs, LIGHT_PASS_PLACES, 0, error));
    light_pass_run_cells(&passes->programs, LIGHT_PASS_PLACES,
                         (int)light_lattice_cells(&field->lattice));
    TRY(gpu_buffer_reserve(&passes->sums, passes->programs.limits, "light among hair", turn * slot,
                           0, error));
    for (int first = 0; first < passes->filled; first += turn) {
        int range[2] = {first, first + turn < passes->filled ? first + turn : passes->filled};
        TRY(fill_range(passes, scene, casters, range, error));
    }
    if (!field->walled) return RESULT_OK;
    TRY(light_pass_use(&passes->programs, LIGHT_PASS_GLOW, 0, error));
    light_pass_run_cells(&passes->programs, LIGHT_PASS_GLOW, passes->active);
    return RESULT_OK;
}

// --- Orders of scattering.

static Result run_sweep(LightPasses *passes, int number, bool sky, Error *error)
{
    gpu_buffer_bind_storage(&passes->total, BIND_LIGHT_TOTAL_OUT);
    TRY(light_pass_use(&passes->programs,
                       passes->field.walled ? LIGHT_PASS_SWEEP_WALLED : LIGHT_PASS_SWEEP, 0,
                       error));
    glUniform2i(0, number, sky);
    glDispatchCompute(ORDINATES, 1, 1);
    light_pass_end();
    return RESULT_OK;
}

// Queues all orders of scattering. A shader sets a flag when a further order would not matter; the
// remaining sweeps then return at once. So the CPU does not have to wait for a result.
static Result sweep_orders(LightPasses *passes, const GridScene *scene, Error *error)
{
    gpu_buffer_bind_storage(&passes->planes, BIND_LIGHT_PLANES_OUT);
    gpu_buffer_bind_storage(&passes->order, BIND_LIGHT_ORDER_OUT);
    if (passes->lights_skin) gpu_buffer_clear(&passes->sent, 0);
    TRY(run_sweep(passes, 0, light_scene_has_sky(scene->draw), error));
    for (int order = 1; order <= scene->orders; ++order) {
        if (passes->lights_skin) gpu_buffer_bind_storage(&passes->sent, BIND_LIGHT_SENT_OUT);
        TRY(light_pass_use(&passes->programs, LIGHT_PASS_SCATTER, 0, error));
        light_pass_run_cells(&passes->programs, LIGHT_PASS_SCATTER, passes->active);
        TRY(run_sweep(passes, order, false, error));
        TRY(light_pass_use(&passes->programs, LIGHT_PASS_ORDER, 0, error));
        glUniform2i(0, order, scene->orders);
        glDispatchCompute(1, 1, 1);
        light_pass_end();
    }
    TRY(light_pass_use(&passes->programs, LIGHT_PASS_CLOSE, 0, error));
    gpu_buffer_bind_storage(&passes->light, BIND_LIGHT_ALL_OUT);
    light_pass_run_cells(&passes->programs, LIGHT_PASS_CLOSE, passes->active);
    return RESULT_OK;
}

// Finds the light that hair sends onto skin.
static Result light_skin(LightPasses *passes, Error *error)
{
    const int cells = (int)light_lattice_cells(&passes->field.lattice);
    const GpuLimits *limits = passes->programs.limits;
    TRY(gpu_buffer_reserve(&passes->onto, limits, "light of hair on skin",
                           (int64_t)cells * ORDINATES * 8, 0, error));
    TRY(gpu_buffer_reserve(&passes->faces, limits, "light of hair on skin",
                           (int64_t)cells * ONTO_FACES * 16, GL_RGBA32F, error));
    TRY(light_pass_use(&passes->programs, LIGHT_PASS_SWEEP_ONTO, 0, error));
    gpu_buffer_bind_storage(&passes->onto, BIND_LIGHT_ONTO_OUT);
    gpu_buffer_bind_storage(&passes->sent, BIND_LIGHT_SENT_OUT);
    gpu_buffer_bind_storage(&passes->planes, BIND_LIGHT_PLANES_OUT);
    glUniform2i(0, 0, 0);
    glDispatchCompute(ORDINATES, 1, 1);
    light_pass_end();
    TRY(light_pass_use(&passes->programs, LIGHT_PASS_ONTO, 0, error));
    gpu_buffer_bind_storage(&passes->faces, BIND_LIGHT_FACES_OUT);
    light_pass_run_cells(&passes->programs, LIGHT_PASS_ONTO, cells);
    return RESULT_OK;
}

Result light_passes_solve(LightPasses *passes, const GridScene *scene, ShadowCasters casters,
                          Error *error)
{
    float box[LIGHT_BOX_WORDS];
    passes->filled = passes->active = 0;
    passes->lights_skin = false;
    if (!passes->box_read.fence) TRY(light_passes_begin(passes, scene, casters, error));
    TRY(take_box(passes, box, error));
    if (!light_field_set_box(&passes->field, scene->cells, box)) return RESULT_OK;
    light_field_set_kinds(&passes->field, scene);
    light_field_find_lights(&passes->field, scene);
    for (uint32_t i = 0; i < casters.count; ++i)
        passes->field.tinted |= casters.list[i].batch->paint.buffer != 0;
    TRY(upload_walls(passes, scene, error));
    set_params(passes, scene);
    passes->lights_skin = scene->skin && passes->field.walled;
    TRY(count_slots(passes, scene, casters, error));
    if (!passes->filled) return RESULT_OK;
    TRY(make_room(passes, error));
    TRY(upload_tables(passes, scene, error));
    set_params(passes, scene);
    TRY(fill_cells(passes, scene, casters, error));
    TRY(sweep_orders(passes, scene, error));
    if (passes->lights_skin) TRY(light_skin(passes, error));
    return gpu_check("light among hair", error);
}

Result light_passes_gather(LightPasses *passes, const GridScene *scene, ShadowCasters casters,
                           const ParticleLight *seen, Error *error)
{
    if (!passes->filled) return RESULT_OK;
    size_t cone_bytes = passes->field.lights ? MAX_LIGHTS * sizeof *passes->field.kinds->cone : 0;
    TRY(light_field_make_gather(&passes->field, scene, error));
    TRY(upload_kinds(passes, scene, FIELD_GATHER,
                     CELL_PATCHES * sizeof *passes->field.kinds->gather, error));
    TRY(light_field_make_cone(&passes->field, scene, error));
    TRY(upload_kinds(passes, scene, FIELD_CONE, cone_bytes, error));
    set_params(passes, scene);
    gpu_buffer_bind_storage(&passes->slots, BIND_LIGHT_SLOTS_OUT);
    gpu_buffer_bind_storage(&passes->cells, BIND_LIGHT_CELLS_OUT);
    gpu_buffer_bind_storage(&passes->state, BIND_LIGHT_STATE_OUT);
    gpu_buffer_bind_storage(&passes->depth, BIND_LIGHT_DEPTH_OUT);
    gpu_buffer_bind_texture(&passes->light, BIND_LIGHT_ALL);
    gpu_buffer_bind_texture(&passes->kinds[FIELD_GATHER].buffer, BIND_LIGHT_GATHER);
    gpu_buffer_bind_texture(&passes->kinds[FIELD_CONE].buffer, BIND_LIGHT_CONE);
    TRY(light_pass_use(&passes->programs, LIGHT_PASS_HIDE, 0, error));
    light_pass_run_cells(&passes->programs, LIGHT_PASS_HIDE, passes->active);
    TRY(light_pass_use(&passes->programs, LIGHT_PASS_GATHER, 0, error));
    for (uint32_t i = 0; i < casters.count; ++i) {
        if (!(casters.list[i].look->features & LOOK_MARSCHNER)) continue;
        glUniform1i(0, scene->hair[i].kind);
        gpu_buffer_bind_storage(&seen[i].seen, BIND_LIGHT_SEEN_OUT);
        light_pass_run_hair(&passes->programs, &casters.list[i], 1,
                            casters.list[i].batch->vertex_count - 1, LIGHT_PART_SEGMENTS);
    }
    light_pass_end();
    return gpu_check("light among hair", error);
}
