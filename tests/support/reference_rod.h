// SPDX-License-Identifier: MIT
// A step of `rod` in double precision, by the equations of glsl/sim/rod.comp, with dense matrices.
// The style is the natural shape (gravity at rest is 0).
#pragma once

#include "support/twin.h"

void reference_rod_step(TwinStrand *strand, const TwinStep *step, const SectionParams *params);

// Energy of the joints of the strand at x (m^3/s^2), with the head at `head`. `gradient`: its
// derivative by x, twist at its minimum; or NULL.
double reference_rod_energy(const TwinStrand *strand, const HeadPose *head,
                            const SectionParams *params, Vec *gradient);

// Turns the twist of each joint to the minimum of the energy, by up to `rounds` rounds.
void reference_rod_untwist(TwinStrand *strand, const HeadPose *head, const SectionParams *params,
                           int rounds);
