// SPDX-License-Identifier: MIT
// Evaluates the functions of probe_cells.h in a shader, one set of numbers for each lane.
#include "probe_cells.h"

layout(local_size_x = 32) in;
layout(std430, binding = 0) readonly buffer Inputs { float inputs[]; };
layout(std430, binding = 1) writeonly buffer Results { float results[]; };

void main()
{
    int lane = int(gl_GlobalInvocationID.x);
    float a[PROBE_INPUTS], r[PROBE_RESULTS];
    for (int i = 0; i < PROBE_INPUTS; ++i) a[i] = inputs[lane * PROBE_INPUTS + i];
    for (int i = 0; i < PROBE_RESULTS; ++i) r[i] = 0.0;
    probe_cells(a, r);
    for (int i = 0; i < PROBE_RESULTS; ++i) results[lane * PROBE_RESULTS + i] = r[i];
}
