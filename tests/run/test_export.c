// SPDX-License-Identifier: MIT
// Exported hair files: the drawn positions, bit for bit, in the order of the input.
#include "formats/strands_read.h"
#include "run/export.h"
#include "support/simulation_fixture.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// Strand `s` of the file as it is drawn.
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

static void check(void **state, const char *pattern, const char *name, FormatKind kind)
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
    check(state, "x_%02d.tfx", "x_04.tfx", FORMAT_TFX2); // 8 and 12 vertices
    check(state, "x_%d.hair", "x_4.hair", FORMAT_HAIR);
    check(state, "x_%d.obj", "x_4.obj", FORMAT_OBJ);
    check(state, "x_%d.data", "x_4.data", FORMAT_SALON_DATA);
}

// Parses the next list after `key`, which has `count` numbers.
static void parse_list(const char *text, const char *key, float *numbers, size_t count)
{
    const char *at = strstr(text, key);
    if (!at) fail_msg("no '%s'", key);
    at += strlen(key);
    for (size_t i = 0; i < count; ++i) {
        char *end;
        at += strcspn(at, "-0123456789");
        numbers[i] = strtof(at, &end);
        assert_ptr_not_equal(end, at);
        at = end;
    }
    assert_true(*at == ')' || *at == ']');
}

static void usd_holds_all_frames_of_all_sections(void **state)
{
    SimulationFixture fixture;
    Exporter exporter;
    Error error;
    simulation_fixture_create(&fixture, "chain", "");
    simulation_fixture_start(&fixture);
    char path[300];
    snprintf(path, sizeof path, "%s", temporary_path(state, "x.usda"));
    if (exporter_create(&exporter, path, 3, &fixture.simulation, &fixture.strands, &error) !=
        RESULT_OK)
        fail_msg("%s", error.text);
    assert_int_equal(exporter.lost, 0);
    size_t count = 3 * (size_t)fixture.strands.vertex_count;
    float *drawn = malloc(2 * count * sizeof *drawn), *read = drawn + count;
    for (int frame = 0; frame < 3; ++frame) {
        if (frame) simulation_fixture_go(&fixture, frame);
        assert_int_equal(exporter_write(&exporter, frame, &error), RESULT_OK);
        if (frame == 1) memcpy(drawn, exporter.strands.position, count * sizeof *drawn);
    }
    assert_false(temporary_has(state, "x.usda"));
    assert_int_equal(exporter_finish(&exporter, &error), RESULT_OK);
    exporter_destroy(&exporter);
    Bytes bytes;
    assert_int_equal(bytes_read_file(&bytes, path, &error), RESULT_OK);
    const char *text = (const char *)bytes.data;
    parse_list(text, "\n        1: ", read, count);
    assert_memory_equal(read, drawn, count * sizeof *drawn);
    assert_non_null(strstr(text, "startTimeCode = 0\n    endTimeCode = 2\n"));
    assert_non_null(strstr(text, "color3f[] primvars:displayColor = [("));
    assert_non_null(strstr(text, "float[] widths = ["));
    bytes_destroy(&bytes);
    free(drawn);
    simulation_fixture_destroy(&fixture);
}

// Followers come after the guides, each with a root within the radius of its guide's root.
static void followers_come_with_them_if_asked_for(void **state)
{
    SimulationFixture fixture;
    Exporter exporter;
    Error error;
    simulation_fixture_create(&fixture, "chain", "");
    SectionParams *params = &fixture.scene.sections[0].params;
    params->followers = (AutoInt){.value = 3};
    params->follower_radius.automatic = false;
    params->follower_radius.value = 0.01f;
    fixture.scene.run.export_followers = true;
    simulation_fixture_start(&fixture);
    simulation_fixture_go(&fixture, 2);
    if (exporter_create(&exporter, temporary_path(state, "x_%d.hair"), 1, &fixture.simulation,
                        &fixture.strands, &error) != RESULT_OK ||
        exporter_write(&exporter, 2, &error) != RESULT_OK)
        fail_msg("%s", error.text);
    const Strands *all = &exporter.strands;
    const Hair *followers = &fixture.simulation.sections[0].follow.hair;
    uint32_t guides = fixture.strands.strand_count, at = guides;
    assert_int_equal(all->strand_count, 4 * guides);
    float(*drawn)[3] = malloc(followers->particle_count * sizeof *drawn), (*p)[3] = drawn;
    assert_int_equal(hair_read_positions(followers, drawn, NULL), RESULT_OK);
    for (uint32_t i = 0; i < followers->batch_count; ++i)
        for (uint32_t s = 0; s < followers->batches[i].strand_count; ++s, ++at) {
            uint32_t guide = followers->batches[i].strand[s], n = strands_size(all, at);
            const float *root = all->position[all->first[guide]];
            assert_int_equal(n, strands_size(all, guide));
            assert_memory_equal(all->position[all->first[at]], p, n * sizeof *p);
            double square = 0;
            for (int k = 0; k < 3; ++k) square += pow((double)(*p)[k] - (double)root[k], 2);
            assert_true(square > 0 && sqrt(square) < 0.01 + 1e-6);
            p += n;
        }
    assert_int_equal(at, all->strand_count);
    free(drawn);
    exporter_destroy(&exporter);
    simulation_fixture_destroy(&fixture);
}

static void names_without_a_number_or_a_kind_are_refused(void **state)
{
    SimulationFixture fixture;
    Exporter exporter;
    Error error;
    simulation_fixture_create(&fixture, "none", "");
    simulation_fixture_start(&fixture);
    const char *const names[] = {"x.tfx", "x.obj", "x_%d.png", "x_%s.tfx", "%d/x.tfx", ""};
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
        TEST(usd_holds_all_frames_of_all_sections),
        TEST(followers_come_with_them_if_asked_for),
        TEST(names_without_a_number_or_a_kind_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
