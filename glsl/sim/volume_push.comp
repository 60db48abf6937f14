// SPDX-License-Identifier: MIT
// Stops hair that approaches a dense cell, or makes it bounce back; accelerates hair that leaves
// the cell slowly.
//
// Consider a face between cells a and b with normal n (from a to b), masses m_a and m_b and mean
// velocities u. The impulse J = e w M, M = m_a m_b / (m_a + m_b), acts on b along n and on a
// against n, if w = n.(u_a - u_b) + s > 0. The restitution e is between 0 and 2: with e = 1 the
// cells end with w = 0, with e = 2 w changes its sign. s is the speed at which hair expands. Both
// are 0 where nothing is dense. All faces act at once. Faces of different axes change different
// components of a velocity. The two faces of one axis push a cell in opposite directions, so that
// the square of their sum is at most the sum of their squares. The energy changes by at most
//     sum over faces of -J (w - s) + J^2 / (2 M) = sum of M ((e^2/2 - e) w^2 + e w s)
// For e <= 2 the first term is not positive, so energy can rise only by the expansion at the speed
// s.
//
// LAST 1: writes the change instead of the velocities
#define WHO 1
#include "sim/volume.glsl"

layout(binding = BIND_VOLUME_CELLS) uniform samplerBuffer cells_first;
layout(binding = BIND_VOLUME_CELLS_2) uniform samplerBuffer cells_before;
layout(binding = BIND_VOLUME_FACES) uniform samplerBuffer faces;
#if LAST
layout(std430, binding = BIND_VOLUME_CHANGES_OUT) writeonly buffer Changes { vec4 changes[]; };
#else
layout(std430, binding = BIND_VOLUME_CELLS_OUT) writeonly buffer Cells { vec4 cells[]; };
#endif
layout(std430, binding = BIND_VOLUME_DENSE_OUT) readonly buffer Dense { uint dense[]; };

// The velocity that the cell gets from what is beside it `way` cells on, along the normal.
float pushed(int c, vec4 cell, float dense_here, int way, vec3 normal)
{
    vec4 beside = texelFetch(cells_before, c + way);
    float bounce = max(dense_here, texelFetch(faces, c + way).x);
    float apart = volume_params.apart * min(bounce, 1.0);
    float approach = max(dot(cell.xyz - beside.xyz, normal) + apart, 0.0);
    return bounce * approach * beside.w / max(cell.w + beside.w, 1.0);
}

void change(int c, vec4 cell)
{
    int row = int(volume_params.size.x);
    ivec3 ways = ivec3(1, row, row * int(volume_params.size.y));
    vec2 own = texelFetch(faces, c).xy;
    vec3 v = cell.xyz;
    for (int k = 0; k < 3; ++k) {
        vec3 normal = volume_params.axis[k].xyz * volume_params.spacing;
        v += (pushed(c, cell, own.x, -ways[k], -normal) - pushed(c, cell, own.x, ways[k], normal)) *
             normal;
    }
#if LAST
    vec3 first = texelFetch(cells_first, c).xyz;
    changes[c] = vec4(v - first + own.y * first, own.y);
#else
    cells[c] = vec4(v, cell.w);
#endif
}

void main()
{
    if (dense[0] == 0u) return;
    for (int k = 0; k < VOLUME_CELLS_A_LANE; ++k) {
        int c = lane_cell(k);
        bool exists = c < int(volume_params.cell_count);
        vec4 cell = exists ? texelFetch(cells_before, c) : vec4(0.0);
        if (cell.w > 0.0) change(c, cell);
#if LAST
        if (exists && cell.w == 0.0) changes[c] = vec4(0.0);
#else
        if (exists && cell.w == 0.0) cells[c] = cell;
#endif
    }
}
