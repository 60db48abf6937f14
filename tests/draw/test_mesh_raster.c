// SPDX-License-Identifier: MIT
// Depths of a mesh's triangles against their definition in double precision.
#include "lanes/mesh_raster.h"

#include "base/random.h"
#include "support/needed.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

enum { SIDE = 64, WIDTH = 57, HEIGHT = 61, PLACES = 1 + MESH_EDGES };

static const double PLACE[PLACES][2] = {
    {0.5, 0.5}, {0.375, 0.125}, {0.875, 0.375}, {0.125, 0.625}, {0.625, 0.875}};

// The mesh's coordinates are the screen's: px, px, depth.
static const float SCREEN[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};

static PlacedMesh place(const float (*position)[3], const float (*normal)[3], uint32_t vertices,
                        const uint32_t (*triangle)[3], uint32_t triangles)
{
    return (PlacedMesh){.position = position,
                        .normal = normal,
                        .triangle = triangle,
                        .vertex_count = vertices,
                        .triangle_count = triangles,
                        .rotation = {0, 0, 0, 1}};
}

static void draw(const PlacedMesh *mesh, const float rows[4][4], MeshSurface *surface, int parts)
{
    MeshRaster raster = {0};
    NEEDED(mesh_surface_resize(surface, WIDTH, HEIGHT, error));
    NEEDED(mesh_raster_surface(&raster, mesh, rows, surface, parts, error));
    mesh_raster_destroy(&raster);
}

static const float *plane(const MeshSurface *surface, int k)
{
    return k ? surface->edge[k - 1] : surface->depth;
}

static void a_triangle_has_its_own_samples_and_their_depths(void **state)
{
    (void)state;
    const float x[3][3] = {{4, 4, 0.25f}, {44, 4, 0.5f}, {4, 24, 0.75f}};
    const uint32_t triangle[1][3] = {{0, 1, 2}};
    PlacedMesh mesh = place(x, x, 3, triangle, 1);
    MeshSurface surface = {0};
    draw(&mesh, SCREEN, &surface, 2);
    for (int k = 0; k < PLACES; ++k)
        for (int i = 0; i < WIDTH * HEIGHT; ++i) {
            double across = (i % WIDTH + PLACE[k][0] - 4) / 40,
                   down = (i / WIDTH + PLACE[k][1] - 4) / 20, left = 1 - across - down,
                   z = 0.25 + 0.25 * across + 0.5 * down;
            float found = plane(&surface, k)[i / WIDTH * surface.pitch + i % WIDTH];
            if (left == 0) continue; // on the edge: see below
            if (across < 0 || down < 0 || left < 0)
                assert_true(found == 1);
            else if (!(fabs((double)found - z) < 1e-6))
                fail_msg("%d %d: depth %g, not %g", i % WIDTH, i / WIDTH, (double)found, z);
        }
    mesh_surface_destroy(&surface);
}

// Every sample in a square belongs to exactly one of the triangles that fill it, also on shared
// edges: half of the inner corners lie exactly on samples, and every third row of corners runs
// along samples.
static void triangles_with_a_common_edge_leave_no_gap_and_do_not_overlap(void **state)
{
    (void)state;
    enum { ACROSS = 12, VERTICES = ACROSS * ACROSS };
    float x[VERTICES][3];
    int hits[PLACES][SIDE * SIDE] = {{0}};
    Random random = random_create(27, 1);
    for (int v = 0; v < VERTICES; ++v) {
        const int at[2] = {v % ACROSS, v / ACROSS};
        for (int k = 0; k < 2; ++k) {
            bool inner = at[k] > 0 && at[k] < ACROSS - 1;
            double jitter = inner ? random_real(&random) - 0.5 : 0;
            x[v][k] = (float)(3.3 + 4.5 * at[k] + jitter);
            if (inner && v % 2) x[v][k] = floorf(x[v][k]) + 0.5f;
            if (inner && at[k] % 3 == 0) x[v][k] = floorf(3.3f + 4.5f * (float)at[k]) + 0.5f;
        }
        x[v][2] = 0.5f;
    }
    MeshSurface surface = {0};
    for (uint32_t i = 0; i < 2 * (ACROSS - 1) * (ACROSS - 1); ++i) {
        uint32_t a = i / 2 / (ACROSS - 1) * ACROSS + i / 2 % (ACROSS - 1), b = a + 1,
                 c = a + ACROSS, d = c + 1;
        const uint32_t triangle[1][3] = {{i % 2 ? b : a, c, i % 2 ? d : b}};
        PlacedMesh mesh = place((const float(*)[3])x, (const float(*)[3])x, VERTICES, triangle, 1);
        draw(&mesh, SCREEN, &surface, 2);
        for (int k = 0; k < PLACES; ++k)
            for (int p = 0; p < WIDTH * HEIGHT; ++p)
                hits[k][p / WIDTH * SIDE + p % WIDTH] +=
                    plane(&surface, k)[p / WIDTH * surface.pitch + p % WIDTH] < 1;
    }
    for (int k = 0; k < PLACES; ++k)
        for (int p = 0; p < WIDTH * HEIGHT; ++p) {
            double u = p % WIDTH + PLACE[k][0], v = p / WIDTH + PLACE[k][1];
            bool inside = u > 3.31 && v > 3.31 && u < 52.79 && v < 52.79;
            if (inside) assert_int_equal(hits[k][p / WIDTH * SIDE + p % WIDTH], 1);
        }
    mesh_surface_destroy(&surface);
}

enum { FOCAL = 40 };
static const double NEAR = 0.5, FAR = 100;

// A camera at the world's origin that looks along -z, y up; depths as in OpenGL.
static void look(float rows[4][4])
{
    const double a = FAR / (FAR - NEAR);
    const float all[4][4] = {{FOCAL, 0, -WIDTH / 2.0f, 0},
                             {0, -FOCAL, -HEIGHT / 2.0f, 0},
                             {0, 0, (float)-a, (float)(-a * NEAR)},
                             {0, 0, -1, 0}};
    memcpy(rows, all, sizeof all);
}

// A floor with corners behind the eye or 10 km away is clipped and visible up to `FAR`. Its normals
// are a function of position, which shows whether they are interpolated in perspective.
static void what_is_near_far_or_wide_is_cut(void **state)
{
    (void)state;
    const float x[4][3] = {{-3, -1, 5}, {9000, -1, 5}, {-3, -1, -9000}, {9000, -1, -9000}},
                n[4][3] = {{-3, 1, 5}, {9000, 1, 5}, {-3, 1, -9000}, {9000, 1, -9000}};
    const uint32_t triangle[2][3] = {{0, 1, 2}, {3, 2, 1}};
    PlacedMesh mesh = place(x, n, 4, triangle, 2);
    MeshSurface surface = {0};
    float rows[4][4];
    int seen = 0;
    look(rows);
    draw(&mesh, (const float(*)[4])rows, &surface, 2);
    for (int p = 0; p < WIDTH * HEIGHT; ++p) {
        size_t at = (size_t)(p / WIDTH * surface.pitch + p % WIDTH);
        double across = p % WIDTH + 0.5 - WIDTH / 2.0, down = p / WIDTH + 0.5 - HEIGHT / 2.0,
               w = FOCAL / down, side = across / FOCAL * w, found = (double)surface.depth[at];
        if (!(w > 0 && w < 0.97 * FAR && side > -2.9)) {
            if (w < 0 || w > 1.03 * FAR || side < -3.1) assert_true(found == 1);
            continue;
        }
        // A corner is rounded to 1/256 px, at `down` px below the horizon: the relative error of w
        // and of what depends on it.
        double a = FAR / (FAR - NEAR), z = a * (1 - NEAR / w), off = 1 / down / 256 + 1e-4,
               inverse = (double)surface.inverse[at];
        ++seen;
        if (!(fabs(found - z) < off * a * NEAR / w && fabs(inverse * w - 1) < off))
            fail_msg("%d %d: depth %g, not %g; w %g, not %g", p % WIDTH, p / WIDTH, found, z,
                     1 / inverse, w);
        assert_true(fabs((double)surface.normal[0][at] / inverse - side) <
                    2 * off * (1 + fabs(side)));
        assert_true(fabs((double)surface.normal[1][at] / inverse - 1) < 2 * off);
        assert_true(fabs((double)surface.normal[2][at] / inverse + w) < 2 * off * w);
    }
    assert_true(seen > 500);
    mesh_surface_destroy(&surface);
}

// A tangle of triangles, also in front of the eye and behind it.
static void make_tangle(float (*x)[3], uint32_t (*triangle)[3], uint32_t count)
{
    Random random = random_create(27, 2);
    for (uint32_t v = 0; v < 3 * count; ++v) {
        for (int k = 0; k < 3; ++k)
            x[v][k] = (float)((k < 2 ? 0 : -3) + 4 * random_real(&random) - 2);
        triangle[v / 3][v % 3] = v;
    }
}

static void threads_do_not_change_a_bit(void **state)
{
    (void)state;
    enum { COUNT = 300 };
    float x[3 * COUNT][3], rows[4][4];
    uint32_t triangle[COUNT][3];
    make_tangle(x, triangle, COUNT);
    PlacedMesh mesh = place((const float(*)[3])x, (const float(*)[3])x, 3 * COUNT,
                            (const uint32_t(*)[3])triangle, COUNT);
    MeshSurface first = {0}, second = {0};
    look(rows);
    draw(&mesh, (const float(*)[4])rows, &first, 1);
    for (int parts = 2; parts < 8; ++parts) {
        draw(&mesh, (const float(*)[4])rows, &second, parts);
        assert_memory_equal(first.memory, second.memory, 9 * 64 * HEIGHT * sizeof(float));
    }
    mesh_surface_destroy(&first);
    mesh_surface_destroy(&second);
}

// A shadow map equals the depths that a surface of the same view has at pixel middles, and the
// head's motion moves the mesh.
static void a_map_has_the_same_depths_as_a_surface(void **state)
{
    (void)state;
    enum { COUNT = 300 };
    static float map[SIDE * SIDE];
    float x[3 * COUNT][3], turned[3 * COUNT][3], rows[4][4];
    uint32_t triangle[COUNT][3];
    make_tangle(x, triangle, COUNT);
    for (int v = 0; v < 3 * COUNT; ++v) { // the rotation takes x to y, y to z, z to x
        for (int k = 0; k < 3; ++k) turned[v][k] = x[v][(k + 1) % 3];
        turned[v][1] += 1;
    }
    PlacedMesh mesh = place((const float(*)[3])x, (const float(*)[3])x, 3 * COUNT,
                            (const uint32_t(*)[3])triangle, COUNT),
               carried = mesh;
    carried.position = (const float(*)[3])turned;
    memcpy(carried.rotation, (const float[4]){0.5f, 0.5f, 0.5f, 0.5f}, sizeof carried.rotation);
    carried.translation[2] = -1;
    MeshSurface surface = {0};
    MeshRaster raster = {0};
    look(rows);
    draw(&mesh, (const float(*)[4])rows, &surface, 2);
    NEEDED(mesh_raster_depths(&raster, &carried, (const float(*)[4])rows, SIDE, map, 3, error));
    int seen = 0;
    for (int p = 0; p < WIDTH * HEIGHT; ++p) {
        float here = surface.depth[p / WIDTH * surface.pitch + p % WIDTH],
              there = map[p / WIDTH * SIDE + p % WIDTH];
        seen += fabsf(here - there) < 1e-5f && here < 1;
    }
    // Samples on edges may differ, because of rounding.
    assert_true(seen > WIDTH * HEIGHT * 99 / 100);
    mesh_raster_destroy(&raster);
    mesh_surface_destroy(&surface);
}

static void broken_vertices_do_no_harm(void **state)
{
    (void)state;
    const float x[5][3] = {
        {4, 4, 0.5f}, {44, 4, 0.5f}, {4, 24, 0.5f}, {NAN, 0, 0}, {INFINITY, 1e38f, -INFINITY}};
    const uint32_t triangle[4][3] = {{0, 1, 3}, {4, 1, 2}, {0, 4, 3}, {0, 1, 2}};
    PlacedMesh mesh = place(x, x, 5, triangle, 4);
    MeshSurface surface = {0};
    draw(&mesh, SCREEN, &surface, 2);
    for (int i = 0; i < WIDTH * HEIGHT; ++i) {
        float z = surface.depth[i / WIDTH * surface.pitch + i % WIDTH];
        assert_true(z == 1 || z == 0.5f);
    }
    assert_true(surface.depth[6 * surface.pitch + 6] == 0.5f);
    mesh_surface_destroy(&surface);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_triangle_has_its_own_samples_and_their_depths),
        cmocka_unit_test(triangles_with_a_common_edge_leave_no_gap_and_do_not_overlap),
        cmocka_unit_test(what_is_near_far_or_wide_is_cut),
        cmocka_unit_test(threads_do_not_change_a_bit),
        cmocka_unit_test(a_map_has_the_same_depths_as_a_surface),
        cmocka_unit_test(broken_vertices_do_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
