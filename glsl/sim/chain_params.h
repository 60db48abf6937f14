// SPDX-License-Identifier: MIT
// Parameters of chain.comp.
#include "common/shared.h"
#include "sim/style_spring.h"

UNIFORM_BLOCK(ChainParams, chain_params, BIND_SOLVER) { StyleSpring spring; }
END_BLOCK(ChainParams, chain_params);
