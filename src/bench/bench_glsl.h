// SPDX-License-Identifier: MIT
// The shaders of glsl/bench/, for shader_add_sources: only tractrix-bench and tests carry them.
#pragma once

#include "gpu/shader.h"

extern const GlslSource BENCH_GLSL_SOURCES[];
