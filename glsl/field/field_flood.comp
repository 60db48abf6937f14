// SPDX-License-Identifier: MIT
// A pass of jump flooding (Rong, Tan: Jump Flooding in GPU with Applications to Voronoi Diagram and
// Distance Transform, I3D 2006): each grid point takes over the closest surface point of the 26
// points around it, `stride` away, if that is nearer.
#include "field/field.glsl"

layout(binding = BIND_REST) uniform samplerBuffer closest_before;
layout(std430, binding = 1) writeonly buffer Closest { vec4 closest[]; };

void main()
{
    ivec3 at = grid_point(), size = grid_size();
    if (at.x >= size.x) return;
    int stride = int(field_params.stride);
    vec3 p = field_params.low.w * vec3(at);
    vec4 best = vec4(0.0);
    float square = 1e30;
    for (int k = 0; k < 27; ++k) {
        ivec3 other = at + stride * (ivec3(k % 3, k / 3 % 3, k / 9) - 1);
        bool inside = all(greaterThanEqual(other, ivec3(0))) && all(lessThan(other, size));
        vec4 candidate = texelFetch(closest_before, grid_address(inside ? other : at));
        vec3 to = candidate.xyz - p;
        float d = candidate.w > 0.0 ? dot(to, to) : 1e30;
        best = d < square ? candidate : best;
        square = min(d, square);
    }
    closest[grid_address(at)] = best;
}
