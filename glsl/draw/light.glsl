// SPDX-License-Identifier: MIT
// Cells of the light grid (needs light.h). Cells with hair have the first slots, cells next to them
// the following slots. The order within both groups is not fixed, and no result depends on it.

#include "kernel/cell.h"

ivec3 cells = ivec3(light_params.count.xyz);
float side = light_params.low.w; // m

vec3 to_lattice(vec3 v)
{
    return vec3(dot(light_params.turn[0].xyz, v), dot(light_params.turn[1].xyz, v),
                dot(light_params.turn[2].xyz, v));
}

// The cell of a place. Hair with valid positions lies in the lattice.
ivec3 cell_around(vec3 x)
{
    return ivec3(clamp((x - light_params.low.xyz) / side, vec3(0.0), vec3(cells - 1)));
}

int cell_address(ivec3 cell) { return (cell.z * cells.y + cell.y) * cells.x + cell.x; }
ivec3 cell_place(int at)
{
    return ivec3(at % cells.x, at / cells.x % cells.y, at / (cells.x * cells.y));
}
bool cell_inside(ivec3 cell)
{
    return all(greaterThanEqual(cell, ivec3(0))) && all(lessThan(cell, cells));
}

// Index of the first of three floats of an ordinate and slot.
int ordinate_address(int d, int slot) { return 3 * (d * int(light_params.room) + slot); }

// The column of an ordinate and channel in a row of LIGHT_WIDE.
int wide_address(int d, int channel)
{
    return (d / LIGHT_LANES * 3 + channel) * LIGHT_LANES + d % LIGHT_LANES;
}

// Rotates components so that axis `axis` comes first.
vec3 turned(vec3 v, int axis) { return axis == 0 ? v.xyz : axis == 1 ? v.yzx : v.zxy; }
ivec3 turned(ivec3 v, int axis) { return axis == 0 ? v.xyz : axis == 1 ? v.yzx : v.zxy; }

int longest_axis(vec3 v)
{
    vec3 a = abs(v);
    return a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
}
