// SPDX-License-Identifier: MIT
// The spring of stiffness k = style_stiffness style/(1 - style) that draws particles to the style.
// step_style_spring (step.c) fills it; each solver reads the form that its rule needs.
#ifdef __STDC__
#pragma once
typedef struct StyleSpring StyleSpring;
#endif

struct StyleSpring {
    // k, 1/s^2
    float stiffness;
    // Implicit in the position: the predicted x* and the style's place s give x* + w (s - x) = x,
    // that is x = x* + pull (s - x*), pull = w/(1 + w) in 0 .. 1, w = k dt h f. Stable at any k.
    float pull;
    // Implicit in the velocity, for half a step (midpoint.glsl): keep v - draw (x - s); draw in 1/s
    float keep;
    float draw;
};
