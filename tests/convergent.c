// SPDX-License-Identifier: MIT
#include "convergent.h"
#include "reference_motion.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

void convergent_equals_twin(const char *algo, TwinFunction twin, const ConvergentCase *cases,
                            int count)
{
    for (int i = 0; i < count; ++i) {
        const TwinRun run = {.algo = algo,
                             .variant = "",
                             .n = cases[i].n,
                             .steps = cases[i].steps,
                             .dt = 1 / cases[i].per_second,
                             .drag = cases[i].drag,
                             .style = cases[i].style,
                             .twin = twin};
        double off = twin_compare(&run);
        if (!(off < cases[i].tolerance)) fail_msg("%.3g exceeds %.3g", off, cases[i].tolerance);
    }
}

void convergent_stays_at_rest(const char *algo)
{
    enum { N = 16 };
    Vec start[N], q[N];
    HairFixture fixture;
    for (int j = 0; j < N; ++j) start[j][0] = 0.1, start[j][1] = 0.3 - 0.016 * j, start[j][2] = 0;
    fixture_create(&fixture, (const Vec *)start, 1, N, algo, "", 0, 0);
    for (int i = 0; i < 600; ++i) fixture_step(&fixture);
    twin_read_strand(&fixture, 0, q);
    assert_true(twin_rms((const Vec *)q, (const Vec *)start, N, 0.24) < 1e-5);
    fixture_destroy(&fixture);
}

void convergent_survives_violence(const char *algo)
{
    for (int n = 8; n <= 64; n *= 8) {
        Vec start[64], q[64];
        TwinStrand rest;
        HairFixture fixture;
        twin_make_curl(start, n, 0, 3);
        twin_start(&rest, n, (const Vec *)start);
        fixture_create(&fixture, (const Vec *)start, 1, n, algo, "", 0.5f, 0);
        for (int i = 0; i < 200; ++i) {
            fixture.step.head.translation[1] = i == 100 ? 200 : 0;
            fixture_step(&fixture);
        }
        twin_read_strand(&fixture, 0, q);
        assert_true(twin_length_error(&rest, (const Vec *)q) < 1e-5);
        fixture_destroy(&fixture);
    }
}

void convergent_falls_with_the_step(const char *algo, double most, double ratio)
{
    static const char scenario[] = "a_horizontal_n16_c4";
    double at_60 = motion_error(scenario, algo, "", 1, NULL);
    double coarse = motion_error(scenario, algo, "", 2, NULL);
    double fine = motion_error(scenario, algo, "", 8, NULL);
    printf("%s: %.3g at 60 Hz, %.3g at 120 Hz, %.3g at 480 Hz\n", scenario, at_60, coarse, fine);
    assert_true(coarse < most);
    assert_true(coarse / fine > ratio);
}
