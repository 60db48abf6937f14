// SPDX-License-Identifier: MIT
// The block-list rasteriser's record of a ribbon: a line, a shape and a tint, each in a buffer of its
// own, since drivers limit a buffer's size.
//
//   line: x, y of its ends, px, as float bits
//   shape: half-widths at its ends (halves, px); bound at the first end, bound at the last (two halves
//      each); opacity, and 1/w at the last end less that at the first, over the mean (halves)
//   tint: colour at the first end and at the last, linear (six halves); 1/w, the mean
//
// Along the strand a ribbon has the share of a pixel that lies beyond its first end less the share
// beyond its last one. At a joint both ribbons have the same share, so that they cover all of the
// pixel together: beyond the joint lies what is on the positive side of its bound, the sum of both
// ribbons' directions, which is square to the mitre; a whole pixel by its middle, since two halves
// of a pixel that are laid over each other would cover less than the pixel. At a free end, and where
// a strand folds back, the bound is the ribbon's own direction, and the share is exact for ribbons
// along an axis: it grows evenly over the pixel's width. The bound's length tells which it is.

const float JOINT = 512.0; // length of a joint's bound, times 2 at most

struct Ribbon {
    vec2 a, b;       // ends, px
    vec2 half_width; // at each
    vec2 bound_a, bound_b;
};

Ribbon unpack_ribbon(uvec4 ends, uvec4 shape)
{
    return Ribbon(uintBitsToFloat(ends.xy), uintBitsToFloat(ends.zw), unpackHalf2x16(shape.x), unpackHalf2x16(shape.y),
                  unpackHalf2x16(shape.z));
}

bool bound_is_free(vec2 bound) { return dot(bound, bound) < 4.0; }

// The share beyond an end is clamp(distance along the bound + this, 0, 1).
float bound_offset(vec2 bound) { return bound_is_free(bound) ? 0.5 : 1.0; }

// A ribbon's span is what dealing it out to blocks needs, in blocks: where its strip's middle crosses
// the middle of the first row that it touches, and how far that moves from row to row (float bits);
// how far the strip reaches to either side, in SPAN_STEPS of a block; first and last row; first and
// last column. Rows and columns have SPAN_BITS, the reach has the other bits of both words.
const int SPAN_BITS = 13;
const float SPAN_STEPS = 32.0;
const int SPAN_REACH_BITS = 32 - SPAN_BITS * 2;
const int SPAN_REACH_MAX = (1 << SPAN_REACH_BITS * 2) - 1; // and any more

struct Span {
    float middle, slope, reach;
    int row, last_row, column, last_column;
};

uvec4 pack_span(Span s)
{
    int reach = s.reach * SPAN_STEPS < float(SPAN_REACH_MAX - 1) ? int(s.reach * SPAN_STEPS) + 1 : SPAN_REACH_MAX;
    int low = reach & ((1 << SPAN_REACH_BITS) - 1), high = reach >> SPAN_REACH_BITS;
    return uvec4(floatBitsToUint(s.middle), floatBitsToUint(s.slope),
                 uint(s.row | (s.last_row << SPAN_BITS) | (low << (2 * SPAN_BITS))),
                 uint(s.column | (s.last_column << SPAN_BITS) | (high << (2 * SPAN_BITS))));
}

Span unpack_span(uvec4 words)
{
    const int MASK = (1 << SPAN_BITS) - 1;
    ivec2 w = ivec2(words.zw);
    int low = int(words.z >> (2 * SPAN_BITS)), high = int(words.w >> (2 * SPAN_BITS));
    int reach = low | (high << SPAN_REACH_BITS);
    return Span(uintBitsToFloat(words.x), uintBitsToFloat(words.y),
                reach == SPAN_REACH_MAX ? 1e6 : float(reach) * (1.0 / SPAN_STEPS), w.x & MASK, (w.x >> SPAN_BITS) & MASK,
                w.y & MASK, (w.y >> SPAN_BITS) & MASK);
}
