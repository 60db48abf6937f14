// SPDX-License-Identifier: MIT
// The state of OpenGL that drawing takes for granted in a context of somebody else's.
#pragma once

#include "base/error.h"

// Checks that the current context's state is OpenGL's default as far as this program relies on it
// and does not set it itself: switches, masks, pixel storage, polygon mode, clip control, samplers.
// RESULT_USAGE with the first state that differs, its value and the default. Leaves all state as it
// is; costs some 100 calls, so only debug builds ask.
Result gl_defaults_check(Error *error);
