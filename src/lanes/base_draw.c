// SPDX-License-Identifier: MIT
#include "lanes/base.h"

#include "base/room.h"

#include "lanes/base_floor.h"
#include "lanes/base_mesh.h"

#include <stdlib.h>
#include <string.h>

enum {
    BAND = 8, // rows that a thread processes at a time
    WIDER = 2 // samples that are added around the mesh's box
};

void lane_base_destroy(LaneBase *base)
{
    mesh_raster_destroy(&base->raster);
    mesh_surface_destroy(&base->surface);
    free(base->lit);
    free(base->light);
    free(base->depth);
    free(base->rim);
    free(base->rimmed);
    *base = (LaneBase){0};
}

// --- Room.

static int clamp(int x, int most)
{
    return x < 0 ? 0 : x > most ? most : x;
}

// The part of a box that lies in the image, with its left edge at a multiple of W. Empty if the box
// lies outside.
static void find_part(const DrawParams *draw, const int box[4], int wider, int part[4])
{
    int width = (int)draw->width, height = (int)draw->height;
    part[0] = clamp(box[0] - wider, width) / W * W;
    part[1] = clamp(box[1] - wider, height);
    part[2] = clamp(box[2] < width ? box[2] + 1 + wider : width, width);
    part[3] = clamp(box[3] < height ? box[3] + 1 + wider : height, height);
    for (int k = 0; k < 2; ++k)
        if (part[k + 2] < part[k]) part[k + 2] = part[k];
}

static Result make_room(LaneBase *base, const LaneBaseScene *scene, Error *error)
{
    int mesh[4] = {0}, all[4];
    if (scene->mesh.triangle_count) find_part(scene->draw, scene->mesh_box, WIDER, mesh);
    find_part(scene->draw, scene->box, 0, all);
    TRY(mesh_surface_resize(&base->surface, mesh[2] - mesh[0], mesh[3] - mesh[1], error));
    base->low[0] = mesh[0];
    base->low[1] = mesh[1];
    size_t lit = 3 * (size_t)base->surface.pitch * (size_t)base->surface.height,
           count = (size_t)(all[2] - all[0]) * (size_t)(all[3] - all[1]),
           words =
               (size_t)((all[2] - all[0] + RIM_BITS - 1) / RIM_BITS) * (size_t)(all[3] - all[1]);
    size_t room = base->room, rim_room = room; // they grow together
    bool good = room_make(&base->lit, &base->lit_room, lit, sizeof *base->lit) &&
                room_make(&base->light, &room, count, sizeof *base->light) &&
                room_make(&base->rim, &rim_room, count, sizeof *base->rim) &&
                room_make(&base->rimmed, &base->rimmed_room, words, sizeof *base->rimmed) &&
                room_make(&base->depth, &base->room, count, sizeof *base->depth);
    if (!good) base->room = 0;
    base->shown = (BlockBase){.x = all[0],
                              .y = all[1],
                              .width = all[2] - all[0],
                              .height = all[3] - all[1],
                              .light = (const uint16_t(*)[4])(void *)base->light,
                              .depth = base->depth,
                              .rimmed = base->rimmed,
                              .rim = base->rim};
    return good ? RESULT_OK
                : error_set(error, RESULT_FAILED, "no memory for %zu px of mesh and floor", count);
}

// --- The mesh's surface.

// The matrix rows that map to px of the surface and to depths 0 .. 1.
static void find_rows(const DrawParams *draw, const int low[2], float rows[4][4])
{
    const float size[2] = {draw->width, draw->height};
    for (int j = 0; j < 4; ++j) {
        const float *clip = draw->clip_from_world[j];
        double w = (double)clip[3];
        for (int k = 0; k < 2; ++k)
            rows[k][j] =
                (float)(0.5 * (double)size[k] * ((double)clip[k] + w) - (double)low[k] * w);
        rows[2][j] = (float)(0.5 * ((double)clip[2] + w));
        rows[3][j] = clip[3];
    }
}

// --- Combining mesh, floor and background.

typedef struct Finish {
    const LaneBase *base;
    BaseView view;
    BaseFloor floor;
    const Backdrop *backdrop;
    int samples, parts;
} Finish;

// Values of 16 px: premultiplied sums of all samples in front of the floor and behind it, the
// depth, and the rims of the pixels whose bits are set in `rimmed`.
typedef struct Pixels {
    float front[4][W], behind[4][W], depth[W];
    float background[4][W];
    float rim[3][W], rim_depth[W];
    uint16_t rim_samples[W];
    unsigned rimmed;
} Pixels;

// The 3 x 3 px around (x, y): depths at pixel centres and their addresses.
typedef struct Around {
    float depth[9];
    size_t at[9];
} Around;

static Around look_around(const MeshSurface *surface, int x, int y)
{
    Around around;
    for (int n = 0; n < 9; ++n) {
        int column = clamp(x + n % 3 - 1, surface->width - 1),
            row = clamp(y + n / 3 - 1, surface->height - 1);
        around.at[n] = (size_t)row * (size_t)surface->pitch + (size_t)column;
        around.depth[n] = surface->depth[around.at[n]];
    }
    return around;
}

// Adds a sample to the rim of the pixel in lane k.
static void add_rim(const float color[3], float z, int k, Pixels *pixels)
{
    bool first = !(pixels->rimmed >> k & 1);
    for (int c = 0; c < 3; ++c) pixels->rim[c][k] = (first ? 0 : pixels->rim[c][k]) + color[c];
    pixels->rim_depth[k] = first ? z : simd_max(z, pixels->rim_depth[k]);
    pixels->rim_samples[k] = first ? 1 : (uint16_t)(pixels->rim_samples[k] + 1);
    pixels->rimmed |= 1u << k;
}

// Resolves a pixel at an edge of the mesh, in lane k, from its four samples.
static void add_edge(const Finish *finish, int x, int y, const float z[MESH_EDGES], float floor_z,
                     int k, Pixels *pixels)
{
    const LaneBase *base = finish->base;
    const MeshSurface *surface = &base->surface;
    const DrawParams *draw = finish->view.draw;
    const size_t plane = base->lit_room / 3;
    size_t at = (size_t)y * (size_t)surface->pitch + (size_t)x;
    Around around = look_around(surface, x, y);
    for (int c = 0; c < 4; ++c) pixels->front[c][k] = pixels->behind[c][k] = 0;
    for (int i = 0; i < MESH_EDGES; ++i) {
        float off = edge_off(z[i], surface->depth[at]);
        bool mesh = z[i] < EDGE_NOWHERE && surface->depth[at] < EDGE_NOWHERE;
        size_t from = at;
        for (int n = 0; n < 9; ++n) {
            float own = fabsf(z[i] - around.depth[n]);
            if (!(around.depth[n] < EDGE_NOWHERE && own < off)) continue;
            off = own, from = around.at[n], mesh = true;
        }
        float(*to)[W] = z[i] < floor_z ? pixels->front : pixels->behind, color[4];
        for (int c = 0; c < 4; ++c) {
            float shown = c == 3 ? 1 : base->lit[(size_t)c * plane + from];
            color[c] = (mesh ? shown : pixels->background[c][k]) / MESH_EDGES;
            to[c][k] += color[c];
        }
        if (z[i] < floor_z &&
            edge_rims(z[i], pixels->depth[k], edge_steep(z[i], draw->depth[0], draw->focal)))
            add_rim(color, z[i], k, pixels);
    }
}

SIMD_INLINE void add_mesh(const Finish *finish, int x, int y, const float floor_z[W],
                          Pixels *pixels)
{
    const LaneBase *base = finish->base;
    const MeshSurface *surface = &base->surface;
    const DrawParams *draw = finish->view.draw;
    const size_t plane = base->lit_room / 3;
    size_t at = (size_t)y * (size_t)surface->pitch + (size_t)x;
    const float *middle = surface->depth + at;
    float z[MESH_EDGES][W], share[W];
    int edge[W], edges = 0;
    for (int i = 0; i < MESH_EDGES; ++i) memcpy(z[i], surface->edge[i] + at, sizeof z[i]);
    for (int k = 0; k < W; ++k) {
        float own = middle[k], steep = edge_steep(own, draw->depth[0], draw->focal), far = own,
              nearer = 0;
        int parts = 0;
        for (int i = 0; i < MESH_EDGES; ++i) {
            far = simd_max(z[i][k], far);
            parts |= edge_parts(z[i][k], own, steep);
            nearer += z[i][k] < floor_z[k] ? 1.0f / MESH_EDGES : 0;
        }
        pixels->depth[k] = parts ? far : own;
        share[k] = nearer;
        edge[k] = parts;
        edges |= parts;
    }
    for (int c = 0; c < 4; ++c) {
        const float *lit = base->lit + (size_t)(c < 3 ? c : 0) * plane + at;
        for (int k = 0; k < W; ++k) {
            float own = c < 3 ? lit[k] : 1;
            own = middle[k] < EDGE_NOWHERE ? own : pixels->background[c][k];
            pixels->front[c][k] = share[k] * own;
            pixels->behind[c][k] = own - share[k] * own;
        }
    }
    for (int k = 0; edges && k < W; ++k) {
        const float own[MESH_EDGES] = {z[0][k], z[1][k], z[2][k], z[3][k]};
        if (edge[k] && x + k < surface->width)
            add_edge(finish, x + k, y, own, floor_z[k], k, pixels);
    }
}

// Converts a finite, non-negative number to a half float.
SIMD_INLINE uint16_t half_of(float x)
{
    x = simd_min(simd_max(x, 0), 65504) * 0x1p-112f;
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return (uint16_t)((bits + 0xfff + (bits >> 13 & 1)) >> 13); // rounds to nearest, ties to even
}

SIMD_INLINE void store(const LaneBase *base, int x, int y, const Pixels *pixels)
{
    const BlockBase *shown = &base->shown;
    uint16_t halves[W][4];
    size_t at = (size_t)(y - shown->y) * (size_t)shown->width + (size_t)(x - shown->x),
           words = (size_t)((shown->width + RIM_BITS - 1) / RIM_BITS);
    int left = shown->x + shown->width - x, count = left < W ? left : W;
    for (int k = 0; k < W; ++k)
        for (int c = 0; c < 4; ++c) halves[k][c] = half_of(pixels->front[c][k]);
    memcpy(base->light + at, halves, (size_t)count * sizeof *halves);
    memcpy(base->depth + at, pixels->depth, (size_t)count * sizeof *pixels->depth);
    base->rimmed[(size_t)(y - shown->y) * words + (size_t)(x - shown->x) / RIM_BITS] =
        (uint16_t)pixels->rimmed;
    for (int k = 0; pixels->rimmed && k < count; ++k) {
        if (!(pixels->rimmed >> k & 1)) continue;
        BaseRim *rim = &base->rim[at + (size_t)k];
        for (int c = 0; c < 3; ++c) rim->light[c] = half_of(pixels->rim[c][k]);
        rim->samples = pixels->rim_samples[k];
        rim->depth = pixels->rim_depth[k];
    }
}

// The background in 16 px from (x, y) on.
SIMD_INLINE void find_background(const Finish *finish, int x, int y, float background[4][W])
{
    const Backdrop *backdrop = finish->backdrop;
    for (int c = 0; c < 4 && !backdrop; ++c)
        for (int k = 0; k < W; ++k) background[c][k] = finish->view.draw->background[c];
    for (int k = 0; k < W && backdrop; ++k) {
        int column = (x + k) / finish->samples, last = backdrop->width - 1;
        const float *light =
            backdrop->light[(size_t)(y / finish->samples) * (size_t)backdrop->width +
                            (size_t)(column < last ? column : last)];
        for (int c = 0; c < 4; ++c) background[c][k] = light[c];
    }
}

SIMD_INLINE void finish_pixels(const Finish *finish, int x, int y)
{
    const LaneBase *base = finish->base;
    const MeshSurface *surface = &base->surface;
    int column = x - base->low[0], row = y - base->low[1];
    BaseFloorPoints floor;
    Pixels pixels;
    bool floored = finish->floor.kind != FLOOR_NONE &&
                   base_floor_find(&finish->floor, &finish->view, x, y, &floor);
    for (int k = 0; !floored && k < W; ++k) floor.depth[k] = EDGE_NOWHERE;
    pixels.rimmed = 0;
    find_background(finish, x, y, pixels.background);
    if (column >= 0 && column < surface->pitch && row >= 0 && row < surface->height) {
        add_mesh(finish, column, row, floor.depth, &pixels);
    } else {
        for (int c = 0; c < 4; ++c)
            for (int k = 0; k < W; ++k)
                pixels.front[c][k] = 0, pixels.behind[c][k] = pixels.background[c][k];
        for (int k = 0; k < W; ++k) pixels.depth[k] = EDGE_NOWHERE;
    }
    if (floored) {
        float shown[4][W];
        base_floor_shade(&finish->floor, &finish->view, &floor, shown);
        for (int c = 0; c < 4; ++c)
            for (int k = 0; k < W; ++k)
                pixels.front[c][k] += (1 - pixels.front[3][k]) * shown[c][k] +
                                      (1 - shown[3][k]) * pixels.behind[c][k];
        base_floor_hide(&finish->floor, &floor, pixels.depth);
    } else {
        for (int c = 0; c < 4; ++c)
            for (int k = 0; k < W; ++k) pixels.front[c][k] += pixels.behind[c][k];
    }
    store(base, x, y, &pixels);
}

SIMD_INLINE void finish_rows(const Finish *finish, int part)
{
    const BlockBase *shown = &finish->base->shown;
    for (int y = shown->y; y < shown->y + shown->height; ++y)
        for (int x = shown->x; x < shown->x + shown->width && y / BAND % finish->parts == part;
             x += W)
            finish_pixels(finish, x, y);
}
SIMD_STAGE(finish_rows, Finish)

static Result draw_all(LaneBase *base, const LaneBaseScene *scene, bool moved, Error *error)
{
    int parts = parallel_threads();
    if (moved) TRY(make_room(base, scene, error));
    if (scene->mesh.triangle_count) {
        float rows[4][4];
        find_rows(scene->draw, base->low, rows);
        if (moved)
            TRY(mesh_raster_surface(&base->raster, &scene->mesh, (const float(*)[4])rows,
                                    &base->surface, parts, error));
        base_mesh_light(base, scene, parts);
    }
    Finish finish = {base,
                     {scene->draw, rays_find(scene->draw)},
                     base_floor(scene->floor, scene->shadow, scene->draw),
                     scene->backdrop,
                     scene->samples,
                     parts};
    run_finish_rows(&finish, parts);
    return RESULT_OK;
}

Result lane_base_draw(LaneBase *base, const LaneBaseScene *scene, Error *error)
{
    bool moved = !base->any || base->mesh_version != scene->mesh_version ||
                 memcmp(&base->drawn, scene->draw, sizeof base->drawn) != 0;
    uint64_t shadowed = scene->shadow ? scene->shadow->version : 0;
    if (!moved && base->shadowed == shadowed) return RESULT_OK;
    base->any = false;
    ++base->version;
    if (moved) ++base->depth_version;
    TRY(draw_all(base, scene, moved, error));
    base->drawn = *scene->draw;
    base->mesh_version = scene->mesh_version;
    base->shadowed = shadowed;
    base->any = true;
    return RESULT_OK;
}
