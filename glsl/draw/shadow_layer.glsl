// SPDX-License-Identifier: MIT
// The layers of a deep opacity map (Yuksel and Keyser 2008): they follow the first depth and grow thicker
// behind it, since light changes most where it comes in (needs shadow.h).

// Place among the layers, 0 .. SHADOW_LAYERS, at the depth `behind` (share of all depth) the first.
float layer_of(float behind)
{
    return min(float(SHADOW_LAYERS) * sqrt(max(behind, 0.0)), float(SHADOW_LAYERS) - 1e-3);
}

// Optical depth before a layer and its own, in 16 bits each: steps of 2^-12, which no light differs by more than 1e-4
// in, up to 16, behind which it is dark. (Halves take CPU drivers longer.)
const float LAYER_STEPS = 4096.0;

uint pack_layer(vec2 depth)
{
    ivec2 steps = ivec2(min(depth * LAYER_STEPS + 0.5, 65535.0));
    return uint(steps.x | steps.y << 16);
}

vec2 unpack_layer(uint bits)
{
    return vec2(ivec2(bits & 0xffffu, bits >> 16)) * (1.0 / LAYER_STEPS);
}
