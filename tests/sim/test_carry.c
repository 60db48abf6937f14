// SPDX-License-Identifier: MIT
// Moving hair and its head together as one body: a solver's result depends neither on the position
// nor on a constant velocity.
#include "sim/carry.h"
#include "support/twin.h"

#include <cglm/cglm.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { N = 12 };
static const double LENGTH = 0.21; // of the curl

typedef struct Pair {
    HairFixture still, moved;
    Carry carry;
    int n;
} Pair;

static void pair_create(Pair *pair, const SolverType *type, const char *variant, float drag)
{
    Vec start[N];
    Error error;
    twin_make_curl(start, N, 0, 1.5);
    fixture_create(&pair->still, (const Vec *)start, 1, N, type->name, variant, 0.3f, drag);
    fixture_create(&pair->moved, (const Vec *)start, 1, N, type->name, variant, 0.3f, drag);
    if (carry_create(&pair->carry, &fixture_gpu()->limits, false, &error) != RESULT_OK)
        fail_msg("%s", error.text);
}

static void pair_destroy(Pair *pair)
{
    fixture_destroy(&pair->still);
    fixture_destroy(&pair->moved);
    carry_destroy(&pair->carry);
}

static void apply(Pair *pair, const HeadMotion *motion)
{
    free(fixture_positions(&pair->moved, 0)); // the solver must have posed
    carry_apply(&pair->carry, &pair->moved.solver, &pair->moved.hair, motion, NULL);
}

// The distance of the moved strand from the still strand moved by `head`: RMS relative to the
// length.
static double difference(Pair *pair, const HeadPose *head)
{
    Vec still[N], moved[N];
    twin_read_strand(&pair->still, 0, still);
    twin_read_strand(&pair->moved, 0, moved);
    for (int j = 0; j < N; ++j) {
        vec3 x = {(float)still[j][0], (float)still[j][1], (float)still[j][2]};
        glm_quat_rotatev((float *)head->rotation, x, x);
        for (int k = 0; k < 3; ++k) still[j][k] = (double)x[k] + (double)head->translation[k];
    }
    return twin_rms((const Vec *)still, (const Vec *)moved, N, LENGTH);
}

// Solvers with larger differences, why, and the bound: RMS relative to the length.
static const struct {
    const char *algo, *variant, *why;
    double carried, galilean;
} EXCEPTIONS[] = {
    {"split", "dragged", "by its definition the root pulls the strand through the world", 0, 0.2},
    {"split", "thesis", "as published", 0, 2},
    {"emulation", "thesis", "as published", 0, 2},
    {"emulation", "projected", "rounding grows 260 times with springs of 200/s2", 0, 4e-4},
    {"hybrid", "", "the same, 250 times", 0, 4e-4},
    {"rod", "particles", "the same, 500 times", 1e-3, 1e-3},
    {"tressfx", "steady", "takes part in a share of the head's motion; air resists the rest", 0,
     0.1},
    {"tressfx", "tressfx4", "the same", 0, 0.5},
    {"rope", "xpbd", "a loose rope in small steps is chaotic: rounding grows", 2e-3, 2e-3},
};

static void check_bound(const SolverType *type, const char *variant, double error, bool galilean)
{
    double bound = 2e-4;
    for (size_t i = 0; i < sizeof EXCEPTIONS / sizeof EXCEPTIONS[0]; ++i)
        if (strcmp(EXCEPTIONS[i].algo, type->name) == 0 &&
            strcmp(EXCEPTIONS[i].variant, variant) == 0)
            bound = fmax(bound, galilean ? EXCEPTIONS[i].galilean : EXCEPTIONS[i].carried);
    if (!(error < bound))
        fail_msg("%s %s: off by %g, expected below %g", type->name, variant, error, bound);
}

typedef void (*Claim)(const SolverType *type, const char *variant);

static void for_all_solvers(Claim claim)
{
    for (const SolverType *const *type = SOLVER_TYPES; *type; ++type)
        for (int v = 0; !solver_is_static(*type) && (v == 0 || (*type)->variants[v]); ++v)
            claim(*type, (*type)->variants[v] ? (*type)->variants[v] : "");
}

// Swings for half a second, is carried, and swings as long again: 60 steps of float32, whose
// rounding 2 m away is 2.4e-7 m per step, 1e-6 of the length; swinging amplifies that 200 times at
// most.
static void check_carried(const SolverType *type, const char *variant)
{
    Pair pair;
    pair_create(&pair, type, variant, 0.5f);
    HeadPose away = {.translation = {2, -1, 0.5f}};
    glm_quatv(away.rotation, 1.1f, (vec3){0.36f, 0.48f, 0.8f});
    vec3 gravity = {0, -9.81f, 0};
    for (int i = 0; i < 60; ++i) {
        if (i == 30) {
            HeadMotion motion = head_motion_between(&pair.moved.step.head, &away);
            apply(&pair, &motion);
            pair.moved.step.head = pair.moved.step.head_old = away;
            glm_quat_rotatev(away.rotation, gravity, pair.moved.step.gravity);
        }
        fixture_step(&pair.still);
        fixture_step(&pair.moved);
    }
    double error = difference(&pair, &away);
    check_bound(type, variant, error, false);
    pair_destroy(&pair);
}

static void carried_hair_goes_on_as_if_it_had_always_been_there(void **state)
{
    (void)state;
    for_all_solvers(check_carried);
}

// A head at constant velocity, with the air at the same velocity, from the first instant: the
// motion is equal except for rounding at positions up to 1.5 m away.
static void check_galilean(const SolverType *type, const char *variant)
{
    Pair pair;
    const float speed[3] = {1.3f, 0.2f, -0.7f};
    HeadMotion start = {.rotation = {0, 0, 0, 1}};
    pair_create(&pair, type, variant, 0.5f);
    memcpy(start.velocity, speed, sizeof start.velocity);
    apply(&pair, &start);
    for (int i = 1; i <= 60; ++i) {
        for (int k = 0; k < 3; ++k) {
            pair.moved.step.head.translation[k] = speed[k] * (float)i / 60;
            for (int w = 0; w < 4; ++w) pair.moved.step.wind[w][k] = speed[k];
        }
        fixture_step(&pair.still);
        fixture_step(&pair.moved);
    }
    double error = difference(&pair, &pair.moved.step.head);
    check_bound(type, variant, error, true);
    pair_destroy(&pair);
}

static void a_head_at_constant_speed_is_like_one_at_rest(void **state)
{
    (void)state;
    for_all_solvers(check_galilean);
}

// All parts of a motion together, in a state with any velocities: x' = R x + T, v' = R v + V + W x
// x'. Float32 rounds positions of up to 3 m and velocities of up to 6 m/s: a few units of 2^-23 and
// 2^-22.
static void a_motion_acts_as_its_formula_says(void **state)
{
    (void)state;
    Vec start[N];
    TwinStrand strand;
    HairFixture fixture;
    Carry carry;
    Error error;
    SolverBuffer buffers[SOLVER_MAX_BUFFERS];
    HeadMotion motion = {
        .translation = {1, -2, 0.5f}, .velocity = {0.3f, -1, 2}, .spin = {1, -2, 0.5f}};
    glm_quatv(motion.rotation, 1.1f, (vec3){0.36f, 0.48f, 0.8f});
    twin_make_curl(start, N, 0, 1.5);
    twin_start(&strand, N, (const Vec *)start);
    for (int j = 0; j < N; ++j)
        for (int k = 0; k < 3; ++k) strand.v[j][k] = sin(3 * j + k);
    fixture_create(&fixture, (const Vec *)start, 1, N, "chain", "", 0.3f, 1);
    if (carry_create(&carry, &fixture_gpu()->limits, false, &error) != RESULT_OK)
        fail_msg("%s", error.text);
    twin_put(&fixture, &strand, 1);
    carry_apply(&carry, &fixture.solver, &fixture.hair, &motion, NULL);
    solver_buffers(&fixture.solver, 0, buffers);
    float(*points)[4] = gpu_buffer_read(buffers[0].buffer);
    float(*velocities)[4] = gpu_buffer_read(buffers[1].buffer);
    assert_true(points && velocities);
    for (uint32_t j = 0; j < N; ++j) {
        uint32_t at = (uint32_t)hair_address(&fixture.hair.batches[0], 0, j);
        vec3 x, v, turning;
        for (int k = 0; k < 3; ++k) x[k] = (float)strand.x[j][k], v[k] = (float)strand.v[j][k];
        glm_quat_rotatev(motion.rotation, x, x);
        glm_quat_rotatev(motion.rotation, v, v);
        glm_vec3_add(x, motion.translation, x);
        glm_vec3_cross(motion.spin, x, turning);
        for (int k = 0; k < 3; ++k) {
            assert_true(fabsf(points[at][k] - x[k]) < 1e-6f);
            assert_true(fabsf(velocities[at][k] - (v[k] + motion.velocity[k] + turning[k])) <
                        4e-6f);
        }
    }
    free(points);
    free(velocities);
    carry_destroy(&carry);
    fixture_destroy(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(carried_hair_goes_on_as_if_it_had_always_been_there),
        cmocka_unit_test(a_motion_acts_as_its_formula_says),
        cmocka_unit_test(a_head_at_constant_speed_is_like_one_at_rest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
