// SPDX-License-Identifier: MIT
// Functions for drawing hair into a shadow map (needs shadow.h).
#include "kernel/caster.h"

// A local copy, because each use of a uniform costs a load.
mat4 cast_from_world = cast_params.from_world;
float limit = cast_params.limit;
int side = cast_params.side;

// u, v (texels), depth (0..1 over the hair), w.
vec4 shadow_place(vec3 x)
{
    CasterPlace place = caster_place(cast_from_world, x.x, x.y, x.z);
    return vec4(place.u, place.v, place.z, place.w);
}
