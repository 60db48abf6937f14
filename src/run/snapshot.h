// SPDX-License-Identifier: MIT
// The state of an unfinished simulation in a file, so that another run goes on from it.
#pragma once

#include "base/bytes.h"
#include "sim/simulation.h"

// Writes the simulation's state after its present frame; the file appears whole or not at all.
// RESULT_FAILED with path and reason.
Result snapshot_write(const char *path, Simulation *simulation, const Strands *strands,
                      Error *error);

// Reads a state of this very simulation for simulation_state_restore, and of which frame it is.
// RESULT_BAD_INPUT with one line if there is none or it is of another one. Free with bytes_destroy.
Result snapshot_read(Bytes *state, int *frame, const char *path, const Simulation *simulation,
                     const Strands *strands, Error *error);
