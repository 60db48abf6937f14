// SPDX-License-Identifier: MIT
// Wind by strand: each strand's own mixture of the step's four directions (glsl/sim/forces.glsl).
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

// Uniform bits from a number: "lowbias32" of C. Wellons.
static uint32_t hash_bits(uint32_t id)
{
    id = (id ^ (id >> 16)) * 0x7feb352du;
    id = (id ^ (id >> 15)) * 0x846ca68bu;
    return id ^ (id >> 16);
}

// By the lower half of a strand's bits between the first two and between the last two directions,
// by the upper half between those.
static void strand_wind(uint32_t id, Vec wind)
{
    uint32_t bits = hash_bits(id);
    double x = (bits & 0xffff) / 65535.0, y = (bits >> 16) / 65535.0;
    for (int k = 0; k < 3; ++k) {
        double w[4];
        for (int i = 0; i < 4; ++i) w[i] = (double)WINDS[i][k];
        wind[k] = (1 - y) * ((1 - x) * w[0] + x * w[1]) + y * ((1 - x) * w[2] + x * w[3]);
    }
}

// Without gravity, from rest, a tip is kicked by w (1 - e^{-ch}), flies for dt, and its link turns
// to there. The first step's forces act for half of it. Measured: 2.2e-8 m,
// and three times that: positions round by 2^-27, the few operations to them by as much each.
static void every_strand_has_its_mixture_of_winds(void **state)
{
    (void)state;
    Vec start[STRANDS * PAIR];
    HairFixture fixture;
    double worst = 0, spread = 0;
    for (int s = 0; s < STRANDS; ++s)
        for (int j = 0; j < PAIR; ++j)
            start[s * PAIR + j][0] = LINK * j, start[s * PAIR + j][1] = 0,
                             start[s * PAIR + j][2] = 0;
    fixture_create(&fixture, (const Vec *)start, STRANDS, PAIR, "dftl", "", 0, (float)DRAG);
    fixture.step.dt = 1 / RATE;
    fixture.step.gravity[1] = 0;
    memcpy(fixture.step.wind, WINDS, sizeof WINDS);
    fixture_step(&fixture);
    for (int s = 0; s < STRANDS; ++s) {
        Vec q[PAIR], wind, way = {LINK, 0, 0};
        strand_wind((uint32_t)s, wind);
        vec_add_scaled(way, -expm1(-DRAG * 0.5 / RATE) / RATE, wind, way);
        double size = vec_norm(way);
        twin_read_strand(&fixture, s, q);
        spread = fmax(spread, fabs(q[1][1]));
        for (int k = 0; k < 3; ++k) worst = fmax(worst, fabs(q[1][k] - LINK * way[k] / size));
    }
    print_message("%.2g m off, of up to %.2g m\n", worst, spread);
    assert_true(worst < 6.6e-8);
    fixture_destroy(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_strand_has_its_mixture_of_winds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
