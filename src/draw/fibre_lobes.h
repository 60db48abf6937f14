// SPDX-License-Identifier: MIT
// How a fibre scatters light, for lanes of directions in C: what glsl/draw/shade_marschner.glsl has
// as MARSCHNER 1, with d'Eon et al.'s lobes (2011), from the same table of azimuths (scatter.comp).
#pragma once

#include "draw/ordinates.h"

#include "glsl/draw/material.h"

#include <stdbool.h>
#include <stdint.h>

// Of one colour, by azimuth and cosine of theta_d (SCATTER_ of draw.h): R, TT, TRT and nothing.
typedef struct FibreTable {
    const float (*values)[4]; // [SCATTER_COLORS][SCATTER_INCLINATIONS][SCATTER_AZIMUTHS]
} FibreTable;

typedef struct FibreLobes {
    float variance[3]; // of R, TT, TRT along the fibre, rad^2
    float tilt_cos[3], tilt_sin[3];
    float color[3];        // what a diameter lets through, linear
    float (*azimuthal)[4]; // [3][SCATTER_INCLINATIONS][SCATTER_AZIMUTHS], owned
    float (*albedo)[3];    // [SCATTER_INCLINATIONS], owned: share of light that is scattered
    uint64_t serial;       // another one for each that was made
} FibreLobes;

// Of fibres with this material and colour; false if memory is short. Destroying a zeroed struct is
// legal.
bool fibre_lobes_create(FibreLobes *lobes, FibreTable table, const MaterialParams *material,
                        const float color[3]);
void fibre_lobes_destroy(FibreLobes *lobes);

// Whether these lobes are those of the material and colour.
bool fibre_lobes_match(const FibreLobes *lobes, const MaterialParams *material,
                       const float color[3]);

// The share of light square to a fibre that it scatters, by what its diameter lets through: about
// low + (1 - low) color^power. (low, power) from the table at colours 0 and 1/2.
void fibre_lobes_fit_albedo(FibreTable table, float fit[2]);

// A unit vector of each lane.
typedef struct Ways {
    float axis[3][ORDINATE_LANES];
} Ways;

// f (see shade_marschner.glsl; 1/sr) towards `out` of light from `in`, both unit vectors away from
// the fibre, for a fibre with the unit tangent; every lobe is wider by the variance `extra`.
void fibre_lobes_scatter(const FibreLobes *lobes, const float tangent[3], const Ways *out,
                         const Ways *in, float extra, float f[3][ORDINATE_LANES]);

// The albedo (3 channels) at the cosine of an inclination.
void fibre_lobes_albedo(const FibreLobes *lobes, float cosine, float albedo[3]);
