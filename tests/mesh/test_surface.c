// SPDX-License-Identifier: MIT
// A mesh as a surface: distances, normals, texture coordinates; and the noise, sine and cosine
// functions of formulas.
#include "base/portable.h"
#include "base/random.h"
#include "mesh/scalp.h"
#include "mesh/surface.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

static const double PI = 3.14159265358979323846;

static void sine_and_cosine_are_near_the_librarys(void **state)
{
    (void)state;
    for (int i = -4000; i <= 4000; i++) {
        double turns = i / 997.0;
        assert_true(fabs(portable_sine(turns) - sin(2 * PI * turns)) < 1e-11);
        assert_true(fabs(portable_cosine(turns) - cos(2 * PI * turns)) < 1e-11);
    }
}

// At integer coordinates, noise is uniform between -1 and 1: the mean of 8000 values is within five
// standard deviations of 0, 1/sqrt(3) each. It is smooth: along each axis, a step of 1e-4 changes
// it by at most the blend's slope, 1.5, times a change of 2.
static void noise_is_even_and_smooth(void **state)
{
    (void)state;
    double sum = 0;
    for (int i = 0; i < 8000; i++) sum += portable_noise(i % 20, i / 20 % 20, i / 400);
    assert_true(fabs(sum / 8000) < 5 / sqrt(3.0 * 8000));
    for (int i = 0; i < 1000; i++) {
        double x = i * 0.0137, here = portable_noise(x, 2 * x, -x);
        assert_true(fabs(here) <= 1 &&
                    fabs(portable_noise(x + 1e-4, 2 * x, -x) - here) <= 3.001e-4);
    }
}

// A box around the origin. Its triangles share no vertices, so that edges and corners must be found
// by position.
static void make_box(Mesh *mesh, const double half[3])
{
    assert_int_equal(mesh_create(mesh, 36, 12, NULL), RESULT_OK);
    for (int face = 0; face < 6; face++) {
        int axis = face / 2, side = face % 2;
        for (int k = 0; k < 6; k++) {
            static const int corners[6][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
            int v = 6 * face + (side ? k : 5 - k), u = (axis + 1) % 3, w = (axis + 2) % 3;
            mesh->position[v][axis] = (float)(side ? half[axis] : -half[axis]);
            mesh->position[v][u] = (float)(corners[k][0] ? half[u] : -half[u]);
            mesh->position[v][w] = (float)(corners[k][1] ? half[w] : -half[w]);
            mesh->triangle[v / 3][v % 3] = (uint32_t)v;
        }
    }
    mesh_compute_normals(mesh);
}

static double box_distance(const double half[3], const double p[3])
{
    double out = 0, in = -INFINITY;
    for (int i = 0; i < 3; i++) {
        double d = fabs(p[i]) - half[i];
        out += fmax(d, 0) * fmax(d, 0);
        in = fmax(in, d);
    }
    return out > 0 ? sqrt(out) : in;
}

// Half-widths are sums of powers of two, so that corners are exact; distances of about 1 are
// rounded to 1e-16.
static void distances_to_a_box_are_exact(void **state)
{
    (void)state;
    const double half[3] = {0.5, 0.25, 1.0};
    Mesh mesh;
    Surface surface;
    make_box(&mesh, half);
    assert_int_equal(surface_create(&surface, &mesh, "box", NULL), RESULT_OK);
    assert_true(fabs(surface.area - 8 * (0.125 + 0.25 + 0.5)) < 1e-12);
    Random random = random_create(3, 0);
    SurfacePoint nearest = {0};
    for (int i = 0; i < 5000; i++) {
        double p[3];
        for (int k = 0; k < 3; k++) p[k] = 2.4 * (random_real(&random) - 0.5);
        double distance = surface_nearest(&surface, p, &nearest);
        assert_true(fabs(distance - box_distance(half, p)) < 1e-13);
        assert_true(fabs(double3_distance(p, nearest.place) - fabs(distance)) < 1e-13);
    }
    surface_destroy(&surface);
    mesh_destroy(&mesh);
}

// A tetrahedron's inside is behind all of its planes. This one is sharp: near an edge or a corner,
// the normal of a single face would classify some outside points as inside. Corners are exact,
// planes err by 1e-16.
static void sharp_edges_and_corners_have_two_sides(void **state)
{
    (void)state;
    static const float corners[4][3] = {{-1, 0, 0}, {1, 0.25f, 0}, {0, 0.25f, -1}, {0, 0.375f, 1}};
    static const uint32_t faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    Mesh mesh;
    Surface surface;
    assert_int_equal(mesh_create(&mesh, 4, 4, NULL), RESULT_OK);
    memcpy(mesh.position, corners, sizeof corners);
    memcpy(mesh.triangle, faces, sizeof faces);
    mesh_compute_normals(&mesh);
    assert_int_equal(surface_create(&surface, &mesh, "mesh", NULL), RESULT_OK);
    Random random = random_create(5, 0);
    SurfacePoint nearest = {0};
    int inside = 0;
    for (int i = 0; i < 20000; i++) {
        Double3 p, normal, at;
        double height = -INFINITY;
        for (int k = 0; k < 3; k++) p[k] = (k == 1 ? 1.0 : 3.0) * (random_real(&random) - 0.5);
        for (uint32_t t = 0; t < 4; t++) {
            surface_triangle(&mesh, t, normal);
            double3_from_float(mesh.position[faces[t][0]], at);
            double3_subtract(p, at, at);
            height = fmax(height, double3_dot(at, normal));
        }
        if (fabs(height) < 1e-12) continue;
        assert_true((surface_nearest(&surface, p, &nearest) < 0) == (height < 0));
        inside += height < 0;
    }
    assert_true(inside > 100);
    surface_destroy(&surface);
    mesh_destroy(&mesh);
}

// The tree finds the same as a search of all triangles, whatever triangle it starts with.
static void the_tree_misses_nothing(void **state)
{
    (void)state;
    Mesh mesh;
    Surface surface;
    assert_int_equal(scalp_make_mesh(&mesh, SCALP_HEAD, 16, NULL), RESULT_OK);
    assert_int_equal(surface_create(&surface, &mesh, "head", NULL), RESULT_OK);
    Random random = random_create(4, 0);
    for (int i = 0; i < 300; i++) {
        Double3 p, weight;
        random_direction(&random, p);
        for (int k = 0; k < 3; k++) p[k] *= 0.2 * random_real(&random);
        SurfacePoint nearest = {.triangle = random_below(&random, mesh.triangle_count)};
        double found = fabs(surface_nearest(&surface, p, &nearest)), best = INFINITY;
        // no grid point on any triangle is nearer
        for (int a = 0; a < (int)mesh.triangle_count; a++)
            for (int k = 0; k < 15; k++) {
                static const int grid[15][2] = {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4},
                                                {1, 0}, {1, 1}, {1, 2}, {1, 3}, {2, 0},
                                                {2, 1}, {2, 2}, {3, 0}, {3, 1}, {4, 0}};
                weight[0] = grid[k][0] / 4.0, weight[1] = grid[k][1] / 4.0;
                weight[2] = 1 - weight[0] - weight[1];
                SurfacePoint at = surface_at(&surface, (uint32_t)a, weight);
                best = fmin(best, double3_distance(p, at.place));
            }
        assert_true(found <= best + 1e-12 && found > best - 0.01); // edges are shorter than 0.03
    }
    surface_destroy(&surface);
    mesh_destroy(&mesh);
}

// Seen from inside, longitude grows to the right and latitude upwards.
static void texture_coordinates_have_axes(void **state)
{
    (void)state;
    Mesh mesh;
    Surface surface;
    assert_int_equal(scalp_make_mesh(&mesh, SCALP_SPHERE, 24, NULL), RESULT_OK);
    assert_int_equal(surface_create(&surface, &mesh, "ball", NULL), RESULT_OK);
    SurfacePoint front = {0};
    surface_nearest(&surface, (Double3){0.003, 0.002, 0.2}, &front);
    Double3 u, v;
    double uv[2];
    assert_true(surface_uv(&surface, &front, uv) && surface_uv_axes(&surface, &front, u, v));
    assert_true(fabs(uv[0] - 0.5) < 0.02 && fabs(uv[1] - 0.5) < 0.02);
    assert_true(u[0] > 0.99 && v[1] > 0.99);
    surface_destroy(&surface);
    mesh_destroy(&mesh);
}

static void triangles_without_area_are_counted(void **state)
{
    (void)state;
    Mesh mesh;
    Surface surface;
    Error error;
    assert_int_equal(mesh_create(&mesh, 3, 2, NULL), RESULT_OK);
    assert_int_equal(surface_create(&surface, &mesh, "m.obj", &error), RESULT_BAD_INPUT);
    assert_string_equal(error.text, "m.obj: no triangle has an area");
    mesh.position[1][0] = mesh.position[2][1] = 1;
    mesh.triangle[0][1] = 1, mesh.triangle[0][2] = 2;
    assert_int_equal(surface_create(&surface, &mesh, "m.obj", &error), RESULT_OK);
    assert_int_equal(surface.flat_count, 1);
    SurfacePoint nearest = {.triangle = 1}; // the degenerate triangle
    double3_copy((Double3){0}, nearest.place);
    assert_true(fabs(surface_nearest(&surface, (Double3){0.2, 0.2, -3}, &nearest) + 3) < 1e-12);
    surface_destroy(&surface);
    mesh_destroy(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sine_and_cosine_are_near_the_librarys),
        cmocka_unit_test(noise_is_even_and_smooth),
        cmocka_unit_test(distances_to_a_box_are_exact),
        cmocka_unit_test(sharp_edges_and_corners_have_two_sides),
        cmocka_unit_test(the_tree_misses_nothing),
        cmocka_unit_test(texture_coordinates_have_axes),
        cmocka_unit_test(triangles_without_area_are_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
