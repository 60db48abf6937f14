// SPDX-License-Identifier: MIT
// The automatic radius: hair and fur of any density cover their surface.
#include "gen/strands_make.h"
#include "strands/paint.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

enum { POINTS = 20 }; // along each side of the test area

static Strands make_fur(uint32_t count, uint32_t size, double length)
{
    StrandsRecipe recipe = strands_make_recipe(STRANDS_STYLE_FUR);
    Strands strands;
    Error error;
    recipe.count = count;
    recipe.vertices = size;
    recipe.length = (float)length;
    if (strands_make(&strands, &recipe, &error) != RESULT_OK) fail_msg("%s", error.text);
    return strands;
}

// Whether the point (x, y), seen along z, lies on the segment from a to b with these radii at its
// ends.
static bool covers(const float a[3], const float b[3], double at_a, double at_b, double x, double y)
{
    double u = (double)b[0] - a[0], v = (double)b[1] - a[1], square = u * u + v * v;
    double along = ((x - a[0]) * u + (y - a[1]) * v) / (square > 0 ? square : 1);
    along = fmin(fmax(along, 0), 1);
    double radius = at_a + along * (at_b - at_a);
    return hypot(a[0] + along * u - x, a[1] + along * v - y) <= radius;
}

static bool is_covered(const Strands *strands, double radius, double x, double y)
{
    for (uint32_t s = 0; s < strands->strand_count; ++s) {
        const float(*at)[3] = (const float(*)[3]) & strands->position[strands->first[s]];
        uint32_t n = strands_size(strands, s);
        if (at[0][2] < 0) continue; // behind the ball
        for (uint32_t j = 0; j + 1 < n; ++j)
            if (covers(at[j], at[j + 1], radius * (1 - 0.7 * j / (n - 1)),
                       radius * (1 - 0.7 * (j + 1) / (n - 1)), x, y))
                return true;
    }
    return false;
}

// The share of a disc as large as the ball (0.1 m) that the fur of its front half covers.
static double find_coverage(const Strands *strands, double radius)
{
    int covered = 0, count = 0;
    for (int i = 0; i < POINTS * POINTS; ++i) {
        double x = 0.2 * (i / POINTS + 0.5) / POINTS - 0.1,
               y = 0.2 * (i % POINTS + 0.5) / POINTS - 0.1;
        if (hypot(x, y) > 0.1) continue;
        ++count;
        covered += is_covered(strands, radius, x, y);
    }
    return (double)covered / count;
}

// Fur of a bear with four vertices per strand was once drawn with a 400th of its length, so that
// the skin was visible.
static void fur_of_any_density_covers_the_body(void **state)
{
    (void)state;
    static const struct {
        uint32_t count, size;
        double length, least;
    } CASES[] = {{48113, 4, 0.03, 0.9},
                 {12000, 8, 0.03, 0.8},
                 {100000, 3, 0.01, 0.9},
                 {48113, 4, 0.008, 0.8}}; // a strand's width is 1/12 of its length
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; ++i) {
        Strands strands = make_fur(CASES[i].count, CASES[i].size, CASES[i].length);
        double radius = (double)paint_auto_radius(&strands, 0);
        double coverage = find_coverage(&strands, radius);
        // In the middle of the ball, upright fur points at the eye; fewer than 3 of the points lie
        // there.
        if (coverage < CASES[i].least) fail_msg("case %zu: %g of it is covered", i, coverage);
        // shows that the test can fail
        assert_true(find_coverage(&strands, CASES[i].length / 400) < coverage - 0.1);
        strands_destroy(&strands);
    }
}

static void followers_share_the_picture(void **state)
{
    (void)state;
    Strands strands = make_fur(20000, 6, 0.03);
    double alone = (double)paint_auto_radius(&strands, 0),
           nine = (double)paint_auto_radius(&strands, 8);
    assert_true(fabs(nine * 9 / alone - 1) < 1e-6);
    strands_destroy(&strands);
}

// A single strand so thick that it covers its bounding box would not look like a strand.
static void few_strands_still_look_like_fibres(void **state)
{
    (void)state;
    Strands one = make_fur(1, 8, 0.3), few = make_fur(100, 8, 0.03);
    assert_true(paint_auto_radius(&one, 0) <= 0.3f / 399);
    // At most a 300th of the side of the ball's silhouette, 0.23 m; less, because some cells are
    // empty.
    float thick = paint_auto_radius(&few, 0);
    assert_true(thick > 0.03f / 399 && thick < 0.25f / 300);
    strands_destroy(&one);
    strands_destroy(&few);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fur_of_any_density_covers_the_body),
        cmocka_unit_test(followers_share_the_picture),
        cmocka_unit_test(few_strands_still_look_like_fibres),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
