// SPDX-License-Identifier: MIT
// Hair and mesh in front of a light, for tests of the light that reaches a point.
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

// Two lights that cast shadows: from straight above, and a lamp at (0.3, 2, 0.1) m.
extern const Light LIGHT_ABOVE, LIGHT_LAMP;

// Hair and mesh, the shadow maps, and the reference for the light that reaches a point.
typedef struct ShadowStage {
    Strands strands;
    Hair hair;
    SectionParams material;
    ReferenceItem item;
    ReferenceScene reference_scene;
    ShadowReference reference;
    Look looks[8]; // looks of the casters
    ShadowCaster casters[8];
    ShadowScene scene;
    RenderMesh mesh;
    const Mesh *source; // the mesh's source, or NULL
    ShadowWay way;      // used by the last shadow_stage_draw; maps of the other way are empty
    Shadows shadow;
    LaneShadow lanes;
    void *position[8], *paint[8]; // copies of the casters' data for lanes
    bool on_fibre;                // points are on the axis of fibres
    Light light;
} ShadowStage;

// Takes ownership of the strands. All have `radius` (m) and `opacity`; `mesh` may be NULL. Draws no
// maps yet.
void shadow_stage_open(ShadowStage *stage, Strands strands, float radius, float opacity,
                       const Mesh *mesh, const Light *light);
void shadow_stage_close(ShadowStage *stage);

// Draws maps of side x side texels; `spacing`: see ShadowOptions.
void shadow_stage_draw(ShadowStage *stage, Shadow kind, int side, float spacing, ShadowWay way);

// Draws maps again if the scene has changed. Returns how many were drawn.
uint32_t shadow_stage_again(ShadowStage *stage);
const ShadowParams *shadow_stage_params(const ShadowStage *stage);

// shadow_stage_forget_mesh: the mesh changes. shadow_stage_wipe_mesh: its maps are lost without the
// renderer's knowledge.
void shadow_stage_forget_mesh(ShadowStage *stage);
void shadow_stage_wipe_mesh(ShadowStage *stage);

// The light at `count` points according to the maps. The caller frees the result.
float *shadow_stage_light(ShadowStage *stage, const float (*points)[4], uint32_t count);

// The exact share of the light that reaches a point (m), by the reference.
double shadow_stage_exact(const ShadowStage *stage, double x, double y, double z);

// `layers` straight strands, 1 m long and 2 * radius wide, at y = 0, -0.1, -0.2 ...
Strands shadow_stage_layers(uint32_t layers);

// A horizontal mesh at y, from -half to half along both axes.
Mesh shadow_stage_square(float y, float half);

// Fails the test unless |got - expected| <= tolerance.
void shadow_assert_near(double got, double expected, double tolerance);
