// SPDX-License-Identifier: MIT
// Parameters with the defaults of --look plain, with which tests compare their own results.
#pragma once

#include "scene/scene.h"

// Fails the test when memory is short. Free with params_destroy_section.
void plain_section(SectionParams *params);
