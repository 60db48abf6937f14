// SPDX-License-Identifier: MIT
// How the hair of one section looks, and the size of the batch that is being drawn.
#include "common/shared.h"
#ifdef __STDC__
#pragma once
#endif

UNIFORM_BLOCK(MaterialParams, material, BIND_MATERIAL)
{
    vec4 color;                      // linear RGB
    float color_variation;           // brightness of strands varies by this share either way
    float warmth_variation;          // red against blue, in the same way
    float radius;                    // m, at the root
    float tip_ratio;                 // radius at the tip over that at the root
    float opacity, shadow_opacity;   // to the eye, to light
    float ambient, diffuse;          // Ka, Kd
    float specular1, exponent1;      // first highlight, white
    float specular2, exponent2;      // second highlight, tinted
    float shift1_cos, shift1_sin;    // tilt of the first highlight, towards the root
    float shift2_cos, shift2_sin;    // tilt of the second highlight, towards the tip
    vec4 lobe_sharpness, lobe_scale; // marschner, x R, y TT, z TRT: 1/v, and 1/(v (1 - exp(-2/v)))
    vec4 lobe_tilt_cos, lobe_tilt_sin; // cosine and sine of twice the tilt
    vec4 albedo;                       // marschner: x, y of fibre_lobes_fit_albedo
    vec4 mean_albedo;                  // albedo of the hair's mean colour, from it
    uint vertex_count;
    uint first_strand, drawn_strands; // the part of the batch that is being drawn
    uint smooth_parts, smooth_curve;  // parts of a segment; 0 Catmull-Rom, 1 B-spline
    uint last_strand;                 // the last strand, if only a share of strands is drawn ...
    float last_share;                 // ... and the share of its width that is drawn
}
END_BLOCK(MaterialParams, material);
