// SPDX-License-Identifier: MIT
#include "scene/turntable.h"

#include <math.h>

// Integral of 3 s^2 - 2 s^3 from 0 to s.
static double eased(double s)
{
    return s * s * s - 0.5 * s * s * s * s;
}

// The share of the turn that is made after the share u of the sequence. With the full speed v, an
// ease-in of length a comes v a/2 far, an ease-out of length b v b/2, what is between
// v (1 - a - b), together 1.
static double turned(double u, double a, double b)
{
    double v = 1 / (1 - 0.5 * (a + b));
    if (u < a) return v * a * eased(u / a);
    if (u > 1 - b) return 1 - v * b * eased((1 - u) / b);
    return v * (u - 0.5 * a);
}

double turntable_angle_deg(const RunParams *run, int frame)
{
    int rounds = frame / run->frames;
    double u = (double)(frame % run->frames) / run->frames;
    double share = turned(u, (double)run->ease_in, (double)run->ease_out);
    return fmod((double)run->turntable * (rounds + share), 360);
}
