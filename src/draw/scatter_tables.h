// SPDX-License-Identifier: MIT
// Tables of marschner shading, made on the GPU when an image first needs them
// (glsl/draw/scatter.comp).
#pragma once

#include "gpu/shader.h"

#include <stdint.h>

typedef struct ScatterTable {
    float refraction, roughness;
    GLuint texture; // 3D, RGBA16F: R, TT, TRT by azimuth, cosine of theta_d and colour (draw.h)
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
void scatter_tables_destroy(ScatterTables *tables);
