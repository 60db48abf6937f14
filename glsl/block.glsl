// SPDX-License-Identifier: MIT
// The block-list rasteriser's records: a ribbon each, three texels.
//
//   0: x, y of its ends, px, as float bits
//   1: half-widths at its ends (halves, px); bound at the first end, bound at the last (two halves
//      each); opacity, and 1/w at the last end less that at the first, over the mean (halves)
//   2: colour at the first end and at the last, linear (six halves); 1/w, the mean
//
// A bound is the sum of the directions of both ribbons at a joint, which is square to the mitre: a
// ribbon has the pixels whose middles lie on its side. Both ribbons at the joint have the same end
// and the same bound, bit for bit, and so find the same sign: no pixel is taken twice, none is left.
// At a free end, and where a strand folds back, the bound is the ribbon's own direction.

#define RECORD_TEXELS 3

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
