// SPDX-License-Identifier: MIT
// The light that reaches a point (needs draw.h).
//   SHADOW, SHADOW_BY_MESH, LIGHT_COUNT: see shadow.glsl
//   LIGHTS 0: only directional lights and one ambient colour   1: also point lights, spots, a sky

#include "kernel/lamp.h"
#if SHADOW
#include "draw/shadow.h"
#endif
#include "draw/shadow.glsl"

#if LIGHT_COUNT
const int light_count = LIGHT_COUNT;
#else
int light_count = draw_params.light_count;
#endif

#if LIGHTS
// The share of light i's colour that a perpendicular surface at x receives, and the unit vector
// towards the light. A directional light's place is its direction, with w = 0.
float light_share(int i, vec3 x, out vec3 to_light)
{
    vec4 place = draw_params.light_place[i], axis = draw_params.light_axis[i],
         cone = draw_params.light_cone[i];
    vec3 way = place.xyz - place.w * x;
    float square = max(dot(way, way), LAMP_NEAREST);
    to_light = way * inversesqrt(square);
    return lamp_share(place.w, square, axis.w, cone.x, cone.y, dot(axis.xyz, to_light));
}
#endif

// Linear RGB of light i at x, as a matt white surface perpendicular to it would show without
// occluders, and the unit vector towards the light.
vec3 light_sent(int i, vec3 x, out vec3 to_light)
{
#if LIGHTS
    return draw_params.light_color[i].rgb * light_share(i, x, to_light);
#else
    to_light = draw_params.light_place[i].xyz;
    return draw_params.light_color[i].rgb;
#endif
}

// Like light_sent, but with shadows. If SHADOW is set, x must be the point of the last shadow_find.
vec3 light_reaching(int i, vec3 x, out vec3 to_light)
{
    return light_sent(i, x, to_light) * light_left(i);
}

// The mean ambient light between sky and ground on a surface whose unit normal has this y.
vec3 light_upright(float up)
{
    vec4 sky = draw_params.sky, ground = draw_params.ground;
    return vec3(lamp_around(sky.r, ground.r, up), lamp_around(sky.g, ground.g, up),
                lamp_around(sky.b, ground.b, up));
}

// What an environment adds to it: terms of the first degree in the normal, and of the second.
vec3 light_aside(vec3 n)
{
    vec4 x = draw_params.around[0], z = draw_params.around[1];
    return vec3(lamp_aside(x.r, z.r, n.x, n.z), lamp_aside(x.g, z.g, n.x, n.z),
                lamp_aside(x.b, z.b, n.x, n.z));
}

vec3 light_bent(vec3 n)
{
    vec4 xy = draw_params.around[2], yz = draw_params.around[3], zx = draw_params.around[4],
         level = draw_params.around[5], up = draw_params.around[6];
    return vec3(lamp_bent(xy.r, yz.r, zx.r, level.r, up.r, n.x, n.y, n.z),
                lamp_bent(xy.g, yz.g, zx.g, level.g, up.g, n.x, n.y, n.z),
                lamp_bent(xy.b, yz.b, zx.b, level.b, up.b, n.x, n.y, n.z));
}

// The mean ambient light on a surface with the unit normal n.
vec3 light_around(vec3 n)
{
    vec3 light = light_upright(n.y);
    if (draw_params.around[0].w > 0.0)
        light = max(light + light_aside(n) + light_bent(n), vec3(0.0));
    return light;
}

// The ambient light on the visible side of a fibre, whose unit tangent has the cosine `eye` with
// the unit vector to the eye. A normal at the angle a from the middle m of this side has the weight
// cos a. So the mean of a term of the first degree is PI/4 times its value at m. The mean of a term
// of the second degree is a third of the difference between its values at m and at the tangent,
// because its values at three perpendicular normals add up to 0.
vec3 light_around_fibre(vec3 tangent, vec3 to_eye, float eye)
{
#if LIGHTS
    vec3 side = to_eye - eye * tangent;
    side *= inversesqrt(max(dot(side, side), 1e-12));
    vec3 light = light_upright(0.25 * PI * side.y);
    if (draw_params.around[0].w > 0.0)
        light = max(light + 0.25 * PI * light_aside(side) +
                        (light_bent(side) - light_bent(tangent)) / 3.0,
                    vec3(0.0));
    return light;
#else
    return draw_params.sky.rgb;
#endif
}
