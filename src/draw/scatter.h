// SPDX-License-Identifier: MIT
// What light among hair depends on, and what of it is asked for: for both ways to find it.
#pragma once

#include "draw/backend.h"
#include "draw/light_scene.h"

#include "glsl/draw/shadow.h"

// What is asked for, whatever the frame.
ScatterOptions scatter_options(const RendererOptions *options);

// Whether a look of the frame shows light among hair.
bool scatter_is_wanted(const ScatterOptions *options, const BackendFrame *frame);

// Whether lights and sky are the same.
bool scatter_same_lights(const DrawParams *a, const DrawParams *b);

// Of how many strands one stands for all in the cells.
uint32_t scatter_step(const ScatterOptions *options, const BackendFrame *frame);

// Lights, eye and what is asked for, of a frame whose shadow maps these are; hair, kinds and mesh
// are the caller's.
GridScene scatter_scene(const ScatterOptions *options, const BackendFrame *frame,
                        const ShadowParams *shadows);

// The mesh, where the head has carried it.
LightMesh scatter_mesh(const BackendFrame *frame);
