// SPDX-License-Identifier: MIT
// Imitates a driver with other rounding, for tests (gpu/assume.h). The results of functions for
// which GLSL 4.30 permits errors are moved by ULPS units in the last place; a hash of the argument
// decides whether up or down. This file is included first, so that shaders need no changes.
float perturbed(float y, float x)
{
    uint hash = floatBitsToUint(x) * 2654435761u;
    int step = (hash >> 31) != 0u ? ULPS : -ULPS;
    // 0, 1, infinities and NaN stay, because they are exact on every driver.
    return abs(y) > 1e-30 && abs(y) < 1e30 && y != 1.0 ? intBitsToFloat(floatBitsToInt(y) + step)
                                                       : y;
}

#define PERTURB(name)                                                                              \
    float perturbed_##name(float x) { return perturbed(name(x), x); }                              \
    vec2 perturbed_##name(vec2 x) { return vec2(perturbed_##name(x.x), perturbed_##name(x.y)); }   \
    vec3 perturbed_##name(vec3 x) { return vec3(perturbed_##name(x.xy), perturbed_##name(x.z)); }  \
    vec4 perturbed_##name(vec4 x) { return vec4(perturbed_##name(x.xy), perturbed_##name(x.zw)); }

PERTURB(sqrt)
PERTURB(inversesqrt)
PERTURB(exp)
PERTURB(exp2)
PERTURB(log)
PERTURB(log2)
PERTURB(sin)
PERTURB(cos)
PERTURB(asin)
PERTURB(acos)

#define sqrt        perturbed_sqrt
#define inversesqrt perturbed_inversesqrt
#define exp         perturbed_exp
#define exp2        perturbed_exp2
#define log         perturbed_log
#define log2        perturbed_log2
#define sin         perturbed_sin
#define cos         perturbed_cos
#define asin        perturbed_asin
#define acos        perturbed_acos
