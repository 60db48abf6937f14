// SPDX-License-Identifier: MIT
// A mannequin's bust: skull, face, ears, neck and shoulders, as a signed distance. Metres, y up,
// the face towards +z, crown at y = 0.11, chin at -0.12, the origin between the ears. Sums,
// products and square roots only: the same numbers on every machine.
#pragma once

#include "base/double3.h"
#include "mesh/mesh.h"

// Distance from the surface, m: negative inside, about 0.8 to 1.2 times the exact one near the
// surface. Mirror images have equal distances, to the bit.
double head_distance(const Double3 at);

// The parts of the head that matter within `reach` (m, at most 0.01) of a point: a distance there
// costs a fraction of head_distance's time, and is the same to the bit.
enum { HEAD_PARTS_MOST = 64 };

typedef struct HeadPatch {
    int count;
    unsigned char part[HEAD_PARTS_MOST];
} HeadPatch;

// Returns the point's distance, too.
double head_patch_find(HeadPatch *patch, const Double3 point, double reach);
double head_patch_distance(const HeadPatch *patch, const Double3 point);

// Outward normal of unit length there: the distance's gradient.
void head_normal(const Double3 at, Double3 normal);

// The same of a patch that reaches at least HEAD_NORMAL_REACH (m) from the point.
#define HEAD_NORMAL_REACH 1e-5
void head_patch_normal(const HeadPatch *patch, const Double3 at, Double3 normal);

#define HEAD_UNIT 1e-5 // m: the mesh's coordinates are multiples of it

// A closed mesh of at most `triangle_count` triangles, or as few as keep it whole. Vertices lie on
// the surface to 0.01 mm; texture coordinates are longitude (0.5 in front, the seam at the back)
// and latitude (1 on top) about the origin. RESULT_FAILED when memory is short.
Result head_make_mesh(Mesh *mesh, uint32_t triangle_count, Error *error);
