// SPDX-License-Identifier: MIT
// The light that reaches a point (needs draw.h).
//   SHADOW, SHADOW_BY_MESH, LIGHT_COUNT: see shadow.glsl
//   LIGHTS 0: directional lights, and the same from everywhere else   1: also points, spots, a sky

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
// The share of light i's colour that a surface at x square to it is given, and the unit vector
// towards it. A directional light's place is its direction, with w = 0.
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

// Linear RGB of light i at x, as a matt white surface square to it would show it, were nothing
// between them, and the unit vector towards it.
vec3 light_sent(int i, vec3 x, out vec3 to_light)
{
#if LIGHTS
    return draw_params.light_color[i].rgb * light_share(i, x, to_light);
#else
    to_light = draw_params.light_place[i].xyz;
    return draw_params.light_color[i].rgb;
#endif
}

// The same with what stands between them. With SHADOW, x is the point of the last shadow_find.
vec3 light_reaching(int i, vec3 x, out vec3 to_light)
{
    return light_sent(i, x, to_light) * light_left(i);
}

// The mean light from everywhere on surfaces whose unit normals fan out by so much about n, above
// them the sky and below the ground: `share` is 1 for a plane.
vec3 light_around(vec3 n, float share)
{
    float up = share * n.y;
    vec4 sky = draw_params.sky, ground = draw_params.ground;
    return vec3(lamp_around(sky.r, ground.r, up), lamp_around(sky.g, ground.g, up),
                lamp_around(sky.b, ground.b, up));
}

// The same on the side of a fibre that is seen, whose unit tangent has the cosine `eye` with the
// unit vector to the eye: a normal at the angle a off the middle is seen by cos a, so that PI/4 of
// the middle one counts.
vec3 light_around_fibre(vec3 tangent, vec3 to_eye, float eye)
{
#if LIGHTS
    vec3 side = to_eye - eye * tangent;
    return light_around(side * inversesqrt(max(dot(side, side), 1e-12)), 0.25 * PI);
#else
    return draw_params.sky.rgb;
#endif
}
