// SPDX-License-Identifier: MIT
// The compute rasteriser's record of a ribbon: RIBBON_TEXELS uvec4.
//
//   line: x, y of its ends, px, as float bits
//   shape: half-widths at its ends (px, levels); bound at the first end, bound at the last (two
//      shorts each); opacity (12 bits), and 1/w at the last end less that at the first, over the
//      mean (a float's upper 20 bits)
//   tint: colour at the first end and at the last, linear (six levels); 1/w, the mean
//   span: which pixels it may touch: slope and reach (float bits), rows, columns
//      (first | last << 16), px; the strip's middle moves by `slope` from row to row and it reaches
//      so far to either side
//
// At an end, a ribbon's share of a pixel is the share beyond its first end minus the share beyond
// its last end. At a joint both ribbons use the same share, so together they cover the whole pixel.
// The part beyond a joint is the positive side of its bound, which is the sum of both directions
// and perpendicular to the mitre. A whole pixel counts there, by its centre, because two blended
// halves of a pixel would cover less than the pixel. At a free end, and where a strand folds back,
// the bound is the ribbon's own direction, and the share is exact for ribbons along an axis: it
// grows linearly over the pixel's width. The length of the bound tells the two cases apart.

// Two numbers share a word. They are either levels, which are not negative (shared_math.h), or
// shorts, the upper half of a float.
#include "kernel/ribbon.h"

uint pack_levels(vec2 v) { return pack_level(v.x) | (pack_level(v.y) << 16); }

uint pack_shorts(RibbonBound bound)
{
    uvec2 bits = floatBitsToUint(vec2(bound.x, bound.y)) + 0x8000u;
    return (bits.x >> 16) | (bits.y & 0xffff0000u);
}

// Opacity and the change of 1/w share a word.
uint pack_depth(float opacity, float change)
{
    return uint(int(clamp(opacity, 0.0, 1.0) * 4095.0 + 0.5)) |
           ((floatBitsToUint(change) + 0x800u) & 0xfffff000u);
}

RibbonBound unpack_shorts(uint word)
{
    vec2 bound = uintBitsToFloat(uvec2(word << 16, word & 0xffff0000u));
    return RibbonBound(bound.x, bound.y, dot(bound, bound) < 4.0 ? 0.5 : 1.0);
}

struct Span {
    float slope, reach;
    ivec4 box; // px: first column and row, last column and row
};

uvec4 pack_span(Span s)
{
    return uvec4(floatBitsToUint(vec2(s.slope, s.reach)), uvec2(s.box.yx | (s.box.wz << 16)));
}
