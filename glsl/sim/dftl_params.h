// SPDX-License-Identifier: MIT
// Parameters of dftl.comp.
#include "common/shared.h"
#include "sim/style_spring.h"

UNIFORM_BLOCK(DftlParams, dftl_params, BIND_SOLVER)
{
    StyleSpring spring;
    float damping; // s, 0 .. 1
}
END_BLOCK(DftlParams, dftl_params);
