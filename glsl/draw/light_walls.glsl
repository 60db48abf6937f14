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

// As in light_field.h: whether the mesh lets light into a cell along a direction of the group,
// whether the cell is next to the mesh, and the mean unit normal of the mesh there.
bool lets_in(ivec3 cell, int group)
{
    ivec3 from = cell * wall_step;
    int axis = group / 2, further = axis == 0 ? wall_step.x : axis == 1 ? wall_step.y : wall_step.z;
    return wall_at(wall_origin(axis) + from.x + from.y + from.z +
                   ((group & 1) == 1 ? 0 : further)) > 0.0;
}

bool is_beside_mesh(ivec3 cell)
{
    bool all_open = true;
    for (int group = 0; group < LIGHT_ORDINATES / LIGHT_LANES; ++group)
        all_open = all_open && lets_in(cell, group);
    return !all_open;
}

vec3 mesh_normal(ivec3 cell)
{
    vec3 normal;
    for (int k = 0; k < 3; ++k)
        normal[k] = float(lets_in(cell, 2 * k)) - float(lets_in(cell, 2 * k + 1));
    float square = dot(normal, normal);
    return square > 0.0 ? normal * inversesqrt(square) : normal;
}
