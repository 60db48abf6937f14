// SPDX-License-Identifier: MIT
// The cells of the light grid (light_grid.h): numbers and formulas that C and shaders share.
#include "common/shared_math.h"
#ifdef __STDC__
#pragma once
#endif

// Some strands stand for all in the cells: of `drawn` strands one of each `step` that follow each
// other, any one, but always the same.
SHARED_FUNCTION uint cell_strands(uint drawn, uint step)
{
    return step < drawn ? drawn / step : 1u;
}

// The strand number n of them: a step of the golden ratio's multiples spreads them evenly, whatever
// order strands have.
SHARED_FUNCTION uint cell_strand(uint n, uint drawn, uint step)
{
    return n * step + ((n * 0x9e3779b1u) >> 16) % (step < drawn ? step : drawn);
}

// What a cell's light shows of a fibre is tabled by tangents: an octahedron with CELL_SIDE squares
// across, cut into patches of 3 x 3 squares with a node at each corner, each with nodes of its own.
#define CELL_SIDE        30
#define CELL_PATCH_SIDE  3   // squares
#define CELL_PATCH_ROW   4   // nodes
#define CELL_PATCH_NODES 16  // of a patch: [row][column]
#define CELL_PATCHES_ROW 10  // CELL_SIDE / CELL_PATCH_SIDE
#define CELL_PATCHES     100 // [row][column]

// Where a tangent lies among the nodes: the first of the four around it, and the shares of those
// beyond it along a row (u) and a column (v).
SHARED_STRUCT(CellTangent)
{
    int in_patch, node;
    float u, v;
};

// Of a vector of any length.
SHARED_FUNCTION CellTangent cell_tangent(float x, float y, float z)
{
    float scale = 1.0f / SHARED_MAX(SHARED_ABS(x) + SHARED_ABS(y) + SHARED_ABS(z), 1e-12f);
    float u = x * scale, v = y * scale, far_u = 1.0f - SHARED_ABS(v), far_v = 1.0f - SHARED_ABS(u);
    far_u = u < 0.0f ? -far_u : far_u;
    far_v = v < 0.0f ? -far_v : far_v;
    u = z < 0.0f ? far_u : u;
    v = z < 0.0f ? far_v : v;
    const float most = FLOAT(CELL_SIDE) - 1e-3f, half_side = 0.5f * FLOAT(CELL_SIDE);
    u = SHARED_MIN(SHARED_MAX((u + 1.0f) * half_side, 0.0f), most);
    v = SHARED_MIN(SHARED_MAX((v + 1.0f) * half_side, 0.0f), most);
    int column = INT(u), row = INT(v), over = column / CELL_PATCH_SIDE,
        down = row / CELL_PATCH_SIDE;
    CellTangent at;
    at.in_patch = down * CELL_PATCHES_ROW + over;
    at.node = (row - CELL_PATCH_SIDE * down) * CELL_PATCH_ROW + column - CELL_PATCH_SIDE * over;
    at.u = u - FLOAT(column);
    at.v = v - FLOAT(row);
    return at;
}

// --- Light on its way through a cell: out = S + (in - S) exp(-tau), in the mean of the cell
// S + (in - S) (1 - exp(-tau)) / tau.

SHARED_FUNCTION float cell_left(float tau)
{
    return SHARED_EXP2(-FLOAT(LOG2E) * SHARED_MIN(tau, 40.0f));
}

SHARED_FUNCTION float cell_mean_share(float tau, float left)
{
    return tau > 1e-3f ? (1.0f - left) / tau : 1.0f - 0.5f * tau;
}

// --- Orders of scattering: of two after each other what hair meets falls by a factor, and goes on
// falling so. So much of the light at most may be left to orders that are not swept.
#define CELL_LEFT_MOST 0.05f

// The factor, of a channel.
SHARED_FUNCTION float cell_falling(float before, float last)
{
    return before > 0.0f ? SHARED_MIN(last / before, 0.95f) : 0.0f;
}

// What all orders after the last one add, over what it has.
SHARED_FUNCTION float cell_further(float falling) { return falling / (1.0f - falling); }

// Whether it is too much; `all`: of those so far.
SHARED_FUNCTION bool cell_needs_more(float all, float last, float falling)
{
    float left = last * cell_further(falling);
    return left > CELL_LEFT_MOST * (all + left);
}

// --- What is seen.

// Fibres between the eye and a cell, but for those of the cell and of its neighbours, beyond which
// a share of 1e-3 of hair is seen.
#define CELL_HIDDEN_BEHIND 7.0f

SHARED_STRUCT(CellVector) { float x, y, z; };

// Turns a tangent by the smallest rotation from the way to the eye (of any length) to the unit
// vector `axis`, which tables are for.
SHARED_FUNCTION CellVector cell_turn(CellVector tangent, CellVector way, CellVector axis)
{
    float scale =
              1.0f / SHARED_SQRT(SHARED_MAX(way.x * way.x + way.y * way.y + way.z * way.z, 1e-20f)),
          x = way.x * scale, y = way.y * scale, z = way.z * scale;
    float a = x + axis.x, b = y + axis.y, c = z + axis.z,
          cosine = x * axis.x + y * axis.y + z * axis.z;
    float between =
              (tangent.x * a + tangent.y * b + tangent.z * c) / SHARED_MAX(1.0f + cosine, 1e-3f),
          twice = 2.0f * (tangent.x * x + tangent.y * y + tangent.z * z);
    CellVector turned;
    turned.x = tangent.x - between * a + twice * axis.x;
    turned.y = tangent.y - between * b + twice * axis.y;
    turned.z = tangent.z - between * c + twice * axis.z;
    return turned;
}

// --- Classes of tangents (ordinates.h), by the squares of a cube's faces.

// The row or column of a place -1 .. 1 across a face with so many.
SHARED_FUNCTION int cell_square(float at, int squares)
{
    int square = INT(SHARED_MAX(0.5f * (at + 1.0f) * FLOAT(squares), 0.0f));
    return square < squares ? square : squares - 1;
}
