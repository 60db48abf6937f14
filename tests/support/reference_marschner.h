// SPDX-License-Identifier: MIT
// The fibre of glsl/draw/shade_marschner.glsl in double precision, from its definitions.
#pragma once

enum { LOBE_R, LOBE_TT, LOBE_TRT, LOBE_COUNT };

// The density over the azimuth (1/rad) at the azimuth phi from the light's, for each lobe. Light
// crosses a fibre of refractive index eta at the inclination theta_d (cos_d is its cosine, 0 <
// cos_d <= 1); a path through the fibre's axis transmits `color`. By quadrature over the offset h
// with `steps` points; the azimuth is blurred by a wrapped Gaussian of `roughness` rad. The last
// lobe includes all later ones.
void marschner_azimuthal(double eta, double roughness, double cos_d, double color, double phi,
                         int steps, double density[LOBE_COUNT]);

// The longitudinal density of a lobe that is tilted by `tilt` and has the width `beta` (rad, both
// of theta_h): d'Eon et al. 2011. Its integral over cos(theta_i) d theta_i is 1.
double marschner_longitudinal(double theta_i, double theta_r, double tilt, double beta);

// Marschner's density: a Gaussian over theta_h, times cos(theta_i) / cos^2(theta_d).
double marschner_gauss(double theta_i, double theta_r, double tilt, double beta);
