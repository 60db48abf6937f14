// SPDX-License-Identifier: MIT
// IEC 61966-2-1. Not the driver's own conversion: some approximate it.

vec3 srgb_from_linear(vec3 c)
{
    c = clamp(c, 0.0, 1.0);
    return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}
