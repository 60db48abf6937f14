// SPDX-License-Identifier: MIT
// Places roots of hair on a surface.
#pragma once

#include "gen/fur_map.h"

// Picks `count` (at least 1) random roots, with probability by area times `density` (negative
// values count as 0, and values above the largest at 20,000 random points count as that), spread as
// evenly as possible: of four times as many, those that crowd their neighbours most are removed
// (Yuksel 2015, "Sample elimination for generating Poisson disk sample sets"). `name` is the mesh's
// file, for errors: RESULT_USAGE if the density is 0 everywhere or not finite somewhere;
// RESULT_FAILED when memory is short.
Result fur_roots_make(SurfacePoint *roots, uint32_t count, const Surface *surface,
                      const FurMap *density, uint32_t seed, const char *name, Error *error);

// Moves `first` (at most `count`) roots to the front that are distributed and spaced as evenly as
// all of them, and shuffles both parts. RESULT_FAILED when memory is short.
Result fur_roots_order(SurfacePoint *roots, uint32_t count, uint32_t first, uint32_t seed,
                       Error *error);

// The integral (m2) of the density over the surface, where negative values count as 0, from 20,000
// random points. If roots grow on the share s of the area, the standard error is sqrt((1/s -
// 1)/20000) of it. Errors as above.
Result fur_roots_measure(const Surface *surface, const FurMap *density, uint32_t seed,
                         const char *name, double *area, Error *error);
