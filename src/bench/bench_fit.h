// SPDX-License-Identifier: MIT
// Straight lines through logarithms: orders of convergence, exponents of cost.
#pragma once

// The slope of log(y) against log(x), least squares, of `count` points with positive numbers; 0 for
// less than two different x. *spread: its standard error; NaN for less than three points.
double fit_exponent(const double *x, const double *y, int count, double *spread);
