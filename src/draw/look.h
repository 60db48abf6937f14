// SPDX-License-Identifier: MIT
// How a section's hair looks, and the shaders that project and shade such hair: one variant for
// each set of features, so that what a scene does not use costs nothing.
#pragma once

#include "draw/tint_table.h"
#include "gpu/shader.h"
#include "sim/hair.h"
#include "strands/paint.h"

#include "glsl/draw/material.h"

// What shade.glsl's macros are made of.
typedef enum LookFeature {
    LOOK_LIGHTS = 1, // lights that are not directional, or a sky that differs from the ground
    LOOK_MARSCHNER = 2,
    LOOK_GAUSS = 4, // of marschner, --lobes gauss
    LOOK_PAINT = 8, // colours and thickness by particle
    LOOK_SHADOW_APPROX = 16,
    LOOK_SHADOW_DOM = 32,
    LOOK_SHADOW_BY_MESH = 64,
    LOOK_SMOOTH = 128,       // the material's smooth_parts are more than 1
    LOOK_SHADOW_FOUND = 256, // the look has a ParticleLight of each batch
    LOOK_SCATTERED = 512,    // the look has the light among its hair
    LOOK_DUAL = 1024,        // of marschner, --scatter dual
    LOOK_TINTS = 2048,       // of marschner: the look has a table of its own
    LOOK_MESH_TEXELS = 4096, // of shadows by the mesh: its maps are in a buffer
    // Instead of shading (with LOOK_PAINT alone): white, the tangent, the strand's own colour.
    LOOK_WHITE = 8192,
    LOOK_TANGENT = 16384,
    LOOK_STRAND = 24576,
} LookFeature;

enum { LOOK_SHADED = 8192, LOOK_VARIANTS = 4 * LOOK_SHADED };

// What hair leaves of light at the points of a batch (look_points), laid out as its particles are.
typedef struct ParticleLight {
    const HairBatch *batch;
    // float a shadow map and point, 0..1; then, where it is asked for (ShadowOptions), of each as
    // many again: the mean number of fibres behind the point
    GpuBuffer left;
} ParticleLight;

typedef struct Look {
    MaterialParams material;        // complete but for the batch's size
    unsigned features;              // LookFeature bits
    int light_count;                // of the scene
    int map_count;                  // lights that have a shadow map
    GLuint scatter;                 // LOOK_MARSCHNER: the 3D texture of scatter_tables.h
    const TintTable *tints;         // LOOK_TINTS
    float mean_color[3];            // of the hair, linear RGB
    const ParticleLight *lights;    // [batches], LOOK_SHADOW_FOUND
    const ParticleLight *scattered; // [batches], LOOK_SCATTERED: linear RGB, see hair_scatter.h
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

// The variants of one compute shader, for so many lights and shadow maps; a zeroed struct with a
// file and a group size has none yet.
typedef struct LookPrograms {
    const char *file;
    int group_size, light_count, map_count;
    GLuint program[LOOK_VARIANTS];
} LookPrograms;

// Makes the variant for the look and what the batch has the current program, compiled at first use,
// with the textures of both. RESULT_FAILED with the compiler's words.
Result look_programs_use(LookPrograms *programs, const Look *look, const HairBatch *batch,
                         Error *error);

// Says for how many lights and shadow maps variants are; those for others are forgotten.
void look_programs_count(LookPrograms *programs, int light_count, int map_count);

// LIGHT_COUNT of a shader for so many lights, as shadow.glsl has it: 0 if there are too many to
// unroll loops over them.
int look_unrolled(int light_count);

// Compiles the variant of these features if it is not there.
Result look_programs_build(LookPrograms *programs, unsigned features, Error *error);
void look_programs_destroy(LookPrograms *programs);

// Gives every batch the paint of its strands, which `paint` has for all of the file's. Nothing for
// a paint that is zeroed. RESULT_FAILED if memory is short.
Result look_paint(Hair *hair, const Strands *strands, const Paint *paint, const GpuLimits *limits,
                  Error *error);
