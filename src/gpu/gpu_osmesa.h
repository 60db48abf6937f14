// SPDX-License-Identifier: MIT
// Contexts by OSMesa: Mesa's llvmpipe without EGL, loaded at run time.
#pragma once

#include "base/error.h"

typedef struct GpuOsMesa GpuOsMesa;

// Creates a 4.3 core context, makes it current and sets libepoxy's function pointers from it. On
// RESULT_NO_GL (names what is missing) and RESULT_FAILED (no memory), *mesa is NULL.
Result gpu_osmesa_create(GpuOsMesa **mesa, Error *error);
void gpu_osmesa_destroy(GpuOsMesa *mesa);
