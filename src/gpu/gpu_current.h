// SPDX-License-Identifier: MIT
// Whether somebody has made an OpenGL context current on this thread, by EGL or GLX. libepoxy
// cannot be asked: it ends the program where there is none.
#pragma once

#include "base/error.h"

// RESULT_NO_GL if there is none.
Result gpu_current_check(Error *error);
