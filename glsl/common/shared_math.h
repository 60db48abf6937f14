// SPDX-License-Identifier: MIT
// Arithmetic that both C and GLSL need. Each formula and constant is here once, in the common
// subset of the two languages. Literals in functions end in f; constants are double in C, for
// reference code. In C the functions are inlined into loops over lanes that are vectorised, so they
// must not branch.
#ifdef __STDC__
#pragma once
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>
typedef uint32_t uint;
#define SHARED_FUNCTION static inline __attribute__((always_inline))
#define FLOAT(x)        ((float)(x))
#define INT(x)          ((int)(x))
#define UINT(x)         ((uint)(x))
#define SHARED_SQRT     sqrtf
#define SHARED_ABS      fabsf
// A struct of scalars: SHARED_STRUCT(Name) { ... };
#define SHARED_STRUCT(name)                                                                        \
    typedef struct name name;                                                                      \
    struct name
SHARED_FUNCTION float SHARED_MAX(float a, float least) // returns `least` if a is NaN
{
    return a > least ? a : least;
}
SHARED_FUNCTION float SHARED_MIN(float a, float most) { return a < most ? a : most; }
// 2^x for -2^31 < x <= 0, at least 2^-126. The fraction, -1/2 .. 1/2, goes through a Taylor series
// to the sixth power (error 1.2e-7), the integer part becomes the exponent bits. (Clamping x itself
// would be a branch, which keeps compilers from vectorising the loop.)
SHARED_FUNCTION float SHARED_EXP2(float x)
{
    int whole = (int)(x - 0.5f), bounded = whole > -126 ? whole : -126;
    float f = (x - (float)whole) * 0.693147181f;
    float power =
        1 + f * (1 + f * (0.5f + f * (1.f / 6 + f * (1.f / 24 + f * (1.f / 120 + f / 720)))));
    union {
        int bits;
        float value;
    } exponent = {.bits = (bounded + 127) * (1 << 23)};
    return power * exponent.value;
}
SHARED_FUNCTION float FLOAT_OF_BITS(uint bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}
SHARED_FUNCTION uint BITS_OF_FLOAT(float value)
{
    uint bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}
#else
#define SHARED_FUNCTION
#define FLOAT(x)            float(x)
#define INT(x)              int(x)
#define UINT(x)             uint(x)
#define SHARED_SQRT         sqrt
#define SHARED_ABS          abs
#define SHARED_EXP2         exp2
#define SHARED_STRUCT(name) struct name
#define SHARED_MAX          max
#define SHARED_MIN          min
#define FLOAT_OF_BITS       uintBitsToFloat
#define BITS_OF_FLOAT       floatBitsToUint
#endif

#define PI    3.14159265358979323846
#define LOG2E 1.44269504 // exp(x) = exp2(LOG2E * x)

// --- Tone curves, from the light of one channel (>= 0) to a linear colour value.

// Reinhard et al. 2002, equation 4: a light of TONE_WHITE becomes 1.
#define TONE_WHITE 4.0

SHARED_FUNCTION float tone_reinhard(float c)
{
    c = SHARED_MAX(c, 0.0f);
    return c * (1.0f + c / FLOAT(TONE_WHITE * TONE_WHITE)) / (1.0f + c);
}

// K. Narkowicz's fit (2015) of the Academy's filmic curve, (A c^2 + B c) / (C c^2 + D c + E).
#define FILMIC_A 2.51
#define FILMIC_B 0.03
#define FILMIC_C 2.43
#define FILMIC_D 0.59
#define FILMIC_E 0.14

SHARED_FUNCTION float tone_filmic(float c)
{
    c = SHARED_MAX(c, 0.0f);
    return c * (FLOAT(FILMIC_A) * c + FLOAT(FILMIC_B)) /
           (c * (FLOAT(FILMIC_C) * c + FLOAT(FILMIC_D)) + FLOAT(FILMIC_E));
}

// A tone-mapped colour over a plain background, of which `share` is seen. A display cannot show
// more than white, so the colour is clipped before it is mixed, as in a transparent image.
SHARED_FUNCTION float tone_over(float shown, float background, float share)
{
    shown = SHARED_MIN(shown, 1.0f);
    return shown + share * (background - shown);
}

// --- sRGB (IEC 61966-2-1): value = SRGB_SLOPE linear up to SRGB_KNEE, then
// (1 + SRGB_OFFSET) linear^(1 / SRGB_POWER) - SRGB_OFFSET.
#define SRGB_KNEE     0.0031308 // linear
#define SRGB_KNEE_OUT 0.04045   // the same point in sRGB
#define SRGB_SLOPE    12.92
#define SRGB_OFFSET   0.055
#define SRGB_POWER    2.4

#ifdef __STDC__
static inline double srgb_decode(double value)
{
    return value <= SRGB_KNEE_OUT ? value / SRGB_SLOPE
                                  : pow((value + SRGB_OFFSET) / (1 + SRGB_OFFSET), SRGB_POWER);
}

static inline double srgb_encode(double linear)
{
    return linear <= SRGB_KNEE ? SRGB_SLOPE * linear
                               : (1 + SRGB_OFFSET) * pow(linear, 1 / SRGB_POWER) - SRGB_OFFSET;
}

// In float arithmetic. The colours of scenes have always been computed this way, so images depend
// on it.
static inline float linear_from_srgb(float value)
{
    return value <= FLOAT(SRGB_KNEE_OUT)
               ? value / FLOAT(SRGB_SLOPE)
               : powf((value + FLOAT(SRGB_OFFSET)) / FLOAT(1 + SRGB_OFFSET), FLOAT(SRGB_POWER));
}

static inline void linear_from_srgb_color(const float srgb[3], float linear[3])
{
    for (int k = 0; k < 3; ++k) linear[k] = linear_from_srgb(srgb[k]);
}
#endif

// Drivers' own conversions are not used, because some are approximate. pow would cost a CPU driver
// as much as a dozen ribbons. Instead, the curve from SRGB_KNEE to 1 is a sum of c and three roots,
// fitted by Remez' exchange algorithm; the error is at most 0.012 of one of 255 levels.
SHARED_FUNCTION float srgb_from_linear(float c)
{
    c = SHARED_MIN(SHARED_MAX(c, 0.0f), 1.0f);
    float root2 = SHARED_SQRT(c), root4 = SHARED_SQRT(root2), root8 = SHARED_SQRT(root4);
    float curve =
        0.64236677f * root2 + 0.71210915f * root4 - 0.33686939f * root8 - 0.017563495f * c;
    return c <= FLOAT(SRGB_KNEE) ? FLOAT(SRGB_SLOPE) * c : curve;
}

// --- Levels: numbers >= 0 in 16 bits, two a word. Six bits of a float's exponent, from 2^-40
// (which is 0, too), and ten of its mantissa, as many as a half has; a CPU unpacks them in a few
// operations, a half takes it a dozen and a half.
#define LEVEL_LEAST ((127u - 40u) << 23) // as float bits

SHARED_FUNCTION uint pack_level(float value)
{
    value = SHARED_MIN(SHARED_MAX(value, FLOAT_OF_BITS(LEVEL_LEAST)), 65504.0f);
    return (BITS_OF_FLOAT(value) - LEVEL_LEAST + 0x1000u) >> 13;
}

SHARED_FUNCTION float low_level(uint word)
{
    return FLOAT_OF_BITS(((word & 0xffffu) << 13) + LEVEL_LEAST);
}

SHARED_FUNCTION float high_level(uint word)
{
    return FLOAT_OF_BITS(((word >> 16) << 13) + LEVEL_LEAST);
}

// --- Deep opacity maps (Yuksel and Keyser 2008). Layers follow the first depth and grow thicker
// behind it, since light changes most where it comes in.
#define SHADOW_LAYERS 16
#define LAYER_END     (FLOAT(SHADOW_LAYERS) - 1e-3f) // the last place among them

// Place among the layers, 0 .. LAYER_END, at the depth `behind` (share of all depth) the first.
SHARED_FUNCTION float layer_of(float behind)
{
    return SHARED_MIN(FLOAT(SHADOW_LAYERS) * SHARED_SQRT(SHARED_MAX(behind, 0.0f)), LAYER_END);
}

// Mean number of fibres that block light before a layer and in it, in 16 bits each: steps of 2^-12,
// which no light differs by more than 1e-4 in, up to 16, behind which it is dark. (Halves take CPU
// drivers longer.)
#define LAYER_STEPS 4096.0f

SHARED_FUNCTION uint pack_layer(float before, float own)
{
    return UINT(INT(SHARED_MIN(before * LAYER_STEPS + 0.5f, 65535.0f))) |
           (UINT(INT(SHARED_MIN(own * LAYER_STEPS + 0.5f, 65535.0f))) << 16);
}

// The same before a place in a packed layer, `share` of which lies before it.
SHARED_FUNCTION float layer_depth(uint bits, float share)
{
    return (FLOAT(INT(bits & 0xffffu)) + share * FLOAT(INT(bits >> 16))) * (1.0f / LAYER_STEPS);
}

// A texel holds the mean number of fibres that light meets on its way through it: each fibre adds
// its opacity times the share of the texel that it covers. Fibres at random places leave
// exp(-number) of the light (Poisson). (Not the logarithm of what a texel's own fibres leave: a
// fibre as wide as a texel would darken all of its neighbours.) A ribbon of many texels does not
// lie at random: it takes its opacity, exactly.
#define RESOLVED_FROM 6.0f // texels: width from which a ribbon counts as such ...
#define RESOLVED_OVER 6.0f // ... the more, up to so much more

// -ln x for 1e-3 <= x <= 1: ln(2^e m) = e ln 2 + 2 artanh((m - 1) / (m + 1)), with m within
// sqrt(1/2) .. sqrt(2) by the series to the ninth power (1e-9 off).
SHARED_FUNCTION float minus_log(float x)
{
    int bits = INT(BITS_OF_FLOAT(x)), exponent = (bits - 0x3f3504f3) >> 23;
    float mantissa = FLOAT_OF_BITS(UINT(bits - exponent * 0x800000)),
          t = (mantissa - 1.0f) / (mantissa + 1.0f), s = t * t;
    float series = 1.0f + s * (0.33333333f + s * (0.2f + s * (0.14285714f + s * 0.11111111f)));
    return -(FLOAT(exponent) * 0.693147181f + 2.0f * t * series);
}

// x^power for 0 <= x <= 1 and power >= 0; 2^-60 where it is less. (Drivers have their own.)
#ifdef __STDC__
SHARED_FUNCTION float SHARED_POW(float x, float power)
{
    return SHARED_EXP2(-FLOAT(LOG2E) * power * minus_log(SHARED_MAX(x, 1e-30f)));
}
#else
#define SHARED_POW pow
#endif

// What a fibre adds where it covers a texel. `width`: texels.
SHARED_FUNCTION float fibre_depth(float opacity, float width)
{
    float resolved =
        SHARED_MIN(SHARED_MAX((width - RESOLVED_FROM) * (1.0f / RESOLVED_OVER), 0.0f), 1.0f);
    float exact = minus_log(SHARED_MAX(1.0f - opacity, 1e-3f));
    return opacity + resolved * (exact - opacity);
}

// A fibre is in the map itself, smeared over the texels beside it and its layer's depth. Where it
// lies it finds OWN_SHARE of a thin one of its width (texels): the middle of a line that is laid
// into texels, smoothed by 1 2 1 and read between four of them, in the mean over where it crosses
// them; of a wide one all. `share`: of the layer before the fibre.
#define OWN_SHARE 0.4375f

SHARED_FUNCTION float own_layer_depth(float width, float opacity, float share)
{
    return share * fibre_depth(opacity, width) * SHARED_MIN(OWN_SHARE * width, 1.0f);
}
