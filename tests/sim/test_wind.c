// SPDX-License-Identifier: MIT
// Wind that depends on place: each strand gets a mixture of the step's four directions by its root
// (glsl/sim/forces.glsl).
#include "support/hair_fixture.h"
#include "support/twin.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { STRANDS = 40, PAIR = 2 };
static const double LINK = 0.2, DRAG = 3, RATE = 64;

// Winds across the links, which lie along x: the four differ in both components.
static const float WINDS[4][3] = {{0, 3, 1}, {0, -2, 4}, {0, 1, -5}, {0, -4, -1}};

// A wave from 0 to 1 and back per period of 1, as 3 w^2 - 2 w^3.
static double wave(double t)
{
    double way = fabs(2 * (t - floor(t)) - 1);
    return way * way * (3 - 2 * way);
}

// Two curved waves depend on the root's position: the first mixes directions 1 and 2 and directions
// 3 and 4, and the second mixes the two results.
static void strand_wind(const Vec root, Vec wind)
{
    double x = 2.1 * root[0] + 1.3 * root[1] - 2.3 * root[2],
           y = -1.7 * root[0] + 2.6 * root[1] + 1.4 * root[2];
    double across = wave(x + 0.3 * wave(y)), along = wave(y + 0.3 * wave(x));
    for (int k = 0; k < 3; ++k) {
        double w[4];
        for (int i = 0; i < 4; ++i) w[i] = (double)WINDS[i][k];
        wind[k] = (1 - along) * ((1 - across) * w[0] + across * w[1]) +
                  along * ((1 - across) * w[2] + across * w[3]);
    }
}

// Without gravity and from rest, a tip gets the velocity w (1 - e^{-ch}), moves for dt, and its
// link turns to that position. In the first step, forces act for half of it. Measured: 2.2e-8 m;
// three times that is allowed: positions are rounded by 2^-27, and each of the few operations as
// much.
static void winds_mix_by_the_place_of_the_root(void **state)
{
    (void)state;
    Vec start[STRANDS * PAIR];
    HairFixture fixture;
    double worst = 0, spread = 0;
    for (int s = 0; s < STRANDS; ++s)
        for (int j = 0; j < PAIR; ++j)
            start[s * PAIR + j][0] = 0.001 * s + LINK * j, start[s * PAIR + j][1] = -0.006 * s,
                             start[s * PAIR + j][2] = 0.006 * s;
    fixture_create(&fixture, (const Vec *)start, STRANDS, PAIR, "dftl", "", 0, (float)DRAG);
    fixture.step.dt = 1 / RATE;
    fixture.step.gravity[1] = 0;
    memcpy(fixture.step.wind, WINDS, sizeof WINDS);
    fixture_step(&fixture);
    for (int s = 0; s < STRANDS; ++s) {
        Vec q[PAIR], wind, way = {LINK, 0, 0};
        strand_wind(start[s * PAIR], wind);
        vec_add_scaled(way, -expm1(-DRAG * 0.5 / RATE) / RATE, wind, way);
        double size = vec_norm(way);
        twin_read_strand(&fixture, s, q);
        spread = fmax(spread, fabs(q[1][1] - start[s * PAIR][1]));
        for (int k = 0; k < 3; ++k)
            worst = fmax(worst, fabs(q[1][k] - start[s * PAIR][k] - LINK * way[k] / size));
    }
    print_message("%.2g m off, of up to %.2g m\n", worst, spread);
    assert_true(worst < 6.6e-8);
    fixture_destroy(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(winds_mix_by_the_place_of_the_root),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
