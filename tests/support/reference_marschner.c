// SPDX-License-Identifier: MIT
#include "support/reference_marschner.h"

#include <math.h>

#define PI 3.14159265358979323846

// Fresnel's unpolarised reflectance at the cosine of the angle of incidence.
static double fresnel(double eta, double cosine)
{
    double inside = sqrt(1 - (1 - cosine * cosine) / (eta * eta));
    double s = (cosine - eta * inside) / (cosine + eta * inside),
           p = (eta * cosine - inside) / (eta * cosine + inside);
    return (s * s + p * p) / 2;
}

static double wrapped_gauss(double x, double width)
{
    double sum = 0;
    x = remainder(x, 2 * PI);
    for (int k = -3; k <= 3; ++k) sum += exp(-pow((x + 2 * PI * k) / width, 2) / 2);
    return sum / (width * sqrt(2 * PI));
}

void marschner_azimuthal(double eta, double roughness, double cos_d, double color, double phi,
                         int steps, double density[LOBE_COUNT])
{
    double sin2_d = 1 - cos_d * cos_d, eta_d = sqrt(eta * eta - sin2_d) / cos_d;
    double cos_t = sqrt(1 - sin2_d / (eta * eta)), step = PI / steps;
    for (int p = 0; p < LOBE_COUNT; ++p) density[p] = 0;
    for (int i = 0; i < steps; ++i) {
        // h = sin(gamma_i); 1/2 dh is the share of the light that enters there.
        double gamma_i = (i + 0.5) * step - PI / 2, gamma_t = asin(sin(gamma_i) / eta_d);
        double share = cos(gamma_i) * step / 2, f = fresnel(eta, cos_d * cos(gamma_i));
        double through = pow(color, cos(gamma_t) / cos_t);
        double out[LOBE_COUNT] = {f, (1 - f) * (1 - f) * through,
                                  (1 - f) * (1 - f) * f * through * through};
        for (int p = 0; p < LOBE_COUNT; ++p)
            density[p] += share * out[p] *
                          wrapped_gauss(phi - (2 * p * gamma_t - 2 * gamma_i + p * PI), roughness);
        density[LOBE_TRT] += share * out[LOBE_TRT] * f * through / (1 - f * through) / (2 * PI);
    }
}

// exp(-x) I0(x), from the integral that defines I0.
static double bessel_i0_scaled(double x)
{
    const int steps = 2000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) sum += exp(x * (cos(PI * (i + 0.5) / steps) - 1));
    return sum / steps;
}

double marschner_longitudinal(double theta_i, double theta_r, double tilt, double beta)
{
    double v = 4 * beta * beta, t = theta_r - 2 * tilt;
    double c = fabs(cos(theta_i) * cos(t)), s = sin(theta_i) * sin(t);
    return exp((c - s - 1) / v) * bessel_i0_scaled(c / v) / (v * (1 - exp(-2 / v)));
}

double marschner_gauss(double theta_i, double theta_r, double tilt, double beta)
{
    double off = ((theta_i + theta_r) / 2 - tilt) / beta, cos_d = cos((theta_r - theta_i) / 2);
    return exp(-off * off / 2) / (2 * beta * sqrt(2 * PI)) * cos(theta_i) / (cos_d * cos_d);
}
