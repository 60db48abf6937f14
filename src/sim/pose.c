// SPDX-License-Identifier: MIT
#include "sim/pose.h"

#include "glsl/sim/pose_params.h"

#include <cglm/cglm.h>

#include <math.h>
#include <string.h>

enum { TERMS = 8 };

static PoseMix mix_of(const PoseOptions *options)
{
    float style = options->style;
    if (options->varies) return POSE_VARIES;
    if (style <= 0) return POSE_PHYSICAL;
    if (style >= 1) return POSE_STYLE;
    return style <= 0.5f ? POSE_NEAR_PHYSICAL : POSE_NEAR_STYLE;
}

// The coefficients of a rotation by v p as functions of x = sin^2(p/2): cos(v p) and sin(v
// p)/sin(p).
static double turn_cos(double x, double v)
{
    return cos(2 * v * asin(sqrt(x)));
}

static double turn_sin(double x, double v)
{
    double p = 2 * asin(sqrt(x));
    return p < 1e-9 ? v : sin(v * p) / sin(p);
}

// Interpolates the function at the Chebyshev nodes of 0 <= x <= 1/2 (p <= 90 deg) by Newton's
// divided differences. The nearest singularity is x = 1, so each further term divides the error by
// 3 + sqrt(8); with 8 terms the error is below 3e-7 for any v.
static void interpolate(double (*function)(double, double), double v, float coefficients[TERMS])
{
    double x[TERMS], d[TERMS], c[TERMS] = {0};
    for (int i = 0; i < TERMS; ++i) {
        x[i] = 0.25 + 0.25 * cos(3.14159265358979323846 * (2 * i + 1) / (2 * TERMS));
        d[i] = function(x[i], v);
    }
    for (int k = 1; k < TERMS; ++k)
        for (int i = TERMS - 1; i >= k; --i) d[i] = (d[i] - d[i - 1]) / (x[i] - x[i - k]);
    for (int k = TERMS - 1; k >= 0; --k) { // c = c (X - x[k]) + d[k]
        for (int i = TERMS - 1; i > 0; --i) c[i] = c[i - 1] - x[k] * c[i];
        c[0] = d[k] - x[k] * c[0];
    }
    for (int i = 0; i < TERMS; ++i) coefficients[i] = (float)c[i];
}

Result pose_create(Pose *pose, const Gpu *gpu, const PoseOptions *options, Error *error)
{
    const float *hanging = options->hanging;
    pose->held = 1;
    pose->bound = options->bound;
    memcpy(pose->hanging, hanging, sizeof pose->hanging);
    bool hangs = hanging[0] != 0 || hanging[1] != 0 || hanging[2] != 0;
    double style = (double)options->style, v = hangs ? 1 - style : 2 * fmin(style, 1 - style);
    interpolate(turn_cos, v, pose->turn_cos);
    interpolate(turn_sin, v, pose->turn_sin);
    const ShaderDefine defines[] = {{"MIX", (int)mix_of(options)},
                                    {"HANGS", hangs},
                                    {"FADES", hangs && options->fades},
                                    {"BOUND", options->bound},
                                    {0}};
    return step_pass_create(&pose->pass, gpu, "sim/pose.comp", defines, error);
}

void pose_destroy(Pose *pose)
{
    step_pass_destroy(&pose->pass);
}

void pose_write(Pose *pose, const HairBatch *batch, const GpuBuffer *segments, uint32_t lead,
                const HeadPose *head)
{
    PoseParams params = {
        .strand_count = batch->strand_count, .vertex_count = batch->vertex_count, .lead = lead};
    if (pose->bound) // the shader turns it by the strand's frame
        memcpy(params.hanging, pose->hanging, sizeof pose->hanging);
    else
        glm_quat_rotatev((float *)head->rotation, pose->hanging, params.hanging);
    params.held = pose->held;
    head_put(params.head_rotation, params.head_translation, head);
    memcpy(params.turn_cos, pose->turn_cos, sizeof pose->turn_cos);
    memcpy(params.turn_sin, pose->turn_sin, sizeof pose->turn_sin);
    gpu_buffer_bind_texture(&batch->rest, BIND_REST);
    if (segments) gpu_buffer_bind_texture(segments, BIND_STATE);
    gpu_buffer_bind_storage(&batch->position, BIND_POSITION_OUT);
    step_pass_run(&pose->pass, &params, sizeof params, batch->strand_count);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}
