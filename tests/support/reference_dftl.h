// SPDX-License-Identifier: MIT
// Dynamic follow-the-leader in double precision, one strand on the CPU, as the paper states it.
#pragma once

#include "support/twin.h"

// Mueller, Kim, Chentanez, "Fast Simulation of Inextensible Hair and Fur", VRIPHYS 2012, equations
// 4 to 10.
void reference_dftl_step(TwinStrand *strand, const TwinStep *step, const SectionParams *params);

// As `steady` does it: strand->v are the drawn strand's velocities, strand->carried[j] is what
// particle j gives back as a share of its follower's segment, 1/s.
void reference_dftl_guarded_step(TwinStrand *strand, const TwinStep *step,
                                 const SectionParams *params);
