// SPDX-License-Identifier: MIT
// Checks whether strands are calm (sleep.h): each particle must be within `leave` of its anchor,
// and no farther from it than before by more than `grow`. A strand that is not calm starts
// counting again; if it has left its anchors, with new anchors. One strand a lane.
#include "sim/sleep_params.h"
#include "common/hair_address.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(binding = BIND_POSITION) uniform samplerBuffer position;
layout(binding = BIND_REST) uniform samplerBuffer rest;
layout(std430, binding = BIND_ANCHORS_OUT) buffer Anchors { vec4 anchors[]; };
layout(std430, binding = BIND_CALM_OUT) buffer Calm { uint calm[]; };

void main()
{
    int s = lane_index(), n = int(sleep_params.vertex_count);
    if (s >= int(sleep_params.strand_count)) return;
    int first = particle_address(s, 0, n);
    float strand_length = texelFetch(rest, first).w;
    float leave = sleep_params.leave * strand_length, grow = sleep_params.grow * strand_length;
    float farthest = 0.0, growth = 0.0;
    for (int j = 0; j < n; ++j) {
        int a = first + j * STRAND_TILE;
        vec4 anchor = anchors[a];
        float way = distance(texelFetch(position, a).xyz, anchor.xyz);
        farthest = max(farthest, way);
        growth = max(growth, way - anchor.w);
    }
    bool was_ready = (calm[s] & SLEEP_READY) != 0u;
    bool keeps_anchor = sleep_params.anchor == SLEEP_ANCHOR_LEFT ||
                        (sleep_params.anchor == SLEEP_ANCHOR_UNREADY && was_ready);
    // Written so that a NaN position is never calm.
    bool stays = farthest <= leave && keeps_anchor, is_calm = stays && growth <= grow;
    float reach = 0.0;
    for (int j = 0; j < n; ++j) {
        int a = first + j * STRAND_TILE;
        vec4 anchor = anchors[a];
        vec3 x = texelFetch(position, a).xyz;
        float way = distance(x, anchor.xyz);
        anchor.w = way - anchor.w > grow ? way : anchor.w;
        anchors[a] = stays ? anchor : vec4(x, 0.0);
        reach = max(reach, anchor.w);
    }
    uint checks = is_calm ? (calm[s] & ~SLEEP_READY) + 1u : 0u;
    bool ready =
        stays && was_ready ||
        float(checks) >= sleep_params.checks + sleep_params.checks_reach * reach / strand_length;
    calm[s] = ready ? checks | SLEEP_READY : checks;
}
