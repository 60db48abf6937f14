// SPDX-License-Identifier: MIT
// The bust of a mannequin (skull, face, ears, neck and shoulders) as a signed distance. Metres, y
// up, facing +z, crown at y = 0.11, chin at -0.12, origin between the ears. It uses only sums,
// products and square roots, so results are the same on every machine.
#pragma once

#include "base/double3.h"
#include "mesh/mesh.h"

// Signed distance from the surface, m: negative inside, about 0.8 to 1.2 times the exact distance
// near the surface. Mirrored points have exactly equal distances.
double head_distance(const Double3 at);

// The parts of the head that matter within `reach` (m, at most 0.01) of a point. Evaluating the
// distance there takes a fraction of head_distance's time and gives exactly the same result.
enum { HEAD_PARTS_MOST = 64 };

typedef struct HeadPatch {
    Double3 at;   // the point
    double reach; // m
    int count;
    unsigned char part[HEAD_PARTS_MOST];
} HeadPatch;

// Also returns the distance of the point.
double head_patch_find(HeadPatch *patch, const Double3 point, double reach);
double head_patch_distance(const HeadPatch *patch, const Double3 point);

// The outward unit normal, from the gradient of the distance.
void head_normal(const Double3 at, Double3 normal);

// The same for a patch that reaches at least HEAD_NORMAL_REACH (m) from the point. Returns the
// distance.
#define HEAD_NORMAL_REACH 1e-5
double head_patch_normal(const HeadPatch *patch, const Double3 at, Double3 normal);

#define HEAD_UNIT 1e-5 // m, unit of the mesh's coordinates

// A closed mesh of at most `triangle_count` triangles, or as few as simplification permits.
// Vertices are within 0.01 mm of the surface. Texture coordinates are longitude (0.5 in front, the
// seam at the back) and latitude (1 on top) about the origin. RESULT_FAILED when memory is short.
Result head_make_mesh(Mesh *mesh, uint32_t triangle_count, Error *error);
