// SPDX-License-Identifier: MIT
// A groom, hair in the shape of its file, and how far other positions of the same strands are from
// it: the geometry of tractrix-bench groom. All positions are in the head's frame, m, strand by
// strand from root to tip in the order of hair_read_positions.
#pragma once

#include "mesh/surface.h"
#include "sim/hair.h"

typedef struct GroomShape {
    uint32_t strand_count;
    uint32_t *first;   // [strand_count + 1]
    float (*point)[3]; // [first[strand_count]]
    float *length;     // [strand_count]
    float *depth;      // [first[strand_count]]: depth of each point in the surface; 0: outside
    float edge;        // edge length of voxels: 1 % of the longest side of the groom's box
    float low[3];    // corner of the first voxel: half an edge below the box, so that evenly spaced
                     // hair does not lie on borders between voxels
    double voxels;   // number that the groom fills
    Surface surface; // of the head; without triangles: no head
    const Mesh *mesh; // the head's mesh, not owned
} GroomShape;

// The shape of `strands` in the order of `hair`, which was made of them. `mesh`: the head, which
// must outlive the shape; NULL: none. RESULT_FAILED when memory is short, errors of surface_create.
// The shape may be destroyed in either case.
Result groom_shape_create(GroomShape *shape, const Hair *hair, const Strands *strands,
                          const Mesh *mesh, Error *error);
void groom_shape_destroy(GroomShape *shape);

// Distance from the groom relative to the strand's length: the mean of all particles except roots,
// and the mean of the tips.
void groom_shape_displacement(const GroomShape *shape, const float (*points)[3], double *mean,
                              double *tips);

// The larger of two numbers; NaN if one is NaN.
static inline double groom_shape_greater(double a, double b)
{
    return a >= b || a != a ? a : b;
}

// The largest move of a particle from its position in `before`, relative to the strand's length.
double groom_shape_step(const GroomShape *shape, const float (*points)[3],
                        const float (*before)[3]);

// Number of voxels that the strands pass through, sampled four times per edge; NaN if a point is
// not finite. RESULT_FAILED when memory is short.
Result groom_shape_voxels(const GroomShape *shape, const float (*points)[3], double *count,
                          Error *error);

// Depth in the surface, m: *deepest of all particles, and the largest increase over the groom's
// depth; NaN without a surface. Uses exact distances, not those of the simulation's grid.
// RESULT_FAILED when memory is short.
Result groom_shape_depth(const GroomShape *shape, const float (*points)[3], double *deepest,
                         double *beyond, Error *error);

// Mean distance of the tips from the vertical axis through `middle`, m.
double groom_shape_spread(const GroomShape *shape, const float (*points)[3], const float middle[3]);
