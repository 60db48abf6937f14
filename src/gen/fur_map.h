// SPDX-License-Identifier: MIT
// A quantity over a surface: a number, a formula of the place, or a picture.
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

// Reads `text`: a number; a name that ends in .png, a picture that lies on the mesh by its texture
// coordinates (u to the right, v up from the lowest row, wrapping around); or a formula (formula.h)
// of x, y, z (m), nx, ny, nz (the normal) and u, v (0 where the mesh has none). `name` (an option)
// stands in front of errors: RESULT_USAGE for a formula that cannot be read or a picture on a mesh
// some of whose triangles have no texture coordinates, RESULT_BAD_INPUT for a picture that cannot
// be read.
Result fur_map_create(FurMap *map, const char *name, const char *text, const Mesh *mesh,
                      Error *error);
void fur_map_destroy(FurMap *map);

// The value there. Of a picture: a channel, 0 to 2, between 0 and 1, bilinear, as it stands in the
// file (sRGB or not). Not for two threads at once.
double fur_map_channel(const FurMap *map, const Surface *surface, const SurfacePoint *point,
                       int channel);

// The same with the mean of red, green and blue.
double fur_map_at(const FurMap *map, const Surface *surface, const SurfacePoint *point);
