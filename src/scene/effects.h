// SPDX-License-Identifier: MIT
// Parameters that a user gave although they can have no effect: those of another solver than the
// sections', and those whose condition does not hold, such as --shadow-size with --shadow none.
#pragma once

#include "scene/scene.h"

#include <stdio.h>

// RESULT_USAGE, naming the flag and the reason, if a flag of the command line has no effect: in no
// section, where it is a section's.
Result effects_check(const Scene *scene, Error *error);

// Prints a line for each key of the scene file that has no effect and is not the default.
void effects_warn(const Scene *scene, FILE *stream);
