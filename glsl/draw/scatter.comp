// SPDX-License-Identifier: MIT
// The table for Marschner shading: the azimuthal distribution of light that a fibre scatters, for
// all colours.
//
// Seen along its axis, the fibre is a disc of radius 1. Light with the inclination theta_d enters
// at the offset h = sin(gamma_i) and continues at gamma_t with sin(gamma_t) = h / eta', where eta'
// = sqrt(eta^2 - sin^2 theta_d) / cos theta_d by Bravais' law. After p chords it leaves, turned by
//
//   Phi(p, h) = 2 p gamma_t - 2 gamma_i + p pi
//
// It has the share A(0) = F, A(p) = (1 - F)^2 F^(p-1) T^p of the power (Marschner et al. 2003). F
// is Fresnel's reflectance at the true angle, whose cosine is cos theta_d cos gamma_i. T is the
// transmittance of a chord, which is 2 cos(gamma_t) / cos(theta_t) long; by Beer's law a fibre
// whose diameter transmits `color` has T = color^(cos gamma_t / cos theta_t). The density over the
// azimuth is
//
//   N(p, phi) = 1/2 integral over h from -1 to 1 of A(p, h) G(phi - Phi(p, h))
//
// G is a Gaussian (d'Eon et al. 2011). Without it the brightness would become infinite where
// neighbouring beams meet (caustics). The light that leaves after more than two internal
// reflections, (1-F)^2 F^2 T^3 / (1 - F T), is distributed evenly over all directions, so that no
// light is lost.
#include "common/shared_math.h"
#include "draw/draw.h"

layout(local_size_x = GROUP_SIZE) in;
layout(location = 0) uniform vec2 fibre; // eta, standard deviation of G in rad (< pi / 2)
layout(binding = 0, rgba16f) writeonly uniform image3D table; // R, TT, TRT, further reflections

const int STEPS = 64; // over gamma_i, in which the integrand is smooth: dh = cos(gamma_i) d gamma_i

float fresnel(float eta, float cosine)
{
    float inside = sqrt(1.0 - (1.0 - cosine * cosine) / (eta * eta));
    float s = (cosine - eta * inside) / (cosine + eta * inside),
          p = (eta * cosine - inside) / (eta * cosine + inside);
    return 0.5 * (s * s + p * p);
}

// The Gaussian around 0 and its repetition around the circle.
float blur(float x, float width)
{
    x = abs(x - 2.0 * PI * round(x / (2.0 * PI)));
    vec2 at = vec2(x, 2.0 * PI - x) / width, g = exp(-0.5 * at * at);
    return (g.x + g.y) / (width * sqrt(2.0 * PI));
}

const int QUADS = SCATTER_COLORS / 4;

void main()
{
    ivec2 node = ivec2(gl_GlobalInvocationID);
    if (node.x >= SCATTER_AZIMUTHS) return;
    float eta = fibre.x, width = fibre.y, phi = PI * float(node.x) / float(SCATTER_AZIMUTHS - 1);
    float cos_d = max(float(node.y) / float(SCATTER_INCLINATIONS - 1), 1e-3),
          sin2_d = 1.0 - cos_d * cos_d;
    float eta_d = sqrt(eta * eta - sin2_d) / cos_d, cos_t = sqrt(1.0 - sin2_d / (eta * eta));
    float reflected = 0.0;
    vec4 depth[QUADS], through[QUADS], inside[QUADS]; // four colours each
    for (int c = 0; c < QUADS; ++c) {
        vec4 color = (vec4(4 * c) + vec4(0, 1, 2, 3)) / float(SCATTER_COLORS - 1);
        depth[c] = log2(max(color, 1e-30));
        through[c] = inside[c] = vec4(0.0);
    }
    for (int i = 0; i < STEPS; ++i) {
        float gamma_i = (float(i) + 0.5) * (PI / float(STEPS)) - 0.5 * PI,
              gamma_t = asin(sin(gamma_i) / eta_d);
        float cos_i = cos(gamma_i), share = cos_i * (0.5 * PI / float(STEPS));
        float f = fresnel(eta, cos_d * cos_i), in_and_out = share * (1.0 - f) * (1.0 - f);
        float chord = cos(gamma_t) / cos_t;
        float once = in_and_out * blur(phi - 2.0 * gamma_t + 2.0 * gamma_i - PI, width),
              twice = in_and_out * f * blur(phi - 4.0 * gamma_t + 2.0 * gamma_i - 2.0 * PI, width);
        reflected += share * f * blur(phi + 2.0 * gamma_i, width);
        for (int c = 0; c < QUADS; ++c) {
            vec4 t = exp2(depth[c] * chord);
            through[c] += once * t;
            inside[c] += twice * t * t;
            inside[c] += in_and_out * f * f * t * t * t / (1.0 - f * t) / (2.0 * PI);
        }
    }
    for (int c = 0; c < QUADS; ++c)
        for (int k = 0; k < 4; ++k)
            imageStore(table, ivec3(node, 4 * c + k),
                       vec4(reflected, through[c][k], inside[c][k], 0.0));
}
