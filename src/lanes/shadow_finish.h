// SPDX-License-Identifier: MIT
// From what threads have drawn (shadow_splat.h) to maps that are read.
#pragma once

#include "lanes/shadow_map.h"

// Where layers begin: depths[side][side] of map `map`, a smooth bound of its first depths (as
// glsl/draw/shadow_spread.comp finds it).
void shadow_finish_spread(ShadowMap *shadow, int map, float *depths);

// The layers of map `map`, by its sums; `unit`: their steps for a fibre.
void shadow_finish_layers(ShadowMap *shadow, int map, float unit, uint32_t *layers);

// First depths of map `map`, not deep.
void shadow_finish_firsts(ShadowMap *shadow, int map, float *depths);
