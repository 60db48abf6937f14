// SPDX-License-Identifier: MIT
// The OpenGL state that drawing relies on in a borrowed context.
#pragma once

#include "base/error.h"

// Checks that the current context has OpenGL's default state, as far as this program relies on it
// without setting it: switches, masks, pixel storage, polygon mode, clip control, samplers.
// RESULT_USAGE with the first state that differs, its value and the default. Changes no state;
// takes about 100 calls, so only debug builds do it.
Result gl_defaults_check(Error *error);
