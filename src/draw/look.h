// SPDX-License-Identifier: MIT
// How a section's hair looks. Needs no OpenGL.
#pragma once

#include "draw/fibre_lobes.h"

#include "glsl/draw/material.h"

#include <stdint.h>

typedef struct HairBatch HairBatch; // sim/hair.h

// What hair is shaded by: of shaders one variant for each set.
typedef enum LookFeature {
    LOOK_LIGHTS = 1, // lights that are not directional, or a sky that differs from the ground
    LOOK_MARSCHNER = 2,
    LOOK_GAUSS = 4, // of marschner, --lobes gauss
    LOOK_PAINT = 8, // colours and thickness by particle
    LOOK_SHADOW_APPROX = 16,
    LOOK_SHADOW_DOM = 32,
    LOOK_SHADOW_BY_MESH = 64,
    LOOK_SMOOTH = 128,    // the material's smooth_parts are more than 1
    LOOK_SCATTERED = 256, // the look has the light among its hair
    // Instead of shading (with LOOK_PAINT alone): white, the tangent, the strand's own colour.
    LOOK_WHITE = 512,
    LOOK_TANGENT = 1024,
    LOOK_STRAND = 1536,
} LookFeature;

enum { LOOK_SHADED = 512, LOOK_VARIANTS = 4 * LOOK_SHADED };

typedef struct Look {
    MaterialParams material;               // complete but for the batch's size
    unsigned features;                     // LookFeature bits
    int light_count;                       // of the scene
    int map_count;                         // lights that have a shadow map
    unsigned scatter;                      // LOOK_MARSCHNER: the 3D texture of scatter_tables.h ...
    FibreTable table;                      // ... and its values
    float mean_color[3];                   // of the hair, linear RGB
    const struct ParticleLight *scattered; // [batches], of shaders: LOOK_SCATTERED
    uint32_t batches;
    float share; // of the strands is drawn, 0 .. 1; the material's radius makes up for it
} Look;

// Fills in what depends on the batch, as if it were drawn in one part: the look's share of its
// strands, the last of them narrower, so that the sum of their widths is the share exactly, and
// grows and falls with it without a step; and the parts of a segment, of which a strand has no more
// than CPU drivers' loops can visit.
MaterialParams look_material(const Look *look, const HairBatch *batch);

// Points of each of the batch's strands: its particles, or those of its curve.
uint32_t look_points(const Look *look, const HairBatch *batch);
