// SPDX-License-Identifier: MIT
// Chain in double precision, one strand on the CPU, from its equations in matrix form.
#pragma once

#include "support/twin.h"

// Predicted positions, with the implicit spring towards the style: what chain and the
// thesis's emulation begin with. strand->v becomes the kicked velocities; predicted[0] is the
// root's new place.
void reference_predict(TwinStrand *strand, const TwinStep *step, const SectionParams *params,
                       Vec *predicted);

// Gaussian elimination of a tridiagonal matrix, rows 1 .. count; `right` becomes the solution.
void reference_solve_tridiagonal(int count, const double *lower, double *diagonal,
                                 const double *upper, double *right);

// J J^T for unit masses and a fixed root, J the lengths' derivatives along the segments `r` (1 ..
// n-1): solves it for n - 1 right sides. All arrays count segments from 1.
void reference_solve_lengths(const Vec *r, int n, const double *right, double *lambda);

// The exact tractrices on the way from x to `predicted` and with the root back at `root`: tip to
// root, every segment in the frame of its tail's own prediction, then the root pulled home.
void reference_two_pass(const TwinStrand *strand, const Vec *predicted, const Vec root, Vec *x);

// A TwinFunction.
void reference_chain_step(TwinStrand *strand, const TwinStep *step, const SectionParams *params);
