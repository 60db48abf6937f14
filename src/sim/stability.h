// SPDX-License-Identifier: MIT
// How long a step may be: what --substeps auto goes by.
#pragma once

#include "scene/scene.h"
#include "strands/strands.h"

// The stability number of a step: sigma = dt (n - 1) sqrt(g / L), the greatest among the strands of
// n vertices and length L (m). It counts how much a link can turn within a step of dt s under an
// acceleration of g m/s2 along the strand. 0 without strands or acceleration.
double stability_number(const Strands *strands, double g, double dt);

// The greatest acceleration by gravity and wind that the scene will have, m/s2: keyed values, and
// wind at the height of a gust through the section's drag. The head's own motion isn't in it.
double stability_acceleration(const Scene *scene, const SectionParams *params);

// The fewest steps a period (schedule_period_rate) with which the stability number of each section
// stays within what its solver takes (SolverType.most_stability). `strands`: one for each section.
// RESULT_USAGE with the section's file if that is more than --substeps may be.
Result stability_choose_substeps(int *substeps, const Scene *scene, const Strands *strands,
                                 Error *error);
