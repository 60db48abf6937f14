// SPDX-License-Identifier: MIT
// Parameters that change over time, in a whole simulation.
#include "scene/section_keys.h"
#include "sim/simulation_state.h"
#include "support/simulation_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void add_track(SimulationFixture *fixture, const char *name, const char *formula)
{
    Section *section = &fixture->scene.sections[0];
    Error error = {""};
    json_t *value = json_pack("{s:s}", "formula", formula);
    const JsonPlace place = {.key = name};
    if (section_keys_read(&section->tracks, &section->params, params_find(name), &place, value,
                          &error) != RESULT_OK)
        fail_msg("%s", error.text);
    json_decref(value);
}

static double farthest_apart(SimulationFixture *a, SimulationFixture *b)
{
    const Hair *hair = &a->simulation.sections[0].hair;
    float(*p)[3] = malloc(hair->particle_count * sizeof *p),
    (*q)[3] = malloc(hair->particle_count * sizeof *q);
    double most = 0;
    assert_true(p && q);
    assert_int_equal(hair_read_positions(hair, p, NULL), RESULT_OK);
    assert_int_equal(hair_read_positions(&b->simulation.sections[0].hair, q, NULL), RESULT_OK);
    for (size_t i = 0; i < hair->particle_count; ++i)
        for (int k = 0; k < 3; ++k) most = fmax(most, fabs((double)p[i][k] - (double)q[i][k]));
    free(p);
    free(q);
    return most;
}

// A formula with a constant value gives the same bytes as the value; split draws its style in
// another way, with other rounding.
static void check_constants(const char *algo, const char *variant)
{
    SimulationFixture constant, keyed;
    if (strcmp(variant, "thesis") == 0 || strcmp(variant, "dragged") == 0) return;
    simulation_fixture_create(&constant, algo, variant);
    simulation_fixture_create(&keyed, algo, variant);
    add_track(&keyed, "drag", "3");
    add_track(&keyed, "style", "0.5");
    add_track(&keyed, "gravity_share", "1");
    simulation_fixture_start(&constant);
    simulation_fixture_start(&keyed);
    for (int frame = 0; frame <= 12; frame += 6) {
        simulation_fixture_go(&constant, frame);
        simulation_fixture_go(&keyed, frame);
        double apart = farthest_apart(&constant, &keyed);
        // Polynomials of a rotation are accurate to 3e-7 rad (pose.c), the arcs of the other way to
        // a few roundings of 6e-8, in each of 12 segments of 3 cm: 12 * 0.03 * 1e-6 * 12.
        if (!(apart <= (strcmp(algo, "split") == 0 ? 4.3e-6 : 0)))
            fail_msg("%s %s: frame %d: %g m", algo, variant, frame, apart);
    }
    simulation_fixture_destroy(&constant);
    simulation_fixture_destroy(&keyed);
}

static void constants_as_formulas_change_nothing(void **state)
{
    (void)state;
    simulation_fixture_each(check_constants);
}

static float mean_height(SimulationFixture *fixture)
{
    float tip[3], other[3];
    simulation_fixture_read(fixture, 0, 7, tip);
    simulation_fixture_read(fixture, 1, 11, other);
    return 0.5f * (tip[1] + other[1]);
}

// Hair that loses its style hangs like loose hair: nothing carries its weight any more.
static void check_fading(const char *algo, const char *variant)
{
    SimulationFixture fading, loose;
    if (strcmp(variant, "thesis") == 0 || strcmp(variant, "dragged") == 0 ||
        strcmp(algo, "none") == 0 || strcmp(algo, "tressfx") == 0 ||     // keeps its local shape
        (strcmp(algo, "rod") == 0 && strcmp(variant, "particles") != 0)) // its fibres carry it
        return;
    simulation_fixture_create(&fading, algo, variant);
    simulation_fixture_create(&loose, algo, variant);
    SimulationFixture *both[] = {&fading, &loose};
    for (int i = 0; i < 2; ++i) {
        rigid_track_destroy(&both[i]->scene.bodies[0].head);
        memset(both[i]->scene.run.wind, 0, sizeof both[i]->scene.run.wind);
        both[i]->scene.sections[0].params.drag = 6;
    }
    add_track(&fading, "style", "max(0.5 - 2*t, 0)");
    loose.scene.sections[0].params.style = 0;
    simulation_fixture_start(&fading);
    simulation_fixture_start(&loose);
    float before = mean_height(&fading);
    simulation_fixture_go(&fading, 150);
    simulation_fixture_go(&loose, 150);
    float fell = before - mean_height(&fading), loose_fell = before - mean_height(&loose);
    if (!(loose_fell > 0.01f && fabsf(fell - loose_fell) < 0.2f * loose_fell))
        fail_msg("%s %s: fell by %g m, loose hair by %g m", algo, variant, (double)fell,
                 (double)loose_fell);
    simulation_fixture_destroy(&fading);
    simulation_fixture_destroy(&loose);
}

static void style_that_fades_lets_hair_fall(void **state)
{
    (void)state;
    simulation_fixture_each(check_fading);
}

// A changing parameter wakes sleeping hair, and a resumed run is equal to the bit.
static void changes_wake_hair_and_resume(void **state)
{
    (void)state;
    SimulationFixture whole, resumed;
    Error error;
    Bytes saved;
    SimulationFixture *both[] = {&whole, &resumed};
    for (int i = 0; i < 2; ++i) {
        simulation_fixture_create(both[i], "split", "");
        rigid_track_destroy(&both[i]->scene.bodies[0].head);
        memset(both[i]->scene.run.wind, 0, sizeof both[i]->scene.run.wind);
        both[i]->scene.run.gust = 0;
        add_track(both[i], "style", "t < 9 ? 0.5 : max(0.5 - (t - 9), 0.1)");
        simulation_fixture_start(both[i]);
    }
    simulation_fixture_go(&whole, 530);
    assert_true(whole.simulation.sections[0].sleep.asleep);
    uint64_t asleep = simulation_fixture_hash(&whole);
    assert_int_equal(simulation_state_save(&whole.simulation, &saved, &error), RESULT_OK);
    if (simulation_state_restore(&resumed.simulation, &saved, &error) != RESULT_OK)
        fail_msg("%s", error.text);
    for (int frame = 540; frame <= 570; frame += 10) {
        simulation_fixture_go(&whole, frame);
        simulation_fixture_go(&resumed, frame);
        assert_true(simulation_fixture_hash(&whole) == simulation_fixture_hash(&resumed));
    }
    assert_false(whole.simulation.sections[0].sleep.asleep);
    assert_true(simulation_fixture_hash(&whole) != asleep);
    bytes_destroy(&saved);
    simulation_fixture_destroy(&whole);
    simulation_fixture_destroy(&resumed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constants_as_formulas_change_nothing),
        cmocka_unit_test(style_that_fades_lets_hair_fall),
        cmocka_unit_test(changes_wake_hair_and_resume),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
