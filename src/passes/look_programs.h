// SPDX-License-Identifier: MIT
// The shaders that project and shade hair: one variant for each set of a look's features, so that
// what a scene does not use costs nothing.
#pragma once

#include "draw/look.h"
#include "gpu/gpu_buffer.h"
#include "gpu/shader.h"
#include "sim/hair.h"

// The light among hair at the points of a batch (look_points), laid out as its particles are.
typedef struct ParticleLight {
    const HairBatch *batch;
    GpuBuffer seen; // three floats a point: linear RGB, see hair_scatter.h
} ParticleLight;

// The variants of one compute shader, for so many lights and shadow maps; a zeroed struct with a
// file and a group size has none yet.
typedef struct LookPrograms {
    const char *file;
    int group_size, light_count, map_count;
    GLuint program[LOOK_VARIANTS];
} LookPrograms;

// Makes the variant for the look and what the batch has the current program, compiled at first use,
// with the textures of both. RESULT_FAILED with the compiler's words.
Result look_programs_use(LookPrograms *programs, const Look *look, const HairBatch *batch,
                         Error *error);

// Says for how many lights and shadow maps variants are; those for others are forgotten.
void look_programs_count(LookPrograms *programs, int light_count, int map_count);

// LIGHT_COUNT of a shader for so many lights, as shadow.glsl has it: 0 if there are too many to
// unroll loops over them.
int look_unrolled(int light_count);

// Compiles the variant of these features if it is not there.
Result look_programs_build(LookPrograms *programs, unsigned features, Error *error);
void look_programs_destroy(LookPrograms *programs);
