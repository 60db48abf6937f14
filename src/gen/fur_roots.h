// SPDX-License-Identifier: MIT
// Where hair grows out of a surface.
#pragma once

#include "gen/fur_map.h"

// Picks `count` (at least 1) roots at random, by area times `density` (below 0 counts as 0, more
// than the largest at 20,000 random points as that), none closer to others than need be: of four
// times as many, those stay that crowd their neighbours least (Yuksel 2015, "Sample elimination for
// generating Poisson disk sample sets"). `name` is the mesh's file, for errors: RESULT_USAGE if the
// density is 0 everywhere or not finite somewhere; RESULT_FAILED when memory is short.
Result fur_roots_make(SurfacePoint *roots, uint32_t count, const Surface *surface,
                      const FurMap *density, uint32_t seed, const char *name, Error *error);

// Puts `first` (at most `count`) of the roots in front that are spread as all of them are, as
// evenly, and both parts into random order. RESULT_FAILED when memory is short.
Result fur_roots_order(SurfacePoint *roots, uint32_t count, uint32_t first, uint32_t seed,
                       Error *error);

// The integral (m2) of the density, below 0 counts as 0, over the surface, from 20,000 random
// points: where roots grow on a share s of the area, within sqrt((1/s - 1)/20000) of it, mostly.
// Errors as above.
Result fur_roots_measure(const Surface *surface, const FurMap *density, uint32_t seed,
                         const char *name, double *area, Error *error);
