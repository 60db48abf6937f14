// SPDX-License-Identifier: MIT
// Draws strands into the sums of shadow maps, as points along their segments and, where these are
// wide, across them (glsl/draw/shadow_splat.comp). One pass over the hair fills several maps.
#pragma once

#include "lanes/shadow_map.h"

typedef struct ShadowSplat {
    ShadowMap *shadow;
    const CastParams *params; // [maps]; if not deep or coarse: of a map of first depths
    int maps;                 // no more than shadow->at_once
    MappedCasters casters;
    const float *depths; // [map][side][side]: starts of layers; NULL: first depths are drawn
    bool coarse;         // first depths of a coarse map
} ShadowSplat;

// Clears first depths or sums and draws them, each thread its own.
void shadow_splat_draw(ShadowSplat *splat);
