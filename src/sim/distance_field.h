// SPDX-License-Identifier: MIT
// The signed distance to a mesh, sampled on a grid: computed on the GPU, once for each mesh.
#pragma once

#include "gpu/gpu_buffer.h"
#include "mesh/mesh.h"

typedef struct DistanceField {
    uint32_t size[3]; // grid points along x, y, z
    float low[3];     // the first of them, m
    float spacing;    // between them, m
    GpuBuffer values; // a float each, x fastest, m: negative inside; a buffer texture (GL_R32F)
} DistanceField;

enum { FIELD_LEAST = 8, FIELD_MOST = 512 };

// Computes the field of `mesh` (at least one triangle) with `resolution` (FIELD_LEAST ..
// FIELD_MOST) spacings along its longest side, and three more around it. Distances are exact
// within two spacings of the surface, and beyond that to the nearest of the surface points that
// are closest to grid points there. Inside is where a mean winding number
// (glsl/field/field_sign.comp) says so, which forgives holes and does not depend on the mesh's
// orientation. RESULT_FAILED if the driver allows no buffers of that size or memory is short;
// errors of shaders.
Result distance_field_create(DistanceField *field, const Gpu *gpu, const Mesh *mesh,
                             uint32_t resolution, Error *error);
void distance_field_destroy(DistanceField *field);

// As distance_field_create, but reads tractrix/HASH.field in the folder $XDG_CACHE_HOME, else
// ~/.cache, if that file is complete (chunk.h); else computes the field and tries to write the
// file. HASH is of the mesh and the resolution. Files are safe to delete; a damaged or unwritable
// one only costs time. `read` (may be NULL): whether the file was used.
Result distance_field_create_cached(DistanceField *field, const Gpu *gpu, const Mesh *mesh,
                                    uint32_t resolution, bool *read, Error *error);

// The file's name, to be freed; NULL if neither variable is set or memory is short.
char *distance_field_cache_name(const Mesh *mesh, uint32_t resolution);

// Grid points.
static inline size_t distance_field_count(const DistanceField *field)
{
    return (size_t)field->size[0] * field->size[1] * field->size[2];
}
