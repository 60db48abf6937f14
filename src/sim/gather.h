// SPDX-License-Identifier: MIT
// Copies positions of hair, strand by strand, to a buffer on the GPU, without waiting for the GPU.
#pragma once

#include "sim/hair.h"
#include "sim/step.h"

// A zeroed struct may be destroyed.
typedef struct Gather {
    const Hair *hair;
    StepPass pass;
    GpuBuffer *begins; // [hair->batch_count]: uint a strand, its first vertex in the result
    GLint alignment;   // bytes: the driver's alignment of ranges of buffers
} Gather;

// first[hair->strand_count]: the index of each strand's first vertex in the result; strands in the
// order of the batches. RESULT_FAILED when memory is short, or if there are more positions than a
// shader may write; errors of shader_build_compute.
Result gather_create(Gather *gather, const Gpu *gpu, const Hair *hair, const uint32_t *first,
                     Error *error);
void gather_destroy(Gather *gather);

// Writes one vec4 (x y z 1) a vertex to the buffer, from byte `offset` (a multiple of 16) on. The
// buffer must be large enough. Later commands may read it as vertices, as storage or as a texture.
void gather_run(Gather *gather, GLuint buffer, int64_t offset);
