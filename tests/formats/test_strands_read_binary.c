// SPDX-License-Identifier: MIT
// Binary hair files: complete, truncated and damaged.
#include "formats/format.h"
#include "support/reading.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// Three strands of four vertices with all attributes.
static Strands make_sample(void)
{
    Strands strands;
    assert_int_equal(strands_create(&strands, 3, 12, NULL), RESULT_OK);
    strands.mobility = malloc(12 * sizeof *strands.mobility);
    strands.strand_uv = malloc(3 * sizeof *strands.strand_uv);
    strands.vertex_uv = malloc(12 * sizeof *strands.vertex_uv);
    strands.strand_thickness = malloc(3 * sizeof *strands.strand_thickness);
    strands.vertex_thickness = malloc(12 * sizeof *strands.vertex_thickness);
    strands.color = malloc(12 * sizeof *strands.color);
    for (uint32_t s = 0; s < 3; s++) {
        strands.first[s + 1] = 4 * (s + 1);
        strands.strand_uv[s][0] = 0.1f * (float)s;
        strands.strand_uv[s][1] = 0.7f;
        strands.strand_thickness[s] = 1.0f + (float)s;
    }
    for (uint32_t v = 0; v < 12; v++) {
        strands.mobility[v] = v % 4 ? 1.0f : 0.0f;
        for (int i = 0; i < 3; i++) strands.position[v][i] = 0.1f * (float)v + 0.01f * (float)i;
        for (int i = 0; i < 4; i++) strands.color[v][i] = 0.5f + 0.01f * (float)(v + (unsigned)i);
        strands.vertex_uv[v][0] = strands.vertex_uv[v][1] = 0.05f * (float)v;
        strands.vertex_thickness[v] = 1e-4f * (float)(v + 1);
    }
    return strands;
}

static Bytes make_file(void **state, FormatKind kind)
{
    Strands strands = make_sample();
    Bytes bytes = {0};
    const char *path = temporary_path(state, "sample");
    assert_int_equal(format_write(path, kind, &strands, NULL), RESULT_OK);
    assert_int_equal(bytes_read_file(&bytes, path, NULL), RESULT_OK);
    strands_destroy(&strands);
    return bytes;
}

static void check_truncations(const uint8_t *data, size_t size)
{
    Strands strands;
    StrandsReport report;
    Error error = {""};
    assert_int_equal(reading_copy(&strands, data, size, &METRES, &report, &error), RESULT_OK);
    assert_true(strands_report_is_clean(&report));
    strands_destroy(&strands);
    int refused = 0;
    for (size_t length = 0; length < size; length++) {
        error.text[0] = 0;
        Result result = reading_copy(&strands, data, length, &METRES, &report, &error);
        assert_true(result == RESULT_OK || result == RESULT_BAD_INPUT);
        if (result == RESULT_BAD_INPUT) {
            refused++;
            assert_true(error.text[0] != 0);
            assert_null(strchr(error.text, '\n'));
        }
        strands_destroy(&strands);
    }
    // Only the last few digits of a text may be missing unnoticed.
    assert_true(refused >= (int)size - 12);
}

static void every_truncation_is_read_or_refused(void **state)
{
    static const FormatKind kinds[] = {FORMAT_TFX2, FORMAT_TFX3,     FORMAT_TFX4, FORMAT_HAIR,
                                       FORMAT_PLY,  FORMAT_PLY_TEXT, FORMAT_NPY,  FORMAT_NPZ};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        Bytes bytes = make_file(state, kinds[i]);
        check_truncations(bytes.data, bytes.size);
        bytes_destroy(&bytes);
    }
    float salon[2 * 15 + 2 + 1] = {0};
    uint32_t counts[2] = {2, 2};
    memcpy(salon, counts, 8);
    for (int v = 0; v < 2; v++)
        for (int i = 0; i < 3; i++) salon[2 + 3 * v + i] = (float)(v + i);
    memcpy(salon + 8, counts, 4);
    for (int v = 0; v < 2; v++)
        for (int i = 0; i < 3; i++) salon[9 + 3 * v + i] = (float)(v + i);
    check_truncations((const uint8_t *)salon, 4 * 15);
}

// Sets every byte of a header to every value, and every 32-bit word to large values: the reader
// must not crash or use more memory than the file's size justifies.
static void any_damage_to_a_header_is_survived(void **state)
{
    static const struct {
        FormatKind kind;
        size_t header;
    } cases[] = {{FORMAT_TFX3, 296}, {FORMAT_TFX4, 160}, {FORMAT_HAIR, 136},
                 {FORMAT_PLY, 360},  {FORMAT_NPY, 128},  {FORMAT_NPZ, 176}};
    static const uint32_t words[] = {0,          1,          3,   0x7fffffff, 0x80000000,
                                     0xffffffff, 0xfffffffe, 161, 500};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Bytes bytes = make_file(state, cases[i].kind);
        for (size_t at = 0; at + 4 <= cases[i].header; at++) {
            for (size_t w = 0; w < sizeof words / sizeof *words; w++) {
                uint8_t before[4];
                memcpy(before, bytes.data + at, 4);
                memcpy(bytes.data + at, &words[w], 4);
                Strands strands;
                Result result = reading_copy(&strands, bytes.data, bytes.size, &METRES, NULL, NULL);
                assert_true(result == RESULT_OK || result == RESULT_BAD_INPUT);
                strands_destroy(&strands);
                memcpy(bytes.data + at, before, 4);
            }
        }
        bytes_destroy(&bytes);
    }
}

static void malformed_binaries_are_refused_with_their_byte(void **state)
{
    static const struct {
        FormatKind kind;
        size_t at;
        uint32_t value;
        const char *message;
    } cases[] = {
        {FORMAT_TFX4, 4, 0, "FILE: byte 4: 0 strands: expected at least 1"},
        {FORMAT_TFX4, 8, 0, "FILE: byte 8: 0 vertices per strand: expected at least 2"},
        {FORMAT_TFX4, 4, 0xffffffff,
         "FILE: byte 12: positions need 17179869180 times 16 bytes from byte 160 on, but the file "
         "has only 516 there"},
        {FORMAT_TFX4, 12, 0, "FILE: byte 12: the file has no positions"},
        {FORMAT_TFX4, 12, 4000,
         "FILE: byte 12: positions start at byte 4000, but the file ends at byte 676"},
        {FORMAT_TFX4, 16, 12,
         "FILE: byte 16: strand UVs start at byte 12, within the header of 160 bytes"},
        {FORMAT_TFX4, 28, 600,
         "FILE: byte 28: colours need 12 times 16 bytes from byte 600 on, but the file has only 76 "
         "there"},
        {FORMAT_TFX3, 148, 295,
         "FILE: byte 148: thicknesses start at byte 295, within the header of 296 bytes"},
        {FORMAT_TFX4, 16, 159,
         "FILE: byte 16: strand UVs start at byte 159, within the header of 160 bytes"},
        {FORMAT_TFX3, 144, 100,
         "FILE: byte 144: positions start at byte 100, within the header of 296 bytes"},
        {FORMAT_HAIR, 4, 0, "FILE: byte 4: 0 strands: expected at least 1"},
        {FORMAT_HAIR, 12, 1, "FILE: byte 12: the file has no points"},
        {FORMAT_HAIR, 8, 1000000,
         "FILE: byte 128: points need 1000000 times 12 bytes from byte 128 on, but the file has "
         "only 384 there"},
        {FORMAT_HAIR, 16, 2,
         "FILE: byte 16: 3 strands of 2 segments each have 9 points, the header says 12"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Bytes bytes = make_file(state, cases[i].kind);
        memcpy(bytes.data + cases[i].at, &cases[i].value, 4);
        Strands strands;
        Error error = {""};
        assert_int_equal(reading_copy(&strands, bytes.data, bytes.size, &METRES, NULL, &error),
                         RESULT_BAD_INPUT);
        assert_string_equal(error.text, cases[i].message);
        bytes_destroy(&bytes);
    }
}

// bothEndsImmovable is one byte; the three bytes behind it may have any value.
static void padding_behind_a_bool_does_not_count(void **state)
{
    for (int at = 16; at < 20; ++at) {
        Bytes bytes = make_file(state, FORMAT_TFX3);
        Strands strands;
        memset(bytes.data + 16, 0, 4);
        bytes.data[at] = 1;
        assert_int_equal(reading_copy(&strands, bytes.data, bytes.size, &METRES, NULL, NULL),
                         RESULT_OK);
        assert_int_equal(strands.both_ends_fixed, at == 16);
        strands_destroy(&strands);
        bytes_destroy(&bytes);
    }
}

// Each vertex keeps its colour and opacity.
static void hair_files_keep_every_colour(void **state)
{
    Bytes bytes = make_file(state, FORMAT_HAIR);
    Strands strands, made = make_sample();
    assert_int_equal(reading_copy(&strands, bytes.data, bytes.size, &METRES, NULL, NULL),
                     RESULT_OK);
    for (uint32_t v = 0; v < made.vertex_count; ++v)
        for (int i = 0; i < 4; ++i)
            assert_true(fabsf(strands.color[v][i] - made.color[v][i]) < 1e-6f);
    strands_destroy(&strands);
    strands_destroy(&made);
    bytes_destroy(&bytes);
}

// A negative unit is ignored.
static void a_unit_without_length_is_ignored(void **state)
{
    Bytes bytes = make_file(state, FORMAT_HAIR);
    char *unit = strstr((char *)bytes.data + 40, "unit 1 m");
    assert_non_null(unit);
    unit[4] = '-'; // "unit-1 m", which is parsed as -1
    Strands strands;
    StrandsReport report;
    assert_int_equal(
        reading_copy(&strands, bytes.data, bytes.size, &(StrandsReadOptions){0}, &report, NULL),
        RESULT_OK);
    assert_int_equal(strands.strand_count, 3);
    assert_true(report.unit_used > 0);
    strands_destroy(&strands);
    bytes_destroy(&bytes);
}

static void bytes_behind_the_arrays_are_reported(void **state)
{
    Bytes bytes = make_file(state, FORMAT_TFX4);
    bytes.data = realloc(bytes.data, bytes.size + 8);
    memset(bytes.data + bytes.size, 1, 8);
    Strands strands;
    StrandsReport report;
    assert_int_equal(reading_copy(&strands, bytes.data, bytes.size + 7, &METRES, &report, NULL),
                     RESULT_OK);
    assert_int_equal(report.defects[DEFECT_UNREAD].count, 7);
    assert_int_equal(report.defects[DEFECT_UNREAD].first_place, bytes.size);
    strands_destroy(&strands);
    bytes_destroy(&bytes);
}

static void merged_vertices_take_their_attributes_along(void **state)
{
    Bytes bytes = make_file(state, FORMAT_TFX4);
    memcpy(bytes.data + 160 + 16 * 5, bytes.data + 160 + 16 * 4, 12); // strand 1: 1 onto 0
    Strands strands, whole = make_sample();
    StrandsReport report;
    assert_int_equal(reading_copy(&strands, bytes.data, bytes.size, &METRES, &report, NULL),
                     RESULT_OK);
    assert_int_equal(strands_size(&strands, 1), 3);
    assert_int_equal(report.defects[DEFECT_COINCIDENT].first_place, 160 + 16 * 5);
    assert_memory_equal(strands.color[5], whole.color[6], 16);
    assert_memory_equal(strands.vertex_uv[11 - 1], whole.vertex_uv[11], 8);
    assert_true(strands.mobility[4] == 0.0f && strands.mobility[5] == 1.0f);
    strands_destroy(&strands);
    strands_destroy(&whole);
    bytes_destroy(&bytes);
}

static void empty_roots_of_salon_files_are_left_out_and_counted(void **state)
{
    (void)state;
    struct {
        uint32_t strands, size0;
        float root[3];
        uint32_t size1;
        float position[2][3];
    } data = {2, 1, {1, 2, 3}, 2, {{0, 0, 0}, {0, 1, 0}}};
    Strands strands;
    StrandsReport report;
    assert_int_equal(reading_copy(&strands, &data, sizeof data, &METRES, &report, NULL), RESULT_OK);
    assert_int_equal(report.kind, FORMAT_SALON_DATA);
    assert_int_equal(strands.strand_count, 1);
    assert_int_equal(report.empty_roots, 1);
    assert_true(strands_report_is_clean(&report));
    strands_destroy(&strands);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_truncation_is_read_or_refused, temporary_create,
                                        temporary_destroy),
        cmocka_unit_test_setup_teardown(any_damage_to_a_header_is_survived, temporary_create,
                                        temporary_destroy),
        cmocka_unit_test_setup_teardown(malformed_binaries_are_refused_with_their_byte,
                                        temporary_create, temporary_destroy),
        cmocka_unit_test_setup_teardown(padding_behind_a_bool_does_not_count, temporary_create,
                                        temporary_destroy),
        cmocka_unit_test_setup_teardown(hair_files_keep_every_colour, temporary_create,
                                        temporary_destroy),
        cmocka_unit_test_setup_teardown(a_unit_without_length_is_ignored, temporary_create,
                                        temporary_destroy),
        cmocka_unit_test_setup_teardown(bytes_behind_the_arrays_are_reported, temporary_create,
                                        temporary_destroy),
        cmocka_unit_test_setup_teardown(merged_vertices_take_their_attributes_along,
                                        temporary_create, temporary_destroy),
        cmocka_unit_test(empty_roots_of_salon_files_are_left_out_and_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
