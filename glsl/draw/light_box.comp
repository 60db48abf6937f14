// SPDX-License-Identifier: MIT
// The box of all particles in the axes of the light grid's lattice, and the square of the longest
// segment. Broken positions are left out of both.
#include "draw/light.h"
#include "draw/material.h"
#include "common/hair_address.glsl"
#include "draw/curve.glsl"
#include "draw/light.glsl"
#include "draw/bounds.glsl"

layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(std430, binding = BIND_LIGHT_BOX_OUT) buffer Box { int box[]; };

void main()
{
    uint lane = uint(lane_index());
    if (lane >= cell_strands(material.drawn_strands, light_params.step)) return;
    int s = int(cell_strand(lane, material.drawn_strands, light_params.step)),
        n = int(material.vertex_count);
    Curve curve = curve_open(particle_address(s, 0, n), n);
    int begin = int(gl_WorkGroupID.z) * PART_VERTICES, end = min(begin + PART_VERTICES, n);
    vec3 low = vec3(1e30), high = vec3(-1e30), before = vec3(1e30);
    float longest = 0.0;
    for (int j = max(begin - 1, 0); j < end; ++j) {
        vec3 x = to_lattice(particle(curve, j)), way = x - before;
        bool sound = all(lessThan(abs(x), vec3(1e6)));
        low = sound ? min(low, x) : low;
        high = sound ? max(high, x) : high;
        longest = sound && before.x < 1e30 ? max(longest, dot(way, way)) : longest;
        before = sound ? x : vec3(1e30);
    }
    if (high.x < low.x) return;
    for (int k = 0; k < 3; ++k) {
        atomicMin(box[k], ordered(low[k]));
        atomicMax(box[3 + k], ordered(high[k]));
    }
    atomicMax(box[6], ordered(longest));
}
