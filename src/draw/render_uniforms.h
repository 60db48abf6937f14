// SPDX-License-Identifier: MIT
// Fills the uniform blocks of the drawing shaders.
#pragma once

#include "base/params.h"
#include "scene/camera.h"
#include "scene/scene.h"

#include "glsl/draw/draw.h"
#include "glsl/draw/material.h"

// sRGB 0..1 to linear.
void linear_from_srgb_color(const float srgb[3], float linear[3]);

// Camera and lights for a picture of this size; the rest is left 0.
void draw_params_set_view(DrawParams *draw, const View *view, int width, int height);
void draw_params_set_lights(DrawParams *draw, const Light *lights, uint32_t count);

// `radius`: fibre radius at the root, m. The batch's size is left 0.
MaterialParams material_params(const SectionParams *params, float radius);
