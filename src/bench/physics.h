// SPDX-License-Identifier: MIT
// Elastic strands whose shape or motion is known: part "physics" of `tractrix-bench accuracy`
// (docs/physics.md has the derivations). For the solver rod.
#pragma once

#include "bench/experiment.h"

// The tip of an inextensible elastic cantilever that is clamped horizontally and bends under its
// own weight: its distance from the clamp and its drop, over the length. `gamma`: weight per length
// times length cubed over bending stiffness, 1e-3 .. 1e5.
void physics_cantilever(double gamma, double *along, double *drop);

// Set-ups and measurements of EXPERIMENTS.
bool physics_cantilever_set_up(Setup *setup);
Result physics_cantilever_measure(Run *run, Error *error);
bool physics_curl_set_up(Setup *setup);
Result physics_curl_measure(Run *run, Error *error);
bool physics_motion_set_up(Setup *setup);
