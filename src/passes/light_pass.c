// SPDX-License-Identifier: MIT
#include "passes/light_pass.h"

#include "gpu/gpu_dispatch.h"
#include "gpu/gpu_uniforms.h"

#include "glsl/kernel/cell.h"

enum {
    ORDINATE_GROUP = 64, // a lane for each ordinate, rounded up
    SWEEP_GROUP = 512,
};

// How a pass is built: the values of its file's macros, and what a lane processes.
typedef struct PassShape {
    const char *file;
    int items, shadow, wide, beside, walled, onto;
    int group; // 0: a strand for each lane, -1: a cell
    bool hair; // has variants for hair
} PassShape;

static const PassShape SHAPES[LIGHT_PASSES] = {
    [LIGHT_PASS_BOX] = {.file = "draw/light_box.comp"},
    [LIGHT_PASS_MARK] = {.file = "draw/light_items.comp"},
    [LIGHT_PASS_HAIR_SLOTS] = {.file = "draw/light_slots.comp", .group = -1},
    [LIGHT_PASS_BESIDE_SLOTS] = {.file = "draw/light_slots.comp", .group = -1, .beside = 1},
    [LIGHT_PASS_PLACES] = {.file = "draw/light_slots.comp", .group = -1, .beside = 2},
    [LIGHT_PASS_AREAS] = {.file = "draw/light_items.comp", .items = 1, .hair = true},
    [LIGHT_PASS_LIT] = {.file = "draw/light_items.comp", .items = 2, .shadow = 2, .hair = true},
    [LIGHT_PASS_LIT_WIDE] =
        {.file = "draw/light_items.comp", .items = 2, .shadow = 2, .wide = 1, .hair = true},
    [LIGHT_PASS_LIT_ALL] = {.file = "draw/light_items.comp", .items = 2, .hair = true},
    [LIGHT_PASS_FILL] = {.file = "draw/light_fill.comp", .group = ORDINATE_GROUP},
    [LIGHT_PASS_GLOW] = {.file = "draw/light_glow.comp", .group = -1},
    [LIGHT_PASS_SWEEP] = {.file = "draw/light_sweep.comp", .group = SWEEP_GROUP},
    [LIGHT_PASS_SWEEP_WALLED] = {.file = "draw/light_sweep.comp",
                                 .group = SWEEP_GROUP,
                                 .walled = 1},
    [LIGHT_PASS_SWEEP_ONTO] = {.file = "draw/light_sweep.comp",
                               .group = SWEEP_GROUP,
                               .walled = 1,
                               .onto = 1},
    [LIGHT_PASS_ONTO] = {.file = "draw/light_onto.comp", .group = -1},
    [LIGHT_PASS_ORDER] = {.file = "draw/light_order.comp", .group = 1},
    [LIGHT_PASS_SCATTER] = {.file = "draw/light_scatter.comp", .group = ORDINATE_GROUP},
    [LIGHT_PASS_CLOSE] = {.file = "draw/light_close.comp", .group = ORDINATE_GROUP},
    [LIGHT_PASS_HIDE] = {.file = "draw/light_hide.comp", .group = -1},
    [LIGHT_PASS_GATHER] = {.file = "draw/light_gather.comp"},
};

static int group_of(const LightPrograms *programs, LightPass pass)
{
    const GpuSizes sizes = programs->limits->sizes;
    int group = SHAPES[pass].group;
    return group > 0 ? group : group < 0 ? sizes.items : sizes.strands;
}

Result light_pass_build(LightPrograms *programs, LightPass pass, unsigned variant, Error *error)
{
    const PassShape *shape = &SHAPES[pass];
    variant = shape->hair ? variant : 0;
    const ShaderDefine defines[] = {{"GROUP_SIZE", group_of(programs, pass)},
                                    {"PART_VERTICES", LIGHT_PART_VERTICES},
                                    {"PART_SEGMENTS", LIGHT_PART_SEGMENTS},
                                    {"PAINT", (variant & CAST_PAINT) != 0},
                                    {"SMOOTH", (variant & CAST_SMOOTH) != 0},
                                    {"ITEMS", shape->items},
                                    {"SHADOW", shape->shadow},
                                    {"WIDE", shape->wide},
                                    {"BESIDE", shape->beside},
                                    {"WALLED", shape->walled},
                                    {"ONTO", shape->onto},
                                    {NULL, 0}};
    GLuint *program = &programs->program[pass][variant];
    return *program ? RESULT_OK : shader_build_compute(program, shape->file, defines, error);
}

Result light_pass_use(LightPrograms *programs, LightPass pass, unsigned variant, Error *error)
{
    TRY(light_pass_build(programs, pass, variant, error));
    glUseProgram(programs->program[pass][SHAPES[pass].hair ? variant : 0]);
    return RESULT_OK;
}

void light_pass_end(void)
{
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);
}

void light_pass_run_cells(const LightPrograms *programs, LightPass pass, int count)
{
    bool by_lane = SHAPES[pass].group < 0;
    gpu_dispatch(programs->limits, (uint64_t)count,
                 by_lane ? (uint64_t)group_of(programs, pass) : 1, 1);
    light_pass_end();
}

void light_pass_run_hair(const LightPrograms *programs, const ShadowCaster *caster, uint32_t step,
                         uint32_t of, uint32_t part)
{
    const HairBatch *batch = caster->batch;
    MaterialParams material = look_material(caster->look, batch);
    gpu_uniforms_set(BIND_MATERIAL, &material, sizeof material);
    gpu_buffer_bind_texture(&batch->position, BIND_POSITION);
    if (batch->paint.buffer) gpu_buffer_bind_texture(&batch->paint, BIND_PAINT);
    gpu_dispatch(programs->limits, cell_strands(material.drawn_strands, step),
                 (uint64_t)programs->limits->sizes.strands, (of + part - 1) / part);
}

void light_pass_destroy(LightPrograms *programs)
{
    for (int pass = 0; pass < LIGHT_PASSES; ++pass)
        for (int variant = 0; variant < CAST_VARIANTS; ++variant)
            shader_release(programs->program[pass][variant]);
    *programs = (LightPrograms){0};
}
