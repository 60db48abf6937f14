// SPDX-License-Identifier: MIT
// The bounding box of all particles of hair in the light's view: (u, v, depth). Curves can leave it
// slightly; the map's margins have room for that.
#include "draw/shadow.h"
#include "draw/material.h"
#include "common/hair_address.glsl"
#include "draw/shadow_cast.glsl"
#include "draw/bounds.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(binding = BIND_POSITION) uniform samplerBuffer position;
layout(std430, binding = BIND_BOUNDS_OUT) buffer Bounds { int bounds[]; }; // six for each map

void main()
{
    int s = lane_index(), n = int(material.vertex_count);
    if (s >= int(material.drawn_strands)) return;
    int begin = int(gl_WorkGroupID.z) * PART_VERTICES, end = min(begin + PART_VERTICES, n);
    float reach = cast_params.reach;
    vec3 low = vec3(1e30), high = vec3(-1e30);
    for (int j = begin; j < end; ++j) {
        vec3 x = texelFetch(position, particle_address(s, j, n)).xyz;
        bool sound = all(lessThan(abs(x), vec3(limit)));
        vec3 place = shadow_place(x).xyz;
        sound = sound && all(lessThan(abs(place.xy), vec2(reach)));
        low = sound ? min(low, place) : low;
        high = sound ? max(high, place) : high;
    }
    if (high.x < low.x) return;
    int first = 6 * cast_params.map;
    for (int k = 0; k < 3; ++k) {
        atomicMin(bounds[first + k], ordered(low[k]));
        atomicMax(bounds[first + 3 + k], ordered(high[k]));
    }
}
