// SPDX-License-Identifier: MIT
// Tables of Marschner's shading (glsl/draw/scatter.comp). The GPU makes a table when an image first
// needs it.
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

// The texture for fibres of this refractive index (> 1) and azimuthal roughness (rad, 0.08 ..
// pi/2). RESULT_FAILED if memory is short.
Result scatter_tables_find(ScatterTables *tables, float refraction, float roughness,
                           GLuint *texture, Error *error);
// The values of a table that scatter_tables_find has returned. Waits for the GPU. RESULT_FAILED if
// memory is short.
Result scatter_tables_read(ScatterTables *tables, GLuint texture, FibreTable *table, Error *error);
void scatter_tables_destroy(ScatterTables *tables);
