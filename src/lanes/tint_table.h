// SPDX-License-Identifier: MIT
// Marschner's table for a section whose strands have one colour and differ only in brightness. A
// point reads four texels of it instead of the 24 of the table of all colours (FibreTable).
#pragma once

#include "base/error.h"
#include "draw/fibre_lobes.h"

// The table, in slices of brightness from 1 - variation to 1 + variation, and the values that it
// was made from.
typedef struct TintTable {
    float color[3]; // linear RGB, >= 0
    float variation;
    const float (*values)[4]; // values of the table of all colours
    // [slices][SCATTER_INCLINATIONS][SCATTER_AZIMUTHS], owned: R | TT of red << 16, TT of green and
    // blue, TRT of red and green, TRT of blue, all in units
    uint32_t (*texels)[4];
    float unit[3]; // of R, TT, TRT
    int slices;
} TintTable;

// Makes the table: the shares of R, TT and TRT by azimuth and cosine, for fibres of which one
// diameter has the transmittance color * (1 + variation * (2 slice / (slices - 1) - 1)), at most 1.
// Keeps the table if nothing differs. A zeroed struct is empty. RESULT_FAILED if memory is short.
Result tint_table_make(TintTable *tints, FibreTable table, const float color[3], float variation,
                       Error *error);
void tint_table_destroy(TintTable *tints);
