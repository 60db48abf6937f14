// SPDX-License-Identifier: MIT
// Tables of Marschner's shading (glsl/draw/scatter.comp). The GPU makes a table when an image first
// needs it; the context keeps it for the images that come.
#pragma once

#include "base/error.h"
#include "base/stock.h"
#include "draw/fibre_lobes.h"

#include <stdint.h>

typedef struct ScatterTable ScatterTable;

// The tables in use. Initialise with {.stock = gpu->tables}.
typedef struct ScatterTables {
    Stock *stock;
    ScatterTable **taken; // [count], owned
    uint32_t count;
} ScatterTables;

// The table for fibres of this refractive index (> 1) and azimuthal roughness (rad, 0.08 ..
// pi/2), which stays until scatter_tables_destroy. RESULT_FAILED if memory is short.
Result scatter_tables_find(ScatterTables *tables, float refraction, float roughness,
                           ScatterTable **table, Error *error);
void scatter_tables_destroy(ScatterTables *tables);

// 3D, RGBA16F: R, TT, TRT by azimuth, cosine of theta_d and colour (draw.h).
unsigned scatter_table_texture(const ScatterTable *table);
// The same values in memory. The first call waits for the GPU.
Result scatter_table_read(ScatterTable *table, FibreTable *values, Error *error);
