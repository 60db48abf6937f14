// SPDX-License-Identifier: MIT
// Hair on its way into a shadow map (needs shadow.h).

// Read once: a uniform costs a load wherever it is named.
mat4 cast_from_world = cast_params.from_world;
float limit = cast_params.limit;
int side = cast_params.side;

// u, v (texels), depth (0..1 of the hair), w; what lies beside a lamp or behind it goes far away.
vec4 shadow_place(vec3 x)
{
    vec4 place = vec4(x, 1.0) * cast_from_world;
    float w = max(place.w, 1e-6);
    return vec4(place.w > 0.0 ? place.xy / w : vec2(-1e6), place.z, w);
}
