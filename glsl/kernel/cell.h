// SPDX-License-Identifier: MIT
// The cells of the light grid (light_grid.h): numbers and formulas that C and shaders share.
#include "common/shared_math.h"
#ifdef __STDC__
#pragma once
#endif

// A subset of the strands represents all strands in the cells: one strand of each group of `step`
// consecutive strands, chosen pseudo-randomly but always the same. Returns the size of the subset.
SHARED_FUNCTION uint cell_strands(uint drawn, uint step)
{
    return step < drawn ? drawn / step : 1u;
}

// The strand that represents group n. Multiples of the golden ratio spread the choices evenly,
// whatever order the strands have.
SHARED_FUNCTION uint cell_strand(uint n, uint drawn, uint step)
{
    return n * step + ((n * 0x9e3779b1u) >> 16) % (step < drawn ? step : drawn);
}

// The table of the light that a fibre sends to the eye is indexed by its tangent: an octahedron of
// CELL_SIDE x CELL_SIDE squares, cut into patches of 3 x 3 squares. A patch has its own copies of
// the nodes at the corners of its squares.
#define CELL_SIDE        30
#define CELL_PATCH_SIDE  3   // squares
#define CELL_PATCH_ROW   4   // nodes
#define CELL_PATCH_NODES 16  // nodes of a patch: [row][column]
#define CELL_PATCHES_ROW 10  // CELL_SIDE / CELL_PATCH_SIDE
#define CELL_PATCHES     100 // [row][column]
#define CELL_NODES_ROW   31  // CELL_SIDE + 1
#define CELL_NODES       961 // [row][column]

// The place of a tangent among the nodes: the first of the four around it, and its fractions along
// the row (u) and the column (v).
SHARED_STRUCT(CellTangent)
{
    int in_patch, node;
    float u, v;
};

// `x`, `y`, `z`: a vector of any length.
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

// The number of the first node among all nodes.
SHARED_FUNCTION int cell_node(int in_patch, int node)
{
    int row = in_patch / CELL_PATCHES_ROW * CELL_PATCH_SIDE + node / CELL_PATCH_ROW,
        column = in_patch % CELL_PATCHES_ROW * CELL_PATCH_SIDE + node % CELL_PATCH_ROW;
    return row * CELL_NODES_ROW + column;
}

// --- Light on its way through a cell with the source S: out = S + (in - S) exp(-tau); the cell's
// mean is S + (in - S) (1 - exp(-tau)) / tau.

SHARED_FUNCTION float cell_left(float tau)
{
    return SHARED_EXP2(-FLOAT(LOG2E) * SHARED_MIN(tau, 40.0f));
}

SHARED_FUNCTION float cell_mean_share(float tau, float left)
{
    return tau > 1e-3f ? (1.0f - left) / tau : 1.0f - 0.5f * tau;
}

// --- Light on the mesh in a cell.

// The cosine between its unit normal (nx, ny, nz) and the unit vector to the light; 0 from behind.
// Where the normal is 0, any side may be lit: the mean over all is 1/2.
SHARED_FUNCTION float cell_facing(float nx, float ny, float nz, float x, float y, float z)
{
    return nx * nx + ny * ny + nz * nz > 0.0f ? SHARED_MAX(nx * x + ny * y + nz * z, 0.0f) : 0.5f;
}

// The largest share of a lamp's colour that a place receives.
#define CELL_LAMP_MOST 1e3f

// --- Orders of scattering. The light that hair meets falls by a factor from one order to the next.
// For the orders that are not swept, it is assumed to go on falling by this factor. These orders
// may have at most this share of the light.
#define CELL_LEFT_MOST 0.05f

// The factor for a channel.
SHARED_FUNCTION float cell_falling(float before, float last)
{
    return before > 0.0f ? SHARED_MIN(last / before, 0.95f) : 0.0f;
}

// The light of all orders after the last one, over the light of the last one.
SHARED_FUNCTION float cell_further(float falling) { return falling / (1.0f - falling); }

// Whether more orders must be swept; `all`: the light of the orders so far.
SHARED_FUNCTION bool cell_needs_more(float all, float last, float falling)
{
    float left = last * cell_further(falling);
    return left > CELL_LEFT_MOST * (all + left);
}

// --- Visible cells.

// A cell counts as hidden if this many fibres lie between the eye and the cell, without the fibres
// of the cell and its neighbours: then less than 1e-3 of its hair is visible.
#define CELL_HIDDEN_BEHIND 7.0f

SHARED_STRUCT(CellVector) { float x, y, z; };

// Rotates a tangent by the smallest rotation that takes the direction `way` (of any length) to the
// unit vector `axis`, for which the tables are made.
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

// --- Classes of tangents (ordinates.h), by squares on the faces of a cube.

// The row or column of a coordinate -1 .. 1 on a face that has `squares` rows and columns.
SHARED_FUNCTION int cell_square(float at, int squares)
{
    int square = INT(SHARED_MAX(0.5f * (at + 1.0f) * FLOAT(squares), 0.0f));
    return square < squares ? square : squares - 1;
}
