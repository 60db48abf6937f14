// SPDX-License-Identifier: MIT
// The double-precision twin of chain's bending and twist (glsl/sim/bend.glsl has the derivation).
#pragma once

#include "support/twin.h"

// K for these parameters, m/s^2.
double reference_bend_stiffness(const SectionParams *params);

// The energy of a strand with segments r[1 .. n-1] for K = 1, style in the head's frame.
// `gradient`, if not NULL, gets the derivative by the segments.
double reference_bend_energy(const TwinStrand *strand, const HeadPose *head, const Vec *r,
                             Vec *gradient);
