// SPDX-License-Identifier: MIT
// Hair files of frames: what is drawn, bit for bit, in the order of the file that was read.
#include "export.h"
#include "simulation_fixture.h"
#include "strands_read.h"
#include "temporary.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// Strand `s` of the file, as it is drawn.
static void read_drawn(const SimulationFixture *fixture, uint32_t s, float (*positions)[3])
{
    const Hair *hair = &fixture->simulation.sections[0].hair;
    float(*all)[3] = malloc(hair->particle_count * sizeof *all), (*at)[3] = all;
    assert_int_equal(hair_read_positions(hair, all, NULL), RESULT_OK);
    for (uint32_t i = 0; i < hair->batch_count; ++i) {
        const HairBatch *batch = &hair->batches[i];
        for (uint32_t k = 0; k < batch->strand_count; ++k, at += batch->vertex_count)
            if (batch->strand[k] == s)
                memcpy(positions, at, batch->vertex_count * sizeof *positions);
    }
    free(all);
}

static void check(void **state, const char *pattern, const char *name, StrandsKind kind)
{
    SimulationFixture fixture;
    Exporter exporter;
    Strands read;
    StrandsReport report;
    Error error;
    simulation_fixture_create(&fixture, "chain", "");
    simulation_fixture_start(&fixture);
    simulation_fixture_go(&fixture, 4);
    char path[300];
    snprintf(path, sizeof path, "%s", temporary_path(state, pattern));
    if (exporter_create(&exporter, path, 9, &fixture.simulation, &fixture.strands, &error) !=
            RESULT_OK ||
        exporter_write(&exporter, 4, &error) != RESULT_OK)
        fail_msg("%s", error.text);
    assert_int_equal(strands_read(&read, temporary_path(state, name),
                                  &(StrandsReadOptions){.unit = 1, .strict = true}, &report,
                                  &error),
                     RESULT_OK);
    assert_int_equal(report.kind, kind);
    assert_int_equal(read.strand_count, fixture.strands.strand_count);
    for (uint32_t s = 0; s < read.strand_count; ++s) {
        float drawn[16][3];
        uint32_t n = strands_size(&read, s);
        assert_int_equal(n, strands_size(&fixture.strands, s));
        read_drawn(&fixture, s, drawn);
        assert_memory_equal(drawn, read.position[read.first[s]], n * sizeof *drawn);
    }
    strands_destroy(&read);
    exporter_destroy(&exporter);
    simulation_fixture_destroy(&fixture);
}

static void files_hold_what_is_drawn_bit_for_bit(void **state)
{
    check(state, "x_%02d.tfx", "x_04.tfx", STRANDS_TFX2_TEXT); // 8 and 12 vertices
    check(state, "x_%d.hair", "x_4.hair", STRANDS_HAIR);
}

static void names_without_a_number_or_a_kind_are_refused(void **state)
{
    SimulationFixture fixture;
    Exporter exporter;
    Error error;
    simulation_fixture_create(&fixture, "none", "");
    simulation_fixture_start(&fixture);
    const char *const names[] = {"x.tfx", "x_%d.obj", "x_%s.tfx", "%d/x.tfx", ""};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i)
        assert_int_equal(exporter_create(&exporter, temporary_path(state, names[i]), 2,
                                         &fixture.simulation, &fixture.strands, &error),
                         RESULT_USAGE);
    simulation_fixture_destroy(&fixture);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(files_hold_what_is_drawn_bit_for_bit),
        TEST(names_without_a_number_or_a_kind_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
