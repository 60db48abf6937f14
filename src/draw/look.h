// SPDX-License-Identifier: MIT
// How a section's hair looks. Needs no OpenGL.
#pragma once

#include "draw/fibre_lobes.h"

#include "glsl/draw/material.h"

#include <stdint.h>

typedef struct HairBatch HairBatch; // sim/hair.h

// The features that a shader needs for a look. Each set of features is a variant of the shaders.
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
    LOOK_WIDE = 512,      // lights that have a radius
    // Instead of shading (with LOOK_PAINT alone): white, the tangent, the strand's own colour.
    LOOK_WHITE = 1024,
    LOOK_TANGENT = 2048,
    LOOK_STRAND = 3072,
} LookFeature;

enum { LOOK_SHADED = 1024, LOOK_VARIANTS = 4 * LOOK_SHADED };

typedef struct Look {
    MaterialParams material; // complete except for the members that depend on the batch
    unsigned features;       // LookFeature bits
    int light_count;         // of the scene
    int map_count;           // lights that have a shadow map
    unsigned scatter;        // LOOK_MARSCHNER: the 3D texture of scatter_tables.h
    FibreTable table;        // the values of that texture
    float mean_color[3];     // of the hair, linear RGB
    const struct ParticleLight *scattered; // [batches], for shaders: LOOK_SCATTERED
    uint32_t batches;
    float share; // share of the strands that is drawn, 0 .. 1; the material's radius compensates
                 // for it
} Look;

// The look's material with the members that depend on the batch, as if the batch were drawn in one
// part. They are: the number of drawn strands, by the look's share; the width of the last one, so
// that the sum of widths equals the share and changes with it without steps; and the parts of a
// segment, limited by the loops of CPU drivers.
MaterialParams look_material(const Look *look, const HairBatch *batch);

// Points of each strand of the batch: its particles or the points of its curve.
uint32_t look_points(const Look *look, const HairBatch *batch);
