// SPDX-License-Identifier: MIT
#include "draw/look.h"

#include "base/params.h"

#include "glsl/draw/draw.h"
#include "glsl/draw/shadow.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- Paint on the GPU.

typedef uint32_t Texel[4];

static uint32_t unorm16(float x)
{
    return (uint32_t)(x * 65535.0f + 0.5f);
}

static void fill(Texel *texels, const HairBatch *batch, const Strands *strands, const Paint *paint)
{
    for (uint32_t slot = 0; slot < hair_slots(batch); ++slot) {
        uint32_t s = batch->strand[slot < batch->strand_count ? slot : batch->strand_count - 1];
        for (uint32_t j = 0; j < batch->vertex_count; ++j) {
            uint32_t *texel = texels[hair_address(batch, slot, j)], v = strands->first[s] + j;
            const float *c = paint->color[v];
            texel[0] = unorm16(c[0]) | unorm16(c[1]) << 16;
            texel[1] = unorm16(c[2]) | unorm16(c[3]) << 16;
            memcpy(&texel[2], &paint->thickness[v], sizeof texel[2]);
            texel[3] = 0;
        }
    }
}

static Result paint_batch(HairBatch *batch, const Strands *strands, const Paint *paint,
                          const GpuLimits *limits, Error *error)
{
    size_t count = (size_t)hair_slots(batch) * batch->vertex_count;
    Texel *texels = malloc(count * sizeof *texels);
    if (!texels) return error_set(error, RESULT_FAILED, "no memory for the paint of hair");
    fill(texels, batch, strands, paint);
    gpu_buffer_destroy(&batch->paint);
    Result result =
        gpu_buffer_create(&batch->paint, limits, "hair paint", (int64_t)(count * sizeof *texels),
                          texels, GL_RGBA32UI, error);
    free(texels);
    return result;
}

// The mean colour of all particles.
static void find_mean(const Paint *paint, float mean[3])
{
    double sum[3] = {0};
    for (uint32_t v = 0; v < paint->vertex_count; ++v)
        for (int k = 0; k < 3; ++k) sum[k] += (double)paint->color[v][k];
    for (int k = 0; k < 3; ++k) mean[k] = (float)(sum[k] / paint->vertex_count);
}

Result look_paint(Hair *hair, const Strands *strands, const Paint *paint, const GpuLimits *limits,
                  Error *error)
{
    Result result = RESULT_OK;
    hair->alike = paint->colors_from_file;
    hair->is_painted = paint->color && paint->vertex_count;
    if (hair->is_painted) find_mean(paint, hair->paint_mean);
    for (uint32_t b = 0; paint->color && b < hair->batch_count && result == RESULT_OK; ++b) {
        assert(hair->batches[b].strand);
        result = paint_batch(&hair->batches[b], strands, paint, limits, error);
    }
    return result;
}

// --- Materials and the programs that draw them.

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
                                    {"SCATTERED", (features & LOOK_SCATTERED) != 0},
                                    {"TINTS", (features & LOOK_TINTS) != 0},
                                    {"DUAL", (features & LOOK_DUAL) != 0},
                                    {"MESH_TEXELS", (features & LOOK_MESH_TEXELS) != 0},
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

// The light at the batch's points, of all batches.
static const ParticleLight *light_of(const ParticleLight *lights, uint32_t count,
                                     const HairBatch *batch)
{
    uint32_t i = 0;
    while (i + 1 < count && lights[i].batch != batch) ++i;
    return &lights[i];
}

static void use_lights(const Look *look, const HairBatch *batch)
{
    const ParticleLight *light = light_of(look->lights, look->batches, batch);
    gpu_buffer_bind_texture(&light->left, BIND_SHADOW_LEFT);
    glUniform1i(SHADOW_POINTS_AT, (GLint)(hair_slots(batch) * look_points(look, batch)));
}

Result look_programs_use(LookPrograms *programs, const Look *look, const HairBatch *batch,
                         Error *error)
{
    unsigned features = look->features | (batch->paint.buffer ? LOOK_PAINT : 0);
    look_programs_count(programs, look->light_count, look->map_count);
    TRY(look_programs_build(programs, features, error));
    glUseProgram(programs->program[features]);
    if (features & LOOK_PAINT) gpu_buffer_bind_texture(&batch->paint, BIND_PAINT);
    if (features & LOOK_SHADOW_FOUND) use_lights(look, batch);
    if (features & LOOK_SCATTERED)
        gpu_buffer_bind_texture(&light_of(look->scattered, look->batches, batch)->left,
                                BIND_SCATTERED);
    if (look->features & LOOK_TINTS) {
        gpu_buffer_bind_texture(&look->tints->texels, BIND_SCATTER);
    } else if (look->features & LOOK_MARSCHNER) {
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
