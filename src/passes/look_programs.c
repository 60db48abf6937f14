// SPDX-License-Identifier: MIT
#include "passes/look_programs.h"

#include "base/params.h"

#include "glsl/draw/draw.h"
#include "glsl/draw/shadow.h"

enum { MOST_UNROLLED = 4 };

// Reading a light at a compile-time index costs a fifth of reading it in a loop.
int look_unrolled(int light_count)
{
    return light_count <= MOST_UNROLLED ? light_count : 0;
}

Result look_programs_build(LookPrograms *programs, unsigned features, Error *error)
{
    int model = !(features & LOOK_MARSCHNER) ? 0 : features & LOOK_GAUSS ? 2 : 1;
    int shadow = features & LOOK_SHADOW_DOM      ? SHADOW_DOM
                 : features & LOOK_SHADOW_APPROX ? SHADOW_APPROX
                                                 : SHADOW_NONE;
    int unrolled = look_unrolled(programs->light_count);
    const ShaderDefine defines[] = {{"GROUP_SIZE", programs->group_size},
                                    {"LIGHT_COUNT", unrolled},
                                    {"SHADOW_MAPS", unrolled ? programs->map_count : 0},
                                    {"LIGHTS", (features & LOOK_LIGHTS) != 0},
                                    {"WIDE", (features & LOOK_WIDE) != 0},
                                    {"MARSCHNER", model},
                                    {"AOV", (int)(features / LOOK_SHADED)},
                                    {"PAINT", (features & LOOK_PAINT) != 0},
                                    {"SMOOTH", (features & LOOK_SMOOTH) != 0},
                                    {"SHADOW", shadow},
                                    {"SCATTERED", (features & LOOK_SCATTERED) != 0},
                                    {"SHADOW_BY_MESH", (features & LOOK_SHADOW_BY_MESH) != 0},
                                    {NULL, 0}};
    GLuint *program = &programs->program[features];
    return *program ? RESULT_OK : shader_build_compute(program, programs->file, defines, error);
}

static void forget(LookPrograms *programs)
{
    for (int i = 0; i < LOOK_VARIANTS; ++i) {
        shader_release(programs->program[i]);
        programs->program[i] = 0;
    }
}

void look_programs_count(LookPrograms *programs, int light_count, int map_count)
{
    if (programs->light_count == light_count && programs->map_count == map_count) return;
    forget(programs);
    programs->light_count = light_count;
    programs->map_count = map_count;
}

// Finds the light at this batch's points among the lights of all batches.
static const ParticleLight *light_of(const ParticleLight *lights, uint32_t count,
                                     const HairBatch *batch)
{
    uint32_t i = 0;
    while (i + 1 < count && lights[i].batch != batch) ++i;
    return &lights[i];
}

Result look_programs_use(LookPrograms *programs, const Look *look, const HairBatch *batch,
                         Error *error)
{
    unsigned features = look->features | (batch->paint.buffer ? LOOK_PAINT : 0);
    look_programs_count(programs, look->light_count, look->map_count);
    TRY(look_programs_build(programs, features, error));
    glUseProgram(programs->program[features]);
    if (features & LOOK_PAINT) gpu_buffer_bind_texture(&batch->paint, BIND_PAINT);
    if (features & LOOK_SCATTERED)
        gpu_buffer_bind_texture(&light_of(look->scattered, look->batches, batch)->seen,
                                BIND_SCATTERED);
    if (look->features & LOOK_MARSCHNER) {
        glActiveTexture(GL_TEXTURE0 + BIND_SCATTER);
        glBindTexture(GL_TEXTURE_3D, look->scatter);
    }
    return RESULT_OK;
}

void look_programs_destroy(LookPrograms *programs)
{
    forget(programs);
    *programs = (LookPrograms){0};
}
