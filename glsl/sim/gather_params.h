// SPDX-License-Identifier: MIT
// What gather.comp is given, for one batch of strands.
#include "common/shared.h"

UNIFORM_BLOCK(GatherParams, gather_params, BIND_STEP)
{
    uint strand_count;
    uint vertex_count;
    uint begin; // vec4s before the first strand's
}
END_BLOCK(GatherParams, gather_params);
