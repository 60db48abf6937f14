// SPDX-License-Identifier: MIT
// Marschner's table for the strands of one section, all of one colour but for their brightness: a
// point needs four texels of a buffer where the table of all colours (scatter_tables.h) takes three
// samples of a volume. For CPU drivers, which sample in software.
#pragma once

#include "draw/fibre_lobes.h"
#include "gpu/gpu_buffer.h"

// Of a brightness 1 - variation .. 1 + variation: how many, and what they are made of.
typedef struct TintTable {
    float color[3]; // linear RGB, >= 0
    float variation;
    const float (*values)[4]; // of the table of all colours
    GpuBuffer texels;         // see shade_marschner.glsl; [slices][SCATTER_INCLINATIONS][AZIMUTHS]
    float unit[4];            // what a texel's 1 stands for: R, TT, TRT; slices - 1
} TintTable;

// The shares of R, TT and TRT by azimuth and cosine, of a fibre whose diameter lets color * (1 +
// variation * (2 slice / (slices - 1) - 1)) through, at most 1. Made anew if anything differs; a
// zeroed struct is empty. RESULT_FAILED if memory is short.
Result tint_table_make(TintTable *tints, FibreTable table, const float color[3], float variation,
                       const GpuLimits *limits, Error *error);
void tint_table_destroy(TintTable *tints);
