// SPDX-License-Identifier: MIT
#include "gpu/gpu_dispatch.h"

#include <epoxy/gl.h>

void gpu_dispatch(const GpuLimits *limits, uint64_t items, uint64_t per_group, uint32_t layers)
{
    uint64_t groups = (items + per_group - 1) / per_group, most = (uint64_t)limits->work_groups,
             rows = (groups + most - 1) / most;
    if (rows) glDispatchCompute((GLuint)((groups + rows - 1) / rows), (GLuint)rows, layers);
}
