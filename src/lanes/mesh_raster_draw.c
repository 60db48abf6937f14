// SPDX-License-Identifier: MIT
#include "lanes/mesh_raster.h"

#include "base/double3.h"
#include "lanes/mesh_fill.h"

#include <stdlib.h>
#include <string.h>

enum {
    GUARD = 1 << 14, // px: triangles are clipped at this distance
    PLANES = 6       // planes of the clip volume
};

// The transform of vertices from the mesh's frame to (u w, v w, depth w, w), and the rotation of
// normals.
typedef struct Matrix {
    float rows[4][4], turn[3][3];
} Matrix;

typedef struct Fill {
    const PlacedMesh *mesh;
    MeshRaster *raster;
    Matrix matrix;
    MeshPlanes to;
} Fill;

void mesh_raster_destroy(MeshRaster *raster)
{
    free(raster->place);
    free(raster->on);
    for (int i = 0; i < VALUES; ++i) free(raster->value[i]);
    *raster = (MeshRaster){0};
}

static Result make_room(MeshRaster *raster, size_t count, Error *error)
{
    if (raster->room >= count) return RESULT_OK;
    mesh_raster_destroy(raster);
    bool good = (raster->place = malloc(count * sizeof *raster->place)) != NULL &&
                (raster->on = malloc(count)) != NULL;
    for (int i = 0; i < VALUES && good; ++i)
        good = (raster->value[i] = malloc(count * sizeof(float))) != NULL;
    if (good) {
        raster->room = count;
        return RESULT_OK;
    }
    mesh_raster_destroy(raster);
    return error_set(error, RESULT_FAILED, "no memory for %zu vertices of a mesh", count);
}

enum { PLANE_COUNT = PLACES + VALUES - 1 }; // of a surface

Result mesh_surface_resize(MeshSurface *surface, int width, int height, Error *error)
{
    int pitch = (width + W - 1) / W * W;
    size_t plane = (size_t)pitch * (size_t)height, count = PLANE_COUNT * plane;
    if (surface->room < count) {
        mesh_surface_destroy(surface);
        surface->memory = calloc(count, sizeof(float));
        if (!surface->memory)
            return error_set(error, RESULT_FAILED, "no memory for %d x %d px of a mesh", width,
                             height);
        surface->room = count;
    }
    float **const planes[PLANE_COUNT] = {
        &surface->depth,     &surface->edge[0], &surface->edge[1],   &surface->edge[2],
        &surface->edge[3],   &surface->inverse, &surface->normal[0], &surface->normal[1],
        &surface->normal[2], &surface->tint[0], &surface->tint[1],   &surface->tint[2],
        &surface->tint[3]};
    for (int i = 0; i < PLANE_COUNT && surface->memory; ++i)
        *planes[i] = surface->memory + (size_t)i * plane;
    surface->width = width;
    surface->height = height;
    surface->pitch = pitch;
    return RESULT_OK;
}

void mesh_surface_destroy(MeshSurface *surface)
{
    free(surface->memory);
    *surface = (MeshSurface){0};
}

// --- Vertices.

static Matrix place_mesh(const PlacedMesh *mesh, const float rows[4][4])
{
    double q[4], turn[3][3];
    for (int k = 0; k < 4; ++k) q[k] = (double)mesh->rotation[k];
    double3_rotation(q, turn);
    Matrix matrix;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) matrix.turn[i][j] = (float)turn[i][j];
    for (int i = 0; i < 4; ++i) {
        double last = (double)rows[i][3];
        for (int j = 0; j < 3; ++j) {
            double sum = 0;
            for (int k = 0; k < 3; ++k) sum += (double)rows[i][k] * turn[k][j];
            matrix.rows[i][j] = (float)sum;
            last += (double)rows[i][j] * (double)mesh->translation[j];
        }
        matrix.rows[i][3] = (float)last;
    }
    return matrix;
}

// The signed distance of a point (u w, v w, depth w, w) to a clip plane, positive inside.
SIMD_INLINE float distance_inside(const float h[4], int plane)
{
    switch (plane) {
    case 0:
        return h[2];
    case 1:
        return h[3] - h[2];
    case 2:
        return (float)GUARD * h[3] + h[0];
    case 3:
        return (float)GUARD * h[3] - h[0];
    case 4:
        return (float)GUARD * h[3] + h[1];
    default:
        return (float)GUARD * h[3] - h[1];
    }
}

// The clip planes that a vertex lies beyond, as bits. A broken position (NaN) is beyond all planes.
SIMD_INLINE int beyond(const float h[4])
{
    int on = 0;
    for (int i = 0; i < PLANES; ++i) on |= distance_inside(h, i) >= 0 ? 0 : 1 << i;
    return on;
}

SIMD_INLINE void place_vertex(const Matrix *matrix, const float x[3], float h[4])
{
    for (int i = 0; i < 4; ++i) {
        const float *row = matrix->rows[i];
        h[i] = row[0] * x[0] + row[1] * x[1] + row[2] * x[2] + row[3];
    }
}

SIMD_INLINE void turn_normal(const Fill *fill, size_t v, float n[3])
{
    const float *own = fill->mesh->normal[v];
    float open = fill->mesh->open ? fill->mesh->open[v][0] : 1;
    for (int i = 0; i < 3; ++i) {
        const float *row = fill->matrix.turn[i];
        n[i] = open * (row[0] * own[0] + row[1] * own[1] + row[2] * own[2]);
    }
}

SIMD_INLINE float tint_at(const Fill *fill, size_t v, int channel)
{
    if (channel == 3) return fill->mesh->open ? fill->mesh->open[v][1] : 1;
    return fill->mesh->tint ? fill->mesh->tint[v][channel] : 1;
}

// Rounds to the nearest step of the subpixel grid.
SIMD_INLINE int step_of(float px)
{
    return (int)floorf(px * STEPS + 0.5f);
}

SIMD_INLINE void place_vertices(const Fill *fill, int part)
{
    const MeshRaster *to = fill->raster;
    size_t count = fill->mesh->vertex_count,
           end = count * (size_t)(part + 1) / (size_t)fill->to.parts;
    for (size_t v = count * (size_t)part / (size_t)fill->to.parts; v < end; ++v) {
        float h[4], n[3] = {0};
        place_vertex(&fill->matrix, fill->mesh->position[v], h);
        int on = beyond(h);
        float inverse = 1 / (on ? 1 : h[3]);
        to->on[v] = (unsigned char)on;
        to->place[v][0] = on ? 0 : step_of(h[0] * inverse);
        to->place[v][1] = on ? 0 : step_of(h[1] * inverse);
        to->value[0][v] = h[2] * inverse;
        if (!fill->to.value[1]) continue;
        turn_normal(fill, v, n);
        to->value[1][v] = inverse;
        for (int i = 0; i < 3; ++i) to->value[NORMAL + i][v] = n[i] * inverse;
        for (int i = 0; i < 4; ++i) to->value[TINT + i][v] = tint_at(fill, v, i) * inverse;
    }
}
SIMD_STAGE(place_vertices, Fill)

// --- Clipped triangles.

enum { MOST_CORNERS = 3 + PLANES };

// A vertex before the perspective division.
typedef struct Vertex {
    float h[4], normal[3], tint[4];
} Vertex;

// The intersection of an edge with a plane. It is always computed from the inside vertex to the
// outside one, so both triangles at the edge get the same point.
static Vertex meet(const Vertex *inside, const Vertex *outside, int plane)
{
    Vertex vertex;
    float in = distance_inside(inside->h, plane), out = distance_inside(outside->h, plane),
          share = in / (in - out);
    for (int i = 0; i < 4; ++i) vertex.h[i] = inside->h[i] + share * (outside->h[i] - inside->h[i]);
    for (int i = 0; i < 3; ++i)
        vertex.normal[i] = inside->normal[i] + share * (outside->normal[i] - inside->normal[i]);
    for (int i = 0; i < 4; ++i)
        vertex.tint[i] = inside->tint[i] + share * (outside->tint[i] - inside->tint[i]);
    return vertex;
}

// Clips a polygon by a plane (Sutherland and Hodgman 1974). Returns the number of corners.
static int cut(Vertex *polygon, int count, int plane)
{
    Vertex all[MOST_CORNERS];
    int left = 0;
    memcpy(all, polygon, (size_t)count * sizeof *all);
    for (int i = 0; i < count; ++i) {
        const Vertex *here = &all[i], *next = &all[(i + 1) % count];
        bool in = distance_inside(here->h, plane) >= 0,
             next_in = distance_inside(next->h, plane) >= 0;
        if (in) polygon[left++] = *here;
        if (in != next_in) polygon[left++] = in ? meet(here, next, plane) : meet(next, here, plane);
    }
    return left;
}

static Corner project(const Vertex *vertex)
{
    float inverse = 1 / simd_max(vertex->h[3], 1e-20f), far = GUARD;
    Corner corner = {.value = {vertex->h[2] * inverse, inverse}};
    for (int i = 0; i < 2; ++i)
        corner.place[i] = step_of(simd_min(simd_max(vertex->h[i] * inverse, -far), far));
    for (int i = 0; i < 3; ++i) corner.value[NORMAL + i] = vertex->normal[i] * inverse;
    for (int i = 0; i < 4; ++i) corner.value[TINT + i] = vertex->tint[i] * inverse;
    return corner;
}

// Clips triangle t. Returns the number of corners, at most MOST_CORNERS.
static int cut_triangle(const Fill *fill, uint32_t t, int planes, Corner *corners)
{
    Vertex polygon[MOST_CORNERS] = {0};
    int count = 3;
    for (int i = 0; i < 3; ++i) {
        uint32_t v = fill->mesh->triangle[t][i];
        place_vertex(&fill->matrix, fill->mesh->position[v], polygon[i].h);
        if (fill->to.value[1]) turn_normal(fill, v, polygon[i].normal);
        for (int k = 0; k < 4; ++k) polygon[i].tint[k] = tint_at(fill, v, k);
        for (int k = 0; k < 4; ++k)
            if (!(fabsf(polygon[i].h[k]) <= 1e30f)) return 0; // broken
    }
    for (int plane = 0; plane < PLANES && count; ++plane)
        if (planes >> plane & 1) count = cut(polygon, count, plane);
    for (int i = 0; i < count; ++i) corners[i] = project(&polygon[i]);
    return count;
}

// --- All triangles.

static void clear_rows(const Fill *fill, int part, int places)
{
    for (int y = 0; y < fill->to.height; ++y)
        for (int p = 0; p < places && is_mine(&fill->to, part, y / BAND); ++p) {
            float *row = fill->to.depth[p] + (size_t)y * (size_t)fill->to.pitch;
            for (int x = 0; x < fill->to.pitch; ++x) row[x] = 1;
        }
}

SIMD_INLINE void load_corner(const MeshRaster *raster, uint32_t v, int values, Corner *corner)
{
    corner->place[0] = raster->place[v][0];
    corner->place[1] = raster->place[v][1];
    for (int i = 0; i < values; ++i) corner->value[i] = raster->value[i][v];
}

SIMD_INLINE void fill_triangles(const Fill *fill, int part, bool surface)
{
    const MeshRaster *raster = fill->raster;
    clear_rows(fill, part, surface ? PLACES : 1);
    for (uint32_t t = 0; t < fill->mesh->triangle_count; ++t) {
        const uint32_t *v = fill->mesh->triangle[t];
        Corner corners[MOST_CORNERS];
        int count = 3, on[3] = {raster->on[v[0]], raster->on[v[1]], raster->on[v[2]]};
        if (on[0] & on[1] & on[2]) continue;
        if (on[0] | on[1] | on[2])
            count = cut_triangle(fill, t, on[0] | on[1] | on[2], corners);
        else
            for (int i = 0; i < 3; ++i)
                load_corner(raster, v[i], surface ? VALUES : 1, &corners[i]);
        for (int i = 2; i < count; ++i)
            fill_triangle(&fill->to, part,
                          (const Corner *const[3]){&corners[0], &corners[i - 1], &corners[i]},
                          surface);
    }
}

SIMD_INLINE void fill_depths(const Fill *fill, int part)
{
    fill_triangles(fill, part, false);
}
SIMD_STAGE(fill_depths, Fill)

SIMD_INLINE void fill_surface(const Fill *fill, int part)
{
    fill_triangles(fill, part, true);
}
SIMD_STAGE(fill_surface, Fill)

Result mesh_raster_depths(MeshRaster *raster, const PlacedMesh *mesh, const float rows[4][4],
                          int side, float *depths, int parts, Error *error)
{
    Fill fill = {
        .mesh = mesh,
        .raster = raster,
        .matrix = place_mesh(mesh, rows),
        .to = {.width = side, .height = side, .pitch = side, .parts = parts, .depth = {depths}}};
    TRY(make_room(raster, mesh->vertex_count, error));
    run_place_vertices(&fill, parts);
    run_fill_depths(&fill, parts);
    return RESULT_OK;
}

Result mesh_raster_surface(MeshRaster *raster, const PlacedMesh *mesh, const float rows[4][4],
                           MeshSurface *surface, int parts, Error *error)
{
    Fill fill = {.mesh = mesh,
                 .raster = raster,
                 .matrix = place_mesh(mesh, rows),
                 .to = {.width = surface->width,
                        .height = surface->height,
                        .pitch = surface->pitch,
                        .parts = parts,
                        .depth = {surface->depth, surface->edge[0], surface->edge[1],
                                  surface->edge[2], surface->edge[3]},
                        .value = {NULL, surface->inverse, surface->normal[0], surface->normal[1],
                                  surface->normal[2], surface->tint[0], surface->tint[1],
                                  surface->tint[2], surface->tint[3]}}};
    TRY(make_room(raster, mesh->vertex_count, error));
    run_place_vertices(&fill, parts);
    run_fill_surface(&fill, parts);
    return RESULT_OK;
}
