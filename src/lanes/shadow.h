// SPDX-License-Identifier: MIT
// How much of each light reaches a point past hair and mesh, in C: makes the shadow maps of a
// frame, and reads them for 16 points at once. The same as glsl/draw/shadow.glsl and
// shadow_surface.glsl, but only for points that are asked for.
//
// The functions that read maps are inlined into loops of SIMD_STAGEs.
#pragma once

#include "base/error.h"
#include "base/simd.h"
#include "draw/mapped_caster.h"
#include "draw/shadow_frames.h"
#include "lanes/shadow_map.h"
#include "lanes/shadow_mesh.h"
#include "lanes/shadow_sample.h"
#include "lanes/tile_order.h"

#include "glsl/kernel/left.h"

typedef struct LaneShadowScene {
    const Light *lights;
    uint32_t light_count;
    MappedCasters casters;           // their `order` and `points` are ignored
    const struct PlacedMesh *mesh;   // casts shadows (mesh_raster.h); NULL: none
    float mesh_low[3], mesh_high[3]; // box of the mesh in its own frame, m
    uint64_t mesh_version;           // differs between meshes, > 0
    float middle[3];                 // m, world: the lamps' target
    uint64_t revision;               // changes whenever positions change; 0: always differs
} LaneShadowScene;

typedef struct LaneShadow {
    ShadowOptions options;
    ShadowParams params;              // params.maps of them
    int map_of[MAX_LIGHTS];           // map of each light; -1: none
    float light_place[MAX_LIGHTS][4]; // of each map's light: unit direction towards it and 0; or
                                      // position in m and 1
    uint64_t version;                 // incremented when maps are made
    int maps_drawn;                   // number of maps drawn by the last lane_shadow_draw
    bool any, by_mesh;                // whether there are maps; whether maps of the mesh
    ShadowMap map;
    // Owned, with room for `room` maps, in the form of shadow_map_draw; layers NULL: approx.
    float *depths;    // [map][side][side]
    uint32_t *layers; // [map][side][tile][SHADOW_LAYERS][SHADOW_MAP_TILE]
    int room;
    LaneMeshShadow mesh;
    TileOrder order;
    ShadowSample sample;
    ShadowKey drawn;
} LaneShadow;

// `options->kind` is not none. RESULT_FAILED if memory is short. A zeroed struct may be destroyed.
Result lane_shadow_create(LaneShadow *shadow, const ShadowOptions *options, Error *error);
void lane_shadow_destroy(LaneShadow *shadow);

// Makes the maps of this scene, unless they show it already. RESULT_FAILED if memory is short.
Result lane_shadow_draw(LaneShadow *shadow, const LaneShadowScene *scene, Error *error);

// --- Light that reaches 16 points.

enum { SHADOW_LOOK = STRAND_TILE }; // points

// Positions of points in a map of hair; `inside`: rays to the light cross the map, in front of it.
typedef struct SIMD_ALIGNED ShadowLook {
    float u[SHADOW_LOOK], v[SHADOW_LOOK], z[SHADOW_LOOK], inside[SHADOW_LOOK];
} ShadowLook;

// `reach`: how far a light's edge moves what it sees, in texels for each unit of depth.
SIMD_INLINE void shadow_look(const LaneShadow *shadow, int map, const float x[3][SHADOW_LOOK],
                             float reach, ShadowLook *look)
{
    const float(*rows)[4] = (const float(*)[4])shadow->params.from_world[map];
    float most = (float)shadow->params.side;
    for (int k = 0; k < SHADOW_LOOK; ++k) {
        CasterPlace p = caster_place(rows, x[0][k], x[1][k], x[2][k]);
        float off = reach * simd_positive(p.z), end = most + off;
        bool inside = (p.u >= -off) & (p.v >= -off) & (p.u <= end) & (p.v <= end);
        look->u[k] = p.u, look->v[k] = p.v, look->z[k] = p.z;
        look->inside[k] = inside ? 1.f : 0.f;
    }
}

// The share past hair, from deep maps. `width`: of the points' own fibres, in texels.
SIMD_INLINE void shadow_look_deep(const LaneShadow *shadow, int map, const ShadowLook *look,
                                  const float width[SHADOW_LOOK], const float opacity[SHADOW_LOOK],
                                  float left[SHADOW_LOOK])
{
    enum { N = SHADOW_LOOK, S = SHADOW_MAP_TILE };
    int side = shadow->params.side, tiles = shadow->map.tiles, pitch = tiles * SHADOW_LAYERS * S;
    const float *depths = shadow->depths + (size_t)map * (size_t)side * (size_t)side;
    const uint32_t *layers = shadow->layers + (size_t)map * (size_t)side * (size_t)pitch;
    float wide = (float)side, last = shadow->map.last, u[N], v[N], begin[N], share[N];
    int column[N], row[N], at[N], next[N];
    for (int k = 0; k < N; ++k) {
        u[k] = left_from(look->u[k], wide, 2);
        v[k] = left_from(look->v[k], wide, 2);
        column[k] = (int)u[k], row[k] = (int)v[k];
        u[k] -= (float)column[k], v[k] -= (float)row[k];
    }
    for (int k = 0; k < N; ++k) {
        int texel = row[k] * side + column[k], below = texel + side;
        begin[k] = left_mix(depths[texel], depths[texel + 1], depths[below], depths[below + 1],
                            u[k], v[k]);
    }
    for (int k = 0; k < N; ++k) {
        // equals layer_of, with a bound that compilers can't know, or they would add jumps
        float root = sqrtf(simd_positive(look->z[k] - begin[k])),
              layer = simd_min((float)SHADOW_LAYERS * root, last);
        int whole = (int)layer, first = row[k] * pitch + whole * S, to = column[k] + 1;
        share[k] = layer - (float)whole;
        at[k] = first + column[k] / S * (SHADOW_LAYERS * S) + column[k] % S;
        next[k] = first + to / S * (SHADOW_LAYERS * S) + to % S;
    }
    for (int k = 0; k < N; ++k) {
        int a = at[k], b = next[k], c = a + pitch, d = b + pitch;
        left[k] = left_mix(layer_depth(layers[a], share[k]), layer_depth(layers[b], share[k]),
                           layer_depth(layers[c], share[k]), layer_depth(layers[d], share[k]), u[k],
                           v[k]);
    }
    for (int k = 0; k < N; ++k) left[k] -= own_layer_depth(width[k], opacity[k], share[k]);
    for (int k = 0; k < N; ++k) left[k] = left_of_fibres(simd_positive(left[k]) * look->inside[k]);
}

// The share past hair, from first depths.
SIMD_INLINE void shadow_look_approx(const LaneShadow *shadow, int map, const ShadowLook *look,
                                    float left[SHADOW_LOOK])
{
    enum { N = SHADOW_LOOK, TAPS = LEFT_TAPS };
    int side = shadow->params.side;
    const float *firsts = shadow->depths + (size_t)map * (size_t)side * (size_t)side;
    float fibres = shadow->params.fibres * shadow->params.place[map][1],
          passed = shadow->params.passed, most = (float)(side - 1), sum[N], weights[N];
    for (int k = 0; k < N; ++k) sum[k] = weights[k] = 0;
    for (int tap = 0; tap < TAPS * TAPS; ++tap) {
        int across = tap % TAPS - TAPS / 2, down = tap / TAPS - TAPS / 2;
        for (int k = 0; k < N; ++k) {
            float u = simd_min(simd_max(look->u[k], 0), most + 1),
                  v = simd_min(simd_max(look->v[k], 0), most + 1);
            float x = (float)((int)u + across), y = (float)((int)v + down);
            int column = (int)simd_min(simd_max(x, 0), most),
                row = (int)simd_min(simd_max(y, 0), most);
            float weight = left_cone(x + 0.5f - u, y + 0.5f - v),
                  count = left_fibres(look->z[k], firsts[row * side + column], fibres);
            sum[k] += weight * SHARED_EXP2(passed * count);
            weights[k] += weight;
        }
    }
    for (int k = 0; k < N; ++k) {
        float share = sum[k] / weights[k];
        left[k] = look->inside[k] > 0 ? share : 1;
    }
}

// The same of a wide light (kernel/left.h). `surface`: the points lie on a mesh or a floor.
SIMD_INLINE void shadow_look_wide(const LaneShadow *shadow, int map, const ShadowLook *look,
                                  bool surface, const float width[SHADOW_LOOK],
                                  const float opacity[SHADOW_LOOK], float left[SHADOW_LOOK])
{
    enum { N = SHADOW_LOOK, S = SHADOW_MAP_TILE };
    const float(*rays)[4] =
        (const float(*)[4])(surface ? shadow->params.spread : shadow->params.ray);
    int count = surface ? LEFT_SPREAD : LEFT_RAYS, side = shadow->params.side,
        pitch = shadow->map.tiles * SHADOW_LAYERS * S;
    const float *depths = shadow->depths + (size_t)map * (size_t)side * (size_t)side;
    const uint32_t *layers = shadow->layers + (size_t)map * (size_t)side * (size_t)pitch;
    float reach = shadow->params.wide[map][0], last = shadow->map.last, front[N], sum[N];
    for (int k = 0; k < N; ++k) front[k] = look->z[k], sum[k] = 0;
    for (int r = 0; r < count; ++r) {
        for (int k = 0; k < N; ++k) {
            float off = reach * simd_positive(look->z[k]);
            int column = left_texel(look->u[k] + off * rays[r][0], side),
                row = left_texel(look->v[k] + off * rays[r][1], side);
            front[k] = simd_min(depths[row * side + column], front[k]);
        }
    }
    for (int r = 0; r < count; ++r) {
        const float *ray = rays[r];
        float fibres[N], share[N];
        for (int k = 0; k < N; ++k) fibres[k] = share[k] = 0;
        for (int slab = 0; slab < LEFT_SLABS; ++slab) {
            float away = reach * left_slab_place(slab), ends[2] = {0, left_slab_end(slab)};
            if (slab) ends[0] = left_slab_end(slab - 1);
            for (int k = 0; k < N; ++k) {
                float span = look->z[k] - front[k], off = away * span,
                      u = look->u[k] + off * ray[0] + ray[2],
                      v = look->v[k] + off * ray[1] + ray[3];
                int column = left_texel(u, side), row = left_texel(v, side),
                    at = row * pitch + column / S * (SHADOW_LAYERS * S) + column % S;
                float begin = depths[row * side + column], depth[2];
                for (int e = 0; e < 2; ++e) {
                    float root = sqrtf(simd_positive(front[k] + ends[e] * span - begin)),
                          layer = simd_min((float)SHADOW_LAYERS * root, last);
                    int whole = (int)layer;
                    share[k] = layer - (float)whole;
                    depth[e] = layer_depth(layers[at + whole * S], share[k]);
                }
                float met = depth[1] - depth[0];
                fibres[k] += surface ? left_on_map(u, v, (float)side) * met : met;
            }
        }
        for (int k = 0; k < N; ++k) {
            fibres[k] -= own_layer_depth(width[k], opacity[k], share[k]);
            sum[k] += left_of_fibres(simd_positive(fibres[k]) * look->inside[k]);
        }
    }
    float scale = 1 / (float)count;
    for (int k = 0; k < N; ++k) left[k] = scale * sum[k];
}

// `surface`: the points lie on a mesh or a floor.
SIMD_INLINE void shadow_look_hair(const LaneShadow *shadow, int map, const ShadowLook *look,
                                  bool surface, const float radius[SHADOW_LOOK],
                                  const float opacity[SHADOW_LOOK], float left[SHADOW_LOOK])
{
    float width[SHADOW_LOOK], across = 2 * shadow->params.place[map][3];
    for (int k = 0; k < SHADOW_LOOK; ++k) width[k] = radius[k] * across;
    if (shadow->layers && shadow->params.wide[map][0] > 0)
        shadow_look_wide(shadow, map, look, surface, width, opacity, left);
    else if (shadow->layers)
        shadow_look_deep(shadow, map, look, width, opacity, left);
    else
        shadow_look_approx(shadow, map, look, left);
}

// The places of points in a map of the mesh, in texels and depths; `covered`: 1 inside the map,
// else 0.
SIMD_INLINE void shadow_find_mesh(const LaneShadow *shadow, int map, const float x[3][SHADOW_LOOK],
                                  float u[SHADOW_LOOK], float v[SHADOW_LOOK],
                                  float depth[SHADOW_LOOK], float covered[SHADOW_LOOK])
{
    const float(*rows)[4] = (const float(*)[4])shadow->params.mesh_from_world[map];
    float wide = (float)shadow->params.mesh_side, shift = shadow->params.place[map][2];
    for (int k = 0; k < SHADOW_LOOK; ++k) {
        float inverse = 1 / caster_row(rows, 3, x[0][k], x[1][k], x[2][k]),
              across = caster_row(rows, 0, x[0][k], x[1][k], x[2][k]) * inverse,
              down = caster_row(rows, 1, x[0][k], x[1][k], x[2][k]) * inverse,
              z = caster_row(rows, 2, x[0][k], x[1][k], x[2][k]) * inverse - shift;
        bool on = (across >= 0) & (down >= 0) & (across <= wide) & (down <= wide);
        covered[k] = on ? 1.f : 0.f;
        u[k] = across, v[k] = down;
        depth[k] = z;
    }
}

// The share of a wide light that passes the mesh (kernel/left.h) to points at these places.
SIMD_INLINE void shadow_look_wide_mesh(const LaneShadow *shadow, int map,
                                       const float u[SHADOW_LOOK], const float v[SHADOW_LOOK],
                                       const float depth[SHADOW_LOOK], float past[SHADOW_LOOK])
{
    enum { N = SHADOW_LOOK };
    int side = shadow->params.mesh_side;
    const float *depths = shadow->mesh.depths + (size_t)map * (size_t)side * (size_t)side;
    float reach = shadow->params.wide[map][1], sum[N], count[N], nearest[N], off[N];
    for (int k = 0; k < N; ++k) sum[k] = count[k] = nearest[k] = 0;
    for (int r = 0; r < LEFT_RAYS; ++r) {
        const float *ray = shadow->params.ray[r];
        for (int step = 0; step < LEFT_STEPS; ++step) {
            float aside = reach * left_step(step),
                  length = sqrtf(ray[0] * ray[0] + ray[1] * ray[1]);
            for (int k = 0; k < N; ++k) {
                float away = aside * simd_positive(depth[k]);
                int column = left_texel(u[k] + away * ray[0] + ray[2], side),
                    row = left_texel(v[k] + away * ray[1] + ray[3], side);
                float gap = depths[row * side + column];
                bool before = left_in_way(step, gap, depth[k], length);
                sum[k] += before ? gap : 0;
                count[k] += before ? 1.f : 0.f;
                nearest[k] = before ? simd_max(gap, nearest[k]) : nearest[k];
            }
        }
    }
    for (int k = 0; k < N; ++k) {
        off[k] = reach * (depth[k] - sum[k] / simd_max(count[k], 1));
        nearest[k] = left_limit(depth[k], nearest[k]);
        past[k] = 0;
    }
    for (int r = 0; r < LEFT_RAYS; ++r) {
        const float *ray = shadow->params.ray[r];
        float across = ray[0], down = ray[1];
        for (int turn = 0; turn < LEFT_TURNS; ++turn) {
            for (int k = 0; k < N; ++k) {
                int column = left_texel(u[k] + off[k] * across + ray[2], side),
                    row = left_texel(v[k] + off[k] * down + ray[3], side);
                bool blocked = (count[k] > 0) & (depths[row * side + column] < nearest[k]);
                past[k] += blocked ? 0 : 1.f / (LEFT_RAYS * LEFT_TURNS);
            }
            float turned = LEFT_TURN_COS * across - LEFT_TURN_SIN * down;
            down = LEFT_TURN_SIN * across + LEFT_TURN_COS * down;
            across = turned;
        }
    }
}

// The share past the mesh, 0 .. 1, for points on hair and surfaces; `covered`: 1 inside the map,
// else 0.
SIMD_INLINE void shadow_look_mesh(const LaneShadow *shadow, int map, const float x[3][SHADOW_LOOK],
                                  int taps, float past[SHADOW_LOOK], float covered[SHADOW_LOOK])
{
    enum { N = SHADOW_LOOK, Q = SHADOW_MESH_SQUARE };
    int side = shadow->params.mesh_side, squares = side / Q, texel[N], open[N], any = 0;
    const float *depths = shadow->mesh.depths + (size_t)map * (size_t)side * (size_t)side;
    const float(*bounds)[2] =
        (const float(*)[2])shadow->mesh.bounds + (size_t)map * (size_t)squares * (size_t)squares;
    float wide = (float)side, u[N], v[N], depth[N];
    shadow_find_mesh(shadow, map, x, u, v, depth, covered);
    if (shadow->params.wide[map][1] > 0) {
        shadow_look_wide_mesh(shadow, map, u, v, depth, past);
        return;
    }
    for (int k = 0; k < N; ++k) {
        depth[k] = simd_min(depth[k], 1); // points behind the map's range get its far end
        u[k] = left_from(u[k], wide, (float)taps);
        v[k] = left_from(v[k], wide, (float)taps);
        int column = (int)u[k], row = (int)v[k];
        u[k] -= (float)column, v[k] -= (float)row;
        texel[k] = row * side + column;
        open[k] = row / Q * squares + column / Q;
    }
    for (int k = 0; k < N; ++k) {
        float least = bounds[open[k]][0], most = bounds[open[k]][1];
        past[k] = least < depth[k] ? 0.f : 1.f;
        open[k] = (least < depth[k]) & (most >= depth[k]);
        texel[k] = open[k] ? texel[k] : 0;
        any |= open[k];
    }
    if (!any) return;
    float sum[N], scale = 1 / (float)((taps - 1) * (taps - 1));
    for (int k = 0; k < N; ++k) sum[k] = 0;
    for (int j = 0; j < taps; ++j)
        for (int i = 0; i < taps; ++i)
            for (int k = 0; k < N; ++k) {
                float inside = left_inside(i, taps, u[k]) * left_inside(j, taps, v[k]);
                sum[k] += left_lit(depths[texel[k] + j * side + i], depth[k], inside);
            }
    for (int k = 0; k < N; ++k) past[k] = open[k] ? scale * sum[k] : past[k];
}

// The share, 0 .. 1, of a map's light that reaches points x (m) in the middle of fibres, past hair
// and mesh. `radius` (m) and `opacity` (to light) are those of the fibres themselves, whose own
// shadow is left out.
SIMD_INLINE void lane_shadow_left_of(const LaneShadow *shadow, int map,
                                     const float x[3][SHADOW_LOOK], const float radius[SHADOW_LOOK],
                                     const float opacity[SHADOW_LOOK], float left[SHADOW_LOOK])
{
    const float *before = shadow->params.from_world[map][3];
    ShadowLook look;
    shadow_look(shadow, map, x, 0, &look);
    shadow_look_hair(shadow, map, &look, false, radius, opacity, left);
    if (!shadow->by_mesh) return;
    float past[SHADOW_LOOK], covered[SHADOW_LOOK];
    shadow_look_mesh(shadow, map, x, 2, past, covered);
    for (int k = 0; k < SHADOW_LOOK; ++k) { // there is no shadow behind a lamp
        float w = before[0] * x[0][k] + before[1] * x[1][k] + before[2] * x[2][k] + before[3];
        left[k] *= w > 0 ? past[k] : 1;
    }
}

// The same for points on surfaces with unit normals: of the mesh (moved by mesh_lift) or of a
// floor. `wrap`: the greatest cosine below the horizon at which light still counts; up to the same
// cosine above the horizon a surface's own shadow is faded in. `taps`: texels of the mesh's map
// that are averaged along each axis, 2 .. SHADOW_MESH_TAPS. Where a light cannot shine the share is
// 1.
SIMD_INLINE void lane_shadow_left_on(const LaneShadow *shadow, const float x[3][SHADOW_LOOK],
                                     const float normal[3][SHADOW_LOOK], float wrap, int taps,
                                     float left[][SHADOW_LOOK])
{
    static const float none[SHADOW_LOOK] = {0};
    float shone[SHADOW_LOOK], own[SHADOW_LOOK];
    ShadowLook look;
    for (int map = 0; map < shadow->params.maps; ++map) {
        const float *at = shadow->light_place[map], *before = shadow->params.from_world[map][3];
        for (int k = 0; k < SHADOW_LOOK; ++k) {
            float way[3], square = 0, facing = 0;
            for (int c = 0; c < 3; ++c) {
                way[c] = at[c] - at[3] * x[c][k];
                square += way[c] * way[c];
                facing += way[c] * normal[c][k];
            }
            facing /= sqrtf(simd_max(square, 1e-30f));
            float w = before[0] * x[0][k] + before[1] * x[1][k] + before[2] * x[2][k] + before[3];
            float t = simd_min(simd_max(facing / simd_max(wrap, 1e-6f), 0), 1);
            shone[k] = ((facing > -wrap) & (w > 0)) ? 1.f : 0.f;
            own[k] = wrap > 0 ? t * t * (3 - 2 * t) : 1;
        }
        shadow_look(shadow, map, x, shadow->layers ? shadow->params.wide[map][0] : 0, &look);
        for (int k = 0; k < SHADOW_LOOK; ++k) look.inside[k] *= look.z[k] > 0 ? shone[k] : 0;
        shadow_look_hair(shadow, map, &look, true, none, none, left[map]);
        if (!shadow->by_mesh) continue;
        float past[SHADOW_LOOK], covered[SHADOW_LOOK];
        shadow_look_mesh(shadow, map, x, taps, past, covered);
        for (int k = 0; k < SHADOW_LOOK; ++k)
            left[map][k] *= 1 + shone[k] * covered[k] * own[k] * (past[k] - 1);
    }
}
