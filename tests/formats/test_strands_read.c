// SPDX-License-Identifier: MIT
// Text files, units and axes, real files; binary files are in test_strands_read_binary.c.
#include "support/reading.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

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
        Strands strands = reading_good(texts[i], &report);
        assert_int_equal(report.kind, FORMAT_TFX2);
        assert_true(report.version == 2); // given or not
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
    Strands strands =
        reading_good("version 2.0\nscale 2\nrotation 0 90 0\ntranslation 10 0 0\n"
                     "bothEndsImmovable 1\nnumFollowHairsPerGuideHair 4\n"
                     "maxRadiusAroundGuideHair 0.5\nnumStrands 1\nis sorted 1\n" STRAND,
                     &report);
    // Doubling (1, 2, 3) gives (2, 4, 6); a quarter turn about y makes that (6, 4, -2).
    assert_true(fabsf(strands.position[0][0] - 16.0f) < 1e-5f);
    assert_true(fabsf(strands.position[0][1] - 4.0f) < 1e-5f);
    assert_true(fabsf(strands.position[0][2] + 2.0f) < 1e-5f);
    assert_true(report.rotation_was_deg);
    assert_true(strands.both_ends_fixed);
    assert_int_equal(strands.followers, 4);
    assert_true(strands.follower_radius == 1.0f);
    strands_destroy(&strands);
}

// Rotations about z, then x, then y, like DirectX's XMMatrixRotationRollPitchYaw: a quarter turn
// about each axis moves (1, 2, 3) differently, and the three together depend on their order.
static void a_file_is_turned_about_each_axis(void **state)
{
    (void)state;
    static const struct {
        const char *angles;
        float expected[3];
    } cases[] = {{"90 0 0", {1, -3, 2}},
                 {"0 90 0", {3, 2, -1}},
                 {"0 0 90", {-2, 1, 3}},
                 {"90 90 90", {1, -3, 2}}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char text[200];
        snprintf(text, sizeof text, "rotation %s\nnumStrands 1\nis sorted 1\n" STRAND,
                 cases[i].angles);
        Strands strands = reading_good(text, NULL);
        for (int k = 0; k < 3; ++k)
            if (fabsf(strands.position[0][k] - cases[i].expected[k]) > 1e-5f)
                fail_msg("%s: axis %d at %g", cases[i].angles, k, (double)strands.position[0][k]);
        strands_destroy(&strands);
    }
}

// A kilometre away, floats are 6e-5 apart: two vertices at that distance are merged.
static void far_away_rounding_makes_no_vertices(void **state)
{
    (void)state;
    StrandsReport report;
    Strands strands = reading_good("numStrands 1\nis sorted 1\nstrand 0 numVerts 3 texcoord 0 0\n"
                                   "1000 0 0\n1000.00006 0 0\n1001 0 0\n",
                                   &report);
    assert_int_equal(strands.vertex_count, 2);
    assert_int_equal(report.defects[DEFECT_COINCIDENT].count, 1);
    strands_destroy(&strands);
}

// Lines of a Wavefront file refer to vertices in any order: the reported defect is the first in the
// file.
static void the_first_defect_is_the_first_in_the_file(void **state)
{
    (void)state;
    StrandsReport report;
    Strands strands = reading_good(
        "v 0 0 0\nv 0 1 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 1 1 0\nl 4 5 6\nl 1 2 3\n", &report);
    assert_int_equal(report.defects[DEFECT_COINCIDENT].count, 2);
    assert_int_equal(report.defects[DEFECT_COINCIDENT].first_place, 3);
    strands_destroy(&strands);
}

static void numbers_are_rounded_as_strtof_does(void **state)
{
    (void)state;
    // The middle numbers lie half-way between floats, or so near to that that doubles can't tell.
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
        Strands strands = reading_good(text, NULL);
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
        {"hello\n", "FILE: byte 0: not a hair file: expected USD (.usda), Alembic (.abc), HAIR, "
                    "Wavefront lines, "
                    "TressFX 4 binary, TressFX 3 binary, TressFX 2 text, USC-HairSalon (.data), "
                    "PLY strands, PLY strands as text, numpy arrays (.npz), numpy array (.npy) or "
                    "CT2Hair (.bin)"},
        {"PXR-USDC",
         "FILE: byte 0: not supported: binary USD (.usdc): convert it: usdcat FILE -o x.usda"},
        {"BLENDER",
         "FILE: byte 0: not supported: a Blender file (.blend): convert it: blender -b --python "
         "scripts/blender_hair.py -- export FILE -o x.npz (installed: "
         "/usr/share/tractrix/blender_hair.py)"},
        {"numStrands", "FILE:1: expected the number of strands, got the end of the file"},
        {"numStrands x\n", "FILE:1: expected the number of strands, got 'x'"},
        {"numStrands -1\n", "FILE:1: expected the number of strands, got '-1'"},
        {"numStrands 99999999999\n", "FILE:1: expected the number of strands, got '99999999999'"},
        {"numStrands 0\nis sorted 1\n", "FILE:1: numStrands 0: expected at least 1"},
        {"numStrands 4294967295\nis sorted 1\n" STRAND,
         "FILE:1: numStrands 4294967295: expected at most 3, the number that fits into the file"},
        {"numStrands 1\n" STRAND, "FILE:2: expected 'is sorted', got 'strand'"},
        {"numStrands 1\nis sorted 2\n" STRAND, "FILE:2: expected 0 or 1 for is sorted, got '2'"},
        {"numStrands 1\nis sorted 1 1\n" STRAND, "FILE:2: expected the end of the line, got '1'"},
        {"numStrands 1\nis sorted 1\nhair 0 numVerts 2\n", "FILE:3: expected strand, got 'hair'"},
        {"numStrands 1\nis sorted 1\nstrand 0 numVerts 4294967295\n0 0 0\n",
         "FILE:3: numVerts 4294967295: expected at most 1, the number that fits into the file"},
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
        {"numStrands 2\nis sorted 1\n" STRAND,
         "FILE:6: 1 strands in the file: expected 2, the number in its header"},
        {"numStrands 1\nis sorted 1\n" STRAND STRAND,
         "FILE:6: expected the end of the file after the last strand, got 'strand'"},
        {"version 2.0\nscale 0\n", "FILE:2: scale 0: expected another number than 0"},
        {"version 2.0\ncolour 1\n", "FILE:2: expected is, got 'colour'"},
        {"scale 1.#INF\n", "FILE:1: expected the scale, got '1.#INF'"},
        {"numStrands 1\nis sorted 1\nstrand 0 numVerts 2\n0 0 0\n0 0 0\n",
         "FILE:3: 1 strand of fewer than two distinct vertices (no usable strand among 1)"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Strands strands;
        StrandsReport report;
        Error error = {""};
        assert_int_equal(reading_text(&strands, cases[i].text, &METRES, &report, &error),
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
    Strands strands = reading_good(DIRTY, &report);
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

static void each_kind_of_mending_is_reported_in_one_line(void **state)
{
    (void)state;
    StrandsReport report;
    Strands strands = reading_good(DIRTY, &report);
    strands_destroy(&strands);
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    assert_int_equal(strands_report_print_mended(&report, "FILE", stream), 4);
    fclose(stream);
    assert_string_equal(
        text,
        "FILE:9: 1 strand with a coordinate that is NaN, infinite or beyond 1000 km: dropped\n"
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
    assert_int_equal(reading_text(&strands, DIRTY, &strict, &report, &error), RESULT_BAD_INPUT);
    assert_string_equal(
        error.text, "FILE:9: 1 strand with a coordinate that is NaN, infinite or beyond 1000 km "
                    "(refused because of --strict)");
    assert_false(strands_report_is_clean(&report));
    assert_int_equal(
        reading_text(&strands, "numStrands 1\nis sorted 1\n" STRAND, &strict, &report, &error),
        RESULT_OK);
    strands_destroy(&strands);
}

static void strands_over_the_files_own_limit_stay_whole(void **state)
{
    (void)state;
    StrandsReport report;
    Strands strands =
        reading_good("maxNumVerticesInStrand 1\nnumStrands 1\nis sorted 1\n" STRAND, &report);
    assert_int_equal(strands.vertex_count, 2);
    assert_int_equal(report.defects[DEFECT_OVER_LIMIT].count, 1);
    assert_int_equal(report.defects[DEFECT_OVER_LIMIT].first_place, 4);
    strands_destroy(&strands);
}

// Strand s of n, identified by its u and its height.
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
    Strands a = reading_good(text, &report), b = reading_good(text, NULL);
    Strands sorted = reading_good(sorted_text, NULL);
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
        assert_int_equal(reading_copy(&strands, &data, sizeof data, NULL, &report, NULL),
                         RESULT_OK);
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
    assert_int_equal(reading_text(&strands, text, NULL, &report, NULL), RESULT_OK);
    assert_true(report.unit_used == 0.01f);
    assert_true(fabsf(strands.position[0][1] - 1.03333f) < 1e-6f);
    strands_destroy(&strands);
}

// One strand of two vertices, the second at `x`, 0, `z`, in a HAIR file with this info text.
static Result read_hair(Strands *strands, float x, float z, const char *info,
                        const StrandsReadOptions *options, StrandsReport *report)
{
    struct {
        char name[4];
        uint32_t strands, points, arrays, segments;
        float defaults[5];
        char info[88];
        float position[2][3];
    } data = {"HAIR", 1, 2, 2, 1, {0}, "", {{0, 0, 0}, {x, 0, z}}};
    memcpy(data.info, info, strnlen(info, sizeof data.info));
    return reading_copy(strands, &data, sizeof data, options, report, NULL);
}

static void formats_have_their_own_units_and_axes(void **state)
{
    (void)state;
    static const char LONG[] = "an info that is as long as its place in the header, which is 88 "
                               "characters, and has no zero";
    static const struct {
        const char *info;
        StrandsReadOptions options;
        float length, unit;
        bool up_z, unit_guessed, up_guessed;
    } CASES[] = {
        {"", {.unit = 0}, 40, 0.01f, true, true, true}, // Cem Yuksel's
        {LONG, {.unit = 0}, 400, 0.001f, true, true, true},
        {"", {.up = UP_Y}, 40, 0.01f, false, true, false},
        {"", {.unit = 1}, 40, 1, true, false, true},
        {"Tractrix", {.unit = 0}, 0.5f, 1, false, true, false}, // written before version 0.2
        {"Tractrix: unit 0.25 m, y up", {.unit = 0}, 40, 0.25f, false, false, false},
        {"Tractrix: unit 0.01 m, z up", {.unit = 0}, 4, 0.01f, true, false, false},
        {"Tractrix: unit nan m, z up", {.unit = 0}, 40, 0.01f, true, true, false},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        Strands strands;
        StrandsReport report;
        assert_int_equal(
            read_hair(&strands, 0, CASES[i].length, CASES[i].info, &CASES[i].options, &report),
            RESULT_OK);
        assert_true(report.unit_used == CASES[i].unit && report.up_z == CASES[i].up_z);
        assert_int_equal(report.unit_guessed, CASES[i].unit_guessed);
        assert_int_equal(report.up_guessed, CASES[i].up_guessed);
        float up = strands.position[1][1], expected = CASES[i].length * CASES[i].unit;
        assert_true(fabsf(up - (CASES[i].up_z ? expected : 0)) < 1e-6f * expected);
        strands_destroy(&strands);
    }
    // A large animal in TressFX: a box of 500 units, strands of 400 units.
    Strands strands;
    StrandsReport report;
    struct {
        uint32_t magic[2]; // no signature: USC-HairSalon's counts
        float position[2][3];
    } big = {{1, 2}, {{0, 0, 0}, {300, 400, 0}}};
    assert_int_equal(reading_copy(&strands, &big, sizeof big, NULL, &report, NULL), RESULT_OK);
    assert_true(report.unit_used == 0.001f);
    strands_destroy(&strands);
    const char *text = "numStrands 1\nis sorted 1\nstrand 0 numVerts 2\n0 0 0\n300 400 0\n";
    assert_int_equal(reading_text(&strands, text, NULL, &report, NULL), RESULT_OK);
    assert_true(report.unit_used == 0.01f && !report.up_z);
    strands_destroy(&strands);
}

// Fur of 3 cm on an animal of 3 m is in centimetres; the box alone would suggest millimetres.
static void the_strands_length_counts_as_the_box_does(void **state)
{
    (void)state;
    struct {
        uint32_t strands, size0;
        float strand0[2][3];
        uint32_t size1;
        float strand1[2][3];
    } data = {2, 2, {{0, 0, 0}, {0, 3, 0}}, 2, {{300, 0, 0}, {300, 3, 0}}};
    Strands strands;
    StrandsReport report;
    assert_int_equal(reading_copy(&strands, &data, sizeof data, NULL, &report, NULL), RESULT_OK);
    assert_int_equal(report.kind, FORMAT_SALON_DATA);
    assert_true(report.unit_used == 0.01f);
    strands_destroy(&strands);
}

static void the_guess_is_one_line(void **state)
{
    (void)state;
    static const struct {
        StrandsReport report;
        const char *line;
    } CASES[] = {
        {{.unit_used = 0.01f, .unit_guessed = true, .up_guessed = true, .up_z = true},
         "a.hair: guessed a unit of 0.01 m and z up: set --unit and --up if this is wrong\n"},
        {{.unit_used = 0.001f, .unit_guessed = true},
         "a.hair: guessed a unit of 0.001 m: set --unit if "},
        {{.unit_used = 1, .up_guessed = true, .up_z = true}, "a.hair: guessed z up: set --up if"},
        {{.unit_used = 1, .unit_guessed = true, .up_guessed = true}, ""}, // stays silent
        {{.unit_used = 1}, ""},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char *text = NULL;
        size_t size = 0;
        FILE *stream = open_memstream(&text, &size);
        strands_report_print_guess(&CASES[i].report, "a.hair", stream);
        fclose(stream);
        assert_int_equal(strncmp(text, CASES[i].line, strlen(CASES[i].line)), 0);
        if (!*CASES[i].line) assert_string_equal(text, "");
        free(text);
        for (size_t j = 0; j < sizeof CASES / sizeof *CASES; j++)
            assert_int_equal(strands_report_same_guess(&CASES[i].report, &CASES[j].report),
                             i == j || (i >= 3 && j >= 3));
    }
}

static void z_up_is_turned_to_y_up(void **state)
{
    (void)state;
    StrandsReadOptions options = {.unit = 1.0f, .up = UP_Z};
    Strands strands;
    const char *text = "numStrands 1\nis sorted 1\n" STRAND;
    assert_int_equal(reading_text(&strands, text, &options, NULL, NULL), RESULT_OK);
    assert_memory_equal(strands.position[0], ((float[3]){1, 3, -2}), 12);
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
    assert_int_equal(reading_text(&strands, text, &METRES, NULL, &error), RESULT_BAD_INPUT);
    assert_string_equal(error.text, "FILE:3: strand 0 has 65536 vertices: expected at most 65535");
    free(text);
}

// --- Real files.

static void real_assets_are_read_whole(void **state)
{
    (void)state;
    static const struct {
        const char *path;
        FormatKind kind;
        uint32_t strands, size;
        float unit;
    } files[] = {
        {"../shared/assets/ratboy_mohawk.tfx", FORMAT_TFX4, 2228, 32, 1.0f},
        {"../shared/assets/sintel_228x32.tfx", FORMAT_TFX4, 228, 32, 0.01f},
        {"../shared/assets/ponytail_tail.tfx", FORMAT_TFX3, 255, 16, 0.01f},
        {"../shared/assets/hair_front_16_guide.tfx", FORMAT_TFX2, 93, 16, 0.01f},
        {"../shared/assets/ruby_short_16_guide.tfx", FORMAT_TFX2, 1867, 16, 0.01f},
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

// Strands of 2, 3 and 4 vertices that an array of 4 points each pads with zeros, and one that ends
// at the origin by itself.
static void zeros_behind_the_tips_are_cut_off(void **state)
{
    (void)state;
    Strands strands;
    StrandsReport report;
    const char *text =
        "v 5 0 0\nv 5 .1 0\nv 0 0 0\nv 0 0 0\nv 6 0 0\nv 6 .1 0\nv 6 .2 0\nv 0 0 0\n"
        "v 7 0 0\nv 7 .1 0\nv 7 .2 0\nv 7 .3 0\nv 0 .3 0\nv 0 .2 0\nv 0 .1 0\nv 0 0 0\n"
        "l 1 2 3 4\nl 5 6 7 8\nl 9 10 11 12\nl 13 14 15 16\n";
    assert_int_equal(reading_text(&strands, text, &METRES, &report, NULL), RESULT_OK);
    for (uint32_t s = 0; s < 4; ++s) assert_int_equal(strands_size(&strands, s), s < 3 ? s + 2 : 4);
    assert_int_equal(report.defects[DEFECT_PADDING].count, 2);
    assert_int_equal(report.defects[DEFECT_COINCIDENT].count, 0);
    strands_destroy(&strands);
}

// Two vertices 1 mm apart, 20 km away: their difference is that of the file.
static void hair_far_away_keeps_its_form(void **state)
{
    (void)state;
    const char *text =
        "#usda 1.0\n(\nmetersPerUnit = 1\nupAxis = \"Z\"\n)\ndef Xform \"far\"\n{\n"
        "double3 xformOp:translate = (20000, 0, 300)\n"
        "uniform token[] xformOpOrder = [\"xformOp:translate\"]\ndef BasisCurves \"x\"\n{\n"
        "uniform token type = \"linear\"\nint[] curveVertexCounts = [2]\n"
        "point3f[] points = [(0.25, 0, 0), (0.25, 0, 0.001)]\n}\n}\n";
    Strands strands;
    StrandsReadOptions options = {.recenters = true};
    assert_int_equal(reading_text(&strands, text, &options, NULL, NULL), RESULT_OK);
    assert_true(strands.origin[0] == 20000 && strands.origin[1] == 300 && strands.origin[2] == 0);
    assert_true(strands.position[0][0] == 0.25f && strands.position[0][1] == 0);
    assert_true(strands.position[1][1] == 0.001f); // y is up
    strands_destroy(&strands);
    // The origin of another file.
    const double origin[3] = {19999, 0, 0};
    options = (StrandsReadOptions){.origin = origin};
    assert_int_equal(reading_text(&strands, text, &options, NULL, NULL), RESULT_OK);
    assert_true(strands.position[0][0] == 1.25f && strands.position[0][1] == 300);
    strands_destroy(&strands);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_dialects_and_line_ends_are_read),
        cmocka_unit_test(parameters_mean_what_they_say),
        cmocka_unit_test(a_file_is_turned_about_each_axis),
        cmocka_unit_test(far_away_rounding_makes_no_vertices),
        cmocka_unit_test(the_first_defect_is_the_first_in_the_file),
        cmocka_unit_test(numbers_are_rounded_as_strtof_does),
        cmocka_unit_test(malformed_text_is_refused_with_its_line),
        cmocka_unit_test(dirty_strands_are_mended_and_counted),
        cmocka_unit_test(each_kind_of_mending_is_reported_in_one_line),
        cmocka_unit_test(strict_refuses_what_would_be_mended),
        cmocka_unit_test(strands_over_the_files_own_limit_stay_whole),
        cmocka_unit_test(unsorted_strands_are_shuffled_whole_and_repeatably),
        cmocka_unit_test(units_are_guessed_by_size_and_said_to_be_guesses),
        cmocka_unit_test(formats_have_their_own_units_and_axes),
        cmocka_unit_test(the_strands_length_counts_as_the_box_does),
        cmocka_unit_test(the_guess_is_one_line),
        cmocka_unit_test(zeros_behind_the_tips_are_cut_off),
        cmocka_unit_test(hair_far_away_keeps_its_form),
        cmocka_unit_test(z_up_is_turned_to_y_up),
        cmocka_unit_test(strands_beyond_the_longest_are_refused),
        cmocka_unit_test(real_assets_are_read_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
