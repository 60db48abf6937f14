// SPDX-License-Identifier: MIT
// Changes of strands, and their statistics.
#include "convert/figures.h"
#include "formats/strands_read.h"
#include "gen/strands_make.h"
#include "strands/strands.h"
#include "strands/strands_edit.h"
#include "strands/strands_resample.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static Strands make_curls(void)
{
    StrandsRecipe recipe = strands_make_recipe(STRANDS_STYLE_CURLS);
    recipe.count = 50;
    recipe.vertices = 12;
    Strands strands;
    assert_int_equal(strands_make(&strands, &recipe, NULL), RESULT_OK);
    strands.vertex_thickness = malloc(strands.vertex_count * sizeof(float));
    for (uint32_t v = 0; v < strands.vertex_count; v++)
        strands.vertex_thickness[v] = 1e-3f * (float)v;
    return strands;
}

// One strand along a curve.
static Strands make_strand(uint32_t size, void (*place)(double t, float p[3]))
{
    Strands strands;
    assert_int_equal(strands_create(&strands, 1, size, NULL), RESULT_OK);
    strands.first[1] = size;
    for (uint32_t v = 0; v < size; v++) place((double)v / (size - 1), strands.position[v]);
    return strands;
}

static void quarter_circle(double t, float p[3])
{
    p[0] = (float)cos(t * 1.5707963267948966);
    p[1] = (float)sin(t * 1.5707963267948966);
    p[2] = 0;
}

static void uneven_line(double t, float p[3])
{
    p[0] = 1;
    p[1] = (float)(t * t); // dense at the root
    p[2] = (float)(2 * t * t);
}

static bool same_positions(const Strands *a, const Strands *b)
{
    return a->vertex_count == b->vertex_count &&
           memcmp(a->position, b->position, a->vertex_count * sizeof *a->position) == 0;
}

static void turning_around_twice_changes_nothing(void **state)
{
    (void)state;
    Strands a = make_curls(), b = make_curls();
    strands_reverse(&b);
    assert_memory_equal(b.position[b.first[7]], a.position[a.first[8] - 1], sizeof(float[3]));
    assert_true(b.vertex_thickness[b.first[7]] == a.vertex_thickness[a.first[8] - 1]);
    strands_reverse(&b);
    assert_true(same_positions(&a, &b));
    strands_destroy(&a);
    strands_destroy(&b);
}

static void smoothing_keeps_ends_and_straight_lines_and_calms_zigzags(void **state)
{
    (void)state;
    Strands strands;
    assert_int_equal(strands_create(&strands, 2, 22, NULL), RESULT_OK);
    strands.first[1] = 11;
    strands.first[2] = 22;
    for (int v = 0; v < 22; v++) {
        strands.position[v][1] = (float)(v % 11); // integers: the filter is exact
        if (v >= 11) strands.position[v][0] = (float)(v % 2);
    }
    strands_smooth(&strands, 1);
    for (int v = 0; v < 11; v++) assert_true(strands.position[v][1] == (float)v);
    assert_true(strands.position[11][0] == 1 && strands.position[21][0] == 1);
    for (int v = 12; v < 21; v++) assert_true(strands.position[v][0] == 0.5f);
    strands_destroy(&strands);
}

static void moves_are_what_they_say(void **state)
{
    (void)state;
    Strands a = make_curls(), b = make_curls();
    StrandsMove move = strands_move_none();
    a.position[0][0] = b.position[0][0] = -0.0f;
    strands_move(&b, &move);
    assert_true(same_positions(&a, &b));
    move = strands_move_rotation(1, 90); // x to -z, z to x
    strands_move(&b, &move);
    for (uint32_t v = 0; v < a.vertex_count; v++)
        assert_true(b.position[v][0] == a.position[v][2] && b.position[v][2] == -a.position[v][0]);
    move = strands_move_rotation(1, -90);
    strands_move(&b, &move);
    assert_true(same_positions(&a, &b));
    move = strands_move_none();
    move.scale = 2;
    move.translation[1] = 1;
    strands_move(&b, &move);
    assert_true(b.position[5][1] == (float)(2.0 * a.position[5][1] + 1));
    assert_true(b.vertex_thickness[5] == 2 * a.vertex_thickness[5]);
    strands_destroy(&a);
    strands_destroy(&b);
}

// Strands that are written with another unit and axis are read back as they were; powers of two are
// exact.
static void units_of_output_are_those_of_input(void **state)
{
    Strands a = make_curls(), b = make_curls(), back;
    const char *path = temporary_path(state, "x.hair");
    strands_to_unit(&b, 0.25, true);
    assert_true(b.position[3][2] == 4 * a.position[3][1]);
    assert_int_equal(format_write(path, FORMAT_HAIR, &b, NULL), RESULT_OK);
    const StrandsReadOptions options = {.unit = 0.25f, .up = UP_Z};
    assert_int_equal(strands_read(&back, path, &options, NULL, NULL), RESULT_OK);
    assert_true(same_positions(&a, &back));
    strands_destroy(&a);
    strands_destroy(&b);
    strands_destroy(&back);
}

static void resampling_makes_equal_distances_and_keeps_ends(void **state)
{
    (void)state;
    Strands strands = make_strand(9, uneven_line);
    strands.mobility = calloc(9, sizeof(float));
    strands.vertex_thickness = calloc(9, sizeof(float));
    for (int v = 0; v < 9; v++) {
        strands.mobility[v] = v > 0;
        strands.vertex_thickness[v] = strands.position[v][1]; // linear along the strand
    }
    const ResampleOptions options = {.count = 21};
    assert_int_equal(strands_resample(&strands, &options, NULL), RESULT_OK);
    assert_int_equal(strands.vertex_count, 21);
    // Rounding to float32 of numbers up to 2, and of segments that are summed in double precision.
    for (uint32_t v = 0; v < 21; v++) {
        assert_true(fabs(strands.position[v][1] - v / 20.0) < 1e-6);
        assert_true(fabs(strands.position[v][2] - v / 10.0) < 2e-6);
        assert_true(fabs(strands.vertex_thickness[v] - v / 20.0) < 1e-6);
        assert_true(strands.mobility[v] == (v > 0 ? 1 : 0));
    }
    assert_true(strands.position[20][1] == 1 && strands.position[20][2] == 2);
    strands_destroy(&strands);
}

// A circle of radius 1 by chords of 22.5 degrees errs by 1 - cos(11.25 deg) = 0.019; a centripetal
// Catmull-Rom spline errs by a tenth of that where it has neighbours on both sides.
static void the_spline_is_rounder_than_the_vertices(void **state)
{
    (void)state;
    double worst[2] = {0};
    for (int spline = 0; spline < 2; spline++) {
        Strands strands = make_strand(5, quarter_circle);
        const ResampleOptions options = {.count = 64, .spline = spline};
        assert_int_equal(strands_resample(&strands, &options, NULL), RESULT_OK);
        double step = 0;
        for (uint32_t v = 0; v < 64; v++) {
            const float *p = strands.position[v];
            double off = fabs(1 - hypot(p[0], p[1]));
            if (v > 16 && v < 48) worst[spline] = fmax(worst[spline], off);
            if (v == 0) continue;
            double d = hypot(p[0] - p[-3], p[1] - p[-2]);
            // Chords cut corners: the curve turns by at most 22.5 degrees at a vertex.
            if (v > 1) assert_true(fabs(d / step - 1) < 0.03);
            step = d;
        }
        strands_destroy(&strands);
    }
    assert_true(worst[0] > 0.018 && worst[0] < 0.0193);
    assert_true(worst[1] < 0.0019);
}

static void spacing_makes_as_many_vertices_as_needed(void **state)
{
    (void)state;
    Strands strands = make_strand(9, uneven_line); // of length sqrt(5)
    ResampleOptions options = {.spacing = 2.2360679774997896 / 7};
    assert_int_equal(strands_resample(&strands, &options, NULL), RESULT_OK);
    assert_int_equal(strands.vertex_count, 8);
    options.spacing = 100;
    assert_int_equal(strands_resample(&strands, &options, NULL), RESULT_OK);
    assert_int_equal(strands.vertex_count, 2);
    options.spacing = 1e-9;
    Error error;
    assert_int_equal(strands_resample(&strands, &options, &error), RESULT_FAILED);
    assert_non_null(strstr(error.text, "at most 65535"));
    assert_int_equal(strands.vertex_count, 2);
    strands_destroy(&strands);
}

static void thinning_keeps_the_same_strands_for_the_same_seed(void **state)
{
    (void)state;
    Strands all = make_curls(), a = make_curls(), b = make_curls(), c = make_curls();
    assert_int_equal(strands_thin(&a, 0.3, 1, NULL), RESULT_OK);
    assert_int_equal(strands_thin(&b, 0.3, 1, NULL), RESULT_OK);
    assert_int_equal(strands_thin(&c, 0.3, 2, NULL), RESULT_OK);
    assert_int_equal(a.strand_count, 15);
    assert_true(same_positions(&a, &b));
    assert_false(same_positions(&a, &c));
    uint32_t found = 0; // in the order of the file, with all their attributes
    for (uint32_t s = 0; s < all.strand_count && found < a.strand_count; s++)
        if (memcmp(all.position[all.first[s]], a.position[a.first[found]], sizeof(float[3])) == 0) {
            assert_true(all.vertex_thickness[all.first[s]] == a.vertex_thickness[a.first[found]]);
            found++;
        }
    assert_int_equal(found, a.strand_count);
    assert_int_equal(strands_thin(&a, 1e-9, 1, NULL), RESULT_OK);
    assert_int_equal(a.strand_count, 1);
    strands_destroy(&all);
    strands_destroy(&a);
    strands_destroy(&b);
    strands_destroy(&c);
}

// Chords of a circle of radius 1 that turn by w each: turn w, curvature w / (2 sin(w / 2)).
static void figures_of_a_circle_are_known(void **state)
{
    (void)state;
    Strands strands = make_strand(91, quarter_circle); // one degree each
    Figures figures;
    assert_int_equal(figures_measure(&figures, &strands, NULL, NULL), RESULT_OK);
    const Figure *turn = &figures.figures[FIGURE_TURN];
    double w = 3.141592653589793 / 180, chord = 2 * sin(w / 2);
    // Vertices are rounded by 6e-8, and a chord is 0.017 long: a turn errs by up to 2e-5.
    assert_int_equal(turn->count, 89);
    assert_true(fabs(turn->min - 1) < 2e-3 && fabs(turn->max - 1) < 2e-3);
    assert_true(fabs(figures.figures[FIGURE_CURVATURE].median - w / chord) < 2e-3);
    assert_true(fabs(figures.figures[FIGURE_LENGTH].mean - 90 * chord) < 1e-5);
    assert_true(fabs(figures.figures[FIGURE_REACH].mean - sqrt(2) / (90 * chord)) < 1e-5);
    assert_int_equal(figures.figures[FIGURE_ROOTS].count, 0); // there is no other root
    assert_int_equal(figures.size_count, 1);
    assert_int_equal(figures.sizes[0].size, 91);
    figures_destroy(&figures);
    strands_destroy(&strands);
}

// 101 straight strands, 1 to 101 m long.
static void figures_have_the_5th_50th_and_95th_of_a_hundred(void **state)
{
    (void)state;
    enum { COUNT = 101 };
    Strands strands;
    assert_int_equal(strands_create(&strands, COUNT, 2 * COUNT, NULL), RESULT_OK);
    for (uint32_t s = 0; s <= COUNT; ++s) strands.first[s] = 2 * s;
    for (uint32_t s = 0; s < COUNT; ++s) {
        memset(strands.position[2 * s], 0, sizeof(float[3]));
        memcpy(strands.position[2 * s + 1], (float[3]){0, (float)(s * 37 % COUNT + 1), 0},
               sizeof(float[3]));
    }
    Figures figures;
    assert_int_equal(figures_measure(&figures, &strands, NULL, NULL), RESULT_OK);
    const Figure *length = &figures.figures[FIGURE_LENGTH];
    assert_true(length->min == 1 && length->low == 6 && length->median == 51);
    assert_true(length->high == 96 && length->max == 101 && length->mean == 51);
    figures_destroy(&figures);
    strands_destroy(&strands);
}

static void figures_count_vertices_and_find_roots(void **state)
{
    (void)state;
    Strands strands;
    assert_int_equal(strands_create(&strands, 4, 9, NULL), RESULT_OK);
    const uint32_t first[] = {0, 2, 4, 6, 9};
    memcpy(strands.first, first, sizeof first);
    for (uint32_t v = 0; v < 9; v++) {
        strands.position[v][0] = (float)(v / 2 < 3 ? v / 2 : 3) * (float)(v / 2 < 3 ? v / 2 : 3);
        strands.position[v][1] = (float)(v == 1 || v == 3 || v == 5 ? 1 : v > 6 ? v - 6 : 0);
    }
    Figures figures;
    assert_int_equal(figures_measure(&figures, &strands, NULL, NULL), RESULT_OK);
    assert_int_equal(figures.size_count, 2);
    assert_int_equal(figures.sizes[0].strands, 3);
    assert_int_equal(figures.sizes[1].size, 3);
    const Figure *roots = &figures.figures[FIGURE_ROOTS]; // at 0, 1, 4, 9
    assert_true(roots->min == 1 && roots->max == 5 && roots->mean == 2.5);
    assert_true(figures.figures[FIGURE_SIZE].mean == 2.25 && figures.total_length == 5);
    figures_destroy(&figures);
    strands_destroy(&strands);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(turning_around_twice_changes_nothing),
        cmocka_unit_test(smoothing_keeps_ends_and_straight_lines_and_calms_zigzags),
        cmocka_unit_test(moves_are_what_they_say),
        cmocka_unit_test_setup_teardown(units_of_output_are_those_of_input, temporary_create,
                                        temporary_destroy),
        cmocka_unit_test(resampling_makes_equal_distances_and_keeps_ends),
        cmocka_unit_test(the_spline_is_rounder_than_the_vertices),
        cmocka_unit_test(spacing_makes_as_many_vertices_as_needed),
        cmocka_unit_test(thinning_keeps_the_same_strands_for_the_same_seed),
        cmocka_unit_test(figures_of_a_circle_are_known),
        cmocka_unit_test(figures_have_the_5th_50th_and_95th_of_a_hundred),
        cmocka_unit_test(figures_count_vertices_and_find_roots),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
