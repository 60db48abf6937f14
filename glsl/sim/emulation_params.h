// SPDX-License-Identifier: MIT
// Parameters of emulation.comp.
#include "common/shared.h"
#include "sim/style_spring.h"

UNIFORM_BLOCK(EmulationParams, emulation_params, BIND_SOLVER)
{
    StyleSpring spring;
    uint order_seed; // of the order in which particles are pulled
}
END_BLOCK(EmulationParams, emulation_params);
