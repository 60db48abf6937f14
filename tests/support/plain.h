// SPDX-License-Identifier: MIT
// Parameters with the defaults of --look plain, to which tests compare what they compute
// themselves.
#pragma once

#include "scene/scene.h"

// Fails the test when memory is short. Free with params_destroy_section.
void plain_section(SectionParams *params);
