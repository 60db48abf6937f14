// SPDX-License-Identifier: MIT
// The implicit spring towards the style: with the predicted position x* and stiffness k (1/s^2), x = x* + w (style - x), w = k dt h f, is
// solved for x = (x* + w style)/(1 + w) = x* + b (style - x*), b = w/(1 + w) in 0 .. 1: stable at any stiffness (needs particles.glsl).
#define STYLE_PULL step_params.own[0].x // b

// A particle of the style after another, from the root on: where the head carries it, relative to the root.
vec3 next_style(vec3 before, vec4 rest, vec4 rotation) { return before + rest.w * rotate(rotation, rest.xyz); }
