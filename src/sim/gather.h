// SPDX-License-Identifier: MIT
// Copies positions of hair, strand by strand, to a buffer on the GPU, without waiting.
#pragma once

#include "sim/hair.h"
#include "sim/step.h"

// A zeroed one may be destroyed.
typedef struct Gather {
    const Hair *hair;
    StepPass pass;
    GpuBuffer *begins; // [hair->batch_count]: uint a strand
    GLint alignment;   // bytes, of ranges of buffers
} Gather;

// `first`: where each strand begins, in vertices, in the order of the batches (all of `hair`'s).
// RESULT_FAILED when memory is short or the positions are more than a shader may write; errors of
// shader_build_compute.
Result gather_create(Gather *gather, const Gpu *gpu, const Hair *hair, const uint32_t *first,
                     Error *error);
void gather_destroy(Gather *gather);

// Writes a vec4 a vertex, x y z 1, from byte `offset` of the buffer on (a multiple of 16), which
// has room. What follows may read it as vertices, as storage or as a texture.
void gather_run(Gather *gather, GLuint buffer, int64_t offset);
