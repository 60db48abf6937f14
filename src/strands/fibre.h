// SPDX-License-Identifier: MIT
// The material of hair fibres: round rods of one material.
#pragma once

#include "base/params.h"

// A zeroed struct is unknown, and so is a member that is 0; Poisson's ratio is unknown without a
// modulus, or if it is -1 or less.
typedef struct Fibre {
    double youngs_modulus; // Pa
    double poisson;        // Poisson's ratio
    double density;        // kg/m3
    double radius;         // m, the physical one
} Fibre;

// Whether any member is known; whether both are equal.
bool fibre_is_known(const Fibre *fibre);
bool fibre_equals(const Fibre *a, const Fibre *b);

// Replaces the members that are known in `from`.
void fibre_fill(Fibre *fibre, const Fibre *from);

// The material that the parameters of the solver rod give; of profiles along the strand the mean.
Fibre fibre_of(const SectionParams *params);

// Bending stiffness per mass and length, B/(rho A) = E r^2/(4 rho), in m^4/s^2. The density must
// not be 0.
double fibre_stiffness(const Fibre *fibre);

// The default material, and the magnitude of default gravity in m/s^2 (params.def). RESULT_FAILED
// when memory is short.
Result fibre_default(Fibre *fibre, double *gravity, Error *error);

// The gravito-bending length (B/w)^(1/3) = (E r^2/(4 rho g))^(1/3) in m, where B is the bending
// stiffness and w the weight per length. `gravity`: g > 0, m/s^2. A strand of length L and natural
// curvature k is described by Gamma = (L/L_gb)^3 and by k L_gb (Miller et al., "Shapes of a
// Suspended Curly Hair", PRL 112, 2014).
double fibre_gravito_bending_length(const Fibre *fibre, double gravity);
