// SPDX-License-Identifier: MIT
// TressFX's solver in double precision, one strand on the CPU, written from the definitions
// (docs/solver_derivations.md) and not from the shader: in world coordinates, rotations by axis and
// angle, linear systems by dense elimination.
#pragma once

#include "support/twin.h"

// Are TwinFunctions.
void reference_tressfx_steady(TwinStrand *strand, const TwinStep *step,
                              const SectionParams *params);
void reference_tressfx_4(TwinStrand *strand, const TwinStep *step, const SectionParams *params);
