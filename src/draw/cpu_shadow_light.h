// SPDX-License-Identifier: MIT
// The light that hair leaves at its own particles, by maps of cpu_shadow.h.
#pragma once

#include "draw/cpu_shadow.h"

// What of the light the last deep map, whose `layers` these are, leaves of it where the particles
// of one caster lie: light_through_hair of shadow.glsl. left[particle], as its positions lie; those
// of strands that are not drawn may be left out. `across`: ShadowParams.place[map].w.
void cpu_shadow_find_light(CpuShadow *shadow, const CastParams *params, const CpuCaster *caster,
                           float across, const uint32_t *layers, float *left);
