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
//   TINTS 1: the table has the section's own colour in slices of brightness (tint_table.h), the
//       strand's being the nearest: from there on TT goes as the colour, TRT as its square
#include "common/shared_math.h"

#if TINTS
// R | TT of red << 16, TT of green and blue, TRT of red and green, TRT of blue: units.
layout(binding = BIND_SCATTER) uniform usamplerBuffer tint_table;
#else
layout(binding = BIND_SCATTER) uniform sampler3D scatter_table;
#endif
#if SCATTERED
layout(binding = BIND_SCATTERED) uniform samplerBuffer scattered_light;
#endif

// Read once: a uniform costs a load wherever it is named.
struct Fibre {
    vec4 albedo, mean_albedo;                  // see material.h
    vec3 sharpness, scale, tilt_cos, tilt_sin; // of R, TT, TRT
#if TINTS
    int slice;          // its first texel
    vec3 unit, through; // the strand's colour over the slice's
#endif
};

Fibre fibre_material(Painter painter)
{
#if TINTS
    float last = material.tint_unit.w,
          which = floor((0.5 + 0.5 * hash_signed(painter.id ^ draw_params.seed)) * last + 0.5),
          brightness = 1.0 + material.color_variation * (2.0 * which / max(last, 1.0) - 1.0);
    vec3 of_slice = max(min(material.color.rgb * brightness, 1.0), 1e-3);
#endif
    return Fibre(material.albedo, material.mean_albedo, material.lobe_sharpness.xyz,
                 material.lobe_scale.xyz, material.lobe_tilt_cos.xyz, material.lobe_tilt_sin.xyz
#if TINTS
                 ,
                 int(which) * (SCATTER_INCLINATIONS * SCATTER_AZIMUTHS), material.tint_unit.xyz,
                 max(min(painter.tint, 1.0), 1e-3) / of_slice
#endif
    );
}

// exp(-x) I0(x) for x >= 0 within 0.06 % (Olivares, Martin and Valero, J. Phys. Conf. Ser. 1043,
// 2018).
vec3 bessel_i0_scaled(vec3 x)
{
    vec3 square = x * x;
    return (0.5 + 0.5 * exp(-2.0 * x)) * inversesqrt(sqrt(1.0 + 0.25 * square)) *
           (1.0 + 0.24273 * square) / (1.0 + 0.43023 * square);
}

// M of R, TT and TRT; `to` is the tilted theta_r as the model has it, found once for all lights.
#if MARSCHNER == 2
struct Outgoing {
    vec3 angle;
    float theta;
};

Outgoing outgoing(Fibre m, float sin_r, float cos_r)
{
    float theta = asin(sin_r);
    return Outgoing(theta - atan(m.tilt_sin, m.tilt_cos), theta);
}

vec3 longitudinal(Fibre m, Outgoing to, float sin_i, float cos_i, float cos_d)
{
    vec3 off = asin(sin_i) + to.angle;
    return sqrt(m.sharpness / (2.0 * PI)) * exp(-0.5 * off * off * m.sharpness) *
           (cos_i / max(cos_d * cos_d, 1e-6));
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
    vec3 c = abs(cos_i * to.cosine), s = sin_i * to.sine;
    return m.scale * exp((c - s - 1.0) * m.sharpness) * bessel_i0_scaled(c * m.sharpness);
}
#endif

// The sum over R, TT and TRT of M, which is `along`, times N; x and y of `at` are those of the
// table's nodes.
#if TINTS
// Halves of words are small: whole numbers with a sign become floats in one instruction.
vec4 low_halves(uvec4 words) { return vec4(ivec4(words & 0xffffu)); }
vec4 high_halves(uvec4 words) { return vec4(ivec4(words >> 16)); }

vec3 sum_of_beams(Fibre m, vec3 base, vec2 at, vec3 along)
{
    const vec2 nodes = vec2(SCATTER_AZIMUTHS, SCATTER_INCLINATIONS);
    vec2 place = at * (nodes - 1.0), first = min(floor(place), nodes - 2.0), share = place - first;
    int texel = m.slice + int(first.y) * SCATTER_AZIMUTHS + int(first.x);
    uvec4 a = texelFetch(tint_table, texel), b = texelFetch(tint_table, texel + 1),
          c = texelFetch(tint_table, texel + SCATTER_AZIMUTHS),
          d = texelFetch(tint_table, texel + SCATTER_AZIMUTHS + 1);
    vec4 low = mix(mix(low_halves(a), low_halves(b), share.x),
                   mix(low_halves(c), low_halves(d), share.x), share.y);
    vec4 high = mix(mix(high_halves(a), high_halves(b), share.x),
                    mix(high_halves(c), high_halves(d), share.x), share.y);
    along *= m.unit;
    return along.x * low.x + m.through * (along.y * vec3(high.x, low.y, high.y) +
                                          m.through * (along.z * vec3(low.z, high.z, low.w)));
}
#else
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
#endif

// The share of light square to a fibre that it scatters, by what its diameter lets through.
vec3 albedo_of(Fibre m, vec3 base)
{
    return mix(vec3(m.albedo.x), vec3(1.0), pow(min(base, 1.0), vec3(m.albedo.y)));
}

// Linear RGB of a fibre at x, where point `point` of a batch lies, whose diameter lets `base` of
// white light through, along the unit tangent (root to tip), seen along the unit vector to the eye.
vec3 shade_fibre(Fibre m, vec3 base, int point, vec3 x, vec3 tangent, vec3 to_eye)
{
    float sin_r = clamp(dot(tangent, to_eye), -1.0, 1.0), cos_r = sine_of(sin_r);
    Outgoing to = outgoing(m, sin_r, cos_r);
    vec3 albedo = albedo_of(m, base);
#if SCATTERED
    vec3 color = texelFetch(scattered_light, point).rgb * albedo / m.mean_albedo.rgb;
#else
    vec3 color = albedo * light_around_fibre(tangent, to_eye, sin_r);
#endif
    for (int i = 0; i < light_count; ++i) {
        vec3 to_light, reaching = light_reaching(i, x, to_light);
        float sin_i = clamp(dot(tangent, to_light), -1.0, 1.0), cos_i = sine_of(sin_i),
              across = cos_i * cos_r;
        float cos_phi =
            clamp((dot(to_eye, to_light) - sin_i * sin_r) / max(across, 1e-6), -1.0, 1.0);
#if MARSCHNER == 2
        float cos_d = sqrt(clamp(0.5 + 0.5 * (across + sin_i * sin_r), 0.0, 1.0));
#else
        float cos_d = cos_r;
#endif
        vec3 along = longitudinal(m, to, sin_i, cos_i, cos_d);
        vec2 at = vec2(acos(cos_phi) * (1.0 / PI), cos_d);
        vec3 scattered = sum_of_beams(m, base, at, along);
        color += reaching * PI * scattered;
    }
    return color;
}
