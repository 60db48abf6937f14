// SPDX-License-Identifier: MIT
// OSMesa as the other way to a context: Mesa's llvmpipe without EGL, loaded at run time.
#pragma once

#include "base/error.h"

// Loads libOSMesa.so.8, makes a 4.3 core context current on a small memory buffer of its own and
// fills libepoxy's entry points.
// `*state` is to be given to gpu_osmesa_destroy. RESULT_NO_GL with the reason.
Result gpu_osmesa_create(void **state, Error *error);
void gpu_osmesa_destroy(void *state);
