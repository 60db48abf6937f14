// SPDX-License-Identifier: MIT
// A quantity that varies over a surface: a number, a formula of position, or an image.
#pragma once

#include "base/formula.h"
#include "image/image.h"
#include "mesh/surface.h"

// A zeroed map is 0 everywhere.
typedef struct FurMap {
    double number; // if there is neither formula nor image
    Formula formula;
    Image image;
} FurMap;

// Reads `text`: a number; a name that ends in .png, an image placed by the mesh's texture
// coordinates (u to the right, v up from the lowest row, repeating); or a formula (formula.h) of x,
// y, z (m), nx, ny, nz (the normal) and u, v (0 if the mesh has none). Errors start with `name` (an
// option): RESULT_USAGE for an invalid formula, or an image on a mesh with triangles without
// texture coordinates; RESULT_BAD_INPUT for an image that can't be read.
Result fur_map_create(FurMap *map, const char *name, const char *text, const Mesh *mesh,
                      Error *error);
void fur_map_destroy(FurMap *map);

// The value at a point; of an image, the mean of red, green and blue, each 0 to 1 as stored in the
// file (sRGB or not), bilinear. Must not be called by two threads at once.
double fur_map_at(const FurMap *map, const Surface *surface, const SurfacePoint *point);

// --- Combing: a direction along the surface.

// A zeroed comb has no direction.
typedef struct FurComb {
    FurMap axis[3]; // x, y, z; for an image only the first
    bool combs, is_image;
} FurComb;

// Reads `text`: three comma-separated numbers or formulas, a vector in space; or an image whose red
// and green give the components along u and v, from -1 (black) over 0 (the middle level) to 1.
// Errors of fur_map_create, starting with `name`.
Result fur_map_create_comb(FurComb *comb, const char *name, const char *text, const Mesh *mesh,
                           Error *error);
void fur_map_destroy_comb(FurComb *comb);

// The combed direction at a point with this unit normal: the vector is shortened to length 1 if it
// is longer, and projected onto the surface. The result has length 1 if the projection is at least
// a quarter long, otherwise four times the projection's length: hair is combed less where the
// vector is short or almost perpendicular to the surface.
void fur_map_comb_at(const FurComb *comb, const Surface *surface, const SurfacePoint *point,
                     const Double3 normal, Double3 direction);
