// SPDX-License-Identifier: MIT
// Parameters that the user set although they have no effect: those of a solver that no section
// uses, and those whose condition does not hold, such as --shadow-size with --shadow none.
#pragma once

#include "scene/scene.h"

#include <stdio.h>

// RESULT_USAGE with the flag and the reason, if a flag of the command line has no effect (a
// section's flag: in no section).
Result effects_check(const Scene *scene, Error *error);

// Prints a line for each key of the scene file that has no effect and is not the default.
void effects_warn(const Scene *scene, FILE *stream);
