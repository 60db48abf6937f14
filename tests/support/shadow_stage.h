// SPDX-License-Identifier: MIT
// Hair and mesh before a light, for tests of the light that reaches a point.
#pragma once

#include "lanes/shadow.h"
#include "passes/shadows.h"
#include "reference/shadow_reference.h"
#include "support/hair_fixture.h"
#include "support/needed.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

typedef enum ShadowWay { SHADOW_BY_SHADERS, SHADOW_BY_LANES } ShadowWay;

// Both cast shadows: light from straight above, and a lamp at (0.3, 2, 0.1) m.
extern const Light LIGHT_ABOVE, LIGHT_LAMP;

// Hair and mesh with both judgements of the light that reaches a point.
typedef struct ShadowStage {
    Strands strands;
    Hair hair;
    SectionParams material;
    ReferenceItem item;
    ReferenceScene reference_scene;
    ShadowReference reference;
    Look looks[8]; // of the casters
    ShadowCaster casters[8];
    ShadowScene scene;
    RenderMesh mesh;
    const Mesh *source; // the mesh's, or NULL
    ShadowWay way;      // of the last shadow_stage_draw; the others' maps are empty
    Shadows shadow;
    LaneShadow lanes;
    void *position[8], *paint[8]; // of the casters, copies for lanes
    bool on_fibre;                // points that are asked for lie in the middle of fibres
    Light light;
} ShadowStage;

// Takes the strands over; `radius` (m) and `opacity` of them all, `mesh` may be NULL. No maps are
// drawn yet.
void shadow_stage_open(ShadowStage *stage, Strands strands, float radius, float opacity,
                       const Mesh *mesh, const Light *light);
void shadow_stage_close(ShadowStage *stage);

// Makes maps of side x side texels anew; `spacing`: see ShadowOptions.
void shadow_stage_draw(ShadowStage *stage, Shadow kind, int side, float spacing, ShadowWay way);

// Makes them again where the scene has changed; returns how many were made.
uint32_t shadow_stage_again(ShadowStage *stage);
const ShadowParams *shadow_stage_params(const ShadowStage *stage);

// The mesh is another one; its maps are lost, but the renderer doesn't know.
void shadow_stage_forget_mesh(ShadowStage *stage);
void shadow_stage_wipe_mesh(ShadowStage *stage);

// What the maps say of `count` points; the caller frees it.
float *shadow_stage_light(ShadowStage *stage, const float (*points)[4], uint32_t count);

// What of the light reaches a point (m) exactly, by the reference.
double shadow_stage_exact(const ShadowStage *stage, double x, double y, double z);

// `layers` straight strands, 1 m long and 2 * radius wide, at y = 0, -0.1, -0.2 ...
Strands shadow_stage_layers(uint32_t layers);

// A level mesh at y, from -half to half both ways.
Mesh shadow_stage_square(float y, float half);

// Fails the test unless |got - expected| <= tolerance.
void shadow_assert_near(double got, double expected, double tolerance);
