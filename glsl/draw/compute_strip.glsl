// SPDX-License-Identifier: MIT
// The pixels that a ribbon may touch, from its record's line and span (block.glsl).

struct Strip {
    vec2 a; // a point of its middle line, px
    float slope, reach;
    ivec2 rows; // first, last
    vec2 columns;
};

Strip make_strip(uvec2 line, uvec4 span)
{
    vec2 slope_reach = uintBitsToFloat(span.xy);
    return Strip(uintBitsToFloat(line), slope_reach.x, slope_reach.y,
                 ivec2(span.z & 0xffffu, span.z >> 16), vec2(span.w & 0xffffu, span.w >> 16) + 0.5);
}

// The first and the last column that the ribbon may touch in rows top .. bottom, which must be
// among its own rows. If the last is less than the first, it touches none.
ivec2 strip_columns(Strip s, int top, int bottom)
{
    float middle = s.a.x + (0.5 * float(top + bottom + 1) - s.a.y) * s.slope,
          reach = s.reach + 0.5 * float(bottom - top) * abs(s.slope),
          low = max(middle - reach, s.columns.x), high = min(middle + reach, s.columns.y);
    return low <= high ? ivec2(int(low), int(high)) : ivec2(0, -1);
}
