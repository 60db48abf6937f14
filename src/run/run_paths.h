// SPDX-License-Identifier: MIT
// Checks and claims the files that a run of tractrix-render names, before it opens any.
#pragma once

#include "scene/scene.h"

// Claims all files (paths.h). Refuses a run that would overwrite one of its inputs, or write one
// file for two flags. Without --allow-paths, also refuses outputs outside the scene file's folder
// that the scene file names, and not the command line: a scene from elsewhere must not write
// anywhere else, nor read devices or pipes. RESULT_USAGE names both uses, RESULT_BAD_INPUT the
// scene's key; RESULT_FAILED when memory is short.
Result run_paths_claim(const Scene *scene, Error *error);
