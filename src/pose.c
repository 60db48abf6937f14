// SPDX-License-Identifier: MIT
#include "pose.h"
#include "step_uniforms.h"

#include <string.h>

PoseMix pose_mix_of_style(float style)
{
    return style <= 0 ? POSE_PHYSICAL : style >= 1 ? POSE_STYLE : POSE_MIXED;
}

Result pose_create(Pose *pose, PoseMix mix, Error *error)
{
    *pose = (Pose){.mix = mix};
    const ShaderDefine defines[] = {{"GROUP_SIZE", STEP_GROUP_SIZE}, {"MIX", (int)mix}, {0}};
    return shader_build_compute(&pose->program, "pose.comp", defines, error);
}

void pose_destroy(Pose *pose)
{
    if (pose->program) glDeleteProgram(pose->program);
    gpu_buffer_destroy(&pose->uniforms);
    *pose = (Pose){0};
}

void pose_write(Pose *pose, const HairBatch *batch, const GpuBuffer *segments, const HeadPose *head,
                float style)
{
    StepParams params = {
        .style = style, .strand_count = batch->strand_count, .vertex_count = batch->vertex_count};
    memcpy(params.head_rotation, head->rotation, sizeof head->rotation);
    memcpy(params.head_translation, head->translation, sizeof head->translation);
    gpu_uniforms_set(&pose->uniforms, BIND_STEP, &params, sizeof params);
    gpu_buffer_bind_texture(&batch->rest, BIND_REST);
    if (segments) gpu_buffer_bind_texture(segments, BIND_STATE);
    gpu_buffer_bind_storage(&batch->position, BIND_POSITION_OUT);
    glUseProgram(pose->program);
    glDispatchCompute(step_group_count(batch->strand_count, 1), 1, 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}
