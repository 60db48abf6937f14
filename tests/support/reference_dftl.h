// SPDX-License-Identifier: MIT
// Dynamic follow-the-leader in double precision, for one strand on the CPU, as stated in the paper.
#pragma once

#include "support/twin.h"

// Mueller, Kim, Chentanez, "Fast Simulation of Inextensible Hair and Fur", VRIPHYS 2012, equations
// 4 to 10.
void reference_dftl_step(TwinStrand *strand, const TwinStep *step, const SectionParams *params);

// The variant `steady`. strand->v are the drawn strand's velocities; strand->carried[j] is the
// share of its follower's segment that particle j gives back, 1/s.
void reference_dftl_guarded_step(TwinStrand *strand, const TwinStep *step,
                                 const SectionParams *params);
