// SPDX-License-Identifier: MIT
// Parameters of rod.comp.
#include "common/shared.h"
#include "sim/style_spring.h"

UNIFORM_BLOCK(RodParams, rod_params, BIND_SOLVER)
{
    StyleSpring spring; // only `stiffness` is used
    // B/(rho A) = E r^2/(4 rho) at the root, m^4/s^2: a segment of mass l and stiffness B/l
    float bend;
    float twist; // C/B = 1/(1 + nu)
    float share; // of the step at which bending is taken: 1/2 + damping time/dt
    float area;  // VARIES 1: cross section relative to the root's; also own_along(j).y
}
END_BLOCK(RodParams, rod_params);
