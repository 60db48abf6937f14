// SPDX-License-Identifier: MIT
// FLIP for low dynamic range: P. Andersson, J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K.
// Astroem, M. D. Fairchild, "FLIP: A Difference Evaluator for Alternating Images", Proceedings of
// the ACM on Computer Graphics and Interactive Techniques 3 (2), 2020. It is the visible
// difference, from 0 to 1, when one flips between two images at a given viewing distance.
#pragma once

#include "image/float_image.h"

#include <stddef.h>

// The paper's monitor: 3840 pixels over 0.7 m, seen from 0.7 m.
static const double FLIP_PIXELS_PER_DEGREE = 67;

// Filters and memory for images of up to some number of pixels.
typedef struct FlipFilters FlipFilters;
typedef struct Flip {
    FlipFilters *filters;
    float *planes;
    size_t pixels;
} Flip;

// `pixels_per_degree`: 1 to 1000. RESULT_FAILED when memory is short. A zeroed struct may be
// destroyed.
Result flip_create(Flip *flip, size_t pixels, double pixels_per_degree, Error *error);
void flip_destroy(Flip *flip);

// The error of a pixel depends on pixels up to this many pixels away along x or y.
int flip_reach(double pixels_per_degree);

// Writes the error of each pixel (0 to 1) to `map` [height][width]. The images must have the same
// size, of at most flip->pixels; levels beyond 0..255 are clamped. Equal images give exactly 0.
void flip_find(const Flip *flip, float *map, const FloatImage *a, const FloatImage *b);

// The same at once; `mean` is that of the map. RESULT_FAILED when memory is short.
Result flip_compare(float *map, double *mean, const FloatImage *a, const FloatImage *b,
                    double pixels_per_degree, Error *error);

// Parts of FLIP, for tests. Converts linear RGB (0..1) to the opponent space YCxCz (section 4.1.1),
// and to L*a*b* with a*, b* scaled by 0.01 L* (Hunt's effect, section 4.1.2).
void flip_opponent(double ycc[3], const double rgb[3]);
void flip_hunt_lab(double lab[3], const double rgb[3]);

// |dL| + sqrt(da^2 + db^2) (equation 3), and the resulting colour difference, 0 to 1 (section
// 4.1.3).
double flip_hyab(const double a[3], const double b[3]);
double flip_color_difference(double hyab);
