// SPDX-License-Identifier: MIT
// TressFX's solver in double precision, for one strand on the CPU, written from the definitions
// (docs/solver_derivations.md) and not from the shader: in world coordinates, with rotations by
// axis and angle, and linear systems solved by dense elimination.
#pragma once

#include "support/twin.h"

// TwinFunctions.
void reference_tressfx_steady(TwinStrand *strand, const TwinStep *step,
                              const SectionParams *params);
void reference_tressfx_4(TwinStrand *strand, const TwinStep *step, const SectionParams *params);
