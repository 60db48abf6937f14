// SPDX-License-Identifier: MIT
// IEC 61966-2-1. Not the driver's own conversion: some approximate it. Nor pow, which costs CPU
// drivers as much as a dozen ribbons: 1.055 c^(1/2.4) - 0.055 from 0.0031308 to 1 as a sum of c and
// three roots, by Remez' exchange; it is off by 0.012 of one of 255 levels at most.

vec3 srgb_from_linear(vec3 c)
{
    c = clamp(c, 0.0, 1.0);
    vec3 root2 = sqrt(c), root4 = sqrt(root2), root8 = sqrt(root4);
    vec3 curve = 0.64236677 * root2 + 0.71210915 * root4 - 0.33686939 * root8 - 0.017563495 * c;
    return mix(curve, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}
