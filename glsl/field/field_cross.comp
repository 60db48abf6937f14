// SPDX-License-Identifier: MIT
// Finds where columns of grid points along an axis cross the surface: +1 at the first point behind
// a crossing into the mesh, -1 behind a crossing out of it. A work item is a triangle and a square
// of columns.
//
// The sides of its three edges decide whether a column passes through a triangle. Each edge is
// evaluated from its lexically first end, so both of its triangles get the same number, and a
// column exactly on the edge counts as being on its left. This is as if all columns were moved by
// (-e^2, e), e -> 0, so no column slips between triangles or counts twice.
#include "field/field.glsl"

// Triangle, axis, first column.
layout(std430, binding = 0) readonly buffer Items { uvec4 items[]; };
layout(std430, binding = 1) buffer Crossings { int crossings[]; };

// +1 if p is to the left of the line from a to b, otherwise -1.
int side(vec2 a, vec2 b, vec2 p)
{
    bool turned = a.x > b.x || (a.x == b.x && a.y > b.y);
    vec2 from = turned ? b : a, to = turned ? a : b;
    precise float left = (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
    return (left >= 0.0) != turned ? 1 : -1;
}

void main()
{
    uint i = item();
    if (i >= field_params.count) return;
    uvec4 work = items[i];
    int axis = int(work.y), u = (axis + 1) % 3, v = (axis + 2) % 3;
    vec3 a = corner(work.x, 0), b = corner(work.x, 1), c = corner(work.x, 2),
         n = cross(b - a, c - a);
    vec2 a2 = vec2(a[u], a[v]), b2 = vec2(b[u], b[v]), c2 = vec2(c[u], c[v]);
    float lowest = min(a[axis], min(b[axis], c[axis])),
          highest = max(a[axis], max(b[axis], c[axis]));
    float spacing = field_params.low.w;
    ivec3 size = grid_size();
    for (int k = 0; k < FIELD_COLUMNS * FIELD_COLUMNS; ++k) {
        ivec2 column = ivec2(work.zw) + ivec2(k % FIELD_COLUMNS, k / FIELD_COLUMNS);
        if (column.x >= size[u] || column.y >= size[v]) continue;
        vec2 p = spacing * vec2(column);
        int sides = side(a2, b2, p) + side(b2, c2, p) + side(c2, a2, p);
        if (abs(sides) != 3) continue;
        vec2 from = p - a2;
        float height =
            a[axis] - (n[u] * from.x + n[v] * from.y) / (n[axis] != 0.0 ? n[axis] : 1e-30);
        ivec3 at = ivec3(0);
        at[u] = column.x;
        at[v] = column.y;
        at[axis] = int(ceil(clamp(height, lowest, highest) / spacing));
        if (at[axis] < size[axis]) atomicAdd(crossings[grid_address(at)], sides > 0 ? -1 : 1);
    }
}
