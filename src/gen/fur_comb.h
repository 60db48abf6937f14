// SPDX-License-Identifier: MIT
// The way in which fur is combed: a direction along a surface.
#pragma once

#include "gen/fur_map.h"

// A zeroed comb combs nothing.
typedef struct FurComb {
    FurMap axis[3]; // x, y, z; of a picture only the first
    bool combs, is_picture;
} FurComb;

// Reads `text`: three numbers or formulas (fur_map.h) with commas between them, a vector in space;
// or a picture, whose red and green say how far along u and v, from -1 (black) over 0 (the level in
// the middle) to 1. Errors as fur_map_create gives them, with `name` in front.
Result fur_comb_create(FurComb *comb, const char *name, const char *text, const Mesh *mesh,
                       Error *error);
void fur_comb_destroy(FurComb *comb);

// The direction at a point where the surface has this unit normal: the vector, shortened to a
// length of 1 if it is longer, projected onto the surface. Its length is 1 if at least a quarter is
// left of the vector, else four times what is left: hair is combed less where the vector is short
// or stands on the surface.
void fur_comb_at(const FurComb *comb, const Surface *surface, const SurfacePoint *point,
                 const Double3 normal, Double3 direction);
