// SPDX-License-Identifier: MIT
#include "bench/bench_fit.h"

#include <math.h>

double fit_exponent(const double *x, const double *y, int count, double *spread)
{
    double u = 0, w = 0, uu = 0, uw = 0, ww = 0;
    for (int i = 0; i < count; ++i) {
        double a = log(x[i]), b = log(y[i]);
        u += a, w += b, uu += a * a, uw += a * b, ww += b * b;
    }
    *spread = NAN;
    if (count < 2) return 0;
    uu -= u * u / count, uw -= u * w / count, ww -= w * w / count;
    if (!(uu > 0)) return 0;
    if (count > 2) *spread = sqrt(fmax(ww - uw * uw / uu, 0) / (count - 2) / uu);
    return uw / uu;
}
