// SPDX-License-Identifier: MIT
// Hybrid and emulation in double precision, one strand on the CPU.
#pragma once

#include "support/twin.h"

// TwinFunctions: the rules in docs/solver_derivations.md, and the published rule of emulation.
void reference_hybrid_step(TwinStrand *strand, const TwinStep *step, const SectionParams *params);
void reference_emulation_step(TwinStrand *strand, const TwinStep *step,
                              const SectionParams *params);
void reference_thesis_emulation_step(TwinStrand *strand, const TwinStep *step,
                                     const SectionParams *params);
