// SPDX-License-Identifier: MIT
// The files that a run of tractrix-render names, checked and claimed before any is opened.
#pragma once

#include "scene/scene.h"

// Claims all files (paths.h). Refuses a run that would overwrite a file that it reads, or write one
// file under two flags (paths.h), and outputs that a scene file, not the command line, places
// outside its own folder (unless --allow-paths): a scene from elsewhere may not write where it
// likes, nor read devices or pipes. RESULT_USAGE naming both uses, RESULT_BAD_INPUT naming the
// scene's key, RESULT_FAILED when memory is short.
Result run_paths_claim(const Scene *scene, Error *error);
