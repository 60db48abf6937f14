// SPDX-License-Identifier: MIT
#include "reference/fibre_reference.h"

#include <math.h>

FibreReference fibre_reference_create(double refraction, double roughness, double spread,
                                      const double color[3])
{
    const double WIDTH[3] = {1, 0.5, 2};
    FibreReference fibre = {.refraction = refraction, .spread = spread};
    for (int p = 0; p < 3; ++p) {
        double width = 2 * roughness * WIDTH[p]; // in theta_i + theta_r
        fibre.variance[p] = width * width;
    }
    for (int c = 0; c < 3; ++c) fibre.color[c] = color[c];
    return fibre;
}

static double fresnel(double refraction, double cosine)
{
    double inside = sqrt(1 - (1 - cosine * cosine) / (refraction * refraction));
    double s = (cosine - refraction * inside) / (cosine + refraction * inside),
           p = (refraction * cosine - inside) / (refraction * cosine + inside);
    return 0.5 * (s * s + p * p);
}

static double cosine_of(double sine)
{
    return sqrt(fmax(1 - sine * sine, 1e-12));
}

FibreBeams fibre_reference_beams(const FibreReference *fibre, double sine, double offset)
{
    FibreBeams beams = {.sine = sine};
    double cosine = cosine_of(sine), eta = fibre->refraction,
           across = sqrt(eta * eta - sine * sine) / cosine, // Bravais' index
        gamma_i = asin(fmax(-1, fmin(offset, 1))), gamma_t = asin(sin(gamma_i) / across),
           chord = cos(gamma_t) / sqrt(1 - sine * sine / (eta * eta)),
           f = fresnel(eta, cosine * cos(gamma_i)), enters = (1 - f) * (1 - f);
    for (int c = 0; c < 3; ++c) {
        double left = pow(fibre->color[c], chord);
        beams.share[0][c] = f;
        beams.share[1][c] = enters * left;
        beams.share[2][c] = enters * f * left * left;
        beams.share[3][c] = enters * f * f * left * left * left / (1 - f * left);
    }
    for (int p = 0; p < FIBRE_BEAMS - 1; ++p)
        beams.azimuth[p] = 2 * p * gamma_t - 2 * gamma_i + p * M_PI;
    return beams;
}

// exp(-x) I0(x): the series, or for large x the asymptotic one (Abramowitz and Stegun 9.6.10,
// 9.7.1).
static double bessel(double x)
{
    double sum = 1, term = 1, inverse = 1 / (8 * x);
    if (x > 20) return (1 + inverse * (1 + inverse * (4.5 + inverse * 37.5))) / sqrt(2 * M_PI * x);
    for (int k = 1; k < 80 && term > 1e-17 * sum; ++k) sum += term *= x * x / 4 / k / k;
    return sum * exp(-x);
}

// d'Eon et al. 2011: exp(-s s'/v) I0(c c'/v) / (2 v sinh(1/v)).
static double find_along(double variance, double sine_a, double sine_b)
{
    double both = cosine_of(sine_a) * cosine_of(sine_b) / variance;
    return exp(both - (sine_a * sine_b + 1) / variance) * bessel(both) /
           (variance * (1 - exp(-2 / variance)));
}

static double variance_of(const FibreReference *fibre, int beam)
{
    return fibre->variance[beam < 2 ? beam : 2];
}

// The Gaussian around 0, wrapped around the circle.
static double find_around(double spread, double azimuth)
{
    double off = azimuth - 2 * M_PI * round(azimuth / (2 * M_PI)), sum = 0;
    for (int k = -1; k <= 1; ++k) {
        double z = (off + 2 * M_PI * k) / spread;
        sum += exp(-0.5 * z * z);
    }
    return sum / (spread * sqrt(2 * M_PI));
}

void fibre_reference_density(const FibreReference *fibre, const FibreBeams *beams, double sine,
                             double azimuth, double density[3])
{
    for (int c = 0; c < 3; ++c) density[c] = 0;
    for (int p = 0; p < FIBRE_BEAMS; ++p) {
        double here = find_along(variance_of(fibre, p), sine, beams->sine) *
                      (p < FIBRE_BEAMS - 1 ? find_around(fibre->spread, azimuth - beams->azimuth[p])
                                           : 1 / (2 * M_PI));
        for (int c = 0; c < 3; ++c) density[c] += here * beams->share[p][c];
    }
}

double fibre_reference_chance(const FibreBeams *beams, const double weight[3],
                              const double density[3])
{
    double here = 0, all = 0;
    for (int c = 0; c < 3; ++c) {
        here += weight[c] * density[c];
        for (int p = 0; p < FIBRE_BEAMS; ++p) all += weight[c] * beams->share[p][c];
    }
    return here / all;
}

static double draw_gauss(Random *random)
{
    double radius = sqrt(-2 * log(1 - random_real(random)));
    return radius * cos(2 * M_PI * random_real(random));
}

// find_along is the mean over the azimuth of a density on the sphere, exp(w / v) with w the cosine
// of the angle from the mirrored direction. w and the angle around this direction are drawn.
static double draw_sine(double variance, double sine, Random *random)
{
    double u = random_real(random), w = 1 + variance * log(u + (1 - u) * exp(-2 / variance)),
           off = sqrt(fmax(1 - w * w, 0)) * cos(2 * M_PI * random_real(random));
    return fmax(-1, fmin(off * cosine_of(sine) - w * sine, 1));
}

void fibre_reference_draw(const FibreReference *fibre, const FibreBeams *beams, Random *random,
                          double weight[3], double *sine, double *azimuth)
{
    double size[FIBRE_BEAMS] = {0}, all = 0;
    for (int p = 0; p < FIBRE_BEAMS; ++p) {
        for (int c = 0; c < 3; ++c) size[p] += weight[c] * beams->share[p][c];
        all += size[p];
    }
    int beam = 0;
    for (double at = random_real(random) * all; beam < FIBRE_BEAMS - 1 && at >= size[beam]; ++beam)
        at -= size[beam];
    for (int c = 0; c < 3; ++c) weight[c] *= beams->share[beam][c] * all / size[beam];
    *sine = draw_sine(variance_of(fibre, beam), beams->sine, random);
    *azimuth = beam < FIBRE_BEAMS - 1 ? beams->azimuth[beam] + fibre->spread * draw_gauss(random)
                                      : 2 * M_PI * random_real(random);
}
