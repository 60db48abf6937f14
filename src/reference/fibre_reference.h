// SPDX-License-Identifier: MIT
// A fibre of shade_marschner.glsl (MARSCHNER 1) in double precision, for light that hits it at one
// offset from its axis: its beams, their density, and directions drawn from them. Averaged over all
// offsets this is the density of the table of scatter.comp. Scales are not tilted.
#pragma once

#include "base/random.h"

enum { FIBRE_BEAMS = 4 }; // R, TT, TRT, and all later ones, which leave in every azimuth alike

typedef struct FibreReference {
    double refraction;
    double spread;      // standard deviation of the azimuth, rad
    double variance[3]; // of R, TT, TRT along the fibre, rad^2
    double color[3];    // transmittance of one diameter, linear
} FibreReference;

// `roughness`: of R, rad, over the half angle; those of TT and TRT are 1/2 and 2 of it, as in
// Marschner et al. (2003).
FibreReference fibre_reference_create(double refraction, double roughness, double spread,
                                      const double color[3]);

// The beams of light that leaves at the inclination whose sine is `sine`, from offset -1 .. 1 of
// the radius: shares of the light for each channel, and azimuths (from that of the light that
// leaves, rad) from which R, TT, TRT have come.
typedef struct FibreBeams {
    double sine;
    double share[FIBRE_BEAMS][3], azimuth[FIBRE_BEAMS - 1];
} FibreBeams;

FibreBeams fibre_reference_beams(const FibreReference *fibre, double sine, double offset);

// The density (1/sr) for each channel of light that comes from this inclination and azimuth.
void fibre_reference_density(const FibreReference *fibre, const FibreBeams *beams, double sine,
                             double azimuth, double density[3]);

// The density (1/sr) with which fibre_reference_draw draws a direction whose density for each
// channel is `density`.
double fibre_reference_chance(const FibreBeams *beams, const double weight[3],
                              const double density[3]);

// Chooses a beam in proportion to its shares times `weight`, and a direction of it, from which the
// light has come. Multiplies `weight` by the share over the probability of the choice.
void fibre_reference_draw(const FibreReference *fibre, const FibreBeams *beams, Random *random,
                          double weight[3], double *sine, double *azimuth);
