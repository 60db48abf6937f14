// SPDX-License-Identifier: MIT
#include "strands/fibre.h"

#include <math.h>

static const double FIBRE_LAYERS = 3;
static const double THINNEST = 1.0 / 5000, THICKEST = 1.0 / 400;

float fibre_auto_radius(const Strands *strands, uint32_t followers)
{
    float low[3], high[3];
    strands_bounds(strands, low, high);
    double x = (double)high[0] - low[0], y = (double)high[1] - low[1], z = (double)high[2] - low[2];
    double silhouette = (x * y + y * z + z * x) / 2, total = 0, longest = 0;
    for (uint32_t s = 0; s < strands->strand_count; ++s) {
        double length = strands_length(strands, s);
        total += length;
        longest = fmax(longest, length);
    }
    total *= 1 + (double)followers;
    if (!(total > 0)) return 1e-4f; // nothing to draw
    double radius = FIBRE_LAYERS * silhouette / (2 * total);
    return (float)fmin(fmax(radius, longest * THINNEST), longest * THICKEST);
}

float fibre_radius(const SectionParams *params, const Strands *strands, uint32_t followers)
{
    return params->radius.automatic ? fibre_auto_radius(strands, followers) : params->radius.value;
}
