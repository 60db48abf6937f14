// SPDX-License-Identifier: MIT
// Contexts by OSMesa: Mesa's llvmpipe without EGL, loaded at run time.
#pragma once

#include "base/error.h"

typedef struct GpuOsMesa GpuOsMesa;

// Makes a 4.3 core context and makes it current, and fills libepoxy's pointers from it.
// RESULT_NO_GL with what is missing, RESULT_FAILED without memory; then *mesa is NULL.
Result gpu_osmesa_create(GpuOsMesa **mesa, Error *error);
void gpu_osmesa_destroy(GpuOsMesa *mesa);
