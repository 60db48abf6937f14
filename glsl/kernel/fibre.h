// SPDX-License-Identifier: MIT
// The light that a fibre scatters to the eye, for shaders and for vectorised C.
// shade_marschner.glsl and shade_kajiya.glsl describe the models.
#ifdef __STDC__
#pragma once
#endif
#include "common/shared_math.h"

// The cosine of an inclination from its sine, or the sine from the cosine.
SHARED_FUNCTION float fibre_sine_of(float cosine)
{
    return SHARED_SQRT(SHARED_MAX(1.0f - cosine * cosine, 0.0f));
}

// acos(x) / pi for -1 <= x <= 1, with an error of 1e-8 (Abramowitz and Stegun 4.4.46).
SHARED_FUNCTION float fibre_turn(float x)
{
    float a = SHARED_ABS(x), series = -0.0012624911f;
    series = series * a + 0.0066700901f;
    series = series * a - 0.0170881256f;
    series = series * a + 0.0308918810f;
    series = series * a - 0.0501743046f;
    series = series * a + 0.0889789874f;
    series = series * a - 0.2145988016f;
    series = series * a + 1.5707963050f;
    float turn = SHARED_SQRT(SHARED_MAX(1.0f - a, 0.0f)) * series * FLOAT(1.0 / PI);
    return x < 0.0f ? 1.0f - turn : turn;
}

// exp(-x) I0(x) for x >= 0 within 0.06 % (Olivares, Martin and Valero, J. Phys. Conf. Ser. 1043,
// 2018).
SHARED_FUNCTION float fibre_bessel(float x)
{
    float square = x * x;
    return (0.5f + 0.5f * SHARED_EXP2(-2.0f * FLOAT(LOG2E) * x)) * (1.0f + 0.24273f * square) /
           (SHARED_SQRT(SHARED_SQRT(1.0f + 0.25f * square)) * (1.0f + 0.43023f * square));
}

// The lobe of d'Eon et al. (2011) with the variance v = 1 / sharpness around the cone that mirrors
// theta_i; scale = 1 / (v (1 - exp(-2/v))). `sine` and `cosine` belong to the tilted theta_r.
SHARED_FUNCTION float fibre_lobe(float sin_i, float cos_i, float sine, float cosine,
                                 float sharpness, float scale)
{
    float c = SHARED_ABS(cos_i * cosine), power = (c - sin_i * sine - 1.0f) * sharpness;
    return scale * SHARED_EXP2(FLOAT(LOG2E) * SHARED_MIN(power, 0.0f)) *
           fibre_bessel(c * sharpness);
}

// A wide light is a disc, whose directions have the variance `wide` along the fibre. The mean of a
// lobe over the disc is nearly that of two lobes: they are shifted along the fibre in both
// directions, by the root of FIBRE_WIDE_APART times the variance, and widened by the rest of the
// variance. (A single wider lobe would have a Gaussian's tails, but nothing shines beyond the
// disc's edge.) sqrt(1/2) would give them the disc's fourth moment, but the middle of a lobe 0.1
// radii wide would be a third darker than its sides. With 0.6 it is at most 7 % darker.
#define FIBRE_WIDE_APART 0.6f

// The sharpness of both lobes.
SHARED_FUNCTION float fibre_wide_sharpness(float sharpness, float wide)
{
    return sharpness / (1.0f + sharpness * (1.0f - FIBRE_WIDE_APART) * wide);
}

// The shift of both lobes (radians), or its sine, which is nearly the same.
SHARED_FUNCTION float fibre_wide_shift(float wide) { return SHARED_SQRT(FIBRE_WIDE_APART * wide); }

// The scale of a lobe for fibre_lobe.
SHARED_FUNCTION float fibre_lobe_scale(float sharpness)
{
    return sharpness / (1.0f - SHARED_EXP2(-2.0f * FLOAT(LOG2E) * sharpness));
}

// Marschner's Gaussian in theta_i + theta_r with the variance 1 / sharpness. `off`: theta_i +
// theta_r minus the tilt.
SHARED_FUNCTION float fibre_gauss(float off, float sharpness, float cos_i, float cos_d)
{
    return SHARED_SQRT(sharpness * FLOAT(0.5 / PI)) *
           SHARED_EXP2(-0.5f * FLOAT(LOG2E) * off * off * sharpness) * cos_i /
           SHARED_MAX(cos_d * cos_d, 1e-6f);
}

// The mean of the lobes for theta_i + shift and theta_i - shift. `shift`: its sine. The division by
// its cosine keeps the integral over cos(theta_i) d theta_i at 1.
SHARED_FUNCTION float fibre_lobe_pair(float sin_i, float cos_i, float sine, float cosine,
                                      float sharpness, float scale, float shift)
{
    float turn = fibre_sine_of(shift), s = sin_i * turn, c = cos_i * turn, up = cos_i * shift,
          across = sin_i * shift;
    return (0.5f / turn) * (fibre_lobe(s + up, c - across, sine, cosine, sharpness, scale) +
                            fibre_lobe(s - up, c + across, sine, cosine, sharpness, scale));
}

// The same for fibre_gauss. `shift`: radians.
SHARED_FUNCTION float fibre_gauss_pair(float off, float sharpness, float cos_i, float cos_d,
                                       float shift)
{
    return 0.5f * (fibre_gauss(off + shift, sharpness, cos_i, cos_d) +
                   fibre_gauss(off - shift, sharpness, cos_i, cos_d));
}

// The cosine of the azimuth between light and eye, from the sines and cosines of their inclinations
// and from `dot`, the cosine of the angle between them.
SHARED_FUNCTION float fibre_cos_phi(float dot, float sin_i, float cos_i, float sin_r, float cos_r)
{
    float cosine = (dot - sin_i * sin_r) / SHARED_MAX(cos_i * cos_r, 1e-6f);
    return SHARED_MIN(SHARED_MAX(cosine, -1.0f), 1.0f);
}

// The cosine of theta_d = (theta_r - theta_i) / 2.
SHARED_FUNCTION float fibre_cos_d(float sin_i, float cos_i, float sin_r, float cos_r)
{
    float square = 0.5f + 0.5f * (cos_i * cos_r + sin_i * sin_r);
    return SHARED_SQRT(SHARED_MIN(SHARED_MAX(square, 0.0f), 1.0f));
}

// The share of perpendicular light that a fibre scatters if its diameter transmits `color`. `low`
// and `power` come from fibre_lobes_fit_albedo.
SHARED_FUNCTION float fibre_albedo(float color, float low, float power)
{
    return low + (1.0f - low) * SHARED_POW(SHARED_MIN(color, 1.0f), power);
}

// How near the eye is to the reflected cone that is tilted by a small angle (Kajiya's highlights):
// the cosine of the angle between them, 0 if negative.
SHARED_FUNCTION float fibre_highlight(float light, float light_sine, float eye, float eye_sine,
                                      float turn_cos, float turn_sin)
{
    float cone = -light * turn_cos - light_sine * turn_sin,
          cone_sine = light_sine * turn_cos - light * turn_sin;
    return SHARED_MAX(cone * eye + cone_sine * eye_sine, 0.0f);
}
