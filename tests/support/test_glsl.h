// SPDX-License-Identifier: MIT
// The shaders of tests/glsl/, for shader_add_sources; programs do not contain them. They are called
// probe_x, because the runner takes check_x for a test.
#pragma once

#include "gpu/shader.h"

extern const GlslSource TEST_GLSL_SOURCES[];
