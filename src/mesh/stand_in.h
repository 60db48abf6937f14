// SPDX-License-Identifier: MIT
// The bust of a mannequin (mesh/head.h) as the mesh that replaces a missing head. It is the same
// for every scene and takes a second to make, so the build makes it once (write_stand_in.c) and the
// programs contain the result.
#pragma once

#include "mesh/mesh.h"

enum { STAND_IN_TRIANGLES = 3968 }; // at most

// In out/<config>/mesh/stand_in_table.c, written by write_stand_in.
typedef struct StandInTable {
    uint32_t vertex_count, triangle_count;
    const int16_t (*position)[3]; // HEAD_UNIT
    const uint16_t (*triangle)[3];
} StandInTable;

extern const StandInTable STAND_IN_TABLE;

// As head_make_mesh(mesh, STAND_IN_TRIANGLES) makes it, without texture coordinates.
// RESULT_FAILED when memory is short.
Result stand_in_make_mesh(Mesh *mesh, Error *error);
