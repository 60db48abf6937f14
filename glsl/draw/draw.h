// SPDX-License-Identifier: MIT
// Parameters of drawing one picture: camera, lights, the band of rows that is being drawn. Pixels
// count from the picture's top left corner; the first row of targets is the picture's top row.
#include "common/shared.h"
#ifdef __STDC__
#pragma once
#endif

#define MAX_LIGHTS 8

// Uniform blocks: BIND_DRAW, and BIND_MATERIAL (material.h).
// Shader storage. Those of shared.h are other passes'; there are no more than eight.
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
#define BIND_BASE   9 // what stands behind the hair: linear, premultiplied

// While the base is drawn, before all of these but what shadows are read from.
#define BIND_SURFACE      4 // see surface.frag
#define BIND_LIT          5 // that surface's light
#define BIND_MIDDLE_DEPTH 6 // the mesh's
#define BIND_EDGE_DEPTH   7 // the same of some samples a pixel

#define BIND_PAINT     8  // uvec4 a particle, see look_paint; beside what shadows are read from
#define BIND_SCATTER   10 // marschner's table, see scatter.comp
#define BIND_SCATTERED 15 // vec3 a point of a strand: the light among hair, see hair_scatter.h

// Nodes of that table by azimuth (0 to pi), cosine of theta_d and colour (both 0 to 1).
#define SCATTER_AZIMUTHS     128
#define SCATTER_INCLINATIONS 64
#define SCATTER_COLORS       24

// The same points for the compute rasteriser, which is never at work with the A-buffer, while
// strands are projected.
#define BIND_BLOCK_COUNTS_OUT 0 // uint, 16 for each of 64 groups: ribbons, strands without any
#define BIND_RIBBONS_OUT      1 // RIBBON_TEXELS uvec4 a ribbon, see block.glsl
#define BIND_HIDING_OUT       1 // float a tile, see block_hide.comp
#define BIND_LEVELS_OUT       2 // float a tile and level, see block_level.comp
#define BIND_TALLY_OUT        2 // two uint: strands of the image that are listed, that are hidden
#define BIND_LISTED_OUT       3 // uint: how many strands of a part are listed, then rows
#define BIND_KEYS_OUT         4 // uint a ribbon: its depth's bits; 0: none
#define BIND_LISTED           7 // while strands are projected
#define BIND_MESH_DEPTH       8
#define BIND_HIDING           9 // float a tile and level, see block_cull.comp

#define HIDE_TILE   8 // px of the tiles by which hair is found to be hidden
#define HIDE_LEVELS 6 // each of tiles twice as wide

#define RIBBON_TEXELS     4
#define BLOCK_WIDTH       64 // px, of what is composited at once
#define BLOCK_HEIGHT      64
#define BLOCK_COUNT_WORDS (64 * 16)

// The same points while it composites those ribbons by tiles.
#define BIND_TILE_COUNTS_OUT 0 // uint a tile: its ribbons
#define BIND_TILE_ENDS_OUT   1 // uint a tile: where its list goes on, in the end behind its last pair
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
#define TILE_CELL_WIDTH  8  // px of the cells by which ribbons are left out that miss them
#define TILE_CELL_HEIGHT 4

// Words of TILE_USE_OUT.
#define TILE_USE_PAIRS   0 // of all tiles, modulo 2^32
#define TILE_USE_LONGEST 1 // pairs of a tile
#define TILE_USE_COARSE  2 // sum of each tile's pairs / 1024
#define TILE_USE_TILES   3 // with ribbons
#define TILE_USE_GROUPS  4 // 3 words: work groups for these, as glDispatchComputeIndirect reads them
#define TILE_USE_WORDS   7

#define TILE_ROW 64 // work groups side by side; less than a row too many run

// The A-buffer's pool is split into shards, each with a counter of its own: pixels of different
// 8x8 blocks then rarely wait for each other's atomics. A small picture full of hair would fill few
// of them: it uses one.
#define SHARD_COUNT 64
#define SHARD_RUN   16 // consecutive nodes of one shard

// Words of the counters' buffer: a counter for each shard, SHARD_RUN apart, then these.
#define COUNTER_SEGMENTS (SHARD_COUNT * SHARD_RUN) // sent to the rasteriser
#define COUNTER_CULLED   (COUNTER_SEGMENTS + 1)    // strands outside the picture
#define COUNTER_WORDS    (COUNTER_SEGMENTS + 2)

// Words of the command buffer, as glDrawElementsIndirect reads it.
#define COMMAND_INDEX_COUNT    0
#define COMMAND_INSTANCE_COUNT 1
#define COMMAND_WORDS          5

UNIFORM_BLOCK(DrawParams, draw_params, BIND_DRAW)
{
    mat4 clip_from_world;         // y down
    vec4 eye;                     // xyz, m
    vec4 light_place[MAX_LIGHTS]; // xyz: unit, towards the light, with w = 0; or where it is, m, w
                                  // = 1
    vec4 light_color[MAX_LIGHTS]; // linear RGB times intensity
    vec4 light_axis[MAX_LIGHTS];  // xyz: unit, the way that a spot looks; w: reference distance
                                  // squared, m2
    vec4 light_cone[MAX_LIGHTS];  // x - y cos(angle off the axis): a spot's light before it is cut
                                  // to 0..1
    vec4 sky, ground;             // linear RGB from above, from below
    vec4 background;              // linear RGB, premultiplied; opacity
    vec4 head_rotation;           // quaternion x y z w
    vec4 head_translation;
    vec4 mesh_color;     // linear RGB; w: ambient share
    float width, height; // of the picture, px
    float focal;         // px: size on the screen of one metre at a distance of one
    float near_distance; // m
    vec4 axis;           // xy: where the eye's axis meets the picture, px
    vec4 depth;          // clip z = x * w + y
    vec4 depth_range;    // --aov depth: x, y m that are shown as 1 and as 0; alike: m as they are
    uvec4 band;          // picture's width, first row, end row, pool's nodes in a shard
    int light_count;
    uint seed;
    uint shards; // in use: a power of two, at most SHARD_COUNT
}
END_BLOCK(DrawParams, draw_params);
