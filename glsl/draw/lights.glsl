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

// The mean ambient light on surfaces whose unit normals spread around n; `share` is the length of
// their mean normal, 1 for a plane.
vec3 light_around(vec3 n, float share)
{
    float up = share * n.y;
    vec4 sky = draw_params.sky, ground = draw_params.ground;
    return vec3(lamp_around(sky.r, ground.r, up), lamp_around(sky.g, ground.g, up),
                lamp_around(sky.b, ground.b, up));
}

// The ambient light on the visible side of a fibre, whose unit tangent has the cosine `eye` with
// the unit vector to the eye. A normal at the angle a from the middle of this side has the weight
// cos a, so the mean normal is PI/4 times the middle one.
vec3 light_around_fibre(vec3 tangent, vec3 to_eye, float eye)
{
#if LIGHTS
    vec3 side = to_eye - eye * tangent;
    return light_around(side * inversesqrt(max(dot(side, side), 1e-12)), 0.25 * PI);
#else
    return draw_params.sky.rgb;
#endif
}
