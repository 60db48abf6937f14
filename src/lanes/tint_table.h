// SPDX-License-Identifier: MIT
// Marschner's table for the strands of one section, all of one colour but for their brightness: a
// point needs four texels where the table of all colours (FibreTable) takes 24.
#pragma once

#include "base/error.h"
#include "draw/fibre_lobes.h"

// Of a brightness 1 - variation .. 1 + variation: how many, and what they are made of.
typedef struct TintTable {
    float color[3]; // linear RGB, >= 0
    float variation;
    const float (*values)[4]; // of the table of all colours
    // [slices][SCATTER_INCLINATIONS][SCATTER_AZIMUTHS], owned: R | TT of red << 16, TT of green and
    // blue, TRT of red and green, TRT of blue, all in units
    uint32_t (*texels)[4];
    float unit[3]; // of R, TT, TRT
    int slices;
} TintTable;

// The shares of R, TT and TRT by azimuth and cosine, of a fibre whose diameter lets color * (1 +
// variation * (2 slice / (slices - 1) - 1)) through, at most 1. Made anew if anything differs; a
// zeroed struct is empty. RESULT_FAILED if memory is short.
Result tint_table_make(TintTable *tints, FibreTable table, const float color[3], float variation,
                       Error *error);
void tint_table_destroy(TintTable *tints);
