// SPDX-License-Identifier: MIT
// Finding a head by the roots of hair, and hair that grows on no head.
#include "base/random.h"
#include "gen/strands_make.h"
#include "strands/scalp_fit.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double CENTRE[3] = {0.3, 1.5, -0.2}, RADIUS[3] = {0.077, 0.105, 0.095};

static Strands make_hair(StrandsStyle style)
{
    StrandsRecipe recipe = strands_make_recipe(style);
    Strands strands;
    Error error;
    if (strands_make(&strands, &recipe, &error) != RESULT_OK) fail_msg("%s", error.text);
    return strands;
}

// Strands of two vertices, 1 cm along the normal times `out`. Their roots lie on the part of an
// ellipsoid above `lowest` (of its height, -1 .. 1), displaced by `noise` (m).
static Strands make_scalp(uint32_t count, double lowest, double out, double noise)
{
    Strands strands;
    Random random = random_create(3, 0);
    assert_int_equal(strands_create(&strands, count, 2 * count, NULL), RESULT_OK);
    for (uint32_t s = 0; s < count; ++s) {
        double y = lowest + (1 - lowest) * random_real(&random),
               angle = 6.283185307179586 * random_real(&random), r = sqrt(1 - y * y),
               unit[3] = {r * cos(angle), y, r * sin(angle)};
        strands.first[s + 1] = 2 * (s + 1);
        double off = noise * (2 * random_real(&random) - 1);
        for (int k = 0; k < 3; ++k) {
            double at = CENTRE[k] + (RADIUS[k] + off) * unit[k];
            strands.position[2 * s][k] = (float)at;
            strands.position[2 * s + 1][k] = (float)(at + 0.01 * out * unit[k]);
        }
    }
    return strands;
}

static void assert_refused(const Strands *strands, const char *reason)
{
    ScalpFit fit = scalp_fit(strands, 1);
    if (fit.found || !strstr(fit.reason, reason))
        fail_msg("'%s' lacks '%s'", fit.found ? "found" : fit.reason, reason);
}

static void assert_near(const ScalpFit *fit, double most)
{
    if (!fit->found) fail_msg("%s", fit->reason);
    for (int k = 0; k < 3; ++k)
        if (fabs(fit->centre[k] - CENTRE[k]) > most || fabs(fit->radius[k] - RADIUS[k]) > most)
            fail_msg("axis %d: %g, %g: expected %g, %g", k, fit->centre[k], fit->radius[k],
                     CENTRE[k], RADIUS[k]);
}

// Regularised terms cause larger errors where fewer roots determine them; a sphere would err by
// 0.018 m. The radii are also smaller by the distance that nine of ten roots keep.
static void a_part_of_an_ellipsoid_tells_the_rest(void **state)
{
    (void)state;
    static const struct {
        double lowest, most;
    } CASES[] = {{-0.6, 0.006}, {-0.3, 0.009}, {0, 0.012}};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; ++i) {
        Strands strands = make_scalp(500, CASES[i].lowest, 1, 0.0005);
        ScalpFit fit = scalp_fit(&strands, 1);
        assert_near(&fit, CASES[i].most);
        assert_true(fit.error < 0.002);
        strands_destroy(&strands);
    }
}

static void roots_that_lie_off_do_not_count_much(void **state)
{
    (void)state;
    Strands strands = make_scalp(500, -0.3, 1, 0.0005);
    for (uint32_t s = 0; s < 25; ++s) // a braid next to the head
        for (int k = 0; k < 3; ++k)
            for (uint32_t j = 0; j < 2; ++j)
                strands.position[2 * s + j][k] =
                    (float)(CENTRE[k] + 0.12 * (k == 0) - 0.08 * (k == 1) + 0.001 * (s + j));
    ScalpFit fit = scalp_fit(&strands, 1);
    assert_near(&fit, 0.012);
    strands_destroy(&strands);
}

static void hair_styles_have_a_head_and_roots_are_seen(void **state)
{
    (void)state;
    const StrandsStyle styles[] = {STRANDS_STYLE_STRAIGHT, STRANDS_STYLE_CURLS};
    for (int i = 0; i < 2; ++i) {
        Strands strands = make_hair(styles[i]);
        ScalpFit fit = scalp_fit(&strands, 1);
        uint32_t outside = 0;
        if (!fit.found) fail_msg("%s", fit.reason);
        assert_true(fit.error < 0.004); // a head is not an exact ellipsoid
        for (uint32_t s = 0; s < strands.strand_count; ++s) {
            double square = 0;
            for (int k = 0; k < 3; ++k)
                square += pow(((double)strands.position[strands.first[s]][k] - fit.centre[k]) /
                                  fit.radius[k],
                              2);
            outside += square >= 1;
        }
        assert_true(outside >= 0.9 * strands.strand_count);
        // Two halves of the hair, like two files, give the same head.
        Strands halves[2] = {strands, strands};
        halves[0].strand_count = strands.strand_count / 2;
        halves[0].vertex_count = strands.first[halves[0].strand_count];
        halves[1].first += halves[0].strand_count;
        halves[1].strand_count -= halves[0].strand_count;
        ScalpFit both = scalp_fit(halves, 2);
        assert_true(both.found && fabs(both.radius[1] - fit.radius[1]) < 1e-4);
        strands_destroy(&strands);
    }
}

// Fur is told from the hair of a scalp and from strands in all directions; form and size of the
// body do not matter.
static void roots_around_a_body_are_found(void **state)
{
    (void)state;
    Strands ball = make_hair(STRANDS_STYLE_FUR), random = make_hair(STRANDS_STYLE_RANDOM),
            scalp = make_scalp(500, -0.3, 1, 0), inwards = make_scalp(500, -1, -1, 0);
    assert_true(scalp_fit(&ball, 1).around);
    assert_false(scalp_fit(&random, 1).around);
    assert_false(scalp_fit(&scalp, 1).around);
    assert_false(scalp_fit(&inwards, 1).around);
    for (uint32_t v = 0; v < ball.vertex_count; ++v) ball.position[v][2] *= 5;
    ScalpFit fit = scalp_fit(&ball, 1);
    assert_true(fit.around);
    assert_string_equal(fit.reason, "the ellipsoid is too long");
    strands_destroy(&ball);
    strands_destroy(&random);
    strands_destroy(&scalp);
    strands_destroy(&inwards);
}

static void what_is_no_scalp_gets_no_head(void **state)
{
    (void)state;
    Strands ball = make_hair(STRANDS_STYLE_FUR), random = make_hair(STRANDS_STYLE_RANDOM);
    assert_refused(&ball, "the roots are not on top");
    assert_refused(&random, "strands do not leave outwards");
    strands_destroy(&ball);
    strands_destroy(&random);
    Strands wisp = make_scalp(20, -0.3, 1, 0), patch = make_scalp(500, 0.9, 1, 0),
            inwards = make_scalp(500, -0.3, -1, 0), rough = make_scalp(500, -0.3, 1, 0.05);
    assert_refused(&wisp, "there are too few roots");
    assert_refused(&patch, "the roots are a patch");
    assert_refused(&inwards, "strands do not leave outwards");
    assert_refused(&rough, "");
    // Fur on a flat mat.
    for (uint32_t v = 0; v < patch.vertex_count; ++v) patch.position[v][1] = 0.01f * (v & 1);
    assert_refused(&patch, "");
    // A head one kilometre wide.
    Strands large = make_scalp(500, -0.3, 1, 0);
    for (uint32_t v = 0; v < large.vertex_count; ++v)
        for (int k = 0; k < 3; ++k) large.position[v][k] *= 1e4f;
    assert_refused(&large, "as large as a head");
    ScalpFit fit = scalp_fit(&large, 1);
    assert_true(fit.other_size && fabs(fit.radius[0] / (1e4 * RADIUS[0]) - 1) < 0.05);
    assert_false(scalp_fit(&patch, 1).other_size);
    strands_destroy(&large);
    strands_destroy(&wisp);
    strands_destroy(&patch);
    strands_destroy(&inwards);
    strands_destroy(&rough);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_part_of_an_ellipsoid_tells_the_rest),
        cmocka_unit_test(roots_that_lie_off_do_not_count_much),
        cmocka_unit_test(hair_styles_have_a_head_and_roots_are_seen),
        cmocka_unit_test(what_is_no_scalp_gets_no_head),
        cmocka_unit_test(roots_around_a_body_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
