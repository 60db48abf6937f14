// SPDX-License-Identifier: MIT
// A simulation that was saved and restored equals an uninterrupted one to the bit.
#include "sim/simulation_state.h"
#include "support/simulation_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { LAST = 8 };

// `rate`: --sim-rate, 0: the frames' 60 Hz.
static void start(SimulationFixture *fixture, const char *algo, const char *variant, float rate)
{
    simulation_fixture_create(fixture, algo, variant);
    fixture->scene.run.sim_rate = rate;
    fixture->scene.run.preroll = 0.1f;
    simulation_fixture_start(fixture);
}

static void save(SimulationFixture *fixture, Bytes *saved)
{
    Error error;
    if (simulation_state_save(&fixture->simulation, saved, &error) != RESULT_OK)
        fail_msg("%s", error.text);
}

// Saves at frame `at`, which the other run draws too, then continues to the end.
static void check_at(const char *algo, const char *variant, float rate, int at)
{
    SimulationFixture whole, broken, resumed;
    Bytes saved;
    Error error;
    start(&whole, algo, variant, rate);
    start(&broken, algo, variant, rate);
    start(&resumed, algo, variant, rate);
    simulation_fixture_go(&broken, at);
    save(&broken, &saved);
    simulation_fixture_go(&resumed, at / 2); // existing state must be overwritten
    if (simulation_state_restore(&resumed.simulation, &saved, &error) != RESULT_OK)
        fail_msg("%s %s: %s", algo, variant, error.text);
    for (int frame = at; frame <= LAST; ++frame) {
        simulation_fixture_go(&whole, frame);
        simulation_fixture_go(&resumed, frame);
        if (simulation_fixture_hash(&whole) != simulation_fixture_hash(&resumed))
            fail_msg("%s %s at %g Hz: saved at frame %d, frame %d differs", algo, variant,
                     (double)rate, at, frame);
        // Saving must not affect the run.
        simulation_fixture_go(&broken, frame);
        assert_true(simulation_fixture_hash(&whole) == simulation_fixture_hash(&broken));
    }
    bytes_destroy(&saved);
    simulation_fixture_destroy(&whole);
    simulation_fixture_destroy(&broken);
    simulation_fixture_destroy(&resumed);
}

static void check_solver(const char *algo, const char *variant)
{
    check_at(algo, variant, 0, 3);
    check_at(algo, variant, 25, 4); // 60 fps at 25 Hz: frames 3 and 4 lie between the same steps
}

static void every_solver_goes_on_as_if_it_had_not_stopped(void **state)
{
    (void)state;
    simulation_fixture_each(check_solver);
}

static void saved_with_one_thing_and_read_with_another_is_refused(void **state)
{
    (void)state;
    SimulationFixture chain, split;
    Bytes saved;
    Error error;
    start(&chain, "chain", "", 0);
    start(&split, "split", "", 0);
    save(&chain, &saved);
    assert_int_equal(simulation_state_restore(&split.simulation, &saved, &error), RESULT_BAD_INPUT);
    for (size_t size = 0; size < saved.size; size += 1 + saved.size / 200) {
        // memory of its own, so that the sanitizer sees reads past the end
        Bytes cut = {.data = malloc(size + 1), .size = size};
        memcpy(cut.data, saved.data, size);
        assert_int_equal(simulation_state_restore(&chain.simulation, &cut, &error),
                         RESULT_BAD_INPUT);
        bytes_destroy(&cut);
    }
    assert_int_equal(simulation_state_restore(&chain.simulation, &saved, &error), RESULT_OK);
    bytes_destroy(&saved);
    simulation_fixture_destroy(&chain);
    simulation_fixture_destroy(&split);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_solver_goes_on_as_if_it_had_not_stopped),
        cmocka_unit_test(saved_with_one_thing_and_read_with_another_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
