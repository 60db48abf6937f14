// SPDX-License-Identifier: MIT
// States of the plain float64 implementation of several solvers after 1 to 600 steps
// (tests/data/traces.json).
#pragma once

#include "support/hair_fixture.h"

// Steps the solver through every trace of `algorithm`. Fails if a state's error exceeds 16 times
// the usual float32 error there (which the trace states), or 2^-19 of the length. `k_style` (1/s^2)
// is passed to style_stiffness with style 1/2. `prepare`, which may be NULL, changes the fixture
// before the first step. Returns the number of traces.
int traces_compare(const char *algorithm, const char *algo, const char *variant,
                   void (*prepare)(HairFixture *fixture));

// To be passed as `prepare` for traces with explicit drag v += (g + (w - v) c) dt, which the
// program's exact drag imitates with other constants.
void traces_imitate_explicit_drag(HairFixture *fixture);
