// SPDX-License-Identifier: MIT
// The light that hair leaves at its own particles, by maps of shadow_map.h.
#pragma once

#include "lanes/shadow_map.h"

// What of the light the last deep map, whose `layers` these are, leaves of it where the particles
// of one caster lie: light_through_hair of shadow.glsl. left[particle], as its positions lie; those
// of strands that are not drawn may be left out. `across`: ShadowParams.place[map].w. `behind`: the
// same of the mean number of fibres that stand behind the particle; NULL: is not asked for.
void shadow_light_find(ShadowMap *shadow, const CastParams *params, const MappedCaster *caster,
                       float across, const uint32_t *layers, float *left, float *behind);
