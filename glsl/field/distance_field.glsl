// SPDX-License-Identifier: MIT
// The distance to a mesh that moves with the head: trilinear interpolation of a grid of samples in
// the head's frame, with the exact gradient of the interpolation (needs collide_params.h,
// rigid.glsl). The mesh does not reach the border of the grid; beyond it, the distance is that at
// the nearest point of the grid plus the way there.
//
// BOUND 1: the mesh deforms. A sample then has three more numbers, the displacement of its nearest
// surface in the step, in the head's frame.

layout(binding = BIND_FIELD) uniform samplerBuffer field;

#if BOUND
// The displacement in the step of the surface near p, beyond moving with the head, in the head's
// frame at the step's start. Taken from the nearest sample.
vec3 field_moved(vec3 p)
{
    vec4 to_world = collide_params.head_rotation, to_head = vec4(-to_world.xyz, to_world.w);
    vec3 size = collide_params.field_size.xyz;
    vec3 g =
        (rotate(to_head, p - collide_params.head_translation.xyz) - collide_params.field_low.xyz) /
        collide_params.field_low.w;
    ivec3 at = ivec3(clamp(floor(g + 0.5), vec3(0.0), size - 1.0));
    return texelFetch(field, (at.z * int(size.y) + at.y) * int(size.x) + at.x).yzw;
}
#endif

float field_distance(vec3 p, out vec3 normal)
{
    vec4 to_world = collide_params.head_rotation, to_head = vec4(-to_world.xyz, to_world.w);
    float spacing = collide_params.field_low.w;
    vec3 size = collide_params.field_size.xyz;
    vec3 g =
        (rotate(to_head, p - collide_params.head_translation.xyz) - collide_params.field_low.xyz) /
        spacing;
    vec3 in_grid = clamp(g, vec3(0.0), size - 1.0), cell = min(floor(in_grid), size - 2.0),
         f = in_grid - cell;
    int row = int(size.x), slice = row * int(size.y),
        at = int(cell.z) * slice + int(cell.y) * row + int(cell.x);
    // Samples of the cell's corners; x goes from left to right, y and z are the rows.
    vec4 left = vec4(texelFetch(field, at).x, texelFetch(field, at + row).x,
                     texelFetch(field, at + slice).x, texelFetch(field, at + slice + row).x);
    vec4 right =
        vec4(texelFetch(field, at + 1).x, texelFetch(field, at + row + 1).x,
             texelFetch(field, at + slice + 1).x, texelFetch(field, at + slice + row + 1).x);
    vec4 rise = right - left, rows = left + f.x * rise;
    vec2 slices = mix(rows.xz, rows.yw, f.y), rise_x = mix(rise.xz, rise.yw, f.y),
         rise_y = rows.yw - rows.xz;
    vec3 gradient =
        vec3(mix(rise_x.x, rise_x.y, f.z), mix(rise_y.x, rise_y.y, f.z), slices.y - slices.x);
    float square = dot(gradient, gradient), inside = mix(slices.x, slices.y, f.z);
    normal = rotate(to_world, square > 0.0 ? gradient * inversesqrt(square) : vec3(0.0, 1.0, 0.0));
    vec3 beyond = spacing * (g - in_grid);
    return inside + length(beyond);
}
