// SPDX-License-Identifier: MIT
#include "image/tone.h"

#include <math.h>

static const double WHITE = 4; // reinhard's: light of this becomes 1

double tone_map(Tone tone, double light)
{
    switch (tone) {
    case TONE_REINHARD:
        return light * (1 + light / (WHITE * WHITE)) / (1 + light);
    case TONE_FILMIC:
        return light * (2.51 * light + 0.03) / (light * (2.43 * light + 0.59) + 0.14);
    case TONE_NONE:
        break;
    }
    return light;
}

// The positive root of tone_map(light) = value, a quadratic a light^2 + b light + c = 0 with a > 0
// >= c.
double tone_unmap(Tone tone, double value)
{
    double a, b, c;
    switch (tone) {
    case TONE_REINHARD:
        a = 1 / (WHITE * WHITE), b = 1 - value, c = -value;
        break;
    case TONE_FILMIC:
        a = 2.51 - 2.43 * value, b = 0.03 - 0.59 * value, c = -0.14 * value;
        break;
    default:
        return value;
    }
    return (-b + sqrt(b * b - 4 * a * c)) / (2 * a);
}
