// SPDX-License-Identifier: MIT
// Parameters of hybrid.comp.
#include "common/shared.h"
#include "sim/style_spring.h"

UNIFORM_BLOCK(HybridParams, hybrid_params, BIND_SOLVER) { StyleSpring spring; }
END_BLOCK(HybridParams, hybrid_params);
