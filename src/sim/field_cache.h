// SPDX-License-Identifier: MIT
// Distance fields on disk, so that a mesh's is computed once on a machine.
#pragma once

#include "sim/distance_field.h"

// As distance_field_create, but by the file tractrix/HASH.field in the folder $XDG_CACHE_HOME, else
// ~/.cache, if that is there and whole (chunk.h); else computes the field and tries to write
// that file. HASH is of the mesh and the resolution. Files are safe to delete; one that is damaged
// or cannot be written changes nothing but the time. `read` says which way it was; may be NULL.
Result field_cache_create(DistanceField *field, const Gpu *gpu, const Mesh *mesh,
                          uint32_t resolution, bool *read, Error *error);

// The file's name, to be freed; NULL if neither variable is set or memory is short.
char *field_cache_name(const Mesh *mesh, uint32_t resolution);
