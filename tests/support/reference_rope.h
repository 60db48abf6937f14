// SPDX-License-Identifier: MIT
// Position-based rope in double precision, one strand on the CPU.
#pragma once

#include "support/twin.h"

// Bullet: all sweeps at the end of one step, each link by Bullet's formula
// (btSoftBody::PSolve_Links).
void reference_rope_bullet_step(TwinStrand *strand, const TwinStep *step,
                                const SectionParams *params);

// XPBD: as many small steps as sweeps, each with one sweep.
void reference_rope_xpbd_step(TwinStrand *strand, const TwinStep *step,
                              const SectionParams *params);
