// SPDX-License-Identifier: MIT
// Light on a fibre, by one of the models (needs draw.h, material.h, paint.glsl). Each model defines
// Fibre, its constants for a material, and shade_fibre.
//   AOV 0: light   1: white   2: the tangent   3: a colour for each strand
//   MARSCHNER 0: Kajiya and Kay's   1, 2: Marschner's, see shade_marschner.glsl

#include "draw/lights.glsl"
#include "kernel/fibre.h" // here, because a file is included once, even if its #if is false
#if MARSCHNER
#include "draw/shade_marschner.glsl"
#else
#include "draw/shade_kajiya.glsl"
#endif

// The colour of point `point` of a batch's curves, which lies at x, behind the particle at `at`.
vec3 shade_particle(Fibre m, Painter painter, int at, int point, vec3 x, vec3 tangent, vec3 to_eye)
{
#if AOV == 0
    return shade_fibre(m, paint_color(painter, at), point, x, tangent, to_eye);
#elif AOV == 1
    return vec3(1.0);
#elif AOV == 2
    return 0.5 + 0.5 * tangent;
#else
    uint bits = max(hash_bits(painter.id) & 0xffffffu, 1u); // black means that there is no strand
    return vec3(uvec3(bits, bits >> 8, bits >> 16) & 255u) / 255.0;
#endif
}
