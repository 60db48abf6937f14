// SPDX-License-Identifier: MIT
// Evaluates shade_marschner.glsl for tests: a pair of directions for each lane, with a light of
// 1/PI, so that the result is the density f itself. The fibre runs along y.
#include "draw/draw.h"
#include "draw/material.h"

float sine_of(float cosine) { return sqrt(max(1.0 - cosine * cosine, 0.0)); }

const int light_count = 1;
vec3 lit_from = vec3(0.0);

vec3 light_reaching(int i, vec3 x, out vec3 to_light)
{
    to_light = lit_from;
    return vec3(1.0 / 3.14159265);
}

vec3 light_around_fibre(vec3 tangent, vec3 to_eye, float eye) { return vec3(0.0); }

#include "common/hash.h"
#include "draw/paint.glsl"
#include "draw/shade_marschner.glsl"

layout(local_size_x = 32) in;
layout(std430, binding = 0) readonly buffer Directions
{
    vec4 directions[];
}; // towards the light, towards the eye
layout(std430, binding = 1) writeonly buffer Colors { vec4 colors[]; };

void main()
{
    int i = int(gl_GlobalInvocationID.x);
    if (i >= directions.length() / 2) return;
    lit_from = directions[2 * i].xyz;
    vec3 to_eye = directions[2 * i + 1].xyz;
    Painter painter = paint_strand(0u, 2);
    vec3 color = shade_fibre(fibre_material(), painter.tint, 0, vec3(0.0), vec3(0, 1, 0), to_eye);
    colors[i] = vec4(color, 1.0);
}
