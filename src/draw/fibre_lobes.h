// SPDX-License-Identifier: MIT
// How a fibre scatters light, in C for several directions at once. The same as MARSCHNER 1 of
// glsl/draw/shade_marschner.glsl: lobes of d'Eon et al. (2011) along the fibre, and the table of
// scatter.comp around it.
#pragma once

#include "draw/ordinates.h"

#include "glsl/draw/material.h"

#include <stdbool.h>
#include <stdint.h>

// Texels by colour, cosine of theta_d and azimuth (SCATTER_ of draw.h): R, TT, TRT, unused.
typedef struct FibreTable {
    const float (*values)[4]; // [SCATTER_COLORS][SCATTER_INCLINATIONS][SCATTER_AZIMUTHS]
} FibreTable;

typedef struct FibreLobes {
    float variance[3]; // of R, TT, TRT along the fibre, rad^2
    float tilt_cos[3], tilt_sin[3];
    float color[3];        // transmittance of one diameter, linear
    float (*azimuthal)[4]; // [3][SCATTER_INCLINATIONS][SCATTER_AZIMUTHS], owned
    float (*albedo)[3];    // [SCATTER_INCLINATIONS], owned: share of light that the fibre scatters
    uint64_t serial;       // unique for each FibreLobes that was made
} FibreLobes;

// Makes the lobes of fibres with this material and colour; false if memory is short. A zeroed
// struct may be destroyed.
bool fibre_lobes_create(FibreLobes *lobes, FibreTable table, const MaterialParams *material,
                        const float color[3]);
void fibre_lobes_destroy(FibreLobes *lobes);

// Whether these lobes belong to this material and colour.
bool fibre_lobes_match(const FibreLobes *lobes, const MaterialParams *material,
                       const float color[3]);

// Fits the albedo of a fibre for light square to it as low + (1 - low) color^power, where color is
// the share that a diameter lets through. fit: low, power, from the table at colours 0 and 1/2.
void fibre_lobes_fit_albedo(FibreTable table, float fit[2]);

// Unit vectors, one for each lane.
typedef struct Ways {
    float axis[3][ORDINATE_LANES];
} Ways;

// The scattering function f (shade_marschner.glsl; 1/sr) from `in` towards `out`, both unit vectors
// that point away from the fibre. `tangent`: the fibre's, unit. `extra` is added to the variance of
// every lobe.
void fibre_lobes_scatter(const FibreLobes *lobes, const float tangent[3], const Ways *out,
                         const Ways *in, float extra, float f[3][ORDINATE_LANES]);

// The albedo (3 channels) at this cosine of the inclination.
void fibre_lobes_albedo(const FibreLobes *lobes, float cosine, float albedo[3]);
