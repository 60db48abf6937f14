// SPDX-License-Identifier: MIT
// Shadows on surfaces. Each map is read only where its light can shine on the surface and something
// can block it (needs lights.glsl). CPU drivers execute both sides of an `if`, but they end a loop
// when no lane needs another turn; so loops of at most one turn are used as conditions.
//   SHADOW_WRAP: light counts up to this cosine below the horizon. Up to the same cosine above the
//       horizon the surface's own shadow, which is jagged there, is faded in.
#ifndef SHADOW_WRAP
#define SHADOW_WRAP 0.0
#endif

#if SHADOW
bool shadow_covers(vec2 texel, int side)
{
    return all(greaterThanEqual(texel, vec2(0.0))) && all(lessThanEqual(texel, vec2(side)));
}

// Like shadow_find, for a surface at x with the unit normal n.
void shadow_find_on(vec3 x, vec3 n)
{
    for (int map = 0; map < shadow_maps; ++map) {
        vec4 of_light = shadow_params.place[map],
             place = vec4(x, 1.0) * shadow_params.from_world[map];
        vec4 at = draw_params.light_place[int(of_light.x)];
        // A lamp has no map behind it.
        float facing = dot(normalize(at.xyz - at.w * x), n);
        bool shone = facing > -SHADOW_WRAP && place.w > 0.0;
        float left = 1.0;
        vec2 texel = place.xy / place.w;
#if WIDE && SHADOW == 2
        float off =
            shadow_params.wide[map].x * max(place.z, 0.0); // rays cross the map from outside
#else
        const float off = 0.0;
#endif
        bool covers = all(greaterThanEqual(texel, vec2(-off))) &&
                      all(lessThanEqual(texel, vec2(float(shadow_side) + off)));
        int turns = shone && place.z > 0.0 && covers ? 1 : 0;
        for (int turn = 0; turn < turns; ++turn)
            left = LIGHT_THROUGH(map, texel, place.z, of_light, true);
#if SHADOW_BY_MESH
        vec4 mesh_place = vec4(x, 1.0) * shadow_params.mesh_from_world[map];
        turns =
            shone && shadow_covers(mesh_place.xy / mesh_place.w, shadow_params.mesh_side) ? 1 : 0;
        float own = SHADOW_WRAP > 0.0 ? smoothstep(0.0, SHADOW_WRAP, facing) : 1.0;
        for (int turn = 0; turn < turns; ++turn) left *= mix(1.0, light_past_mesh(map, x), own);
#endif
        shadow_keep(int(of_light.x), left);
    }
}
#endif
