// SPDX-License-Identifier: MIT
// A simulation between two frames as bytes, from which another run of the same scene goes on as if
// it had never stopped. docs/cache.md has the format.
#pragma once

#include "base/bytes.h"
#include "sim/simulation.h"

// Free `state` with bytes_destroy. Waits for the GPU. Hair's positions are those of the last step
// afterwards. RESULT_FAILED when memory is short.
Result simulation_state_save(Simulation *simulation, Bytes *state, Error *error);

// Puts it all back: the next simulation_advance goes on from there, simulation_pose draws the frame
// that was saved. RESULT_BAD_INPUT if the bytes are not of a simulation of the same hair, solvers
// and driver limits; the simulation may be half changed then. RESULT_FAILED when memory is short.
Result simulation_state_restore(Simulation *simulation, const Bytes *state, Error *error);
