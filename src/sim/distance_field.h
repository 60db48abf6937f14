// SPDX-License-Identifier: MIT
// The signed distance to a mesh, sampled on a grid: computed on the GPU, once for each mesh.
#pragma once

#include "gpu/gpu_buffer.h"
#include "mesh/mesh.h"

typedef struct DistanceField {
    uint32_t size[3]; // grid points along x, y, z
    float low[3];     // position of the first grid point, m
    float spacing;    // between grid points, m
    GpuBuffer values; // a float each, x fastest, m: negative inside; a buffer texture (GL_R32F)
} DistanceField;

enum { FIELD_LEAST = 8, FIELD_MOST = 512 };

// Computes the field of `mesh` (at least one triangle). The grid has `resolution` (FIELD_LEAST ..
// FIELD_MOST) spacings along the mesh's longest side, and three more around it.
// Distances are exact within two spacings of the surface. Farther away each grid point has the
// distance to one of the closest surface points that its neighbours found (jump flooding). The
// sign comes from a mean winding number (glsl/field/field_sign.comp), which tolerates holes and
// does not depend on the mesh's orientation.
// RESULT_FAILED if the driver allows no buffers of that size or memory is short; errors of
// shaders.
Result distance_field_create(DistanceField *field, const Gpu *gpu, const Mesh *mesh,
                             uint32_t resolution, Error *error);
void distance_field_destroy(DistanceField *field);

// The largest resolution, from `resolution` down to 2, at which the field takes no longer
// than those of usual meshes: a file of a few KB may have thousands of triangles that all cross the
// whole grid. Usual meshes keep `resolution`.
uint32_t distance_field_affordable(const Mesh *mesh, uint32_t resolution);

// As distance_field_create, but with a cache on disk: reads tractrix/HASH.field in $XDG_CACHE_HOME
// or ~/.cache if that file is complete (chunk.h); otherwise computes the field and tries to write
// the file. HASH is a hash of mesh and resolution. Files are safe to delete; a damaged or
// unwritable file only costs time. `read` (may be NULL) tells whether the file was used.
Result distance_field_create_cached(DistanceField *field, const Gpu *gpu, const Mesh *mesh,
                                    uint32_t resolution, bool *read, Error *error);

// The path of that file, to be freed by the caller; NULL if neither $XDG_CACHE_HOME nor $HOME is
// set, or memory is short.
char *distance_field_cache_name(const Mesh *mesh, uint32_t resolution);

// Number of grid points.
static inline size_t distance_field_count(const DistanceField *field)
{
    return (size_t)field->size[0] * field->size[1] * field->size[2];
}
