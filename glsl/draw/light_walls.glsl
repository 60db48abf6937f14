// SPDX-License-Identifier: MIT
// The share of light that a mesh lets through between neighbouring cells of the light grid (needs
// light.glsl): for each axis, from the centre of the previous cell to the centre of the cell. At
// the lattice's border it is 1.
layout(binding = BIND_LIGHT_WALLS) uniform samplerBuffer walls;

ivec3 wall_step = ivec3(1, cells.x + 2, (cells.x + 2) * (cells.y + 2));

// The index of cell (0, 0, 0) for axis `axis`.
int wall_origin(int axis)
{
    return axis * wall_step.z * (cells.z + 2) + wall_step.x + wall_step.y + wall_step.z;
}

float wall_at(int at) { return texelFetch(walls, at).x; }
