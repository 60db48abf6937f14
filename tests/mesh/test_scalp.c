// SPDX-License-Identifier: MIT
// Roots on the head: the fast search against a slow one.
#include "mesh/scalp.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

enum { ROOTS = 4000 };

static ScalpRoot roots[ROOTS];

static double distance_at(const Double3 direction, double radius)
{
    Double3 at = {0};
    double3_add_scaled(at, radius, direction);
    return scalp_distance(SCALP_HEAD, at);
}

static double ramp(double low, double high, double x)
{
    double t = fmin(fmax((x - low) / (high - low), 0.0), 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// Height above the hair line of docs/fur.md, m.
static double height(const Double3 direction, double radius)
{
    double y = radius * direction[1], z = radius * direction[2];
    return y + 0.085 - 0.099 * ramp(-0.06, -0.022, z) - 0.056 * ramp(0.015, 0.075, z);
}

static int take_roots(void **state)
{
    (void)state;
    ScalpRoots sequence = scalp_roots_begin(SCALP_HEAD, false, 1);
    scalp_roots_take(&sequence, roots, ROOTS);
    return 0;
}

// A ray that grazes the head may cross it twice within the last 2 mm; then both results are
// accepted.
static void roots_are_where_the_head_begins(void **state)
{
    (void)state;
    for (int i = 0; i < ROOTS; i++) {
        const ScalpRoot *root = &roots[i];
        assert_true(fabs(distance_at(root->direction, root->radius)) < 1e-13);
        assert_true(fabs(double3_length(root->normal) - 1.0) < 1e-12);
        assert_true(height(root->direction, root->radius) > 0.0);
        for (double off = 2e-3; off < 0.1; off += 1e-3)
            assert_true(distance_at(root->direction, root->radius + off) > 0.0);
    }
}

// 4000 roots are about 2.5 degrees apart, and every direction above the hair line has a root within
// three times that angle.
static void no_place_with_hair_is_passed_over(void **state)
{
    (void)state;
    enum { GRID = 40 };
    int tried = 0;
    for (int i = 0; i < GRID * GRID; i++) {
        double y = 1.0 - (i / GRID + 0.5) * 1.8 / GRID, turn = 2.0 * M_PI * (i % GRID) / GRID;
        Double3 direction = {sqrt(1.0 - y * y) * sin(turn), y, sqrt(1.0 - y * y) * cos(turn)};
        double radius = 0.3, nearest = -1.0;
        while (distance_at(direction, radius) > 0.0) radius -= 2e-4;
        if (height(direction, radius) < 0.005) continue;
        for (int r = 0; r < ROOTS; r++)
            nearest = fmax(nearest, double3_dot(direction, roots[r].direction));
        assert_true(nearest > cos(7.5 * M_PI / 180.0));
        tried++;
    }
    assert_in_range(tried, GRID * GRID / 4, GRID * GRID);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(roots_are_where_the_head_begins),
        cmocka_unit_test(no_place_with_hair_is_passed_over),
    };
    return cmocka_run_group_tests(tests, take_roots, NULL);
}
