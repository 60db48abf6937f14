// SPDX-License-Identifier: MIT
// Wind by place: the mixture of the step's four directions at a strand's root
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

// Winds across the links, which lie along x: each direction differs from all others in both
// components.
static const float WINDS[4][3] = {{0, 3, 1}, {0, -2, 4}, {0, 1, -5}, {0, -4, -1}};

// From 0 to 1 and back while t grows by 1, as 3 w^2 - 2 w^3.
static double wave(double t)
{
    double way = fabs(2 * (t - floor(t)) - 1);
    return way * way * (3 - 2 * way);
}

// By two bent waves over the root's place, between the first two and between the last two
// directions by the first, between those by the second.
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

// Without gravity, from rest, a tip is kicked by w (1 - e^{-ch}), flies for dt, and its link turns
// to there. The first step's forces act for half of it. Measured: 2.2e-8 m,
// and three times that: positions round by 2^-27, the few operations to them by as much each.
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
