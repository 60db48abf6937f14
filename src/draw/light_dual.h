// SPDX-License-Identifier: MIT
// Light that goes from fibre to fibre by dual scattering (Zinke, Yuksel, Weber, Keyser 2008):
// cheaper and rougher than a light grid. Needs no OpenGL. The same light whatever number of
// threads.
//
// A fibre behind n others (the mean number that the deep map counts) is lit by
//   exp(-n)                      of the light's own rays, and
//   exp(-n (1 - a_f)) - exp(-n)  of rays that the others have sent on, spread along the fibre by
//                                the variance s = v_f n a_f / (1 - exp(-n a_f)),
// and the m fibres behind it send back the share
//   A = a_b a_f^2 / (1 - a_f^2) e + a_b^3 a_f^2 / (1 - a_f^2)^3 e^3,  e = 1 - a_f^(2 m)
// of both, with the variance v of the paper's equation 16. a_f and a_b are the shares of light that
// a fibre scatters to the half space away from the light and back, v_f and v_b their variances
// along the fibre. Other than in the paper the cluster is finite (e is 1 for m without end), passed
// light counts by Poisson's law, and there are no free factors.
#pragma once

#include "draw/light_scene.h"

typedef struct LightDual {
    struct DualTable *tables; // [LIGHT_GRID_KINDS], owned
} LightDual;

// Writes what each point of the hair sends to the eye of such light into `seen`, or adds it to what
// is there. Needs `behind` of all hair. RESULT_FAILED if memory is short.
Result light_dual_find(LightDual *dual, const GridScene *scene, bool add, Error *error);

// A zeroed struct is legal.
void light_dual_destroy(LightDual *dual);
