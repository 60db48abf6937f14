// SPDX-License-Identifier: MIT
// Results of kernel/cell.h and grain.h for some numbers, for comparison between C and a shader
// (tests/draw/test_kernel_cells.c).
#include "kernel/cell.h"
#include "kernel/grain.h"
#ifdef __STDC__
#pragma once
#define PROBE_OUT float
#else
#define PROBE_OUT inout float
#endif

#define PROBE_INPUTS   12
#define PROBE_RESULTS  20
#define PROBE_COUNT(c) (FLOAT(c) * FLOAT(c))

SHARED_FUNCTION void probe_cells(float a[PROBE_INPUTS], PROBE_OUT r[PROBE_RESULTS])
{
    float falling = cell_falling(a[1], a[2]);
    CellVector tangent, way, axis;
    tangent.x = a[3], tangent.y = a[4], tangent.z = a[5];
    way.x = a[6], way.y = a[7], way.z = a[8];
    axis.x = a[9], axis.y = a[10], axis.z = a[11];
    CellTangent at = cell_tangent(a[3], a[4], a[5]);
    CellVector turned = cell_turn(tangent, way, axis);
    int lane = INT(a[2] * 10.0f);
    r[0] = cell_left(a[0]);
    r[1] = cell_mean_share(a[0], r[0]);
    r[2] = falling;
    r[3] = cell_further(falling);
    r[4] = cell_needs_more(a[0], a[2], falling) ? 1.0f : 0.0f;
    r[5] = FLOAT(at.in_patch);
    r[6] = FLOAT(at.node);
    r[7] = at.u;
    r[8] = at.v;
    r[9] = turned.x;
    r[10] = turned.y;
    r[11] = turned.z;
    r[12] = FLOAT(cell_square(1.2f * a[9], 24));
    r[13] = FLOAT(cell_strands(100u, UINT(lane)));
    r[14] = FLOAT(cell_strand(3u, 100u, UINT(lane)));
    r[15] = FLOAT(grain_middle(lane, 4, 7));
    r[16] = FLOAT(grain_cell_at(a[0], 3.0f * a[2], 2.5f, 5, 4, 6));
    r[17] = GRAIN_SMOOTH(PROBE_COUNT, lane, 3, 7);
}
