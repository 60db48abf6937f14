// SPDX-License-Identifier: MIT
// Depth maps of a mesh as lights see it, drawn in C, with bounds of squares of texels that decide
// most look-ups.
#pragma once

#include "base/error.h"
#include "draw/shadow_frames.h"
#include "lanes/mesh_raster.h"

enum {
    SHADOW_MESH_SQUARE = 16, // texels: side of a square with one pair of bounds
    SHADOW_MESH_TAPS = 6     // texels per axis that a point reads, at most
};

// A zeroed struct is empty.
typedef struct LaneMeshShadow {
    float *depths; // [map][SHADOW_MESH_SIDE][SHADOW_MESH_SIDE], owned: 0..1; 1: no mesh
    // [map][row][column], owned: the smallest and the largest depth that points in the square read:
    // most points are in front of or behind all of them
    float (*bounds)[2];
    int room; // maps
    MeshRaster raster;
    ShadowMeshKey drawn;
} LaneMeshShadow;

// Draws the placed maps on `parts` threads, unless they show the mesh already. RESULT_FAILED if
// memory is short.
Result shadow_mesh_draw(LaneMeshShadow *shadow, const ShadowFrames *frames, const PlacedMesh *mesh,
                        int parts, Error *error);
void shadow_mesh_destroy(LaneMeshShadow *shadow);

// Finds the bounds of `maps` maps of side x side texels; side is a multiple of SHADOW_MESH_SQUARE.
void shadow_mesh_bound(const float *depths, int side, int maps, float (*bounds)[2], int parts);
