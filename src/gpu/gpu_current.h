// SPDX-License-Identifier: MIT
// Whether an OpenGL context is current on this thread, by EGL or GLX. libepoxy cannot tell: it ends
// the program if there is none.
#pragma once

#include "base/error.h"

// RESULT_NO_GL if no context is current.
Result gpu_current_check(Error *error);
