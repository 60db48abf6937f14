// SPDX-License-Identifier: MIT
// The options and the scene of the light among hair, for both of its implementations.
#pragma once

#include "draw/backend.h"
#include "draw/light_scene.h"

#include "glsl/draw/shadow.h"

// The options of light among hair, from those of the renderer.
ScatterOptions scatter_options(const RendererOptions *options);

// Whether a look of the frame shows light among hair.
bool scatter_is_wanted(const ScatterOptions *options, const BackendFrame *frame);

// Whether lights and sky are the same.
bool scatter_same_lights(const DrawParams *a, const DrawParams *b);

// The group size: one strand of each group of this many is used in the cells and represents them
// all.
uint32_t scatter_step(const ScatterOptions *options, const BackendFrame *frame);

// The scene of a frame with these shadow maps. The caller fills in hair, kinds and mesh.
GridScene scatter_scene(const ScatterOptions *options, const BackendFrame *frame,
                        const ShadowParams *shadows);

// The mesh, placed by the head's motion in this frame.
LightMesh scatter_mesh(const BackendFrame *frame);
