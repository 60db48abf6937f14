// SPDX-License-Identifier: MIT
// What of a step differs along the strand: parameters that are profiles (base/profile.h), as tables
// of two vec4 a vertex that shaders read (glsl/sim/forces.glsl). Without profiles there is none.
#pragma once

#include "sim/recipe.h"

// A zeroed one may be destroyed and filled.
typedef struct Along {
    const Hair *hair;
    const SectionParams *params;
    const SolverRecipe *recipe;
    GpuBuffer *tables;     // [hair->batch_count], by the solver's vertices from its root on
    const uint32_t *leads; // [hair->batch_count]: vertices before the solver's root
    float (*texels)[4];    // [2 longest]
    void *block;           // the recipe's, for one vertex
    uint64_t stamp;        // SolverStep.params_stamp
    double dt;             // of the step that the tables are for; 0: none yet
    bool first;
} Along;

// Whether a parameter that the recipe can take as one is a profile.
bool along_varies(const SolverRecipe *recipe, const SectionParams *params);

// `leads` (StepPrograms) outlives it. RESULT_FAILED when memory is short.
Result along_create(Along *along, const SolverRecipe *recipe, const Hair *hair,
                    const uint32_t *leads, const SectionParams *params, const GpuLimits *limits,
                    Error *error);
void along_destroy(Along *along);

// The tables for a step, where dt or `first` have changed since the last. `mean`: the recipe's
// block with each profile's mean.
void along_fill(Along *along, const SolverStep *step, const void *mean);

// Binds the table of batch `batch` at BIND_ALONG; nothing where there is none.
void along_bind(const Along *along, uint32_t batch);
