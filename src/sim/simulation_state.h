// SPDX-License-Identifier: MIT
// Saves a simulation between two frames as bytes. Another run of the same scene continues from
// them as if the first had never stopped. docs/cache.md has the format.
#pragma once

#include "base/bytes.h"
#include "sim/simulation.h"

// The caller frees `state` with bytes_destroy. Waits for the GPU. Afterwards Hair's positions are
// those of the last step. RESULT_FAILED when memory is short.
Result simulation_state_save(Simulation *simulation, Bytes *state, Error *error);

// Restores the saved state. simulation_pose then draws the frame that was saved, and the next
// simulation_advance continues from there. RESULT_BAD_INPUT if the bytes come from a simulation
// with other hair, solvers or driver limits; the simulation may then be partly changed.
// RESULT_FAILED when memory is short.
Result simulation_state_restore(Simulation *simulation, const Bytes *state, Error *error);
