// SPDX-License-Identifier: MIT
// Strands of fur: lengths, form, distance from the mesh. test_fur_roots.c tests roots.
#include "gen/fur.h"
#include "image/png.h"
#include "support/shapes.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static Strands grow(const FurRecipe *recipe, const Mesh *mesh)
{
    Strands strands;
    FurReport report;
    Error error = {""};
    if (fur_grow(&strands, recipe, mesh, "mesh", &report, &error) != RESULT_OK)
        fail_msg("%s", error.text);
    assert_int_equal(report.stuck, 0);
    return strands;
}

// Long hair on the head with all features.
static FurRecipe long_hair(void)
{
    FurRecipe recipe = fur_recipe_default();
    recipe.count = 1500;
    recipe.vertices = 40;
    recipe.length = 0.25;
    recipe.density = "y > 0.03";
    recipe.comb = "x/(0.01+abs(x)), -0.4, -0.4";
    recipe.lie = 0.01;
    recipe.comb_reach = 0.1;
    recipe.volume = 0.015;
    recipe.noise = 0.3;
    recipe.scatter = 0.2;
    recipe.guides = 150;
    recipe.clump = 0.7;
    recipe.curl_radius = 0.006;
    recipe.curl_frequency = 25;
    recipe.frizz = 0.003;
    recipe.flyaways = 0.05;
    return recipe;
}

// Coordinates of 0.3 m are rounded to 2^-25: both ends of each of n segments err by sqrt(3) 2^-26 m
// at most, and the strand by n times as much.
static void check_lengths(const Strands *strands, double shortest, double longest)
{
    double slack = strands_size(strands, 0) * 2 * sqrt(3.0) * 0x1p-26;
    for (uint32_t s = 0; s < strands->strand_count; s++) {
        double length = strands_length(strands, s);
        assert_true(length > shortest - slack && length < longest + slack);
    }
}

static void lengths_are_within_the_variation(void **state)
{
    (void)state;
    Scalp scalp;
    shapes_make_scalp(&scalp, SCALP_HEAD, 24);
    FurRecipe recipe = long_hair();
    recipe.length_variation = 0.4;
    Strands strands = grow(&recipe, &scalp.mesh);
    check_lengths(&strands, 0.6 * recipe.length, recipe.length);
    double sum = 0;
    for (uint32_t s = 0; s < strands.strand_count; s++) sum += strands_length(&strands, s);
    // Lengths are uniform between the two: their standard deviation is 0.4/sqrt(12) of the length.
    double mean = sum / strands.strand_count / recipe.length;
    assert_true(fabs(mean - 0.8) < 5 * 0.4 / sqrt(12.0 * strands.strand_count));
    strands_destroy(&strands);
    recipe.length_variation = 0;
    recipe.length_map = "x > 0 ? 0.5 : (x > -0.03 ? 0 : 1)";
    strands = grow(&recipe, &scalp.mesh);
    assert_true(strands.strand_count < (uint32_t)recipe.count);
    for (uint32_t s = 0; s < strands.strand_count; s++) {
        double x = (double)strands.position[strands.first[s]][0];
        double expected = recipe.length * (x > 0 ? 0.5 : 1.0);
        assert_true(x > 0 || x < -0.029);
        assert_true(fabs(strands_length(&strands, s) - expected) < 1e-5);
    }
    shapes_destroy_scalp(&scalp);
    strands_destroy(&strands);
}

// Vertices and segments' middles are outside, except for the rounding of the file's numbers. The
// root is lifted along the interpolated normal, which may lean towards the facet.
static void check_outside(const Strands *strands, const Surface *surface, double least)
{
    SurfacePoint nearest = {0};
    for (uint32_t s = 0; s < strands->strand_count; s++)
        for (uint32_t v = strands->first[s]; v < strands->first[s + 1]; v++) {
            Double3 p, before;
            double3_from_float(strands->position[v], p);
            double over = surface_nearest(surface, p, &nearest);
            assert_true(over > (v == strands->first[s] ? 0.5 : 1.0) * least - 1e-7);
            if (v == strands->first[s]) continue;
            double3_from_float(strands->position[v - 1], before);
            double3_mix(before, p, 0.5, p);
            assert_true(surface_nearest(surface, p, &nearest) > 0);
        }
}

// Hair that is blown against the head from the front and hangs with great weight, curly or not:
// nose, lips and chin are in its way.
static void hair_stays_out_of_the_mesh(void **state)
{
    (void)state;
    Scalp scalp;
    shapes_make_scalp(&scalp, SCALP_HEAD, 36);
    FurRecipe recipe = long_hair();
    recipe.comb = "0, -0.2, 1";
    recipe.gravity_bend = 60;
    for (int curls = 0; curls < 2; curls++) {
        recipe.curl_radius = 0.01 * curls;
        Strands strands = grow(&recipe, &scalp.mesh);
        check_outside(&strands, &scalp.surface, recipe.root_lift);
        strands_destroy(&strands);
    }
    shapes_destroy_scalp(&scalp);
}

static void equal_seeds_give_equal_hair(void **state)
{
    (void)state;
    Scalp scalp;
    shapes_make_scalp(&scalp, SCALP_HEAD, 24);
    FurRecipe recipe = long_hair();
    recipe.count = 300, recipe.guides = 30;
    Strands a = grow(&recipe, &scalp.mesh), b = grow(&recipe, &scalp.mesh);
    assert_memory_equal(a.position, b.position, 12 * (size_t)a.vertex_count);
    recipe.seed = 2;
    Strands c = grow(&recipe, &scalp.mesh);
    assert_memory_not_equal(a.position, c.position, 12 * (size_t)a.vertex_count);
    strands_destroy(&a);
    strands_destroy(&b);
    strands_destroy(&c);
    shapes_destroy_scalp(&scalp);
}

// Mean distance of the tips from the nearest guide's tip, m. Guides come first.
static double measure_clumps(const Strands *strands, uint32_t guides)
{
    double sum = 0;
    for (uint32_t s = guides; s < strands->strand_count; s++) {
        double nearest = INFINITY;
        Double3 tip, other;
        double3_from_float(strands->position[strands->first[s + 1] - 1], tip);
        for (uint32_t g = 0; g < guides; g++) {
            double3_from_float(strands->position[strands->first[g + 1] - 1], other);
            nearest = fmin(nearest, double3_distance(tip, other));
        }
        sum += nearest;
    }
    return sum / (strands->strand_count - guides);
}

// Straight fur of equal length on a sphere: all tips, including the guides', lie on a larger
// sphere. A strand that is pulled by 0.8 of the way to its guide keeps 0.2 of the distance, which
// is 12 mm on average. As it keeps its length, its tip is lower by 12^2/200 mm, so that 0.21
// remains.
static void clumps_gather_tips(void **state)
{
    (void)state;
    Scalp scalp;
    shapes_make_scalp(&scalp, SCALP_SPHERE, 24);
    FurRecipe recipe = fur_recipe_default();
    recipe.count = 2000;
    recipe.guides = 500;
    recipe.length = 0.1;
    recipe.length_variation = 0;
    recipe.gravity_bend = 0;
    Strands loose = grow(&recipe, &scalp.mesh);
    recipe.clump = 0.8;
    Strands gathered = grow(&recipe, &scalp.mesh);
    double ratio = measure_clumps(&gathered, 500) / measure_clumps(&loose, 500);
    assert_true(fabs(ratio - 0.2) < 0.03);
    strands_destroy(&loose);
    strands_destroy(&gathered);
    shapes_destroy_scalp(&scalp);
}

// Combed down without lift on a sphere, the first segment runs downwards along the surface; with a
// lift of 90 degrees, it runs along the normal. The mesh's normals are means of facets' normals,
// which differ from the sphere's by up to half of the facet's diagonal, 2.5 sqrt(2) degrees =
// 0.062. Facets lie up to 0.1 (1 - cos 2.5 deg) m = 0.1 mm below the sphere: an edge in the way
// turns a segment of 2 mm up by 0.1, and by 2 % more (fur_weave_cut).
static void hair_leaves_as_it_is_combed(void **state)
{
    (void)state;
    Scalp scalp;
    shapes_make_scalp(&scalp, SCALP_SPHERE, 36);
    for (int upright = 0; upright < 2; upright++) {
        FurRecipe recipe = fur_recipe_default();
        recipe.count = 300;
        recipe.comb = "0,-1,0";
        recipe.density = "abs(y) < 0.03";
        recipe.length_variation = 0;
        recipe.gravity_bend = 0;
        recipe.lift_deg = upright ? 90 : 0;
        Strands strands = grow(&recipe, &scalp.mesh);
        for (uint32_t s = 0; s < strands.strand_count; s++) {
            Double3 root, next, normal;
            double3_from_float(strands.position[strands.first[s]], root);
            double3_from_float(strands.position[strands.first[s] + 1], next);
            double3_subtract(next, root, next);
            double3_normalize(next);
            double3_copy(root, normal);
            double3_normalize(normal);
            double along = double3_dot(next, normal), most = 0.164;
            // At a height of 0.03 on a radius of 0.1 m, down along the surface is within asin(0.3)
            // of vertical.
            double down = -cos(asin(0.3) + most);
            assert_true(upright ? along > cos(0.062) : fabs(along) < most && next[1] < down);
        }
        strands_destroy(&strands);
    }
    shapes_destroy_scalp(&scalp);
}

// An image that says u everywhere combs along the circles of latitude, turned up by at most 0.1 as
// above.
static void images_comb_along_texture_coordinates(void **state)
{
    Scalp scalp;
    Image image;
    shapes_make_scalp(&scalp, SCALP_SPHERE, 36);
    assert_int_equal(image_create(&image, 2, 2, 3, NULL), RESULT_OK);
    for (int i = 0; i < 12; i++) image.pixels[i] = i % 3 == 0 ? 255 : 128;
    const char *path = temporary_path(state, "u.png");
    assert_int_equal(png_write(path, &image, NULL), RESULT_OK);
    FurRecipe recipe = fur_recipe_default();
    recipe.count = 300;
    recipe.comb = path;
    recipe.density = "abs(y) < 0.05";
    recipe.length_variation = 0;
    recipe.gravity_bend = 0;
    recipe.lift_deg = 0;
    Strands strands = grow(&recipe, &scalp.mesh);
    for (uint32_t s = 0; s < strands.strand_count; s++) {
        const float *root = strands.position[strands.first[s]], *next = root + 3;
        Double3 east = {(double)root[2], 0, -(double)root[0]}, way;
        for (int i = 0; i < 3; i++) way[i] = (double)next[i] - (double)root[i];
        double3_normalize(east);
        double3_normalize(way);
        assert_true(double3_dot(east, way) > cos(0.164));
    }
    strands_destroy(&strands);
    image_destroy(&image);
    shapes_destroy_scalp(&scalp);
}

// Curled strands are shorter from root to tip by the curl's longer way.
static void curls_wind(void **state)
{
    (void)state;
    Scalp scalp;
    shapes_make_scalp(&scalp, SCALP_SPHERE, 24);
    FurRecipe recipe = fur_recipe_default();
    recipe.count = 100;
    recipe.length = 0.1;
    recipe.length_variation = 0;
    recipe.vertices = 60;
    recipe.gravity_bend = 0;
    for (int curls = 0; curls < 2; curls++) {
        recipe.curl_radius = 0.004 * curls;
        recipe.curl_frequency = 70;
        Strands strands = grow(&recipe, &scalp.mesh);
        double reach = 0;
        for (uint32_t s = 0; s < strands.strand_count; s++) {
            Double3 root, tip;
            double3_from_float(strands.position[strands.first[s]], root);
            double3_from_float(strands.position[strands.first[s + 1] - 1], tip);
            reach += double3_distance(root, tip) / recipe.length / strands.strand_count;
        }
        // A helix of radius r and f turns per metre has a length of sqrt(1 + (2 pi f r)^2) = 2.02
        // per metre of its axis; r grows over the first half of the strand, where the mean is 1.3.
        assert_true(curls ? reach > 1 / 2.02 && reach < 1 / 1.3 : reach > 0.9999);
        strands_destroy(&strands);
    }
    shapes_destroy_scalp(&scalp);
}

static void what_does_not_go_together_is_named(void **state)
{
    (void)state;
    Scalp scalp;
    shapes_make_scalp(&scalp, SCALP_SPHERE, 6);
    Strands strands;
    FurReport report;
    static const struct {
        const char *density, *length, *comb, *message;
    } cases[] = {
        {"0", NULL, NULL, "--density: nowhere above 0 on mesh"},
        {"1/0", NULL, NULL, "--density: inf at "},
        {"x +", NULL, NULL, "--density: got 'x +', expected a formula of x, y, z, nx, "},
        {"none.png", NULL, NULL, "--density: none.png: "},
        {NULL, "0", NULL, "--length-map: leaves no hair on mesh"},
        {NULL, "0/0", NULL, "--length-map: not a number at "},
        {NULL, NULL, "1,2",
         "--comb: got '1,2', expected X,Y,Z, each a number or a formula, or a .png file"},
        {NULL, NULL, "1,2,t", "--comb: got 't', expected a formula of x, y, z"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        FurRecipe recipe = fur_recipe_default();
        Error error = {""};
        recipe.count = 20;
        recipe.density = cases[i].density;
        recipe.length_map = cases[i].length;
        recipe.comb = cases[i].comb;
        Result result = fur_grow(&strands, &recipe, &scalp.mesh, "mesh", &report, &error);
        assert_true(result == RESULT_USAGE || (i == 3 && result == RESULT_BAD_INPUT));
        if (strncmp(error.text, cases[i].message, strlen(cases[i].message)) != 0)
            fail_msg("%s", error.text);
    }
    shapes_destroy_scalp(&scalp);
}

int main(void)
{
#define WITH_FILES(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lengths_are_within_the_variation),
        cmocka_unit_test(hair_stays_out_of_the_mesh),
        cmocka_unit_test(equal_seeds_give_equal_hair),
        cmocka_unit_test(clumps_gather_tips),
        cmocka_unit_test(hair_leaves_as_it_is_combed),
        WITH_FILES(images_comb_along_texture_coordinates),
        cmocka_unit_test(curls_wind),
        cmocka_unit_test(what_does_not_go_together_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
