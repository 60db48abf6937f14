// SPDX-License-Identifier: MIT
// The colour, thickness and opacity of a strand's particles (needs draw.h, material.h, hash.h).
//   PAINT 0: the section's   1: by particle, see look_paint
#if PAINT
layout(binding = BIND_PAINT) uniform usamplerBuffer paint;
#endif

// A local copy, because each use of a uniform costs a load.
struct Painter {
    uint id;
    vec3 tint;    // PAINT 0: the strand's colour; 1: a factor for its colours
    float radius; // m
    float thinning;
};

// Strands differ in brightness, and in red against blue.
Painter paint_strand(uint id, int n)
{
    float warmth = material.warmth_variation * hash_signed((id ^ draw_params.seed) + 0x9e3779b9u);
    float brightness = 1.0 + material.color_variation * hash_signed(id ^ draw_params.seed);
    vec3 tint = brightness * vec3(1.0 + warmth, 1.0, 1.0 - warmth);
#if !PAINT
    tint *= material.color.rgb;
#endif
    return Painter(id, tint, material.radius, (1.0 - material.tip_ratio) / float(n - 1));
}

// The colour of particle j, which lies at `at`, or of a place between it and the next.
vec3 paint_color(Painter p, int at)
{
#if PAINT
    uvec2 texel = texelFetch(paint, at).xy;
    return p.tint * vec3(unpackUnorm2x16(texel.x), unpackUnorm2x16(texel.y).x);
#else
    return p.tint;
#endif
}

float paint_radius(Painter p, int at, float j)
{
#if PAINT
    float share = uintBitsToFloat(texelFetch(paint, at).z);
#if SMOOTH
    if (fract(j) > 0.0)
        share = mix(share, uintBitsToFloat(texelFetch(paint, at + STRAND_TILE).z), fract(j));
#endif
#else
    float share = 1.0 - p.thinning * j;
#endif
    return max(p.radius * share, 1e-9);
}

// A factor for all opacities of the strand whose root lies at `root`.
float paint_opacity_share(int root)
{
#if PAINT
    return unpackUnorm2x16(texelFetch(paint, root).y).y;
#else
    return 1.0;
#endif
}

float paint_opacity(int root) { return material.opacity * paint_opacity_share(root); }
