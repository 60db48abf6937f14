// SPDX-License-Identifier: MIT
// Styled hair at rest.
#pragma once

#include "bench/bench_accuracy.h"

// The part "static": RMS distance, over the length, of strands that have come to rest (20 s with
// drag 5/s) from the exact minimum of their energy under position springs, for each case of the
// folder's static_style.json and the solvers with such springs.
Result still_run_static(Accuracy *accuracy, Error *error);

// The part "drift": a helix at default parameters, settled for 10 s (or half the time): how far it
// goes from there in what is left of --seconds ("drift", RMS over the length, at the end), and the
// farthest that a particle goes from frame to frame ("tremor", over the length).
Result still_run_drift(Accuracy *accuracy, Error *error);
