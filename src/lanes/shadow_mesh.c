// SPDX-License-Identifier: MIT
#include "lanes/shadow_mesh.h"

#include "base/room.h"
#include "base/simd.h"

#include <stdlib.h>
#include <string.h>

enum { SIDE = SHADOW_MESH_SIDE, SQUARE = SHADOW_MESH_SQUARE, REACH = SHADOW_MESH_TAPS - 1 };

typedef struct Bounding {
    const float *depths;
    float (*bounds)[2];
    int side, rows, parts; // side: texels of a map; rows: rows of squares of all maps
} Bounding;

// The bounds of all depths that a point in the square may sample: its texels and REACH more on each
// side, within the map.
SIMD_INLINE void bound_square(const float *first, int side, int wide, int high, float bounds[2])
{
    float least[SQUARE], most[SQUARE], low = first[0], top = first[0];
    for (int k = 0; k < SQUARE; ++k) least[k] = most[k] = first[k];
    for (int y = 0; y < high; ++y) {
        const float *row = first + (ptrdiff_t)y * side;
        for (int end = 0; end < 2; ++end) { // the first SQUARE texels of a row, and the last
            const float *at = end ? row + wide - SQUARE : row;
            for (int k = 0; k < SQUARE; ++k) {
                least[k] = simd_min(at[k], least[k]);
                most[k] = simd_max(at[k], most[k]);
            }
        }
    }
    for (int k = 0; k < SQUARE; ++k) {
        low = simd_min(least[k], low);
        top = simd_max(most[k], top);
    }
    bounds[0] = low;
    bounds[1] = top;
}

SIMD_INLINE void bound_squares(const Bounding *all, int part)
{
    int across = all->side / SQUARE, end = all->rows * (part + 1) / all->parts;
    for (int row = all->rows * part / all->parts; row < end; ++row)
        for (int column = 0; column < across; ++column) {
            int wide = column + 1 < across ? SQUARE + REACH : SQUARE,
                high = row % across + 1 < across ? SQUARE + REACH : SQUARE;
            bound_square(all->depths + (ptrdiff_t)row * SQUARE * all->side + column * SQUARE,
                         all->side, wide, high, all->bounds[row * across + column]);
        }
}

SIMD_STAGE(bound_squares, Bounding)

void shadow_mesh_bound(const float *depths, int side, int maps, float (*bounds)[2], int parts)
{
    Bounding all = {depths, bounds, side, maps * (side / SQUARE), parts};
    run_bound_squares(&all, parts);
}

static Result make_room(LaneMeshShadow *shadow, int maps, Error *error)
{
    enum { SQUARES = SIDE / SQUARE * (SIDE / SQUARE) };
    if (shadow->room >= maps) return RESULT_OK;
    shadow_mesh_destroy(shadow);
    shadow->depths = room_new((size_t)maps * SIDE * SIDE, sizeof *shadow->depths);
    shadow->bounds = malloc((size_t)maps * SQUARES * sizeof *shadow->bounds);
    shadow->room = maps;
    if (shadow->depths && shadow->bounds) return RESULT_OK;
    shadow_mesh_destroy(shadow);
    return error_set(error, RESULT_FAILED, "no memory for shadows of the mesh");
}

Result shadow_mesh_draw(LaneMeshShadow *shadow, const ShadowFrames *frames, const PlacedMesh *mesh,
                        int parts, Error *error)
{
    ShadowMeshKey key = shadow_frames_mesh_key(frames);
    if (shadow->room >= key.maps && memcmp(&shadow->drawn, &key, sizeof key) == 0) return RESULT_OK;
    TRY(make_room(shadow, key.maps, error));
    memset(&shadow->drawn, 0, sizeof shadow->drawn);
    for (int map = 0; map < key.maps; ++map)
        TRY(mesh_raster_depths(&shadow->raster, mesh, (const float(*)[4])key.frames[map], SIDE,
                               shadow->depths + (size_t)map * SIDE * SIDE, parts, error));
    shadow_mesh_bound(shadow->depths, SIDE, key.maps, shadow->bounds, parts);
    memcpy(&shadow->drawn, &key, sizeof key);
    return RESULT_OK;
}

void shadow_mesh_destroy(LaneMeshShadow *shadow)
{
    free(shadow->depths);
    free(shadow->bounds);
    mesh_raster_destroy(&shadow->raster);
    *shadow = (LaneMeshShadow){0};
}
