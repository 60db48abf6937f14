// SPDX-License-Identifier: MIT
// The table of glsl/kernel/cone.h: the light of lamps that endless hair of parallel fibres shows to
// the eye after two and more scatterings.
#pragma once

#include "draw/fibre_lobes.h"

#include "glsl/kernel/cone.h"

// A light and an eye for which a table is made: unit vectors in the tables' axes.
typedef struct ConeView {
    float to_light[4]; // w: variance of the light's directions, rad^2
    float color[3];    // linear RGB
    float to_eye[3];
} ConeView;

enum { CONE_DEGREES = 64 };

// The coefficients of the series in light_cone.c, by row, channel and degree.
typedef struct ConeTerms {
    float left[CONE_ROWS][3][CONE_DEGREES];
} ConeTerms;

// `blur`: the variance (rad^2) that the grid adds to the lobes from lamps and to the lobes towards
// the eye; it adds twice this variance to the lobes between fibres. `wide`: ConeView.to_light[3].
void cone_find_terms(ConeTerms *terms, const FibreLobes *lobes, float blur, float wide);

// The light that fibres with this unit tangent show, for each row; the 4th number is unused.
void cone_find_rows(const ConeTerms *terms, const ConeView *view, const float tangent[3],
                    float rows[CONE_ROWS][4]);
