// SPDX-License-Identifier: MIT
// Turns the sums that threads have drawn (shadow_splat.h) into maps.
#pragma once

#include "lanes/shadow_map.h"

// Writes the depths at which layers begin: depths[side][side] of map `map`, a smooth lower bound of
// the first depths (as glsl/draw/shadow_spread.comp).
void shadow_finish_spread(ShadowMap *shadow, int map, float *depths);

// Writes the layers of map `map` from its sums; `unit`: steps of the sums for one fibre.
void shadow_finish_layers(ShadowMap *shadow, int map, float unit, uint32_t *layers);

// Writes the first depths of map `map`, for maps that are not deep.
void shadow_finish_firsts(ShadowMap *shadow, int map, float *depths);
