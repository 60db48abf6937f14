// SPDX-License-Identifier: MIT
// A ribbon's fragment: computes its coverage and stores a node in the A-buffer. Fragments behind
// the mesh are not stored.
//   NEAREST 1: a ribbon hides everything behind it
#include "draw/draw.h"
#include "draw/coverage.glsl"
#include "draw/abuffer.glsl"
#include "kernel/ribbon.h"

layout(early_fragment_tests) in;
layout(std430, binding = BIND_NODES_OUT) writeonly buffer Nodes { uvec4 nodes[]; };
layout(std430, binding = BIND_HEADS_OUT) buffer Heads { uint heads[]; };
layout(std430, binding = BIND_COUNTERS_OUT) buffer Counters { uint counters[]; };

noperspective in float across;
noperspective in float half_width;
noperspective in vec2 ends;
noperspective in vec4 color;
noperspective in float inverse_w;

void main()
{
    // As if the pixel lay along the strand: its share beyond the root minus its share beyond the
    // tip.
    vec2 beyond = clamp(ends + 0.5, 0.0, 1.0);
    float share = max(beyond.x + beyond.y - 1.0, 0.0);
    float coverage = share * ribbon_coverage(across, half_width, vec2(dFdx(across), dFdy(across)));
#if NEAREST
    float alpha = coverage >= RIBBON_LEAST_COVERAGE && color.a >= RIBBON_LEAST_OPACITY ? 1.0 : 0.0;
#else
    float alpha = color.a * coverage;
#endif
    if (!(alpha >= RIBBON_LEAST_OPACITY)) return; // NaN returns, too
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec4 band = draw_params.band; // a local copy: each use of a uniform costs a load
    uint shards = draw_params.shards;
    uint shard = uint((pixel.x >> 3) + (pixel.y & 56)) & (shards - 1u);
    // The counter goes on past the end of the pool, so that the host learns the size it needs.
    uint slot = atomicAdd(counters[shard * SHARD_RUN], 1u);
    if (slot >= band.w) return;
    uint index = (slot / SHARD_RUN * shards + shard) * SHARD_RUN + slot % SHARD_RUN;
    int at = (pixel.y - int(band.y)) * int(band.x) + pixel.x;
    uint next = atomicExchange(heads[at], index + 1u);
    nodes[index] = uvec4(next, abuffer_pack(inverse_w, color.rgb, alpha));
}
