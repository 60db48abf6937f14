// SPDX-License-Identifier: MIT
// A groom, hair as its file has it, and how far other points of the same strands are from it: the
// geometry of tractrix-bench groom. All places are of the head's frame, metres, by strands from
// root to tip in the order of hair_read_positions.
#pragma once

#include "mesh/surface.h"
#include "sim/hair.h"

typedef struct GroomShape {
    uint32_t strand_count;
    uint32_t *first;   // [strand_count + 1]
    float (*point)[3]; // [first[strand_count]]
    float *length;     // [strand_count]
    float *depth;      // [first[strand_count]] of each point in the surface; 0: outside
    float edge;        // of voxels: 1 % of the longest side of the groom's box
    float low[3];      // of the first voxel: half an edge below the box, so that no even groom
                       // lies on the border of two
    double voxels;     // that the groom fills
    Surface surface;   // of the head; without triangles: there is none
    const Mesh *mesh;  // its mesh, not owned
} GroomShape;

// The shape of `strands` in the order of `hair`, which was made of them. `mesh`: what hair must not
// be in, NULL: nothing; it outlives the shape. RESULT_FAILED when memory is short, errors of
// surface_create. The shape may be destroyed in either case.
Result groom_shape_create(GroomShape *shape, const Hair *hair, const Strands *strands,
                          const Mesh *mesh, Error *error);
void groom_shape_destroy(GroomShape *shape);

// Distance from the groom over the strand's length: the mean of all particles but roots, and of the
// tips.
void groom_shape_displacement(const GroomShape *shape, const float (*points)[3], double *mean,
                              double *tips);

// The greater of two numbers; NaN if one is.
static inline double groom_shape_greater(double a, double b)
{
    return a >= b || a != a ? a : b;
}

// How far any particle is from where it was in `before`, over the strand's length.
double groom_shape_step(const GroomShape *shape, const float (*points)[3],
                        const float (*before)[3]);

// How many voxels the strands go through, sampled four times an edge; NaN where a point is not
// finite. RESULT_FAILED when memory is short.
Result groom_shape_voxels(const GroomShape *shape, const float (*points)[3], double *count,
                          Error *error);

// Depth in the surface, m: the deepest of all particles, and how much deeper than in the groom any
// of them is; NaN without a surface. Exact distances, not those of the simulation's grid.
// RESULT_FAILED when memory is short.
Result groom_shape_depth(const GroomShape *shape, const float (*points)[3], double *deepest,
                         double *beyond, Error *error);

// Mean distance of the tips from the vertical axis through `middle`, m.
double groom_shape_spread(const GroomShape *shape, const float (*points)[3], const float middle[3]);
