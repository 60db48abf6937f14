// SPDX-License-Identifier: MIT
#include "sim/step_programs.h"
#include "sim/step_uniforms.h"

#include <stdlib.h>
#include <string.h>

static Result build(StepPrograms *programs, uint32_t batch, uint32_t vertices,
                    const StepProgramsOptions *options, Error *error)
{
    ShaderDefine defines[7 + STEP_OWN_DEFINES] = {
        {"GROUP_SIZE", (int)programs->group_size},
        {"STRANDS", (int)programs->strands_per_lane},
        {"IN_REGISTERS", programs->in_registers},
        {"VERTICES", (int)(vertices - programs->leads[batch])},
        {"LEAD", (int)programs->leads[batch]},
        {"SHELTER", options->sheltered},
    };
    for (int i = 0; options->defines && options->defines[i].name; ++i)
        defines[6 + i] = options->defines[i];
    return shader_build_compute(&programs->programs[batch], options->shader, defines, error);
}

// Batches of equal vertex count, and all of them if strands go through memory, share a program.
static bool is_shared(const StepPrograms *programs, const Hair *hair, uint32_t i)
{
    return i > 0 && programs->leads[i] == programs->leads[i - 1] &&
           (!programs->in_registers ||
            hair->batches[i].vertex_count == hair->batches[i - 1].vertex_count);
}

Result step_programs_create(StepPrograms *programs, const Gpu *gpu, const Hair *hair,
                            const StepProgramsOptions *options, Error *error)
{
    bool in_registers = step_fits_registers(hair, options->most_in_registers);
    *programs = (StepPrograms){
        .programs = calloc(hair->batch_count + 1, sizeof *programs->programs),
        .leads = calloc(hair->batch_count + 1, sizeof *programs->leads),
        .batch_count = hair->batch_count,
        .group_size = step_group_size(gpu),
        .strands_per_lane = in_registers && gpu->software ? options->strands_on_cpu : 1,
        .in_registers = in_registers,
    };
    if (!programs->programs || !programs->leads) {
        step_programs_destroy(programs);
        return error_set(error, RESULT_FAILED, "no memory for a solver");
    }
    Result result = RESULT_OK;
    for (uint32_t i = 0; i < hair->batch_count && result == RESULT_OK; ++i) {
        // At least the tip is free.
        programs->leads[i] = hair->batches[i].vertex_count > 2 ? options->lead : 0;
        if (is_shared(programs, hair, i))
            programs->programs[i] = programs->programs[i - 1];
        else
            result = build(programs, i, hair->batches[i].vertex_count, options, error);
    }
    if (result != RESULT_OK) step_programs_destroy(programs);
    return result;
}

void step_programs_destroy(StepPrograms *programs)
{
    for (uint32_t i = 0; programs->programs && i < programs->batch_count; ++i)
        if (programs->programs[i] && (i == 0 || programs->programs[i] != programs->programs[i - 1]))
            glDeleteProgram(programs->programs[i]);
    free(programs->programs);
    free(programs->leads);
    *programs = (StepPrograms){0};
}

void step_programs_dispatch(const StepPrograms *programs, uint32_t batch, uint32_t strand_count)
{
    glUseProgram(programs->programs[batch]);
    glDispatchCompute(
        step_group_count(strand_count, programs->group_size, programs->strands_per_lane), 1, 1);
}
