// SPDX-License-Identifier: MIT
#include "draw/render_look.h"

#include "base/params.h"

#include <math.h>

#include "glsl/draw/draw.h"
#include "glsl/draw/shadow.h"

enum { MOST_UNROLLED = 4 };

MaterialParams look_material(const Look *look, const HairBatch *batch)
{
    enum { MOST_PARTS = 65000 };
    MaterialParams material = look->material;
    uint most = MOST_PARTS / (batch->vertex_count - 1);
    double drawn = fmax((double)look->share * batch->strand_count, 1e-6),
           count = fmin(ceil(drawn), batch->strand_count);
    material.vertex_count = batch->vertex_count;
    material.drawn_strands = (uint)count;
    material.last_strand = (uint)count - 1;
    material.last_share = (float)(drawn - (count - 1));
    if (material.smooth_parts > most) material.smooth_parts = most ? most : 1;
    return material;
}

uint32_t look_points(const Look *look, const HairBatch *batch)
{
    return (batch->vertex_count - 1) * look_material(look, batch).smooth_parts + 1;
}

// A light that is read at a number known when compiling costs a fifth of one in a loop.
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
                                    {"MARSCHNER", model},
                                    {"AOV", (int)(features / LOOK_SHADED)},
                                    {"PAINT", (features & LOOK_PAINT) != 0},
                                    {"SMOOTH", (features & LOOK_SMOOTH) != 0},
                                    {"SHADOW", shadow},
                                    {"SHADOW_FOUND", (features & LOOK_SHADOW_FOUND) != 0},
                                    {"SHADOW_BY_MESH", (features & LOOK_SHADOW_BY_MESH) != 0},
                                    {NULL, 0}};
    GLuint *program = &programs->program[features];
    return *program ? RESULT_OK : shader_build_compute(program, programs->file, defines, error);
}

static void forget(LookPrograms *programs)
{
    for (int i = 0; i < LOOK_VARIANTS; ++i) {
        if (programs->program[i]) glDeleteProgram(programs->program[i]);
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

static void use_lights(const Look *look, const HairBatch *batch)
{
    uint32_t i = 0;
    while (i + 1 < look->batches && look->lights[i].batch != batch) ++i;
    gpu_buffer_bind_texture(&look->lights[i].left, BIND_SHADOW_LEFT);
    glUniform1i(SHADOW_POINTS_AT, (GLint)(hair_slots(batch) * look_points(look, batch)));
}

Result look_programs_use(LookPrograms *programs, const Look *look, const HairBatch *batch,
                         Error *error)
{
    unsigned features = look->features | (batch->paint.buffer ? LOOK_PAINT : 0);
    look_programs_count(programs, look->light_count, look->map_count);
    Result result = look_programs_build(programs, features, error);
    if (result != RESULT_OK) return result;
    glUseProgram(programs->program[features]);
    if (features & LOOK_PAINT) gpu_buffer_bind_texture(&batch->paint, BIND_PAINT);
    if (features & LOOK_SHADOW_FOUND) use_lights(look, batch);
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
