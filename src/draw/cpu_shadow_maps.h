// SPDX-License-Identifier: MIT
// From the points of hair that threads have laid down in maps of their own (cpu_shadow.c) to one
// map.
#pragma once

#include "draw/cpu_shadow.h"

// Lines of each thread's part of CpuShadow.rows: three rows of all layers, and two more.
enum { CPU_SHADOW_LINES = 3 * SHADOW_LAYERS + 2 };

// The least of all threads' first depths, in those of the first.
void cpu_shadow_merge_firsts(CpuShadow *shadow);

// Deep: merged first depths to `depths`, as shadow_spread.comp.
void cpu_shadow_spread(CpuShadow *shadow);

// Deep: all threads' sums, in steps of 1 / unit, to layers[SHADOW_LAYERS][side][side], as
// shadow_finish.comp: smoothed, and packed as shadow_layer.glsl packs them.
void cpu_shadow_finish(CpuShadow *shadow, float unit, uint32_t *layers);
