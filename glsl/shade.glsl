// SPDX-License-Identifier: MIT
// Light on a fibre, by one of the models (needs draw.h, material.h). Each gives Fibre, what it knows of
// the material, and shade_fibre.
//   MARSCHNER 0: Kajiya and Kay's   1, 2: Marschner's, see there

// Of the sine the cosine or the other way round, where it is not negative.
float sine_of(float cosine)
{
    return sqrt(max(1.0 - cosine * cosine, 0.0));
}

#include "lights.glsl"
#if MARSCHNER
#include "shade_marschner.glsl"
#else
#include "shade_kajiya.glsl"
#endif
