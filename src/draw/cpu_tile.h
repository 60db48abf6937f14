// SPDX-License-Identifier: MIT
// Tiles of strands that stand in the light, one strand in each lane, for cpu_shadow*.c alone.
#pragma once

#include "base/simd.h"
#include "draw/cpu_shadow.h"

#include <string.h>

enum { W = STRAND_TILE, LAYERS = SHADOW_LAYERS };

// Where the particles of a tile lie before the light, and their radii (m).
typedef struct Places {
    float u[W], v[W], z[W], w[W], radius[W];
} Places;

// One tile of one caster.
typedef struct Tile {
    const CpuCaster *caster;
    size_t at;   // of its first particle
    int strands; // that are drawn
    float radius[W], opacity[W];
} Tile;

// The radius that the paint of a particle has, as a share of the material's.
SIMD_INLINE float share_of(const CpuCaster *caster, size_t at)
{
    float share;
    memcpy(&share, &caster->paint[at][2], sizeof share);
    return share;
}

// Particle j of the tile's strands. What lies beside a lamp or behind it goes far away.
SIMD_INLINE void find_places(const CastParams *params, const Tile *tile, int j, Places *places)
{
    const float(*rows)[4] = (const float(*)[4])params->from_world;
    const CpuCaster *caster = tile->caster;
    const MaterialParams *material = &caster->material;
    size_t at = tile->at + (size_t)j * W;
    const float(*x)[4] = caster->position + at;
    float thinning = (1 - material->tip_ratio) / (float)(material->vertex_count - 1),
          share = 1 - thinning * (float)j;
    for (int k = 0; k < W; ++k) {
        float p = x[k][0], q = x[k][1], r = x[k][2], one = x[k][3];
        float w = rows[3][0] * p + rows[3][1] * q + rows[3][2] * r + rows[3][3] * one,
              inverse = 1 / simd_max(w, 1e-6f);
        float u = rows[0][0] * p + rows[0][1] * q + rows[0][2] * r + rows[0][3] * one,
              v = rows[1][0] * p + rows[1][1] * q + rows[1][2] * r + rows[1][3] * one;
        places->u[k] = w > 0 ? u * inverse : -1e6f;
        places->v[k] = w > 0 ? v * inverse : -1e6f;
        places->z[k] = rows[2][0] * p + rows[2][1] * q + rows[2][2] * r + rows[2][3] * one;
        places->w[k] = simd_max(w, 1e-6f);
    }
    for (int k = 0; k < W; ++k) places->radius[k] = simd_max(tile->radius[k] * share, 1e-9f);
    for (int k = 0; caster->paint && k < W; ++k)
        places->radius[k] = simd_max(tile->radius[k] * share_of(caster, at + (size_t)k), 1e-9f);
}

// Tile `number` of a caster.
static inline Tile open_tile(const CpuCaster *caster, int number)
{
    const MaterialParams *material = &caster->material;
    int first = number * W, left = (int)material->drawn_strands - first;
    Tile tile = {.caster = caster,
                 .at = (size_t)first * material->vertex_count,
                 .strands = left < W ? left : W};
    for (int k = 0; k < W; ++k) {
        bool last = first + k == (int)material->last_strand;
        tile.radius[k] = material->radius * (last ? material->last_share : 1);
        uint32_t bits = caster->paint ? caster->paint[tile.at + (size_t)k][1] >> 16 : 0xffff;
        tile.opacity[k] = material->shadow_opacity * (float)bits / 65535;
    }
    return tile;
}

// The tiles of a caster, from range[0] to before range[1], that one of `parts` threads works on.
static inline void find_range(const CpuCaster *caster, int part, int parts, int range[2])
{
    int64_t tiles = ((int64_t)caster->material.drawn_strands + W - 1) / W;
    range[0] = (int)(tiles * part / parts);
    range[1] = (int)(tiles * (part + 1) / parts);
}
