// SPDX-License-Identifier: MIT
// The layers of a deep opacity map (Yuksel and Keyser 2008): they follow the first depth and grow thicker
// behind it, since light changes most where it comes in (needs shadow.h).

// Place among the layers, 0 .. SHADOW_LAYERS, at the depth `behind` (share of all depth) the first.
float layer_of(float behind)
{
    return min(float(SHADOW_LAYERS) * sqrt(max(behind, 0.0)), float(SHADOW_LAYERS) - 1e-3);
}
