// SPDX-License-Identifier: MIT
// From steps to frames: clocks, frames between steps, warm-up, automatic sub-steps.
#include "mesh/scalp.h"
#include "support/hair_fixture.h"
#include "support/simulation_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

// A run with a simulation rate of 120 Hz.
static void start(SimulationFixture *fixture, const char *algo, const char *variant, float fps,
                  float speed)
{
    simulation_fixture_create(fixture, algo, variant);
    fixture->scene.run.sim_rate = 120;
    fixture->scene.run.fps = fps;
    fixture->scene.run.speed = speed;
    simulation_fixture_start(fixture);
}

static void schedules_name_step_and_share(void **state)
{
    (void)state;
    RunParams run = {.fps = 24, .speed = 1, .sim_rate = 120};
    Schedule schedule = schedule_create(&run, 2);
    assert_true(schedule.steps_per_s == 240 && schedule.steps_per_frame == 10);
    run.fps = 50;
    run.preroll = 0.1f;
    schedule = schedule_create(&run, 1);
    assert_int_equal(schedule.settling, 12); // 0.1f is slightly more than 0.1
    ScheduledFrame frame = schedule_frame(&schedule, &run, 3);
    assert_int_equal(frame.step, 7);
    assert_true(fabsf(frame.share - 0.2f) < 1e-6f && frame.time == 3.0 / 50);
    assert_true(schedule_frame(&schedule, &run, 5).share == 0);
    run.sim_rate = 0;
    run.speed = 0.25f;
    schedule = schedule_create(&run, 3);
    assert_true(schedule.steps_per_s == 600 && schedule.steps_per_frame == 3);
    // TV frame rates: no drift within a day of 2 million frames.
    run = (RunParams){.fps = 24000 / 1001.f, .speed = 1, .sim_rate = 5 * (24000 / 1001.f)};
    schedule = schedule_create(&run, 1);
    for (int i = 0; i < 2000000; i += 997)
        assert_true(schedule_frame(&schedule, &run, i).step == 5 * (int64_t)i &&
                    schedule_frame(&schedule, &run, i).share == 0);
}

// At 24, 60 and 48 frames per second, a frame takes 5, 2 and 2.5 steps of 120 Hz. They coincide
// every 1/12 s, and drawing between two steps does not affect what follows.
static void check_rates(const char *algo, const char *variant)
{
    SimulationFixture film, video, between;
    start(&film, algo, variant, 24, 1);
    start(&video, algo, variant, 60, 1);
    start(&between, algo, variant, 48, 1);
    uint64_t first = simulation_fixture_hash(&film);
    for (int i = 1; i <= 4; ++i) {
        simulation_fixture_go(&film, 2 * i);
        simulation_fixture_go(&video, 5 * i);
        for (int frame = 4 * i - 3; frame <= 4 * i; ++frame) simulation_fixture_go(&between, frame);
        uint64_t hash = simulation_fixture_hash(&film);
        if (hash == first) fail_msg("%s %s: nothing moves", algo, variant);
        if (simulation_fixture_hash(&video) != hash)
            fail_msg("%s %s: 24 and 60 fps differ at %d/12 s", algo, variant, i);
        if (simulation_fixture_hash(&between) != hash)
            fail_msg("%s %s: 24 and 48 fps differ at %d/12 s", algo, variant, i);
    }
    simulation_fixture_destroy(&film);
    simulation_fixture_destroy(&video);
    simulation_fixture_destroy(&between);
}

static void the_frames_rate_does_not_change_the_motion(void **state)
{
    (void)state;
    simulation_fixture_each(check_rates);
}

// More frames than steps: 90 fps at 30 Hz lie at thirds of a step.
static void frames_between_steps_lie_between_them(void **state)
{
    (void)state;
    SimulationFixture fixture;
    simulation_fixture_create(&fixture, "chain", "");
    fixture.scene.run.sim_rate = 30;
    fixture.scene.run.fps = 90;
    track_destroy(&fixture.scene.bodies[0].head.translation);
    track_destroy(&fixture.scene.bodies[0].head.rotation);
    simulation_fixture_start(&fixture);
    for (int step = 0; step < 8; ++step) {
        float p[4][3];
        for (int i = 0; i < 4; ++i) {
            simulation_fixture_go(&fixture, 3 * step + i);
            simulation_fixture_read(&fixture, 1, 11, p[i]);
        }
        for (int k = 0; k < 3; ++k)
            for (int i = 1; i < 3; ++i) {
                float expected = p[0][k] + (float)i / 3 * (p[3][k] - p[0][k]);
                // Coordinates below 2 are rounded to 2^-24 of that a few times.
                assert_true(fabsf(p[i][k] - expected) < 1e-6f);
            }
    }
    simulation_fixture_destroy(&fixture);
}

// The first vertex stays on the head, also between steps.
static void check_roots(const char *algo, const char *variant)
{
    SimulationFixture fixture, still;
    start(&fixture, algo, variant, 48, 1);
    start(&still, "none", "", 48, 1);
    for (int frame = 1; frame < 12; ++frame) {
        float root[3], expected[3];
        simulation_fixture_go(&fixture, frame);
        simulation_fixture_go(&still, frame);
        simulation_fixture_read(&fixture, 0, 0, root);
        simulation_fixture_read(&still, 0, 0, expected);
        for (int k = 0; k < 3; ++k)
            if (!(fabsf(root[k] - expected[k]) < 2e-6f))
                fail_msg("%s %s: frame %d: the root is off by %g m", algo, variant, frame,
                         (double)(root[k] - expected[k]));
    }
    simulation_fixture_destroy(&fixture);
    simulation_fixture_destroy(&still);
}

static void roots_stay_on_the_head_between_steps(void **state)
{
    (void)state;
    simulation_fixture_each(check_roots);
}

static void slow_motion_shows_the_same_motion_more_often(void **state)
{
    (void)state;
    SimulationFixture plain, slow;
    start(&plain, "split", "", 30, 1);
    start(&slow, "split", "", 30, 0.25f);
    for (int frame = 1; frame <= 4; ++frame) {
        simulation_fixture_go(&plain, frame);
        simulation_fixture_go(&slow, 4 * frame);
        assert_true(simulation_fixture_hash(&plain) == simulation_fixture_hash(&slow));
    }
    assert_int_equal(plain.simulation.step, slow.simulation.step);
    simulation_fixture_destroy(&plain);
    simulation_fixture_destroy(&slow);
    // Without --sim-rate there is one step per frame.
    simulation_fixture_create(&slow, "split", "");
    slow.scene.run.speed = 0.25f;
    simulation_fixture_start(&slow);
    simulation_fixture_go(&slow, 8);
    assert_int_equal(slow.simulation.step, 8);
    assert_true(slow.simulation.schedule.steps_per_s == 240);
    simulation_fixture_destroy(&slow);
}

// Everything stays as the warm-up leaves it, also the head, which moves otherwise.
static void at_speed_0_everything_stands(void **state)
{
    (void)state;
    SimulationFixture fixture;
    simulation_fixture_create(&fixture, "split", "");
    fixture.scene.run.speed = 0;
    fixture.scene.run.preroll = 0.5f;
    simulation_fixture_start(&fixture);
    assert_true(fixture.simulation.schedule.steps_per_s == 60);
    uint64_t first = simulation_fixture_hash(&fixture);
    simulation_fixture_go(&fixture, 90);
    assert_int_equal(fixture.simulation.step, 0);
    assert_true(simulation_fixture_hash(&fixture) == first);
    simulation_fixture_destroy(&fixture);
}

// With constant forces and the head at rest, the warm-up equals the run's own start.
static void the_warm_up_is_simulated_with_the_head_at_rest(void **state)
{
    (void)state;
    SimulationFixture settled, plain;
    simulation_fixture_create(&settled, "chain", "");
    settled.scene.run.preroll = 0.5f;
    settled.scene.run.wind[0] = 0;
    simulation_fixture_start(&settled);
    assert_int_equal(settled.simulation.step, 0);
    simulation_fixture_create(&plain, "chain", "");
    plain.scene.run.wind[0] = 0;
    track_destroy(&plain.scene.bodies[0].head.translation);
    track_destroy(&plain.scene.bodies[0].head.rotation);
    simulation_fixture_start(&plain);
    uint64_t first = simulation_fixture_hash(&plain);
    simulation_fixture_go(&plain, 30);
    assert_true(simulation_fixture_hash(&plain) != first);
    assert_true(simulation_fixture_hash(&settled) == simulation_fixture_hash(&plain));
    // Then the head moves from its first pose.
    simulation_fixture_go(&settled, 1);
    assert_true(settled.simulation.bodies[0].head.translation[0] != 0);
    simulation_fixture_destroy(&settled);
    simulation_fixture_destroy(&plain);
}

static void automatic_substeps_are_the_fewest_stable_ones(void **state)
{
    (void)state;
    SimulationFixture fixture;
    simulation_fixture_create(&fixture, "hybrid", "");
    RunParams *run = &fixture.scene.run;
    run->substeps = (AutoInt){.automatic = true};
    run->fps = 24;
    run->gravity[1] = -200;
    ForcesMost forces = forces_most(&fixture.scene);
    double g = simulation_acceleration(&forces, &fixture.scene.sections[0].params);
    assert_true(fabs(g - (200 + 3 * 0.5 * 1.5)) < 1e-6); // drag 3/s, wind 0.5 m/s, half of it gusts
    for (uint32_t i = 0; i < 3; ++i) // the wind's greatest speed in the frames' time counts
        assert_int_equal(track_set_formula(&fixture.scene.wind, i, i == 1 ? "4*sin(pi*t)" : "0",
                                           &(TrackRange){-100, 100, 1}, NULL),
                         RESULT_OK);
    run->frames = 25;
    forces = forces_most(&fixture.scene);
    double windy = simulation_acceleration(&forces, &fixture.scene.sections[0].params);
    assert_true(fabs(windy - (200 + 3 * 4 * 1.5)) < 1e-4);
    track_destroy(&fixture.scene.wind);
    simulation_fixture_start(&fixture);
    int chosen = fixture.simulation.substeps;
    assert_true(chosen > 1);
    assert_true(simulation_stability(&fixture.strands, g, 1.0 / 24 / chosen) <= 1.6f);
    assert_true(simulation_stability(&fixture.strands, g, 1.0 / 24 / (chosen - 1)) > 1.6f);
    simulation_fixture_destroy(&fixture);
    // Solvers that are stable with any step get one sub-step; impossible numbers are refused.
    simulation_fixture_create(&fixture, "split", "");
    fixture.scene.run.substeps.automatic = true;
    simulation_fixture_start(&fixture);
    assert_int_equal(fixture.simulation.substeps, 1);
    simulation_fixture_destroy(&fixture);
    simulation_fixture_create(&fixture, "hybrid", "");
    fixture.scene.run.gravity[1] = -1e6f;
    fixture.scene.run.fps = 1;
    int substeps;
    Error error;
    assert_int_equal(
        simulation_choose_substeps(&substeps, &fixture.scene, &fixture.strands, &error),
        RESULT_USAGE);
    assert_true(strncmp(error.text, "curls: --substeps auto comes to ", 32) == 0);
    simulation_fixture_destroy(&fixture);
}

static void a_strand_of_n_has_the_stability_number_of_its_links(void **state)
{
    (void)state;
    // algorithms.md: n = 16 at 60 Hz: 1.6, n = 32: 3.2, for strands of about 0.24 m.
    Strands strands;
    assert_int_equal(strands_create(&strands, 1, 16, NULL), RESULT_OK);
    for (int j = 0; j < 16; ++j) strands.position[j][1] = -0.016f * (float)j;
    strands.first[1] = 16;
    assert_true(fabs(simulation_stability(&strands, 9.81, 1.0 / 60) - 0.25 * sqrt(9.81 / 0.24)) <
                1e-5);
    assert_true(simulation_stability(&strands, 0, 1.0 / 60) == 0);
    strands_destroy(&strands);
}

// Spacing of the distance field that the simulation makes of a mesh; 0: no field.
static float spacing_of(const char *algo, bool mesh, bool section)
{
    SimulationFixture fixture;
    Mesh ball;
    Error error;
    simulation_fixture_create(&fixture, algo, "");
    fixture.scene.run.sdf_cache = false;
    if (!mesh) fixture.scene.bodies[0].params.collide_mesh = false;
    if (!section) fixture.scene.sections[0].params.collide = false;
    assert_int_equal(scalp_make_mesh(&ball, SCALP_SPHERE, 8, &error), RESULT_OK);
    if (simulation_create(&fixture.simulation, fixture_gpu(), &fixture.timer, &fixture.scene,
                          &fixture.strands, &ball, &error))
        fail_msg("%s", error.text);
    float spacing = fixture.simulation.bodies[0].field.spacing;
    mesh_destroy(&ball);
    simulation_fixture_destroy(&fixture);
    return spacing;
}

static void a_mesh_becomes_a_field_only_where_hair_collides_with_it(void **state)
{
    (void)state;
    assert_true(spacing_of("split", true, true) > 0);
    assert_true(spacing_of("split", false, true) == 0);
    assert_true(spacing_of("split", true, false) == 0);
    assert_true(spacing_of("none", true, true) == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(schedules_name_step_and_share),
        cmocka_unit_test(the_frames_rate_does_not_change_the_motion),
        cmocka_unit_test(frames_between_steps_lie_between_them),
        cmocka_unit_test(roots_stay_on_the_head_between_steps),
        cmocka_unit_test(slow_motion_shows_the_same_motion_more_often),
        cmocka_unit_test(at_speed_0_everything_stands),
        cmocka_unit_test(the_warm_up_is_simulated_with_the_head_at_rest),
        cmocka_unit_test(automatic_substeps_are_the_fewest_stable_ones),
        cmocka_unit_test(a_mesh_becomes_a_field_only_where_hair_collides_with_it),
        cmocka_unit_test(a_strand_of_n_has_the_stability_number_of_its_links),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
