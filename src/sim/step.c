// SPDX-License-Identifier: MIT
#include "sim/step.h"
#include "gpu/gpu_dispatch.h"
#include "gpu/gpu_uniforms.h"

#include <cglm/cglm.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void carry(const HeadPose *head, const float point[3], vec3 carried)
{
    glm_quat_rotatev((float *)head->rotation, (float *)point, carried);
    glm_vec3_add((float *)head->translation, carried, carried);
}

// A rotation is applied as q v + 2 q.xyz x (q.xyz x v + q.w v) in double precision.
static void carry_exactly(const HeadPose *head, const float point[3], double carried[3])
{
    double q[4], v[3], t[3];
    for (int i = 0; i < 4; ++i) q[i] = (double)head->rotation[i];
    for (int i = 0; i < 3; ++i) v[i] = (double)point[i];
    for (int i = 0; i < 3; ++i) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        t[i] = q[j] * v[k] - q[k] * v[j] + q[3] * v[i];
    }
    for (int i = 0; i < 3; ++i) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        carried[i] = v[i] + 2 * (q[j] * t[k] - q[k] * t[j]) + (double)head->translation[i];
    }
}

// The move of the pivot by the step's poses, as they are rounded.
static void rounded_move(const SolverStep *step, double move[3])
{
    double old[3];
    carry_exactly(&step->head_old, step->pivot, old);
    carry_exactly(&step->head, step->pivot, move);
    for (int k = 0; k < 3; ++k) move[k] -= old[k];
}

void step_set_move(SolverStep *step, const float pivot[3], const double move[3])
{
    double rounded[3];
    memcpy(step->pivot, pivot, sizeof step->pivot);
    rounded_move(step, rounded);
    for (int k = 0; k < 3; ++k) step->move_lost[k] = (float)(move[k] - rounded[k]);
}

void step_shelter(SolverStep *step, const float middle[3], float share)
{
    vec3 old = {0};
    carry(&step->head_old, middle, old);
    carry(&step->head, middle, step->shelter);
    step->shelter[3] = share;
    for (int k = 0; k < 3; ++k)
        step->head_velocity[k] = (float)((double)(step->shelter[k] - old[k]) / step->dt);
}

void step_drag_factors(double c, double h, float *decay, float *gain)
{
    *decay = (float)exp(-c * h);
    *gain = c > 0 ? (float)(-expm1(-c * h) / c) : (float)h;
}

StepParams step_uniforms(const SolverStep *step, const SectionParams *params)
{
    StepParams uniforms = {.dt = (float)step->dt, .drag = params->drag};
    head_put(uniforms.head_rotation_old, uniforms.head_translation_old, &step->head_old);
    head_put(uniforms.head_rotation, uniforms.head_translation, &step->head);
    double move[3];
    rounded_move(step, move);
    for (int k = 0; k < 3; ++k) {
        uniforms.head_pivot[k] = step->pivot[k];
        uniforms.head_move[k] = (float)(move[k] + (double)step->move_lost[k]);
    }
    uniforms.frame_old = step->frame_old;
    uniforms.frame_now = step->frame_now;
    memcpy(uniforms.gravity, step->gravity, sizeof step->gravity);
    for (int i = 0; i < 4; ++i) memcpy(uniforms.wind[i], step->wind[i], sizeof step->wind[i]);
    memcpy(uniforms.shelter, step->shelter, sizeof step->shelter);
    memcpy(uniforms.head_velocity, step->head_velocity, sizeof step->head_velocity);
    step_drag_factors((double)params->drag, step->first ? step->dt / 2 : step->dt, &uniforms.decay,
                      &uniforms.gain);
    return uniforms;
}

StyleSpring step_style_spring(const StepParams *uniforms, double h, const SectionParams *params)
{
    const double most_style = 0.999999; // a style of 1 would make the springs infinitely stiff
    double style = (double)params->style, stiffness = (double)params->style_stiffness;
    double decay = (double)uniforms->decay, gain = (double)uniforms->gain;
    double w = style * stiffness * h * gain;
    double finite = fmin(style, most_style), k = stiffness * finite / (1 - finite);
    // At rest, each of the two half kicks adds (1 + e^{-ch})/(1 + e^{-2ch}) gain. Scaling the
    // spring by the same factor keeps the balance exact.
    double z = k * h * gain * (1 + decay) / (1 + decay * decay);
    double keep = 1 / (1 + 2 * z);
    return (StyleSpring){.stiffness = (float)k,
                         .pull = w > 0 ? (float)(w / (1 - style + w)) : 0,
                         .keep = (float)keep,
                         .draw = (float)(keep * z / h)};
}

StyleSpring step_midpoint(StepParams *uniforms, const SolverStep *step, const SectionParams *params)
{
    double h = step->dt / 2;
    step_drag_factors((double)params->drag, h, &uniforms->decay, &uniforms->gain);
    return step_style_spring(uniforms, h, params);
}

void step_spring_along(float texel[4], const void *block, const void *mean,
                       const SectionParams *there)
{
    const StyleSpring *spring = block;
    (void)mean, (void)there;
    texel[0] = spring->stiffness, texel[1] = spring->pull;
    texel[2] = spring->keep, texel[3] = spring->draw;
}

float step_style_odds(const SectionParams *params)
{
    return params->style / fmaxf(1 - params->style, 1e-6f);
}

Result step_pass_create(StepPass *pass, const Gpu *gpu, const char *shader,
                        const ShaderDefine *defines, Error *error)
{
    *pass = (StepPass){.limits = &gpu->limits};
    ShaderDefine all[3 + STEP_OWN_DEFINES] = {{"GROUP_SIZE", gpu->limits.sizes.strands},
                                              {"ORDERED", gpu->kind == GPU_HARDWARE}};
    for (int i = 0; defines && defines[i].name; ++i) all[2 + i] = defines[i];
    return shader_build_compute(&pass->program, shader, all, error);
}

void step_pass_destroy(StepPass *pass)
{
    shader_release(pass->program);
    *pass = (StepPass){0};
}

void step_pass_run(StepPass *pass, const void *params, size_t size, uint32_t strand_count)
{
    gpu_uniforms_set(BIND_STEP, params, size);
    glUseProgram(pass->program);
    gpu_dispatch(pass->limits, strand_count, (uint64_t)pass->limits->sizes.strands, 1);
}

// Whether the strands can stay in registers during a step. They must have at most `most` vertices,
// and at most MOST_COUNTS different numbers of vertices and leads, because each costs a compilation
// (0.2 to 0.7 s on a CPU driver).
static bool fits_registers(const Hair *hair, const uint32_t *leads, uint32_t most)
{
    enum { MOST_COUNTS = 2 };
    uint32_t counts = 0, last = 0, last_lead = 0;
    for (uint32_t i = 0; i < hair->batch_count; ++i) {
        if (hair->batches[i].vertex_count > most) return false;
        counts += hair->batches[i].vertex_count != last || leads[i] != last_lead;
        last = hair->batches[i].vertex_count, last_lead = leads[i];
    }
    return counts <= MOST_COUNTS;
}

static uint32_t lead_of(const HairBatch *batch, const StepProgramsOptions *options)
{
    uint32_t n = batch->vertex_count, own = options->carried > 1 ? options->carried : 1,
             lead = n > 2 ? options->lead : 0; // at least the tip must be free
    if (batch->held == n) return n - 1;
    if (batch->held > own && batch->held - own > lead) lead = batch->held - own;
    return lead;
}

static Result build(StepPrograms *programs, uint32_t batch, uint32_t vertices,
                    const StepProgramsOptions *options, Error *error)
{
    ShaderDefine defines[11 + STEP_OWN_DEFINES] = {
        {"GROUP_SIZE", programs->limits->sizes.strands},
        {"STRANDS", (int)programs->strands_per_lane},
        {"IN_REGISTERS", programs->in_registers},
        {"VERTICES", programs->in_registers ? (int)(vertices - programs->leads[batch]) : 0},
        {"LEAD", (int)programs->leads[batch]},
        {"SHELTER", options->sheltered},
        {"STYLED", options->styled},
        {"VARIES", options->varies},
        {"ORDERED", programs->ordered},
        {"BOUND", options->bound},
    };
    for (int i = 0; options->defines && options->defines[i].name; ++i)
        defines[10 + i] = options->defines[i];
    return shader_build_compute(&programs->programs[batch], options->shader, defines, error);
}

// CPU drivers end the loops of a lane after 65,535 turns, which most_vertices allows for one
// strand.
static uint32_t strands_in_memory(const StepSizes *sizes, const Hair *hair,
                                  const StepProgramsOptions *options)
{
    uint32_t most = sizes->strands_in_memory;
    for (uint32_t i = 0; i < hair->batch_count && options->most_vertices; ++i) {
        uint32_t fit = options->most_vertices / hair->batches[i].vertex_count;
        if (fit < most) most = fit;
    }
    return most ? most : 1;
}

Result step_programs_create(StepPrograms *programs, const Gpu *gpu, const Hair *hair,
                            const StepProgramsOptions *options, Error *error)
{
    const StepSizes *sizes = &STEP_SIZES[options->shape][gpu->kind];
    *programs = (StepPrograms){
        .programs = calloc(hair->batch_count + 1, sizeof *programs->programs),
        .leads = calloc(hair->batch_count + 1, sizeof *programs->leads),
        .batch_count = hair->batch_count,
        .limits = &gpu->limits,
        .strands_per_lane = 1,
        .ordered = gpu->kind == GPU_HARDWARE,
    };
    Result result = RESULT_OK;
    if (!programs->programs || !programs->leads)
        result = error_set(error, RESULT_FAILED, "no memory for a solver");
    for (uint32_t i = 0; i < hair->batch_count && result == RESULT_OK; ++i)
        programs->leads[i] = lead_of(&hair->batches[i], options);
    if (result == RESULT_OK) {
        programs->in_registers = fits_registers(hair, programs->leads, sizes->most_in_registers);
        programs->strands_per_lane =
            programs->in_registers ? sizes->strands : strands_in_memory(sizes, hair, options);
    }
    for (uint32_t i = 0; i < hair->batch_count && result == RESULT_OK; ++i)
        if (hair->batches[i].held < hair->batches[i].vertex_count)
            result = build(programs, i, hair->batches[i].vertex_count, options, error);
    if (result != RESULT_OK) step_programs_destroy(programs);
    return result;
}

void step_programs_destroy(StepPrograms *programs)
{
    for (uint32_t i = 0; programs->programs && i < programs->batch_count; ++i)
        shader_release(programs->programs[i]);
    free(programs->programs);
    free(programs->leads);
    *programs = (StepPrograms){0};
}

void step_programs_dispatch(const StepPrograms *programs, uint32_t batch, uint32_t strand_count)
{
    glUseProgram(programs->programs[batch]);
    uint64_t per_group = (uint64_t)programs->limits->sizes.strands * programs->strands_per_lane;
    gpu_dispatch(programs->limits, strand_count, per_group, 1);
}

uint64_t step_programs_lanes(const StepPrograms *programs, uint32_t strand_count)
{
    uint64_t lanes = (uint64_t)programs->limits->sizes.strands,
             per_group = lanes * programs->strands_per_lane;
    return (strand_count + per_group - 1) / per_group * lanes;
}
