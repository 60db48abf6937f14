// SPDX-License-Identifier: MIT
// Marschner et al.'s fibre (SIGGRAPH 2003): a rough glass cylinder with pigment inside (needs
// material.h, lights.glsl). Three beams leave it: R, reflected outside; TT, transmitted; TRT,
// reflected inside. The share of light from wi that it scatters towards wr, as the mean radiance
// over its width, is
//
//   f = sum over p of M_p(theta_i, theta_r) N_p(theta_d, phi)
//
// per unit of solid angle; theta is the inclination to the plane across the fibre, positive towards
// the tip, phi the azimuth between both. N is tabulated (scatter.comp).
//   MARSCHNER 1: energy   M is d'Eon et al.'s (2011) lobe of the variance v, with
//     t = theta_r - 2 alpha for scales that tilt the lobe by alpha,
//       M = exp(-sin(theta_i) sin(t) / v) I0(cos(theta_i) cos(t) / v) / (2 v sinh(1 / v)),
//     whose integral over cos(theta_i) d theta_i is 1, and theta_d = theta_r: a fibre without
//     pigment under light L from everywhere shows L.
//   MARSCHNER 2: gauss   M is Marschner's Gaussian with the variance v,
//       M = g(theta_i + theta_r - 2 alpha) cos(theta_i) / cos^2(theta_d),
//     and theta_d = (theta_r - theta_i) / 2: the lobe is reciprocal, but at grazing angles it loses
//     or gains light. (A tilted lobe cannot be both normalised and reciprocal, because the width of
//     a beam changes with its inclination.)
// Light from other fibres and from the sky has been computed before (light_grid.h), for the hair's
// mean colour. It is scaled by the strand's albedo over the mean albedo.
//   SCATTERED 1: with this light   0: nothing occludes the sky for the fibre
#include "kernel/fibre.h"

layout(binding = BIND_SCATTER) uniform sampler3D scatter_table;
#if SCATTERED
layout(binding = BIND_SCATTERED) uniform samplerBuffer scattered_light;
#endif

// A local copy, because each use of a uniform costs a load.
struct Fibre {
    vec4 albedo, mean_albedo;                  // see material.h
    vec3 sharpness, scale, tilt_cos, tilt_sin; // for R, TT, TRT
};

Fibre fibre_material()
{
    return Fibre(material.albedo, material.mean_albedo, material.lobe_sharpness.xyz,
                 material.lobe_scale.xyz, material.lobe_tilt_cos.xyz, material.lobe_tilt_sin.xyz);
}

// M of R, TT and TRT. `to`: the tilted theta_r in the form that the model needs, computed once for
// all lights.
#if MARSCHNER == 2
struct Outgoing {
    vec3 angle;
};

Outgoing outgoing(Fibre m, float sin_r, float cos_r)
{
    return Outgoing(asin(clamp(sin_r, -1.0, 1.0)) - atan(m.tilt_sin, m.tilt_cos));
}

vec3 longitudinal(Fibre m, Outgoing to, float sin_i, float cos_i, float cos_d)
{
    vec3 off = asin(clamp(sin_i, -1.0, 1.0)) + to.angle;
    return vec3(fibre_gauss(off.x, m.sharpness.x, cos_i, cos_d),
                fibre_gauss(off.y, m.sharpness.y, cos_i, cos_d),
                fibre_gauss(off.z, m.sharpness.z, cos_i, cos_d));
}
#else
struct Outgoing {
    vec3 sine, cosine;
};

Outgoing outgoing(Fibre m, float sin_r, float cos_r)
{
    return Outgoing(sin_r * m.tilt_cos - cos_r * m.tilt_sin,
                    cos_r * m.tilt_cos + sin_r * m.tilt_sin);
}

vec3 longitudinal(Fibre m, Outgoing to, float sin_i, float cos_i, float cos_d)
{
    return vec3(fibre_lobe(sin_i, cos_i, to.sine.x, to.cosine.x, m.sharpness.x, m.scale.x),
                fibre_lobe(sin_i, cos_i, to.sine.y, to.cosine.y, m.sharpness.y, m.scale.y),
                fibre_lobe(sin_i, cos_i, to.sine.z, to.cosine.z, m.sharpness.z, m.scale.z));
}
#endif

#if WIDE
// The same in light whose directions have the variance `wide`.
vec3 longitudinal_wide(Fibre m, Outgoing to, float sin_i, float cos_i, float cos_d, float wide)
{
    if (wide <= 0.0) return longitudinal(m, to, sin_i, cos_i, cos_d);
    float shift = fibre_wide_shift(wide);
    vec3 along;
    for (int p = 0; p < 3; ++p) {
        float sharp = fibre_wide_sharpness(m.sharpness[p], wide);
#if MARSCHNER == 2
        along[p] = fibre_gauss_pair(asin(clamp(sin_i, -1.0, 1.0)) + to.angle[p], sharp, cos_i,
                                    cos_d, shift);
#else
        along[p] = fibre_lobe_pair(sin_i, cos_i, to.sine[p], to.cosine[p], sharp,
                                   fibre_lobe_scale(sharp), shift);
#endif
    }
    return along;
}
#endif

// The sum over R, TT and TRT of M (`along`) times N. `at`: the place in the table, in nodes.
vec3 azimuthal(vec2 at, float color)
{
    const vec3 nodes = vec3(SCATTER_AZIMUTHS, SCATTER_INCLINATIONS, SCATTER_COLORS);
    return textureLod(scatter_table, (vec3(at, min(color, 1.0)) * (nodes - 1.0) + 0.5) / nodes, 0.0)
        .rgb;
}

vec3 sum_of_beams(Fibre m, vec3 base, vec2 at, vec3 along)
{
    return vec3(dot(along, azimuthal(at, base.r)), dot(along, azimuthal(at, base.g)),
                dot(along, azimuthal(at, base.b)));
}

vec3 albedo_of(Fibre m, vec3 base)
{
    return vec3(fibre_albedo(base.r, m.albedo.x, m.albedo.y),
                fibre_albedo(base.g, m.albedo.x, m.albedo.y),
                fibre_albedo(base.b, m.albedo.x, m.albedo.y));
}

// Linear RGB of a fibre at x, at point `point` of a batch. `base`: share of white light that the
// fibre's diameter transmits; `tangent`: unit, root to tip; `to_eye`: unit.
vec3 shade_fibre(Fibre m, vec3 base, int point, vec3 x, vec3 tangent, vec3 to_eye)
{
    float sin_r = clamp(dot(tangent, to_eye), -1.0, 1.0), cos_r = fibre_sine_of(sin_r);
    Outgoing to = outgoing(m, sin_r, cos_r);
    vec3 albedo = albedo_of(m, base);
#if SCATTERED
    vec3 color = texelFetch(scattered_light, point).rgb * albedo / m.mean_albedo.rgb;
#else
    vec3 color = albedo * light_around_fibre(tangent, to_eye, sin_r);
#endif
    for (int i = 0; i < light_count; ++i) {
        vec3 to_light, reaching = light_reaching(i, x, to_light);
        float sin_i = clamp(dot(tangent, to_light), -1.0, 1.0), cos_i = fibre_sine_of(sin_i);
        float cos_phi = fibre_cos_phi(dot(to_eye, to_light), sin_i, cos_i, sin_r, cos_r);
#if MARSCHNER == 2
        float cos_d = fibre_cos_d(sin_i, cos_i, sin_r, cos_r);
#else
        float cos_d = cos_r;
#endif
#if WIDE
        vec3 along = longitudinal_wide(m, to, sin_i, cos_i, cos_d, draw_params.light_color[i].w);
#else
        vec3 along = longitudinal(m, to, sin_i, cos_i, cos_d);
#endif
        vec2 at = vec2(fibre_turn(cos_phi), cos_d);
        vec3 scattered = sum_of_beams(m, base, at, along);
        color += reaching * PI * scattered;
    }
    return color;
}
