// SPDX-License-Identifier: MIT
#include "lanes/base_mesh.h"

#include "lanes/base_light.h"
#include "lanes/light_grid_onto.h"

#include "glsl/kernel/skin.h"

enum {
    BAND = 4,     // rows that a thread processes at a time
    MESH_TAPS = 4 // of its own shadow map, whose texels would show under grazing light
};

typedef struct Lighting {
    const LaneBase *base;
    const LaneShadow *shadow;
    const LightGrid *grid; // NULL: hair sends no light onto the surface
    BaseView view;
    bool skin;
    int parts;
} Lighting;

// The surface points of 16 px. Values of pixels without mesh are not used.
typedef struct Points {
    float x[3][W], normal[3][W], to_eye[3][W]; // x: m; the others are unit vectors
    float open[W], bare[W];                    // share of the sky that is seen, and without hair
    float color[3][W];                         // linear RGB, tinted
} Points;

SIMD_INLINE float dot3(const float a[3][W], const float b[3][W], int k)
{
    return a[0][k] * b[0][k] + a[1][k] * b[1][k] + a[2][k] * b[2][k];
}

// Surfaces that are seen from behind are lit like front faces. Pixels without mesh get arbitrary
// finite points; their memory may be uninitialised, which is harmless.
SIMD_INLINE void find_points(const Lighting *lighting, int x, int y, Points *points)
{
    const LaneBase *base = lighting->base;
    const MeshSurface *surface = &base->surface;
    const float *eye = lighting->view.draw->eye;
    size_t at = (size_t)y * (size_t)surface->pitch + (size_t)x;
    float way[3][W], w[W], normal[3][W];
    base_ways(&lighting->view, base->low[0] + x, base->low[1] + y, way);
    for (int k = 0; k < W; ++k) {
        float there = surface->depth[at + (size_t)k] < 1 ? 1 : 0;
        w[k] = 1 / (surface->inverse[at + (size_t)k] * there + 1 - there);
        for (int c = 0; c < 3; ++c) normal[c][k] = w[k] * surface->normal[c][at + (size_t)k];
        for (int c = 0; c < 3; ++c)
            points->color[c][k] =
                lighting->view.draw->mesh_color[c] * w[k] * surface->tint[c][at + (size_t)k];
    }
    const float(*n)[W] = (const float(*)[W])normal;
    for (int k = 0; k < W; ++k) {
        float square = simd_max(dot3(n, n, k), 1e-20f), unit = 1 / sqrtf(square);
        points->open[k] = simd_min(square * unit, 1);
        points->bare[k] = simd_min(w[k] * surface->tint[3][at + (size_t)k], 1);
        unit = dot3(n, (const float(*)[W])way, k) > 0 ? -unit : unit;
        for (int c = 0; c < 3; ++c) {
            points->normal[c][k] = unit * n[c][k];
            points->x[c][k] = eye[c] + w[k] * way[c][k];
        }
    }
    for (int c = 0; c < 3 && lighting->shadow; ++c) // avoids self-shadowing
        for (int k = 0; k < W; ++k)
            points->x[c][k] += lighting->shadow->params.mesh_lift * points->normal[c][k];
    for (int k = 0; k < W; ++k) {
        float back =
            -1 / sqrtf(way[0][k] * way[0][k] + way[1][k] * way[1][k] + way[2][k] * way[2][k]);
        for (int c = 0; c < 3; ++c) points->to_eye[c][k] = back * way[c][k];
    }
}

// The share of a light's colour that the points reflect diffusely, and the share in their
// highlight.
SIMD_INLINE void reflect(const Points *points, const float to_light[3][W], bool skin,
                         float diffuse[W], float highlight[W])
{
    const float(*n)[W] = points->normal, (*eye)[W] = points->to_eye;
    for (int k = 0; k < W; ++k) {
        float to = dot3(n, to_light, k), p = to_light[0][k] + eye[0][k],
              q = to_light[1][k] + eye[1][k], r = to_light[2][k] + eye[2][k],
              unit = 1 / sqrtf(simd_max(p * p + q * q + r * r, 1e-12f));
        diffuse[k] = skin ? skin_diffuse(to) : simd_max(to, 0);
        highlight[k] = skin ? skin_highlight(to, dot3(n, eye, k),
                                             unit * (n[0][k] * p + n[1][k] * q + n[2][k] * r),
                                             unit * (eye[0][k] * p + eye[1][k] * q + eye[2][k] * r))
                            : 0;
    }
}

SIMD_INLINE void light_points(const Lighting *lighting, const Points *points, bool skin,
                              float light[3][W])
{
    const DrawParams *draw = lighting->view.draw;
    const float(*color)[W] = points->color;
    float left[MAX_LIGHTS][W], to_light[3][W], share[W], diffuse[W], highlight[W], over[3][W],
        sent[3][W] = {{0}};
    bool hairy = skin && lighting->grid;
    if (hairy) light_grid_onto(lighting->grid, points->x, points->normal, sent);
    for (int c = 0; c < 3; ++c) {
        base_around(draw, c, points->normal, light[c]);
        for (int k = 0; k < W; ++k) {
            float open = skin ? points->open[k] : 1, bare = hairy ? points->bare[k] : open;
            light[c][k] = (draw->mesh_color[3] * light[c][k] * open + sent[c][k]) *
                          lamp_between(bare, color[c][k]);
            over[c][k] = 0;
        }
    }
    base_left(lighting->shadow, draw->light_count, points->x, points->normal,
              skin ? FLOAT(SKIN_WRAP) : 0, MESH_TAPS, left);
    for (int i = 0; i < draw->light_count; ++i) {
        lamp_find(draw, i, points->x, to_light, share);
        reflect(points, (const float(*)[W])to_light, skin, diffuse, highlight);
        for (int k = 0; k < W; ++k) share[k] *= left[i][k];
        for (int c = 0; c < 3; ++c)
            for (int k = 0; k < W; ++k) {
                float reaching = draw->light_color[i][c] * share[k];
                light[c][k] += reaching * diffuse[k];
                over[c][k] += reaching * highlight[k];
            }
    }
    for (int c = 0; c < 3; ++c)
        for (int k = 0; k < W; ++k) light[c][k] = color[c][k] * light[c][k] + over[c][k];
}

SIMD_INLINE void light_rows(const Lighting *lighting, int part)
{
    const LaneBase *base = lighting->base;
    const MeshSurface *surface = &base->surface;
    for (int y = 0; y < surface->height; ++y)
        for (int x = 0; x < surface->width && y / BAND % lighting->parts == part; x += W) {
            size_t at = (size_t)y * (size_t)surface->pitch + (size_t)x;
            float nearest = 1, light[3][W];
            Points points;
            for (int k = 0; k < W; ++k) nearest = simd_min(surface->depth[at + (size_t)k], nearest);
            if (nearest >= 1) continue;
            find_points(lighting, x, y, &points);
            if (lighting->skin)
                light_points(lighting, &points, true, light);
            else
                light_points(lighting, &points, false, light);
            for (int c = 0; c < 3; ++c)
                memcpy(base->lit + (size_t)c * (base->lit_room / 3) + at, light[c],
                       sizeof light[c]);
        }
}
SIMD_STAGE(light_rows, Lighting)

void base_mesh_light(const LaneBase *base, const LaneBaseScene *scene, int parts)
{
    Lighting lighting = {
        .base = base,
        .shadow = scene->shadow,
        .grid = light_grid_lights_skin(scene->grid) ? scene->grid : NULL,
        .view = {scene->draw, rays_find(scene->draw)},
        .skin = scene->shading == MESH_SKIN,
        .parts = parts,
    };
    run_light_rows(&lighting, parts);
}
