// SPDX-License-Identifier: MIT
// Mass-spring strands in double precision, for one strand on the CPU, with absolute positions and a
// banded solver instead of the shader's links and block elimination.
#pragma once

#include "support/twin.h"

// Backward Euler, linearised at the start of the step.
void reference_spring_implicit_step(TwinStrand *strand, const TwinStep *step,
                                    const SectionParams *params);

// Symplectic Euler with as many sub-steps as the solver takes.
void reference_spring_explicit_step(TwinStrand *strand, const TwinStep *step,
                                    const SectionParams *params);
