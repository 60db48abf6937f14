// SPDX-License-Identifier: MIT
// For each tile of the picture, the depth behind which hair is hidden: 1/w of the farthest opaque
// surface in the tile, 0 if the background shows.
#include "draw/draw.h"
#include "kernel/edge.h"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(location = 0) uniform ivec2 tiles; // columns, rows
layout(binding = BIND_MESH_DEPTH) uniform sampler2D mesh_depth;
layout(std430, binding = BIND_HIDING_OUT) writeonly buffer Hiding { float hiding[]; };

void main()
{
    int tile = lane_index(), columns = tiles.x;
    if (tile >= columns * tiles.y) return;
    ivec2 corner = HIDE_TILE * ivec2(tile % columns, tile / columns);
    ivec2 edge = ivec2(draw_params.width, draw_params.height) - 1;
    float farthest = 0.0;
    for (int y = 0; y < HIDE_TILE; ++y)
        for (int x = 0; x < HIDE_TILE; ++x)
            farthest = max(farthest, texelFetch(mesh_depth, min(corner + ivec2(x, y), edge), 0).x);
    hiding[tile] = edge_inverse_w(farthest, draw_params.depth.x, draw_params.depth.y);
}
