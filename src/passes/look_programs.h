// SPDX-License-Identifier: MIT
// The shaders that project and shade hair. There is a variant for each set of a look's features, so
// features that a scene does not use cost nothing.
#pragma once

#include "draw/look.h"
#include "gpu/gpu_buffer.h"
#include "gpu/shader.h"
#include "sim/hair.h"

// The light among hair at the points of a batch (look_points), in the order of its particles.
typedef struct ParticleLight {
    const HairBatch *batch;
    GpuBuffer seen; // three floats per point: linear RGB, see hair_scatter.h
} ParticleLight;

// The variants of one compute shader, for a number of lights and of shadow maps. A zeroed struct
// with a file and a group size has none yet.
typedef struct LookPrograms {
    const char *file;
    int group_size, light_count, map_count;
    GLuint program[LOOK_VARIANTS];
} LookPrograms;

// Makes the variant for this look and batch the current program, with their textures. It is
// compiled at first use. RESULT_FAILED with the compiler's message.
Result look_programs_use(LookPrograms *programs, const Look *look, const HairBatch *batch,
                         Error *error);

// Sets the number of lights and shadow maps. Variants for other numbers are dropped.
void look_programs_count(LookPrograms *programs, int light_count, int map_count);

// The macro LIGHT_COUNT of a shader for this many lights (shadow.glsl): 0 if there are too many to
// unroll loops over them.
int look_unrolled(int light_count);

// Compiles the variant with these features, if missing.
Result look_programs_build(LookPrograms *programs, unsigned features, Error *error);
void look_programs_destroy(LookPrograms *programs);
