// SPDX-License-Identifier: MIT
// The frames of animated hair files (Section.frames): each section that has them is drawn with the
// positions of its file instead of those of its solver.
#pragma once

#include "sim/simulation.h"

// Whether any section of the scene is played.
bool played_any(const Scene *scene);

// Replaces the drawn positions of the played sections by those of the simulation's current frame,
// interpolated linearly between the file's frames; after the last frame the hair stays. Call it
// after simulation_pose. RESULT_FAILED when memory is short.
Result played_show(Simulation *simulation, Error *error);
