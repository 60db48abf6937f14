// SPDX-License-Identifier: MIT
// Parameters of spring.comp.
#include "common/shared.h"

UNIFORM_BLOCK(SpringParams, spring_params, BIND_SOLVER)
{
    float coil;         // K, 1/s^2
    float angular;      // B, m/s^2
    uint stretch_drawn; // 1: links are drawn as long as they are
}
END_BLOCK(SpringParams, spring_params);
