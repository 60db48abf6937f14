// SPDX-License-Identifier: MIT
// Roots of fur are evenly spread over the surface, keep apart from each other, and follow a density
// map.
#include "base/random.h"
#include "gen/fur_roots.h"
#include "image/png.h"
#include "support/shapes.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void make_roots(SurfacePoint *roots, uint32_t count, const Scalp *scalp, const char *density,
                       uint32_t seed)
{
    FurMap map;
    Error error = {""};
    if (fur_map_create(&map, "--density", density, &scalp->mesh, &error) != RESULT_OK ||
        fur_roots_make(roots, count, &scalp->surface, &map, seed, "mesh", &error) != RESULT_OK)
        fail_msg("%s", error.text);
    fur_map_destroy(&map);
}

// The head's triangles in 60 groups of successive triangles. For random points, chi-square has the
// mean 59 and the standard deviation sqrt(2 x 59) = 10.9. Points that keep apart have less, as they
// are more even. The bound, 2.8 standard deviations below the mean, is reached by random points
// only once in 400 times. (If triangles were picked without regard to their area: 92.)
static void roots_are_even_by_area(void **state)
{
    (void)state;
    enum { GROUPS = 60, COUNT = 6000 };
    static SurfacePoint roots[COUNT];
    double area[GROUPS] = {0}, found[GROUPS] = {0}, chi = 0;
    Scalp scalp;
    shapes_make_scalp(&scalp, SCALP_HEAD, 24);
    make_roots(roots, COUNT, &scalp, "1", 1);
    uint32_t size = (scalp.mesh.triangle_count + GROUPS - 1) / GROUPS;
    for (uint32_t t = 0; t < scalp.mesh.triangle_count; t++) {
        Double3 normal;
        area[t / size] += 0.5 * surface_triangle(&scalp.mesh, t, normal);
    }
    for (int i = 0; i < COUNT; i++) found[roots[i].triangle / size]++;
    for (int g = 0; g < GROUPS; g++) {
        double expected = COUNT * area[g] / scalp.surface.area;
        chi += (found[g] - expected) * (found[g] - expected) / expected;
    }
    assert_true(chi < 59 - 2.8 * 10.9);
    shapes_destroy_scalp(&scalp);
}

// Uniform points (x, y) of the triangle x, y >= 0, x + y <= 1: half of them have x + y < sqrt(1/2),
// and by symmetry half have x < y. The standard deviation of the count of n points is sqrt(n)/2.
static void roots_are_even_within_a_triangle(void **state)
{
    (void)state;
    enum { COUNT = 4000 };
    static SurfacePoint roots[COUNT];
    Mesh mesh;
    Scalp scalp;
    assert_int_equal(mesh_create(&mesh, 3, 1, NULL), RESULT_OK);
    mesh.position[1][0] = mesh.position[2][1] = 1;
    mesh.triangle[0][1] = 1, mesh.triangle[0][2] = 2;
    mesh_compute_normals(&mesh);
    scalp.mesh = mesh;
    assert_int_equal(surface_create(&scalp.surface, &mesh, "mesh", NULL), RESULT_OK);
    make_roots(roots, COUNT, &scalp, "1", 5);
    int near = 0, below = 0;
    for (int i = 0; i < COUNT; i++) {
        near += roots[i].place[0] + roots[i].place[1] < sqrt(0.5);
        below += roots[i].place[0] < roots[i].place[1];
    }
    assert_true(abs(near - COUNT / 2) < 5 * sqrt(COUNT) / 2);
    assert_true(abs(below - COUNT / 2) < 5 * sqrt(COUNT) / 2);
    surface_destroy(&scalp.surface);
    mesh_destroy(&mesh);
}

// The distance of the closest two of `count` roots, relative to the spacing of a hexagonal lattice
// of as many points.
static double find_closest(const SurfacePoint *roots, uint32_t count, double area)
{
    double closest = INFINITY;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t j = 0; j < i; j++)
            closest = fmin(closest, double3_distance(roots[i].place, roots[j].place));
    return closest / sqrt(2 / sqrt(3.0) * area / count);
}

// The closest two of n random points are about 1/n of the width apart: 1/sqrt(n) of the spacing,
// 0.03 here. Yuksel (2015) reaches 0.7 and more with four candidates per point; the first quarter,
// chosen from so few candidates, is slightly less even.
static void roots_keep_away_from_each_other(void **state)
{
    (void)state;
    enum { COUNT = 1200 };
    static SurfacePoint roots[COUNT];
    Scalp scalp;
    shapes_make_scalp(&scalp, SCALP_HEAD, 24);
    make_roots(roots, COUNT, &scalp, "1", 2);
    assert_true(find_closest(roots, COUNT, scalp.surface.area) > 0.55);
    assert_int_equal(fur_roots_order(roots, COUNT, 60, 1, NULL), RESULT_OK);
    assert_true(find_closest(roots, 60, scalp.surface.area) > 0.45);
    shapes_destroy_scalp(&scalp);
}

// The density is a fifth on one half of a sphere: a sixth of the roots lie there, within five
// standard deviations of random points, and none where the density is 0 or below.
static void roots_are_as_dense_as_the_map_says(void **state)
{
    (void)state;
    enum { COUNT = 6000 };
    static SurfacePoint roots[COUNT];
    int thin = 0;
    Scalp scalp;
    shapes_make_scalp(&scalp, SCALP_SPHERE, 24);
    make_roots(roots, COUNT, &scalp, "x < 0 ? 1 : 0.2", 3);
    for (int i = 0; i < COUNT; i++) thin += roots[i].place[0] >= 0;
    assert_true(fabs(thin - COUNT / 6.0) < 5 * sqrt(COUNT * 5 / 36.0));
    make_roots(roots, COUNT, &scalp, "y - 0.05", 3);
    for (int i = 0; i < COUNT; i++) assert_true(roots[i].place[1] >= 0.05);
    shapes_destroy_scalp(&scalp);
}

// White where u is between 0.25 and 0.75: the front half of the sphere. Interpolation extends a
// texel's value into its neighbours.
static void images_lie_on_texture_coordinates(void **state)
{
    enum { SIZE = 64, COUNT = 500 };
    static SurfacePoint roots[COUNT];
    Image image;
    Scalp scalp;
    shapes_make_scalp(&scalp, SCALP_SPHERE, 24);
    assert_int_equal(image_create(&image, SIZE, 8, 3, NULL), RESULT_OK);
    for (int i = 0; i < SIZE * 8 * 3; i++) {
        int x = i / 3 % SIZE;
        image.pixels[i] = x >= SIZE / 4 && x < 3 * SIZE / 4 ? 255 : 0;
    }
    const char *path = temporary_path(state, "front.png");
    assert_int_equal(png_write(path, &image, NULL), RESULT_OK);
    make_roots(roots, COUNT, &scalp, path, 1);
    int left = 0;
    for (int i = 0; i < COUNT; i++) {
        left += roots[i].place[0] < 0;
        assert_true(roots[i].place[2] > -0.1 * sin(2 * 3.14159265 / SIZE));
    }
    assert_true(abs(left - COUNT / 2) < 5 * sqrt(COUNT) / 2);
    image_destroy(&image);
    shapes_destroy_scalp(&scalp);
}

int main(void)
{
#define WITH_FILES(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(roots_are_even_by_area),
        cmocka_unit_test(roots_are_even_within_a_triangle),
        cmocka_unit_test(roots_keep_away_from_each_other),
        cmocka_unit_test(roots_are_as_dense_as_the_map_says),
        WITH_FILES(images_lie_on_texture_coordinates),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
