// SPDX-License-Identifier: MIT
// A head that starts with a velocity, and a head that jumps, in a whole simulation.
#include "sim/head.h"
#include "support/head_formulas.h"
#include "support/simulation_fixture.h"

#include <cglm/cglm.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { LAST_VERTEX = 11, BATCH_OF_12 = 1 };

// A head moved by formulas instead of keys, in still air.
static void create(SimulationFixture *fixture, const char *algo, const char *x, const char *turn)
{
    simulation_fixture_create(fixture, algo, "");
    rigid_track_destroy(&fixture->scene.bodies[0].head);
    memset(fixture->scene.run.wind, 0, sizeof fixture->scene.run.wind);
    fixture->scene.run.gust = 0;
    head_set_translation(&fixture->scene.bodies[0].head, x, "0", "0");
    head_set_rotation(&fixture->scene.bodies[0].head, "0", turn, "0");
}

// The tip in the head's coordinates.
static void read_tip(SimulationFixture *fixture, vec3 tip)
{
    const HeadPose *head = &fixture->simulation.bodies[0].head;
    versor back;
    simulation_fixture_read(fixture, BATCH_OF_12, LAST_VERTEX, tip);
    glm_vec3_sub(tip, (float *)head->translation, tip);
    glm_quat_inv((float *)head->rotation, back);
    glm_quat_rotatev(back, tip, tip);
}

static float tips_apart(SimulationFixture *a, SimulationFixture *b)
{
    vec3 tip = {0}, other = {0};
    read_tip(a, tip);
    read_tip(b, other);
    return glm_vec3_distance(tip, other);
}

static void the_start_has_the_heads_velocity(void **state)
{
    (void)state;
    SimulationFixture fixture;
    HeadMotion motion;
    create(&fixture, "chain", "3*t + 5*t^2", "90*t");
    fixture.scene.bodies[0].head.pivot[0] = 0.5f;
    assert_true(head_starts_moving(&fixture.scene.bodies[0].head, &motion));
    // The differences contain float32 rounding, 2e-7 rad or m in 1e-3 s.
    assert_true(fabsf(motion.spin[1] - 1.5707963f) < 1e-3f);
    // The point at the origin rotates about the pivot 0.5 m away and moves along with it.
    assert_true(fabsf(motion.velocity[0] - 3) < 1e-3f);
    assert_true(fabsf(motion.velocity[2] - 0.5f * 1.5707963f) < 1e-3f);
    simulation_fixture_destroy(&fixture);
    simulation_fixture_create(&fixture, "chain", ""); // smooth keys start at rest
    head_starts_moving(&fixture.scene.bodies[0].head, &motion);
    assert_true(glm_vec3_norm(motion.velocity) < 1e-3f && glm_vec3_norm(motion.spin) < 1e-2f);
    simulation_fixture_destroy(&fixture);
}

// Strands of 0.2 m that swing by about 5 cm: 1e-5 m is a hundred roundings of positions below 2 m.
static void hair_rides_along_from_the_first_instant(void **state)
{
    (void)state;
    static const char *const ALGOS[] = {"split", "chain", "dftl"};
    for (size_t i = 0; i < sizeof ALGOS / sizeof ALGOS[0]; ++i) {
        SimulationFixture still, riding;
        create(&still, ALGOS[i], "0", "0");
        create(&riding, ALGOS[i], "1.5*t", "0");
        riding.scene.run.wind[0] = 1.5f;
        riding.scene.run.wind_spread = 0;
        simulation_fixture_start(&still);
        simulation_fixture_start(&riding);
        simulation_fixture_go(&still, 40);
        simulation_fixture_go(&riding, 40);
        float apart = tips_apart(&still, &riding);
        if (!(apart < 1e-5f)) fail_msg("%s: %g m apart", ALGOS[i], (double)apart);
        simulation_fixture_destroy(&still);
        simulation_fixture_destroy(&riding);
    }
}

// At t = 0.2 s the head jumps 3 m and turns round. Returns the difference from a head that stays.
static float after_a_jump(const char *algo, TeleportRule rule, uint64_t *jumps)
{
    SimulationFixture still, jumping;
    create(&still, algo, "0", "0");
    create(&jumping, algo, "t < 0.2 ? 0 : 3", "t < 0.2 ? 0 : 120");
    jumping.scene.run.teleport = rule;
    simulation_fixture_start(&still);
    simulation_fixture_start(&jumping);
    simulation_fixture_go(&still, 16);
    simulation_fixture_go(&jumping, 16);
    float apart = tips_apart(&still, &jumping);
    *jumps = jumping.simulation.jumps;
    simulation_fixture_destroy(&still);
    simulation_fixture_destroy(&jumping);
    return apart;
}

static void a_jump_carries_the_hair_along(void **state)
{
    (void)state;
    static const char *const ALGOS[] = {"split", "chain", "spring", "none"};
    for (size_t i = 0; i < sizeof ALGOS / sizeof ALGOS[0]; ++i) {
        uint64_t jumps;
        float apart = after_a_jump(ALGOS[i], TELEPORT_CARRY, &jumps);
        if (!(apart < 2e-5f)) fail_msg("%s: %g m apart", ALGOS[i], (double)apart);
        assert_int_equal(jumps, 1);
    }
}

static void a_limited_jump_is_felt_less_than_a_free_one(void **state)
{
    (void)state;
    uint64_t jumps;
    float limited = after_a_jump("chain", TELEPORT_LIMIT, &jumps);
    assert_int_equal(jumps, 1);
    float free_jump = after_a_jump("chain", TELEPORT_NONE, &jumps);
    assert_int_equal(jumps, 0);
    if (!(limited > 1e-3f && free_jump > 1e-3f))
        fail_msg("limited %g m, free %g m", (double)limited, (double)free_jump);
}

// A jump larger than the limit is carried except for a motion of the limit's size.
static void what_is_carried_leaves_the_limit(void **state)
{
    (void)state;
    SimulationFixture fixture;
    create(&fixture, "none", "0", "0");
    Scene *scene = &fixture.scene;
    scene->bodies[0].head.pivot[1] = 1;
    scene->run.teleport = TELEPORT_LIMIT;
    HeadPose from = {.rotation = {0, 0, 0, 1}}, to = {.translation = {2, 0, 0}}, carried;
    // a rotation about a vertical axis through the pivot
    glm_quatv(to.rotation, glm_rad(60), (vec3){0, 1, 0});
    assert_true(head_jumps(&scene->run, scene->bodies[0].head.pivot, &from, &to, &carried));
    // A quarter of 2 m is 0.5 m, of 60 degrees 15.
    assert_true(fabsf(carried.translation[0] - 1.5f) < 1e-6f);
    assert_true(fabsf(2 * acosf(carried.rotation[3]) - glm_rad(45)) < 1e-5f);
    to.translation[0] = 0.4f;
    assert_false(head_jumps(&scene->run, scene->bodies[0].head.pivot, &from, &to, &carried));
    glm_quatv(to.rotation, glm_rad(100), (vec3){0, 1, 0});
    assert_true(head_jumps(&scene->run, scene->bodies[0].head.pivot, &from, &to, &carried));
    scene->run.teleport = TELEPORT_NONE;
    assert_false(head_jumps(&scene->run, scene->bodies[0].head.pivot, &from, &to, &carried));
    simulation_fixture_destroy(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_start_has_the_heads_velocity),
        cmocka_unit_test(hair_rides_along_from_the_first_instant),
        cmocka_unit_test(a_jump_carries_the_hair_along),
        cmocka_unit_test(a_limited_jump_is_felt_less_than_a_free_one),
        cmocka_unit_test(what_is_carried_leaves_the_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
