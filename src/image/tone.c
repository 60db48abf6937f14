// SPDX-License-Identifier: MIT
#include "image/tone.h"

#include "glsl/common/shared_math.h"

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
