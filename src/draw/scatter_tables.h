// SPDX-License-Identifier: MIT
// Tables of marschner shading, made on the GPU when an image first needs them
// (glsl/draw/scatter.comp).
#pragma once

#include "draw/fibre_lobes.h"
#include "gpu/shader.h"

#include <stdint.h>

typedef struct ScatterTable {
    float refraction, roughness;
    float (*values)[4]; // owned, as the texture has them; NULL: not read yet
    GLuint texture;     // 3D, RGBA16F: R, TT, TRT by azimuth, cosine of theta_d and colour (draw.h)
} ScatterTable;

// One table for every pair of values; a zeroed struct has none.
typedef struct ScatterTables {
    ScatterTable *tables; // [count], owned
    uint32_t count;
    GLuint program;
} ScatterTables;

// The table of fibres of this refractive index (> 1) and azimuthal roughness (rad, 0.08 .. pi/2).
// RESULT_FAILED if memory is short.
Result scatter_tables_find(ScatterTables *tables, float refraction, float roughness,
                           GLuint *texture, Error *error);
// The values of a table that was found before. Waits for the GPU. RESULT_FAILED if memory is short.
Result scatter_tables_read(ScatterTables *tables, GLuint texture, FibreTable *table, Error *error);
void scatter_tables_destroy(ScatterTables *tables);
