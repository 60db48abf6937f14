// SPDX-License-Identifier: MIT
// A quantity over a surface: a number, a formula of the place, or an image.
#pragma once

#include "base/formula.h"
#include "image/image.h"
#include "mesh/surface.h"

// A zeroed map is 0 everywhere.
typedef struct FurMap {
    double number; // where there is neither of the others
    Formula formula;
    Image image;
} FurMap;

// Reads `text`: a number; a name that ends in .png, an image that lies on the mesh by its texture
// coordinates (u to the right, v up from the lowest row, wrapping around); or a formula (formula.h)
// of x, y, z (m), nx, ny, nz (the normal) and u, v (0 where the mesh has none). `name` (an option)
// stands in front of errors: RESULT_USAGE for a formula that cannot be read or an image on a mesh
// some of whose triangles have no texture coordinates, RESULT_BAD_INPUT for an image that cannot
// be read.
Result fur_map_create(FurMap *map, const char *name, const char *text, const Mesh *mesh,
                      Error *error);
void fur_map_destroy(FurMap *map);

// The value there; of an image the mean of red, green and blue, each 0 to 1 as it stands in the
// file (sRGB or not), bilinear. Not for two threads at once.
double fur_map_at(const FurMap *map, const Surface *surface, const SurfacePoint *point);

// --- The way in which fur is combed: a direction along a surface.

// A zeroed comb combs nothing.
typedef struct FurComb {
    FurMap axis[3]; // x, y, z; of an image only the first
    bool combs, is_image;
} FurComb;

// Reads `text`: three numbers or formulas with commas between them, a vector in space;
// or an image, whose red and green say how far along u and v, from -1 (black) over 0 (the level in
// the middle) to 1. Errors as fur_map_create gives them, with `name` in front.
Result fur_map_create_comb(FurComb *comb, const char *name, const char *text, const Mesh *mesh,
                           Error *error);
void fur_map_destroy_comb(FurComb *comb);

// The direction at a point where the surface has this unit normal: the vector, shortened to a
// length of 1 if it is longer, projected onto the surface. Its length is 1 if at least a quarter is
// left of the vector, else four times what is left: hair is combed less where the vector is short
// or stands on the surface.
void fur_map_comb_at(const FurComb *comb, const Surface *surface, const SurfacePoint *point,
                     const Double3 normal, Double3 direction);
