// SPDX-License-Identifier: MIT
// Inside or outside. The winding number of a closed mesh at a point is the number of crossings in,
// less those out, on any way to it from afar; that of a mesh with holes is the mean over all
// directions (Jacobson et al.: Robust Inside-Outside Segmentation using Generalized Winding
// Numbers, SIGGRAPH 2013). Here it is the mean over six: both ways along each axis. A point is
// inside where it is at least 1/2, so a hole misleads only points that are seen through holes from
// three of six sides. Its sign says how the mesh is oriented, and does not matter.
//
// With w the sum of crossings up to a point and W that of its whole column, the winding numbers
// from either end are w and w - W. Summed up over the axes, `winding` is six times the mean. After
// the last axis the distance gets its sign.
#include "field/field.glsl"

layout(std430, binding = 0) buffer Crossings { int crossings[]; };
layout(std430, binding = 1) buffer Winding { int winding[]; };
layout(binding = BIND_REST) uniform samplerBuffer closest;
layout(std430, binding = 2) writeonly buffer Distances { float distances[]; };

void main()
{
    int axis = int(field_params.axis), u = (axis + 1) % 3, v = (axis + 2) % 3;
    ivec3 size = grid_size(), at = ivec3(0);
    at[u] = int(gl_GlobalInvocationID.x);
    at[v] = int(gl_WorkGroupID.y);
    if (at[u] >= size[u]) return;
    int first = grid_address(at),
        step = axis == 0   ? 1
               : axis == 1 ? size.x
                           : size.x * size.y,
        all = 0, before = 0, n = size[axis];
    for (int k = 0; k < n; ++k) all += crossings[first + k * step];
    float spacing = field_params.low.w;
    for (int k = 0; k < n; ++k) {
        int address = first + k * step;
        before += crossings[address];
        crossings[address] = 0;
        int sum = winding[address] + 2 * before - all;
        winding[address] = sum;
        at[axis] = k;
        if (axis == 2)
            distances[address] = distance(texelFetch(closest, address).xyz, spacing * vec3(at)) *
                                 (abs(sum) >= 3 ? -1.0 : 1.0);
    }
}
