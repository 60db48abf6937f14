// SPDX-License-Identifier: MIT
// Parameters of drawing one picture: camera, lights, the band of rows that is being drawn. Pixels
// count from the picture's top left corner; the first row of targets is the picture's top row.
#include "common/shared.h"
#ifdef __STDC__
#pragma once
#endif

#define MAX_LIGHTS   8
#define AROUND_TERMS 7 // of an environment, beside its sky and ground

// Uniform blocks: BIND_DRAW, and BIND_MATERIAL (material.h).
// Shader storage. shared.h has the bindings of other passes; no pass uses more than eight.
#define BIND_COUNTERS_OUT 0 // uint a shard, 16 apart
#define BIND_INDICES_OUT  1 // uint, triangles
#define BIND_COMMAND_OUT  2 // COMMAND_WORDS uint
#define BIND_EDGES_OUT    3 // uvec4 a particle, see hair.vert
#define BIND_SHADES_OUT   4 // uvec4 a particle
#define BIND_EXTENT_OUT   5 // 4 int: screen box of the hair, px
#define BIND_NODES_OUT    6 // uvec4 a fragment, see abuffer.glsl
#define BIND_HEADS_OUT    7 // uint a pixel
#define BIND_SHORTAGE_OUT 0 // uint, while pixels are resolved

// Textures, after those of shared.h.
#define BIND_EDGES  4
#define BIND_SHADES 5
#define BIND_EXTENT 6
#define BIND_NODES  7
#define BIND_HEADS  8
#define BIND_BASE   9 // the image behind the hair: linear, premultiplied
// Rims of that image's pixels, see base.frag. Ribbons bind their tables (BIND_SCATTER) again.
#define BIND_RIM       10
#define BIND_RIM_DEPTH 14

// Used while the base is drawn, before the bindings above, except those for shadows.
#define BIND_SURFACE      4 // see surface.frag
#define BIND_LIT          5 // that surface's light
#define BIND_MIDDLE_DEPTH 6 // depth of the mesh at pixel centres
#define BIND_EDGE_DEPTH   7 // depths of the mesh at several samples a pixel
#define BIND_BACKDROP     4 // vec4 a pixel: the environment as background; no surface is bound then
#define BIND_TINT         8 // factors of the mesh's colour
#define BIND_ONTO         9 // six vec4 a cell: the light of hair on skin, see kernel/onto.h

#define BIND_PAINT     8  // uvec4 a particle, see look_paint; used together with shadows
#define BIND_SCATTER   10 // the table for Marschner shading, see scatter.comp
#define BIND_SCATTERED 15 // vec3 a point: the light among hair, see hair_scatter.h

// The nodes of this table: azimuth (0 to pi), cosine of theta_d, and colour (both 0 to 1).
#define SCATTER_AZIMUTHS     128
#define SCATTER_INCLINATIONS 64
#define SCATTER_COLORS       24

// The same binding points in the compute rasteriser while strands are projected. It never runs
// together with the A-buffer.
#define BIND_BLOCK_COUNTS_OUT 0 // uint, 16 for each of 64 groups: ribbons, strands without any
#define BIND_RIBBONS_OUT      1 // RIBBON_TEXELS uvec4 a ribbon, see block.glsl
#define BIND_HIDING_OUT       1 // float a tile, see block_hide.comp
#define BIND_LEVELS_OUT       2 // float a tile and level, see block_level.comp
#define BIND_TALLY_OUT        2 // two uint: numbers of listed and of hidden strands of the image
#define BIND_LISTED_OUT       3 // uint: number of listed strands of a part, then their rows
#define BIND_KEYS_OUT         4 // uint a ribbon: its depth's bits; 0: none
#define BIND_LISTED           7 // while strands are projected
#define BIND_MESH_DEPTH       8
#define BIND_HIDING           9 // float a tile and level, see block_cull.comp

#define HIDE_TILE   8 // px: tiles for finding hidden hair
#define HIDE_LEVELS 6 // levels; tiles are twice as wide on each next level

#define RIBBON_TEXELS     4
#define BLOCK_WIDTH       64 // px: a block, which is composited at once
#define BLOCK_HEIGHT      64
#define BLOCK_COUNT_WORDS (64 * 16)

// The same binding points while the compute rasteriser composites these ribbons by tiles.
#define BIND_TILE_COUNTS_OUT 0 // uint a tile: its ribbons
#define BIND_TILE_ENDS_OUT   1 // uint a tile: where its list continues; finally its end
#define BIND_TILE_USE_OUT    2 // TILE_USE_WORDS uint
#define BIND_PAIRS_OUT       3 // uvec2 a ribbon in a tile: ~depth, slot
#define BIND_TILES_OUT       4 // uint: the tiles with ribbons
#define BIND_RIBBONS         4 // RIBBON_TEXELS uvec4 a slot
#define BIND_KEYS            5 // uint a slot, as KEYS_OUT
#define BIND_SORTED          6
#define IMAGE_PAIRS          0 // image units
#define IMAGE_SORTED         1 // as PAIRS_OUT, each list in order
#define IMAGE_PICTURE        2

#define TILE_SIDE        16 // px; a work group composites one
#define TILE_CELL_WIDTH  8  // px: a cell; ribbons that miss it are skipped
#define TILE_CELL_HEIGHT 4

// Words of TILE_USE_OUT.
#define TILE_USE_PAIRS   0 // pairs of all tiles, modulo 2^32
#define TILE_USE_LONGEST 1 // most pairs of a tile
#define TILE_USE_COARSE  2 // sum of each tile's pairs / 1024
#define TILE_USE_TILES   3 // tiles with ribbons
#define TILE_USE_GROUPS  4 // 3 words: work groups for these tiles, for glDispatchComputeIndirect
#define TILE_USE_WORDS   7

#define TILE_ROW 64 // work groups in a row; less than a row of spare groups is run

// The A-buffer's pool is split into shards, each with its own counter, so that pixels of different
// 8x8 blocks rarely wait for each other's atomics. A small picture full of hair would fill only few
// shards, so it uses one.
#define SHARD_COUNT 64
#define SHARD_RUN   16 // consecutive nodes of one shard

// Words of the counters' buffer: a counter for each shard, SHARD_RUN apart, then these.
#define COUNTER_SEGMENTS (SHARD_COUNT * SHARD_RUN) // segments that are rasterised
#define COUNTER_CULLED   (COUNTER_SEGMENTS + 1)    // strands outside the picture
#define COUNTER_WORDS    (COUNTER_SEGMENTS + 2)

// Words of the command buffer, as glDrawElementsIndirect reads it.
#define COMMAND_INDEX_COUNT    0
#define COMMAND_INSTANCE_COUNT 1
#define COMMAND_WORDS          5

UNIFORM_BLOCK(DrawParams, draw_params, BIND_DRAW)
{
    mat4 clip_from_world;         // clip-space y points down
    vec4 eye;                     // xyz, m
    vec4 light_place[MAX_LIGHTS]; // xyz: unit vector towards the light, with w = 0; or the place of
                                  // a lamp, m, with w = 1
    vec4 light_color[MAX_LIGHTS]; // linear RGB times intensity; w: variance of its directions along
                                  // one axis, rad^2: 0 of a light without a radius
    vec4 light_axis[MAX_LIGHTS];  // xyz: unit, direction of a spot; w: reference distance squared,
                                  // m2
    vec4 light_cone[MAX_LIGHTS];  // x - y cos(angle to the axis): a spot's light before clamping to
                                  // 0..1
    vec4 sky, ground;             // linear RGB of the ambient light from above, from below
    vec4 around[AROUND_TERMS]; // linear RGB: see lamp_bent; w of the first: 1 with an environment,
                               // of the next three: the environment's first axis
    vec4 background;           // light behind everything: linear RGB, premultiplied; opacity
    vec4 backing;              // colour under the tone-mapped picture: linear RGB; 1, or 0: none
    vec4 head_rotation;        // quaternion x y z w
    vec4 head_translation;
    vec4 mesh_color;     // linear RGB; w: ambient share
    float width, height; // of the picture, px
    float focal;         // px of one metre at a distance of one metre
    float near_distance; // m
    vec4 axis;           // xy, px: where the optical axis meets the picture
    vec4 depth;          // clip-space z = x * w + y
    vec4 depth_range;    // --aov depth: x, y: m shown as 1 and as 0; equal: shows m
    uvec4 band;          // picture's width, first row, end row, nodes of a shard
    int light_count;
    uint seed;
    uint shards; // shards in use: a power of two, at most SHARD_COUNT
}
END_BLOCK(DrawParams, draw_params);
