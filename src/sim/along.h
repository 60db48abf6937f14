// SPDX-License-Identifier: MIT
// Parameters that differ along the strand (profiles, base/profile.h). Shaders read them from
// tables of two vec4 a vertex (glsl/sim/forces.glsl). Without profiles there is no table.
#pragma once

#include "sim/recipe.h"

// A zeroed struct may be destroyed and filled.
typedef struct Along {
    const Hair *hair;
    const SectionParams *params;
    const SolverRecipe *recipe;
    GpuBuffer *tables;     // [hair->batch_count]: two vec4 a vertex, from the solver's root on
    const uint32_t *leads; // [hair->batch_count]: vertices before the solver's root
    float (*texels)[4];    // [2 * vertices of the longest strand], scratch memory
    void *block;           // scratch memory: the recipe's uniform block for one vertex
    uint64_t stamp;        // SolverStep.params_stamp
    double dt;             // s, of the step for which the tables are filled; 0: not filled yet
    bool first;            // the same step's SolverStep.first
} Along;

// Whether a parameter is a profile that the recipe supports.
bool along_varies(const SolverRecipe *recipe, const SectionParams *params);

// `leads` (StepPrograms.leads) must outlive `along`. RESULT_FAILED when memory is short.
Result along_create(Along *along, const SolverRecipe *recipe, const Hair *hair,
                    const uint32_t *leads, const SectionParams *params, const GpuLimits *limits,
                    Error *error);
void along_destroy(Along *along);

// Fills the tables for a step, if its dt or `first` differ from the last call's. `mean`: the
// recipe's block, made from the mean of each profile.
void along_fill(Along *along, const SolverStep *step, const void *mean);

// The section's parameters at the place `share` (0 .. 1) along the strand.
SectionParams along_params_at(const SectionParams *params, double share);

// Binds the table of batch `batch` at BIND_ALONG. Does nothing if there is no table.
void along_bind(const Along *along, uint32_t batch);
