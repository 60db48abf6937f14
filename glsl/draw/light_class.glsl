// SPDX-License-Identifier: MIT
// Classes of tangents, see ordinates.h (needs light.glsl).
layout(binding = BIND_LIGHT_TABLES) uniform samplerBuffer light_tables;

float class_sine(int which, int d)
{
    return texelFetch(light_tables, which * LIGHT_ORDINATES + d).x;
}

vec3 class_tangent(int which)
{
    int at = LIGHT_TANGENT_AT + 3 * which;
    return vec3(texelFetch(light_tables, at).x, texelFetch(light_tables, at + 1).x,
                texelFetch(light_tables, at + 2).x);
}

// The nearest class to a vector of any length.
int class_of(vec3 t)
{
    int axis = longest_axis(t);
    vec3 from = turned(t, axis);
    vec2 at = from.yz / max(abs(from.x), 1e-20);
    int column = cell_square(at.x, LIGHT_SQUARES), row = cell_square(at.y, LIGHT_SQUARES);
    int face = 2 * axis + int(from.x > 0.0);
    return int(texelFetch(light_tables,
                          LIGHT_NEAREST_AT + (face * LIGHT_SQUARES + row) * LIGHT_SQUARES + column)
                   .x);
}
