// SPDX-License-Identifier: MIT
#include "image/tone.h"

#include "glsl/common/shared_math.h"

#include <math.h>

double tone_map(Tone tone, double light)
{
    switch (tone) {
    case TONE_REINHARD:
        return light * (1 + light / (TONE_WHITE * TONE_WHITE)) / (1 + light);
    case TONE_FILMIC:
        return light * (FILMIC_A * light + FILMIC_B) /
               (light * (FILMIC_C * light + FILMIC_D) + FILMIC_E);
    case TONE_NONE:
        break;
    }
    return light;
}

// The positive root of tone_map(light) = value. It is a quadratic equation a light^2 + b light + c
// = 0 with a > 0 >= c.
double tone_unmap(Tone tone, double value)
{
    double a, b, c;
    switch (tone) {
    case TONE_REINHARD:
        a = 1 / (TONE_WHITE * TONE_WHITE), b = 1 - value, c = -value;
        break;
    case TONE_FILMIC:
        a = FILMIC_A - FILMIC_C * value, b = FILMIC_B - FILMIC_D * value, c = -FILMIC_E * value;
        break;
    default:
        return value;
    }
    return (-b + sqrt(b * b - 4 * a * c)) / (2 * a);
}
