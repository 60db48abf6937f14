// SPDX-License-Identifier: MIT
// Marschner et al.'s fibre (SIGGRAPH 2003): a rough glass cylinder with pigment inside (needs
// material.h, lights.glsl). Three beams leave it: R, reflected outside; TT, gone through; TRT,
// reflected inside. Of light from wi it sends towards wr, as the mean radiance over its width,
//
//   f = sum over p of M_p(theta_i, theta_r) N_p(theta_d, phi)
//
// per unit of solid angle; theta is the inclination against the plane across the fibre, towards the
// tip, phi the azimuth between both. N is tabulated (scatter.comp).
//   MARSCHNER 1: energy   M is d'Eon et al.'s (2011) lobe of the variance v, with
//     t = theta_r - 2 alpha for scales that tilt the lobe by alpha,
//       M = exp(-sin(theta_i) sin(t) / v) I0(cos(theta_i) cos(t) / v) / (2 v sinh(1 / v)),
//     whose integral over cos(theta_i) d theta_i is 1, and theta_d = theta_r: a fibre without
//     pigment under light L from everywhere shows L.
//   MARSCHNER 2: gauss   M is Marschner's Gaussian with the variance v,
//       M = g(theta_i + theta_r - 2 alpha) cos(theta_i) / cos^2(theta_d),
//     and theta_d = (theta_r - theta_i) / 2: light goes either way alike, but some is lost or made
//     at grazing angles. (No tilted lobe can do both: a beam that leaves at another inclination has
//     another width.)
// Light that comes from other fibres and from the sky has been found before (light_grid.h) for the
// hair's mean colour; what a strand's own colour scatters of it differs by its albedo.
//   SCATTERED 1: so it is   0: nothing stands between the fibre and the sky
#include "kernel/fibre.h"

layout(binding = BIND_SCATTER) uniform sampler3D scatter_table;
#if SCATTERED
layout(binding = BIND_SCATTERED) uniform samplerBuffer scattered_light;
#endif

// Read once: a uniform costs a load wherever it is named.
struct Fibre {
    vec4 albedo, mean_albedo;                  // see material.h
    vec3 sharpness, scale, tilt_cos, tilt_sin; // of R, TT, TRT
};

Fibre fibre_material()
{
    return Fibre(material.albedo, material.mean_albedo, material.lobe_sharpness.xyz,
                 material.lobe_scale.xyz, material.lobe_tilt_cos.xyz, material.lobe_tilt_sin.xyz);
}

// M of R, TT and TRT; `to` is the tilted theta_r as the model has it, found once for all lights.
#if MARSCHNER == 2
struct Outgoing {
    vec3 angle;
};

Outgoing outgoing(Fibre m, float sin_r, float cos_r)
{
    return Outgoing(asin(sin_r) - atan(m.tilt_sin, m.tilt_cos));
}

vec3 longitudinal(Fibre m, Outgoing to, float sin_i, float cos_i, float cos_d)
{
    vec3 off = asin(sin_i) + to.angle;
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

// The sum over R, TT and TRT of M, which is `along`, times N; x and y of `at` are those of the
// table's nodes.
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

// Linear RGB of a fibre at x, where point `point` of a batch lies, whose diameter lets `base` of
// white light through, along the unit tangent (root to tip), seen along the unit vector to the eye.
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
        vec3 along = longitudinal(m, to, sin_i, cos_i, cos_d);
        vec2 at = vec2(fibre_turn(cos_phi), cos_d);
        vec3 scattered = sum_of_beams(m, base, at, along);
        color += reaching * PI * scattered;
    }
    return color;
}
