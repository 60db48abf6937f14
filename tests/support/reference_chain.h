// SPDX-License-Identifier: MIT
// Chain in double precision, for one strand on the CPU, from its equations in matrix form.
#pragma once

#include "support/twin.h"

// Predicts positions with the implicit spring towards the style: the beginning of chain and of the
// thesis's emulation. strand->v becomes the kicked velocities; predicted[0] is the root's new
// place.
void reference_predict(TwinStrand *strand, const TwinStep *step, const SectionParams *params,
                       Vec *predicted);

// Gaussian elimination of a tridiagonal matrix, rows 1 .. count. `right` becomes the solution.
void reference_solve_tridiagonal(int count, const double *lower, double *diagonal,
                                 const double *upper, double *right);

// Solves J J^T lambda = right for unit masses and a fixed root, with n - 1 right-hand sides. J has
// the derivatives of the lengths along the segments `r` (1 .. n-1). All arrays count segments from
// 1.
void reference_solve_lengths(const Vec *r, int n, const double *right, double *lambda);

// The exact tractrices of the two passes: from tip to root on the way from x to `predicted`, every
// segment in the frame of its tail's own prediction; then the root is pulled back to `root`.
void reference_two_pass(const TwinStrand *strand, const Vec *predicted, const Vec root, Vec *x);

// A TwinFunction.
void reference_chain_step(TwinStrand *strand, const TwinStep *step, const SectionParams *params);
