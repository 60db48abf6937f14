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

// By row, channel and degree: what is left of light on its way from the lamp to the eye.
typedef struct ConeTerms {
    float left[CONE_ROWS][3][CONE_DEGREES];
} ConeTerms;

// `blur`: the variance that the grid adds to the lobes from lamps and to the eye, and twice to
// those between fibres; `wide`: ConeView.to_light[3].
void cone_find_terms(ConeTerms *terms, const FibreLobes *lobes, float blur, float wide);

// The light of fibres with the unit tangent; 4th number unused.
void cone_find_rows(const ConeTerms *terms, const ConeView *view, const float tangent[3],
                    float rows[CONE_ROWS][4]);
