// SPDX-License-Identifier: MIT
#include "strands_read.h"
#include "strands_write.h"
#include "temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

// Content is copied to a block of its exact size (and the zero), so that a sanitizer sees every
// read beyond it.
static Result read_copy(Strands *strands, const void *data, size_t size,
                        const StrandsReadOptions *options, StrandsReport *report, Error *error)
{
    Bytes bytes = {malloc(size + 1), size};
    assert_non_null(bytes.data);
    memcpy(bytes.data, data, size);
    bytes.data[size] = 0;
    Result result = strands_read_bytes(strands, "FILE", &bytes, options, report, error);
    bytes_destroy(&bytes);
    return result;
}

static Result read_text(Strands *strands, const char *text, const StrandsReadOptions *options,
                        StrandsReport *report, Error *error)
{
    return read_copy(strands, text, strlen(text), options, report, error);
}

static const StrandsReadOptions METRES = {.unit = 1.0f};

// Reads text that must be good, in metres.
static Strands read_good(const char *text, StrandsReport *report)
{
    Strands strands;
    Error error = {""};
    if (read_text(&strands, text, &METRES, report, &error) != RESULT_OK) fail_msg("%s", error.text);
    return strands;
}

#define STRAND "strand 0 numVerts 2 texcoord 0.5 0.25\n1 2 3\n1 3 3\n"

// --- Text.

static void both_dialects_and_line_ends_are_read(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "numStrands 1\nis sorted 1\n" STRAND,
        "numStrands 1 is sorted 1\n" STRAND,
        "numStrands 1\r\nis sorted 1\r\nstrand 0 numVerts 2 texcoord 0.5 0.25\r\n1 2 3\r\n1 3 "
        "3\r\n",
        "  numStrands\t1\n\nis  sorted 1\n\nstrand 7 numVerts 2\ttexcoord .5 25e-2\n"
        " 1.0 +2 3.\n\n1 3 0.3e1",
        "version 2.0\nscale 1.0\nrotation 0 0 0\ntranslation 0 0 0\nbothEndsImmovable 0\n"
        "maxNumVerticesInStrand 16\nnumFollowHairsPerGuideHair 0\nmaxRadiusAroundGuideHair 0\n"
        "numStrands 1\nis sorted 1\n" STRAND,
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        StrandsReport report;
        Strands strands = read_good(texts[i], &report);
        assert_int_equal(report.kind, STRANDS_TFX2_TEXT);
        assert_int_equal(strands.vertex_count, 2);
        assert_memory_equal(strands.position[1], ((float[3]){1, 3, 3}), 12);
        assert_memory_equal(strands.strand_uv[0], ((float[2]){0.5f, 0.25f}), 8);
        assert_true(strands_report_is_clean(&report));
        strands_destroy(&strands);
    }
}

static void parameters_mean_what_they_say(void **state)
{
    (void)state;
    StrandsReport report;
    Strands strands = read_good("version 2.0\nscale 2\nrotation 0 90 0\ntranslation 10 0 0\n"
                                "bothEndsImmovable 1\nnumFollowHairsPerGuideHair 4\n"
                                "maxRadiusAroundGuideHair 0.5\nnumStrands 1\nis sorted 1\n" STRAND,
                                &report);
    // (1, 2, 3) twice as large is (2, 4, 6); a quarter turn about y makes (6, 4, -2) of it.
    assert_true(fabsf(strands.position[0][0] - 16.0f) < 1e-5f);
    assert_true(fabsf(strands.position[0][1] - 4.0f) < 1e-5f);
    assert_true(fabsf(strands.position[0][2] + 2.0f) < 1e-5f);
    assert_true(report.rotation_was_deg);
    assert_true(strands.both_ends_fixed);
    assert_int_equal(strands.followers, 4);
    assert_true(strands.follower_radius == 1.0f);
    strands_destroy(&strands);
}

static void numbers_are_rounded_as_strtof_does(void **state)
{
    (void)state;
    // The middle ones lie half way between floats, or so near that a double cannot tell.
    static const char *const numbers[] = {"0.1",
                                          "-0",
                                          "1e-45",
                                          "1.17549435e-38",
                                          "16777217",
                                          "16777217.0000000000000001",
                                          "1.00000017881393432617187499",
                                          "1.00000017881393432617187501",
                                          "0.000000000000000000001",
                                          "123456789012345678901234",
                                          "3.4028234e5",
                                          "-4.80447",
                                          "00012.5000",
                                          "9007199254740993e-9"};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        char text[200];
        snprintf(text, sizeof text,
                 "numStrands 1\nis sorted 1\nstrand 0 numVerts 2 texcoord %s 0\n0 0 0\n0 1 0\n",
                 numbers[i]);
        Strands strands = read_good(text, NULL);
        float expected = strtof(numbers[i], NULL);
        assert_memory_equal(&strands.strand_uv[0][0], &expected, 4);
        strands_destroy(&strands);
    }
}

static void malformed_text_is_refused_with_its_line(void **state)
{
    (void)state;
    static const struct {
        const char *text, *message;
    } cases[] = {
        {"", "FILE: byte 0: the file is empty"},
        {"hello\n", "FILE: byte 0: not hair: neither TressFX 2, 3 or 4, HAIR or Wavefront lines, "
                    "nor whole strands of "
                    "USC-HairSalon or CT2Hair"},
        {"numStrands", "FILE:1: expected the number of strands, got the end of the file"},
        {"numStrands x\n", "FILE:1: expected the number of strands, got 'x'"},
        {"numStrands -1\n", "FILE:1: expected the number of strands, got '-1'"},
        {"numStrands 99999999999\n", "FILE:1: expected the number of strands, got '99999999999'"},
        {"numStrands 0\nis sorted 1\n", "FILE:1: numStrands 0: expected at least 1"},
        {"numStrands 4294967295\nis sorted 1\n" STRAND,
         "FILE:1: numStrands 4294967295: the file has room for at most 3"},
        {"numStrands 1\n" STRAND, "FILE:2: expected 'is sorted', got 'strand'"},
        {"numStrands 1\nis sorted 2\n" STRAND, "FILE:2: expected 0 or 1 for is sorted, got '2'"},
        {"numStrands 1\nis sorted 1 1\n" STRAND, "FILE:2: expected the end of the line, got '1'"},
        {"numStrands 1\nis sorted 1\nhair 0 numVerts 2\n", "FILE:3: expected strand, got 'hair'"},
        {"numStrands 1\nis sorted 1\nstrand 0 numVerts 4294967295\n0 0 0\n",
         "FILE:3: numVerts 4294967295: the file has room for at most 1"},
        {"numStrands 1\nis sorted 1\nstrand 0 numVerts 2\n0 0 0\n0 y 0\n",
         "FILE:5: expected a vertex's y, got 'y'"},
        {"numStrands 1\nis sorted 1\nstrand 0 numVerts 2\n0 0\n0 1 0\n",
         "FILE:4: expected a vertex's z, got the end of the line"},
        {"numStrands 1\nis sorted 1\nstrand 0 numVerts 2\n0 0 0x1\n0 1 0\n",
         "FILE:4: expected a vertex's z, got '0x1'"},
        {"numStrands 1\nis sorted 1\nstrand 0 numVerts 2\n0 0 0\n0 1 0 7\n",
         "FILE:5: expected the end of the line, got '7'"},
        {"numStrands 1\nis sorted 1\nstrand 0 numVerts 2\n0 0 0\n            \n",
         "FILE:6: expected a vertex's x, got the end of the file"},
        {"numStrands 2\nis sorted 1\n" STRAND, "FILE:6: the file ends after 1 of 2 strands"},
        {"numStrands 1\nis sorted 1\n" STRAND STRAND,
         "FILE:6: expected the end of the file behind the last strand, got 'strand'"},
        {"version 2.0\nscale 0\n", "FILE:2: scale 0 leaves no hair"},
        {"version 2.0\ncolour 1\n", "FILE:2: expected is, got 'colour'"},
        {"scale 1.#INF\n", "FILE:1: expected the scale, got '1.#INF'"},
        {"numStrands 1\nis sorted 1\nstrand 0 numVerts 2\n0 0 0\n0 0 0\n",
         "FILE:3: 1 strand of fewer than two distinct vertices (no usable strand among 1)"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Strands strands;
        StrandsReport report;
        Error error = {""};
        assert_int_equal(read_text(&strands, cases[i].text, &METRES, &report, &error),
                         RESULT_BAD_INPUT);
        assert_string_equal(error.text, cases[i].message);
        assert_null(strands.position);
    }
}

static const char DIRTY[] = "numStrands 5\n"
                            "is sorted 1\n"
                            "strand 0 numVerts 3 texcoord 0 0\n" // merged: line 5
                            "0 0 0\n0 0 0\n0 1 0\n"
                            "strand 1 numVerts 2 texcoord 0.1 0\n" // dropped: line 9
                            "0 0 0\n-1.#INF 1.#QNAN -1.#IND00\n"
                            "strand 2 numVerts 1 texcoord 0.2 0\n" // too short: line 10
                            "0 0 0\n"
                            "strand 3 numVerts 2 texcoord 0.3 0\n" // too short
                            "1 1 1\n1 1 1\n"
                            "strand 4 numVerts 4 texcoord 0.4 1.#INF\n" // attribute: line 15
                            "0 0 0\n0 1 0\n0 2 0\n0 2 0\n";

static void dirty_strands_are_mended_and_counted(void **state)
{
    (void)state;
    StrandsReport report;
    Strands strands = read_good(DIRTY, &report);
    assert_int_equal(strands.strand_count, 2);
    assert_int_equal(strands_size(&strands, 0), 2);
    assert_int_equal(strands_size(&strands, 1), 3);
    assert_true(strands.strand_uv[1][0] == 0.4f && strands.strand_uv[1][1] == 0.0f);
    assert_int_equal(report.declared_strands, 5);
    static const Defect expected[DEFECT_KINDS] = {{1, 9}, {2, 10}, {2, 5}, {1, 15}, {0, 0}, {0, 0}};
    for (int kind = 0; kind < DEFECT_KINDS; kind++) {
        assert_int_equal(report.defects[kind].count, expected[kind].count);
        assert_int_equal(report.defects[kind].first_place, expected[kind].first_place);
    }
    assert_int_equal(report.shared_roots, 1);
    strands_destroy(&strands);
}

static void each_kind_of_mending_is_told_in_one_line(void **state)
{
    (void)state;
    StrandsReport report;
    Strands strands = read_good(DIRTY, &report);
    strands_destroy(&strands);
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    assert_int_equal(strands_report_print_mended(&report, "FILE", stream), 4);
    fclose(stream);
    assert_string_equal(
        text, "FILE:9: 1 strand with a coordinate that is not finite or beyond 1000 km: dropped\n"
              "FILE:10: first of 2 strands of fewer than two distinct vertices: dropped\n"
              "FILE:5: first of 2 vertices that coincide with the one before them: merged\n"
              "FILE:15: 1 attribute value that is not a finite number: replaced\n");
    free(text);
}

static void strict_refuses_what_would_be_mended(void **state)
{
    (void)state;
    StrandsReadOptions strict = {.unit = 1.0f, .strict = true};
    StrandsReport report;
    Strands strands;
    Error error = {""};
    assert_int_equal(read_text(&strands, DIRTY, &strict, &report, &error), RESULT_BAD_INPUT);
    assert_string_equal(error.text,
                        "FILE:9: 1 strand with a coordinate that is not finite or beyond 1000 km "
                        "(refused: --strict)");
    assert_false(strands_report_is_clean(&report));
    assert_int_equal(
        read_text(&strands, "numStrands 1\nis sorted 1\n" STRAND, &strict, &report, &error),
        RESULT_OK);
    strands_destroy(&strands);
}

static void strands_over_the_files_own_limit_stay_whole(void **state)
{
    (void)state;
    StrandsReport report;
    Strands strands =
        read_good("maxNumVerticesInStrand 1\nnumStrands 1\nis sorted 1\n" STRAND, &report);
    assert_int_equal(strands.vertex_count, 2);
    assert_int_equal(report.defects[DEFECT_OVER_LIMIT].count, 1);
    assert_int_equal(report.defects[DEFECT_OVER_LIMIT].first_place, 4);
    strands_destroy(&strands);
}

// Strand s of n, each told by its u and by its height.
static char *write_many(const char *sorted, int count)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    fprintf(stream, "numStrands %d\nis sorted %s\n", count, sorted);
    for (int s = 0; s < count; s++)
        fprintf(stream, "strand %d numVerts %d texcoord %d 0\n%d 0 0\n%d 1 0\n%s", s, 2 + s % 2, s,
                s, s, s % 2 ? "0 2 0\n" : "");
    fclose(stream);
    return text;
}

static void unsorted_strands_are_shuffled_whole_and_repeatably(void **state)
{
    (void)state;
    char *text = write_many("0", 100), *sorted_text = write_many("1", 100);
    StrandsReport report;
    Strands a = read_good(text, &report), b = read_good(text, NULL);
    Strands sorted = read_good(sorted_text, NULL);
    assert_true(report.shuffled);
    assert_memory_equal(a.position, b.position, 12 * a.vertex_count);
    int moved = 0;
    for (uint32_t s = 0; s < 100; s++) {
        uint32_t was = (uint32_t)a.strand_uv[s][0];
        moved += was != s;
        assert_true(a.position[a.first[s]][0] == (float)was);
        assert_int_equal(strands_size(&a, s), 2 + was % 2);
        assert_true(sorted.strand_uv[s][0] == (float)s);
    }
    assert_true(moved > 80);
    strands_destroy(&a);
    strands_destroy(&b);
    strands_destroy(&sorted);
    free(text);
    free(sorted_text);
}

// --- Units and axes.

static void units_are_guessed_by_size_and_said_to_be_guesses(void **state)
{
    (void)state;
    static const struct {
        float height, unit;
    } cases[] = {{0.87f, 1.0f}, {87.0f, 0.01f}, {870.0f, 0.001f}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct {
            uint32_t strands, size;
            float position[2][3];
        } data = {1, 2, {{0, 0, 0}, {0, cases[i].height, 0}}};
        Strands strands;
        StrandsReport report;
        assert_int_equal(read_copy(&strands, &data, sizeof data, NULL, &report, NULL), RESULT_OK);
        assert_true(report.unit_guessed);
        assert_true(report.unit_used == cases[i].unit);
        assert_true(fabs(report.length_max - 0.87) < 1e-6);
        strands_destroy(&strands);
    }
    // Small, but far from the origin: text in centimetres.
    Strands strands;
    StrandsReport report;
    const char *text =
        "numStrands 1\nis sorted 1\nstrand 0 numVerts 2\n-4.80447 103.333 25.4651\n-5 104 26\n";
    assert_int_equal(read_text(&strands, text, NULL, &report, NULL), RESULT_OK);
    assert_true(report.unit_used == 0.01f);
    assert_true(fabsf(strands.position[0][1] - 1.03333f) < 1e-6f);
    strands_destroy(&strands);
}

static void z_up_is_turned_to_y_up(void **state)
{
    (void)state;
    StrandsReadOptions options = {.unit = 1.0f, .up_z = true};
    Strands strands;
    const char *text = "numStrands 1\nis sorted 1\n" STRAND;
    assert_int_equal(read_text(&strands, text, &options, NULL, NULL), RESULT_OK);
    assert_memory_equal(strands.position[0], ((float[3]){1, 3, -2}), 12);
    strands_destroy(&strands);
}

// --- Binary.

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

static Bytes make_file(void **state, StrandsKind kind)
{
    Strands strands = make_sample();
    Bytes bytes = {0};
    const char *path = temporary_path(state, "sample");
    assert_int_equal(strands_write(path, kind, &strands, NULL), RESULT_OK);
    assert_int_equal(bytes_read_file(&bytes, path, NULL), RESULT_OK);
    strands_destroy(&strands);
    return bytes;
}

static void check_truncations(const uint8_t *data, size_t size)
{
    Strands strands;
    StrandsReport report;
    Error error = {""};
    assert_int_equal(read_copy(&strands, data, size, &METRES, &report, &error), RESULT_OK);
    assert_true(strands_report_is_clean(&report));
    strands_destroy(&strands);
    int refused = 0;
    for (size_t length = 0; length < size; length++) {
        error.text[0] = 0;
        Result result = read_copy(&strands, data, length, &METRES, &report, &error);
        assert_true(result == RESULT_OK || result == RESULT_BAD_INPUT);
        if (result == RESULT_BAD_INPUT) {
            refused++;
            assert_true(error.text[0] != 0);
            assert_null(strchr(error.text, '\n'));
        }
        strands_destroy(&strands);
    }
    // Only the last few digits of a text may be missed.
    assert_true(refused >= (int)size - 12);
}

static void every_truncation_is_read_or_refused(void **state)
{
    static const StrandsKind kinds[] = {STRANDS_TFX2_TEXT, STRANDS_TFX3, STRANDS_TFX4,
                                        STRANDS_HAIR};
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

// Every byte of a header set to every value, and every 32-bit word to large ones: nothing may crash
// or ask for more memory than the file's size warrants.
static void any_damage_to_a_header_is_survived(void **state)
{
    static const struct {
        StrandsKind kind;
        size_t header;
    } cases[] = {{STRANDS_TFX3, 296}, {STRANDS_TFX4, 160}, {STRANDS_HAIR, 136}};
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
                Result result = read_copy(&strands, bytes.data, bytes.size, &METRES, NULL, NULL);
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
        StrandsKind kind;
        size_t at;
        uint32_t value;
        const char *message;
    } cases[] = {
        {STRANDS_TFX4, 4, 0, "FILE: byte 4: 0 strands: expected at least 1"},
        {STRANDS_TFX4, 8, 0, "FILE: byte 8: 0 vertices per strand: expected at least 2"},
        {STRANDS_TFX4, 4, 0xffffffff,
         "FILE: byte 12: positions need 17179869180 times 16 bytes from byte 160 on, the file has "
         "516"},
        {STRANDS_TFX4, 12, 0, "FILE: byte 12: the file has no positions"},
        {STRANDS_TFX4, 12, 4000,
         "FILE: byte 12: positions start at byte 4000, the file ends at byte 676"},
        {STRANDS_TFX4, 16, 12,
         "FILE: byte 16: strand UVs start at byte 12, within the header of 160 bytes"},
        {STRANDS_TFX4, 28, 600,
         "FILE: byte 28: colours need 12 times 16 bytes from byte 600 on, the file has 76"},
        {STRANDS_TFX3, 144, 100,
         "FILE: byte 144: positions start at byte 100, within the header of 296 bytes"},
        {STRANDS_HAIR, 4, 0, "FILE: byte 4: 0 strands: expected at least 1"},
        {STRANDS_HAIR, 12, 1, "FILE: byte 12: the file has no points"},
        {STRANDS_HAIR, 8, 1000000,
         "FILE: byte 128: points need 1000000 times 12 bytes from byte 128 on, the file has 384"},
        {STRANDS_HAIR, 16, 2,
         "FILE: byte 16: 3 strands of 2 segments each have 9 points, the header says 12"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Bytes bytes = make_file(state, cases[i].kind);
        memcpy(bytes.data + cases[i].at, &cases[i].value, 4);
        Strands strands;
        Error error = {""};
        assert_int_equal(read_copy(&strands, bytes.data, bytes.size, &METRES, NULL, &error),
                         RESULT_BAD_INPUT);
        assert_string_equal(error.text, cases[i].message);
        bytes_destroy(&bytes);
    }
}

static void bytes_behind_the_arrays_are_told(void **state)
{
    Bytes bytes = make_file(state, STRANDS_TFX4);
    bytes.data = realloc(bytes.data, bytes.size + 8);
    memset(bytes.data + bytes.size, 1, 8);
    Strands strands;
    StrandsReport report;
    assert_int_equal(read_copy(&strands, bytes.data, bytes.size + 7, &METRES, &report, NULL),
                     RESULT_OK);
    assert_int_equal(report.defects[DEFECT_UNREAD].count, 7);
    assert_int_equal(report.defects[DEFECT_UNREAD].first_place, bytes.size);
    strands_destroy(&strands);
    bytes_destroy(&bytes);
}

static void merged_vertices_take_their_attributes_along(void **state)
{
    Bytes bytes = make_file(state, STRANDS_TFX4);
    memcpy(bytes.data + 160 + 16 * 5, bytes.data + 160 + 16 * 4, 12); // strand 1: 1 onto 0
    Strands strands, whole = make_sample();
    StrandsReport report;
    assert_int_equal(read_copy(&strands, bytes.data, bytes.size, &METRES, &report, NULL),
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
    assert_int_equal(read_copy(&strands, &data, sizeof data, &METRES, &report, NULL), RESULT_OK);
    assert_int_equal(report.kind, STRANDS_SALON_DATA);
    assert_int_equal(strands.strand_count, 1);
    assert_int_equal(report.empty_roots, 1);
    assert_true(strands_report_is_clean(&report));
    strands_destroy(&strands);
}

static void strands_beyond_the_longest_are_refused(void **state)
{
    (void)state;
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    fprintf(stream, "numStrands 1\nis sorted 1\nstrand 0 numVerts 65536\n");
    for (int v = 0; v < 65536; v++) fprintf(stream, "%d 0 0\n", v);
    fclose(stream);
    Strands strands;
    Error error;
    assert_int_equal(read_text(&strands, text, &METRES, NULL, &error), RESULT_BAD_INPUT);
    assert_string_equal(error.text, "FILE:3: strand 0 has 65536 vertices, at most 65535 work");
    free(text);
}

// --- Real files.

static void real_assets_are_read_whole(void **state)
{
    (void)state;
    static const struct {
        const char *path;
        StrandsKind kind;
        uint32_t strands, size;
        float unit;
    } files[] = {
        {"../shared/assets/ratboy_mohawk.tfx", STRANDS_TFX4, 2228, 32, 1.0f},
        {"../shared/assets/sintel_228x32.tfx", STRANDS_TFX4, 228, 32, 0.01f},
        {"../shared/assets/ponytail_tail.tfx", STRANDS_TFX3, 255, 16, 0.01f},
        {"../shared/assets/hair_front_16_guide.tfx", STRANDS_TFX2_TEXT, 93, 16, 0.01f},
        {"../shared/assets/ruby_short_16_guide.tfx", STRANDS_TFX2_TEXT, 1867, 16, 0.01f},
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        if (access(files[i].path, R_OK) != 0) {
            print_message("%s is not here: skipped\n", files[i].path);
            skip();
        }
        Strands strands;
        StrandsReport report;
        assert_int_equal(strands_read(&strands, files[i].path, NULL, &report, NULL), RESULT_OK);
        assert_int_equal(report.kind, files[i].kind);
        assert_int_equal(strands.strand_count, files[i].strands);
        assert_int_equal(report.size_min, files[i].size);
        assert_int_equal(report.size_max, files[i].size);
        assert_true(report.unit_used == files[i].unit);
        strands_destroy(&strands);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_dialects_and_line_ends_are_read),
        cmocka_unit_test(parameters_mean_what_they_say),
        cmocka_unit_test(numbers_are_rounded_as_strtof_does),
        cmocka_unit_test(malformed_text_is_refused_with_its_line),
        cmocka_unit_test(dirty_strands_are_mended_and_counted),
        cmocka_unit_test(each_kind_of_mending_is_told_in_one_line),
        cmocka_unit_test(strict_refuses_what_would_be_mended),
        cmocka_unit_test(strands_over_the_files_own_limit_stay_whole),
        cmocka_unit_test(unsorted_strands_are_shuffled_whole_and_repeatably),
        cmocka_unit_test(units_are_guessed_by_size_and_said_to_be_guesses),
        cmocka_unit_test(z_up_is_turned_to_y_up),
        cmocka_unit_test_setup_teardown(every_truncation_is_read_or_refused, temporary_create,
                                        temporary_destroy),
        cmocka_unit_test_setup_teardown(any_damage_to_a_header_is_survived, temporary_create,
                                        temporary_destroy),
        cmocka_unit_test_setup_teardown(malformed_binaries_are_refused_with_their_byte,
                                        temporary_create, temporary_destroy),
        cmocka_unit_test_setup_teardown(bytes_behind_the_arrays_are_told, temporary_create,
                                        temporary_destroy),
        cmocka_unit_test_setup_teardown(merged_vertices_take_their_attributes_along,
                                        temporary_create, temporary_destroy),
        cmocka_unit_test(empty_roots_of_salon_files_are_left_out_and_counted),
        cmocka_unit_test(strands_beyond_the_longest_are_refused),
        cmocka_unit_test(real_assets_are_read_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
