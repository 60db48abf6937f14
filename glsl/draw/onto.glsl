// SPDX-License-Identifier: MIT
// The light that hair sends onto a point of skin: light_grid_onto.h (needs draw.h).
#include "kernel/onto.h"

layout(binding = BIND_ONTO) uniform samplerBuffer onto_faces;
layout(location = 0) uniform vec4 onto_axis[3]; // xyz: unit axis of the lattice; w: its low side, m
layout(location = 3) uniform vec4 onto_cells;   // xyz: cells along each axis; w, m: side of a cell

// x: m, n: unit normal, both in the world.
vec3 onto_light(vec3 x, vec3 n)
{
    ivec3 count = ivec3(onto_cells.xyz);
    float side = onto_cells.w;
    mat3 axes = mat3(onto_axis[0].xyz, onto_axis[1].xyz, onto_axis[2].xyz);
    vec3 low = vec3(onto_axis[0].w, onto_axis[1].w, onto_axis[2].w), m = n * axes,
         at = ((x + ONTO_ABOVE * side * n) * axes - low) / side,
         inside = clamp(at, vec3(0.0), onto_cells.xyz), off = (at - inside) * side,
         from = clamp(inside - 0.5, vec3(0.0), onto_cells.xyz - 1.0);
    ivec3 first = ivec3(from);
    vec3 share = from - vec3(first), sum = vec3(0.0);
    float weights = 0.0, brightest = 0.0, all[8];
    int faces[8];
    for (int q = 0; q < 8; ++q) {
        ivec3 cell = min(first + ivec3(q & 1, q >> 1 & 1, q >> 2), count - 1);
        faces[q] = ((cell.z * count.y + cell.y) * count.x + cell.x) * ONTO_FACES;
        all[q] = texelFetch(onto_faces, faces[q]).a;
        brightest = max(brightest, all[q]);
    }
    for (int q = 0; q < 8; ++q) {
        vec3 of = mix(1.0 - share, share, equal(ivec3(q & 1, q >> 1 & 1, q >> 2), ivec3(1)));
        int face = faces[q];
        float weight = all[q] > ONTO_LEAST * brightest ? of.x * of.y * of.z : 0.0;
        weights += weight;
        for (int k = 0; k < 3; ++k)
            sum +=
                weight * onto_share(m[k]) * texelFetch(onto_faces, face + onto_face(k, m[k])).rgb;
    }
    float longest = side * max(max(onto_cells.x, onto_cells.y), onto_cells.z);
    return onto_away(dot(off, off), longest) / max(weights, 1e-6) * sum;
}
