// SPDX-License-Identifier: MIT
// Wind in the shelter of the head.
#include "support/hair_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// Strands that hang from roots 10 cm in front of, beside and behind the head's centre, in wind
// along x.
enum { BEFORE, BESIDE, BEHIND, STRANDS, N = 8 };

typedef struct Bends {
    float x[STRANDS]; // m: how far the wind moves the tips
} Bends;

static bool oblique; // the root behind is at 45 degrees to the side

static Bends blow(const char *algo, float share, float head_speed, float wind)
{
    double start[STRANDS * N][3];
    const double roots[STRANDS][3] = {{-0.1, 0, 0}, {0, 0, 0.1}, {0.1, 0, 0}};
    HairFixture fixture;
    Bends bends;
    for (int i = 0; i < STRANDS * N; ++i) {
        memcpy(start[i], roots[i / N], sizeof start[i]);
        if (oblique && i / N == BEHIND) start[i][2] = 0.1;
        start[i][1] -= 0.02 * (i % N);
    }
    fixture_create(&fixture, (const double(*)[3])start, STRANDS, N, algo, "", 0.2f, 8);
    if (share > 0) fixture_shelter(&fixture);
    for (int i = 0; i < 4; ++i) fixture.step.wind[i][0] = wind;
    const float middle[3] = {0, 0, 0};
    for (int i = 1; i <= 60; ++i) {
        fixture.step.head.translation[0] = (float)(head_speed * (float)i * (float)fixture.step.dt);
        step_shelter(&fixture.step, middle, share);
        fixture_step(&fixture);
    }
    float(*p)[4] = fixture_positions(&fixture, 0);
    for (uint32_t s = 0; s < STRANDS; ++s)
        bends.x[s] = p[hair_address(&fixture.hair.batches[0], s, N - 1)][0] -
                     p[hair_address(&fixture.hair.batches[0], s, 0)][0];
    free(p);
    fixture_destroy(&fixture);
    return bends;
}

// All solvers with steps, each with its default variant.
static void check_lee(const char *algo)
{
    Bends open = blow(algo, 0, 0, 3), half = blow(algo, 0.5f, 0, 3), lee = blow(algo, 1, 0, 3);
    if (!(open.x[BEHIND] > 5e-3f)) fail_msg("%s: no wind", algo);
    for (int s = BEFORE; s <= BESIDE; ++s)
        if (open.x[s] != lee.x[s]) fail_msg("%s: strand %d is sheltered", algo, s);
    if (!(half.x[BEHIND] < 0.9f * open.x[BEHIND] && half.x[BEHIND] > 2e-3f))
        fail_msg("%s: half a shelter leaves %g of %g m", algo, (double)half.x[BEHIND],
                 (double)open.x[BEHIND]);
    if (!(fabsf(lee.x[BEHIND]) < 1e-5f))
        fail_msg("%s: %g m in the lee", algo, (double)lee.x[BEHIND]);
}

static void hair_in_the_lee_hangs_still(void **state)
{
    (void)state;
    for (const SolverType *const *type = SOLVER_TYPES; *type; ++type)
        if (!solver_is_static(*type)) check_lee((*type)->name);
}

// From the side to the back, shelter grows smoothly with 3 c^2 - 2 c^3, where c is the cosine: at
// 45 degrees, the wind is weaker by that share.
static void it_grows_smoothly_towards_the_lee(void **state)
{
    (void)state;
    const double c = sqrt(0.5), share = c * c * (3 - 2 * c);
    oblique = true;
    Bends half = blow("chain", 0.5f, 0, 3);
    Bends weaker = blow("chain", 0, 0, (float)(3 * (1 - 0.5 * share)));
    oblique = false;
    assert_true(fabsf(half.x[BEHIND] - weaker.x[BEHIND]) < 1e-5f);
}

// A head that moves through still air shelters hair behind it, like a head at rest in wind. (The
// first steps differ, because the hair's initial velocity is 0.)
static void motion_counts_like_wind(void **state)
{
    (void)state;
    Bends running = blow("chain", 1, -3, 0), bare = blow("chain", 0, -3, 0);
    assert_true(bare.x[BEHIND] > 5e-3f);
    assert_true(running.x[BEHIND] < 0.5f * bare.x[BEHIND]);
    assert_true(running.x[BEFORE] == bare.x[BEFORE]);
}

static void the_middle_is_that_of_all_roots(void **state)
{
    (void)state;
    Strands strands[2];
    float middle[3];
    for (int i = 0; i < 2; ++i) {
        assert_int_equal(strands_create(&strands[i], 1, 2, NULL), RESULT_OK);
        strands[i].first[0] = 0, strands[i].first[1] = 2;
        strands[i].position[0][0] = 4.0f * (float)i;
        strands[i].position[1][0] = 100;
    }
    head_middle(middle, strands, 2);
    assert_true(middle[0] == 2 && middle[1] == 0);
    strands_destroy(&strands[0]);
    strands_destroy(&strands[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hair_in_the_lee_hangs_still),
        cmocka_unit_test(it_grows_smoothly_towards_the_lee),
        cmocka_unit_test(motion_counts_like_wind),
        cmocka_unit_test(the_middle_is_that_of_all_roots),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
