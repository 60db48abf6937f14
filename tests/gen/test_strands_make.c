// SPDX-License-Identifier: MIT
// Hair of tractrix-gen's generated kinds, and its random numbers.
#include "base/random.h"
#include "formats/strands_read.h"
#include "gen/strands_make.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

// Reference values of SplitMix64 with state 0 (Vigna's splitmix64.c).
static void random_numbers_are_splitmix64(void **state)
{
    (void)state;
    Random random = {0};
    assert_true(random_next(&random) == 0xe220a8397b1dcdafu);
    assert_true(random_next(&random) == 0x6e789e6aa1b965f4u);
    assert_true(random_next(&random) == 0x06c45d188009454fu);
}

static void permutations_hold_every_number_once(void **state)
{
    (void)state;
    uint32_t order[257], seen[257] = {0};
    Random random = random_create(5, 0);
    random_permutation(&random, order, 257);
    for (int i = 0; i < 257; i++) seen[order[i]]++;
    for (int i = 0; i < 257; i++) assert_int_equal(seen[i], 1);
}

static void test_sets_have_the_counts_and_lengths_of_the_thesis(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        uint32_t strands, vertices;
    } sets[] = {{"1k16", 1000, 16}, {"1k32", 1000, 32}, {"10k16", 10000, 16}, {"10k32", 10000, 32}};
    for (int i = 0; i < 4; i++) {
        Strands strands;
        assert_int_equal(strands_make_set(&strands, sets[i].name, 1, NULL), RESULT_OK);
        assert_int_equal(strands.strand_count, sets[i].strands);
        assert_int_equal(strands.vertex_count, sets[i].strands * sets[i].vertices);
        for (uint32_t s = 0; s < strands.strand_count; s += 97) {
            const float *root = strands.position[strands.first[s]];
            double x = (double)root[0], y = (double)root[1], z = (double)root[2];
            assert_int_equal(strands_size(&strands, s), sets[i].vertices);
            assert_true(fabs(strands_length(&strands, s) - 0.25) < 1e-6);
            assert_true(fabs(sqrt(x * x + y * y + z * z) - 0.1) < 1e-7);
            assert_true(y > 0.0);
        }
        strands_destroy(&strands);
    }
}

static void unknown_sets_are_refused_with_the_list(void **state)
{
    (void)state;
    Strands strands;
    Error error;
    assert_int_equal(strands_make_set(&strands, "10k64", 1, &error), RESULT_USAGE);
    assert_non_null(strstr(error.text, "expected 1k16, 1k32, 10k16 or 10k32"));
}

// For n uniform directions, the mean of a coordinate has the standard deviation 1/sqrt(3 n), and
// the mean of its square 2/(3 sqrt(5 n)): 15,000 segments, five standard deviations.
static void directions_of_random_segments_are_even(void **state)
{
    (void)state;
    Strands strands;
    assert_int_equal(strands_make_set(&strands, "1k16", 3, NULL), RESULT_OK);
    double sum[3] = {0}, squares[3] = {0}, count = 15000.0, segment = 0.25 / 15.0;
    for (uint32_t s = 0; s < strands.strand_count; s++)
        for (uint32_t v = strands.first[s] + 1; v < strands.first[s + 1]; v++)
            for (int i = 0; i < 3; i++) {
                double d = (double)strands.position[v][i] - (double)strands.position[v - 1][i];
                sum[i] += d / segment;
                squares[i] += d * d / (segment * segment);
            }
    for (int i = 0; i < 3; i++) {
        assert_true(fabs(sum[i] / count) < 5.0 / sqrt(3.0 * count));
        assert_true(fabs(squares[i] / count - 1.0 / 3.0) < 5.0 * 2.0 / (3.0 * sqrt(5.0 * count)));
    }
    strands_destroy(&strands);
}

static void equal_seeds_give_equal_strands_and_others_do_not(void **state)
{
    (void)state;
    for (int style = 0; style < STRANDS_STYLES; style++) {
        StrandsRecipe recipe = strands_make_recipe((StrandsStyle)style);
        recipe.count = 50;
        Strands a, b, c;
        assert_int_equal(strands_make(&a, &recipe, NULL), RESULT_OK);
        assert_int_equal(strands_make(&b, &recipe, NULL), RESULT_OK);
        recipe.seed = 2;
        assert_int_equal(strands_make(&c, &recipe, NULL), RESULT_OK);
        assert_memory_equal(a.position, b.position, 12 * (size_t)a.vertex_count);
        assert_memory_not_equal(a.position, c.position, 12 * (size_t)a.vertex_count);
        strands_destroy(&a);
        strands_destroy(&b);
        strands_destroy(&c);
    }
}

// Height of a point above the surface, m.
static double height_over(ScalpShape shape, const float point[3])
{
    Double3 at;
    double3_from_float(point, at);
    return scalp_distance(shape, at);
}

static void every_style_grows_from_the_surface_to_its_length(void **state)
{
    (void)state;
    for (int style = 0; style < STRANDS_STYLES; style++) {
        for (int shape = 0; shape < 2; shape++) {
            StrandsRecipe recipe = strands_make_recipe((StrandsStyle)style);
            recipe.shape = (ScalpShape)shape;
            recipe.count = 300;
            Strands strands;
            assert_int_equal(strands_make(&strands, &recipe, NULL), RESULT_OK);
            double longest = (double)recipe.length;
            double shortest = longest * (1.0 - (double)recipe.length_variation);
            for (uint32_t s = 0; s < strands.strand_count; s++) {
                double length = strands_length(&strands, s);
                assert_true(length < 1.01 * longest && length > 0.99 * shortest);
                assert_true(fabs(height_over(recipe.shape, strands.position[strands.first[s]])) <
                            1e-6);
            }
            strands_destroy(&strands);
        }
    }
}

// A vertex may lie below the surface by the height of a segment's chord, l^2 / (8 r): about 0.4 mm
// for l = 13 mm and r = 50 mm, and slightly more where the vertex is pulled back to its length.
static void hair_stays_out_of_the_head(void **state)
{
    (void)state;
    for (int style = STRANDS_STYLE_STRAIGHT; style <= STRANDS_STYLE_FUR; style++) {
        StrandsRecipe recipe = strands_make_recipe((StrandsStyle)style);
        Strands strands;
        assert_int_equal(strands_make(&strands, &recipe, NULL), RESULT_OK);
        for (uint32_t v = 0; v < strands.vertex_count; v++)
            assert_true(height_over(recipe.shape, strands.position[v]) > -1e-3);
        strands_destroy(&strands);
    }
}

// Octants of the sphere have equal shares of all roots and of the first tenth; the counts of a
// low-discrepancy set of n points err far less than the 3 sqrt(n) of random points.
static void roots_are_even_from_the_first_on(void **state)
{
    (void)state;
    StrandsRecipe recipe = strands_make_recipe(STRANDS_STYLE_FUR);
    recipe.count = 8000;
    Strands strands;
    assert_int_equal(strands_make(&strands, &recipe, NULL), RESULT_OK);
    for (uint32_t count = 800; count <= 8000; count *= 10) {
        uint32_t octant[8] = {0};
        for (uint32_t s = 0; s < count; s++) {
            const float *root = strands.position[strands.first[s]];
            octant[(root[0] > 0) + 2 * (root[1] > 0) + 4 * (root[2] > 0)]++;
        }
        for (int i = 0; i < 8; i++) assert_true(fabs(octant[i] - count / 8.0) < sqrt(count));
    }
    strands_destroy(&strands);
}

static void values_out_of_range_are_named(void **state)
{
    (void)state;
    Strands strands;
    Error error;
    StrandsRecipe recipe = strands_make_recipe(STRANDS_STYLE_CURLS);
    recipe.vertices = 1;
    assert_int_equal(strands_make(&strands, &recipe, &error), RESULT_USAGE);
    assert_string_equal(error.text, "vertices 1: expected 2 to 65535");
    recipe.vertices = 20;
    recipe.length = NAN;
    assert_int_equal(strands_make(&strands, &recipe, &error), RESULT_USAGE);
    recipe.length = 0.1f;
    recipe.curl_radius = 0.1f;
    assert_int_equal(strands_make(&strands, &recipe, &error), RESULT_USAGE);
    assert_non_null(strstr(error.text, "do not fit"));
}

static void bundled_assets_are_clean(void **state)
{
    (void)state;
    static const char *const paths[] = {"assets/demo.tfx", "assets/curls.tfx", "assets/fur.tfx"};
    StrandsReadOptions strict = {.strict = true};
    for (int i = 0; i < 3; i++) {
        Strands strands;
        StrandsReport report;
        Error error = {""};
        if (strands_read(&strands, paths[i], &strict, &report, &error) != RESULT_OK)
            fail_msg("%s", error.text);
        assert_true(report.unit_used == 1.0f);
        assert_int_equal(report.shared_roots, 0);
        strands_destroy(&strands);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_numbers_are_splitmix64),
        cmocka_unit_test(permutations_hold_every_number_once),
        cmocka_unit_test(test_sets_have_the_counts_and_lengths_of_the_thesis),
        cmocka_unit_test(unknown_sets_are_refused_with_the_list),
        cmocka_unit_test(directions_of_random_segments_are_even),
        cmocka_unit_test(equal_seeds_give_equal_strands_and_others_do_not),
        cmocka_unit_test(every_style_grows_from_the_surface_to_its_length),
        cmocka_unit_test(hair_stays_out_of_the_head),
        cmocka_unit_test(roots_are_even_from_the_first_on),
        cmocka_unit_test(values_out_of_range_are_named),
        cmocka_unit_test(bundled_assets_are_clean),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
