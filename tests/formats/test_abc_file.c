// SPDX-License-Identifier: MIT
// Alembic files in the Ogawa format. Alembic 1.8 wrote tests/data/curves.abc, groom.abc and
// unreal.abc. Files that the tests write are read by our own reader only.
#include "formats/frames_file.h"
#include "formats/ogawa.h"
#include "formats/strands_read.h"
#include "strands/strands_edit.h"
#include "support/reading.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// Strands of 2 and 3 vertices with all attributes.
static Strands make_rich(void)
{
    static const float positions[5][3] = {
        {0, 0, 0}, {0, 0.1f, 0}, {1, 0, 0}, {1, 1e-5f, 0}, {1.0000001f, 0.25f, -0.0f}};
    Strands strands;
    assert_int_equal(strands_create(&strands, 2, 5, NULL), RESULT_OK);
    strands.first[1] = 2, strands.first[2] = 5;
    memcpy(strands.position, positions, sizeof positions);
    strands.strand_uv = calloc(2, sizeof *strands.strand_uv);
    strands.strand_thickness = calloc(2, sizeof(float));
    strands.strand_group = calloc(2, sizeof(float));
    strands.vertex_uv = calloc(5, sizeof *strands.vertex_uv);
    strands.vertex_thickness = calloc(5, sizeof(float));
    strands.mobility = calloc(5, sizeof(float));
    strands.color = calloc(5, sizeof *strands.color);
    strands.strand_uv[1][0] = strands.vertex_uv[4][1] = strands.strand_thickness[1] = 0.5f;
    strands.strand_group[1] = 7;
    for (int v = 0; v < 5; ++v) {
        strands.vertex_thickness[v] = 1e-4f * (float)(v + 1);
        for (int k = 0; k < 4; ++k) strands.color[v][k] = 0.1f * (float)(v + k);
    }
    strands.followers = 12;
    strands.follower_radius = 0.125f;
    strands.both_ends_fixed = true;
    return strands;
}

static void assert_same(const Strands *a, const Strands *b)
{
    assert_int_equal(a->strand_count, b->strand_count);
    assert_memory_equal(a->first, b->first, 4 * (size_t)(a->strand_count + 1));
    assert_memory_equal(a->position, b->position, 12 * (size_t)a->vertex_count);
#define SAME(array, count)                                                                         \
    assert_true(!a->array == !b->array);                                                           \
    if (a->array) assert_memory_equal(a->array, b->array, (count) * sizeof *a->array);
#define OF_VERTICES(array, width, mended) SAME(array, a->vertex_count)
#define OF_STRANDS(array, width, mended)  SAME(array, a->strand_count)
    STRANDS_ARRAYS_OF_VERTICES(OF_VERTICES)
    STRANDS_ARRAYS_OF_STRANDS(OF_STRANDS)
    assert_int_equal(a->followers, b->followers);
    assert_true(a->follower_radius == b->follower_radius);
    assert_int_equal(a->both_ends_fixed, b->both_ends_fixed);
}

static Strands read_data(const char *name, StrandsFrames *frames, StrandsReport *report)
{
    Strands strands;
    Error error = {""};
    if (strands_read_frames(&strands, frames, name, &METRES, report, &error) != RESULT_OK)
        fail_msg("%s", error.text);
    return strands;
}

static void everything_that_strands_have_reads_back_to_the_bit(void **state)
{
    Strands strands = make_rich(), back;
    StrandsReport report;
    const char *path = temporary_path(state, "x.abc");
    assert_int_equal(format_write(path, FORMAT_ABC, &strands, NULL), RESULT_OK);
    assert_int_equal(strands_read(&back, path, NULL, &report, NULL), RESULT_OK);
    assert_int_equal(report.kind, FORMAT_ABC);
    assert_false(report.unit_guessed || report.up_guessed); // the file contains both
    assert_same(&strands, &back);
    strands_destroy(&strands);
    strands_destroy(&back);
}

static void unit_and_axis_are_those_of_the_file(void **state)
{
    Strands strands = make_rich(), back;
    StrandsReport report;
    const char *path = temporary_path(state, "x.abc");
    strands_to_unit(&strands, 0.01, true);
    assert_int_equal(format_write(path, FORMAT_ABC, &strands, NULL), RESULT_OK);
    assert_int_equal(strands_read(&back, path, NULL, &report, NULL), RESULT_OK);
    assert_true(report.up_z && report.unit_used == 0.01f);
    assert_float_equal(back.position[4][1], 0.25, 1e-7);
    assert_float_equal(back.vertex_thickness[4], 5e-4, 1e-10);
    strands_destroy(&strands);
    strands_destroy(&back);
}

static void frames_are_samples_at_their_times(void **state)
{
    Strands strands = make_rich(), back;
    StrandsFrames frames;
    StrandsReport report;
    FramesFile file;
    const CurvesOptions options = {
        .metres_per_unit = 1, .animated = true, .fps = 24, .first = 10, .last = 14};
    const char *path = temporary_path(state, "x.abc");
    assert_int_equal(frames_file_open(&file, FORMAT_ABC, path, &strands, &options, NULL),
                     RESULT_OK);
    for (int i = 10; i <= 14; i += 2) {
        strands.position[1][2] = (float)i;
        assert_int_equal(frames_file_add(&file, i, (const float(*)[3])strands.position, NULL),
                         RESULT_OK);
    }
    assert_false(temporary_has(state, "x.abc")); // not before it is complete
    assert_int_equal(frames_file_finish(&file, NULL), RESULT_OK);
    back = read_data(path, &frames, &report);
    assert_int_equal(frames.count, 3);
    assert_string_equal(report.note, "");
    assert_float_equal(frames.fps, 12, 1e-12); // every second frame
    assert_int_equal(frames.first, 5);
    for (uint32_t f = 0; f < 3; ++f)
        assert_true(frames.position[f * 5 + 1][2] == 10 + 2 * (float)f);
    assert_true(frames.position[9][1] == 0.25f);
    strands_frames_destroy(&frames);
    strands_destroy(&strands);
    strands_destroy(&back);
}

static void assert_near(const float (*points)[3], size_t count, const double (*wanted)[3])
{
    for (size_t v = 0; v < count; ++v)
        for (int k = 0; k < 3; ++k) assert_float_equal(points[v][k], wanted[v][k], 1e-6);
}

// Rotated, moved and scaled by a transform; strands of 3, 5 and 2 points, whose samples 2 and 3 are
// equal; a B-spline with its knots; indexed texture coordinates; one width for all.
static void alembics_own_curves_are_read(void **state)
{
    (void)state;
    StrandsFrames frames;
    Strands strands = read_data("tests/data/curves.abc", &frames, NULL);
    const double depth[] = {0, 1, 2, 2},
                 spline[4][3] = {{0, 0, 0}, {1 / 6., 5 / 6., 0}, {5 / 6., 7 / 6., 0}, {1, 2, 0}};
    const uint32_t first[] = {0, 3, 8, 10, 14};
    assert_int_equal(strands.strand_count, 4);
    assert_memory_equal(strands.first, first, sizeof first);
    assert_int_equal(frames.count, 4);
    assert_float_equal(frames.fps, 30, 1e-9);
    for (uint32_t f = 0; f < 4; ++f)
        for (uint32_t s = 0; s < 3; ++s)
            for (uint32_t v = first[s]; v < first[s + 1]; ++v) {
                const double wanted[1][3] = {{-0.5 * (v - first[s]), 1 + 2.0 * s, depth[f]}};
                assert_near((const float(*)[3])frames.position + 14 * f + v, 1, wanted);
            }
    assert_near((const float(*)[3])frames.position + 52, 4, spline);
    const float uv[4][2] = {{0.3f, 0.4f}, {0.1f, 0.2f}, {0.3f, 0.4f}, {0.7f, 0.8f}};
    assert_memory_equal(strands.strand_uv, uv, sizeof uv);
    // 2 mm, doubled by the transform; 2 and 1 mm on the spline.
    assert_float_equal(strands.vertex_thickness[0], 4e-3, 1e-9);
    assert_float_equal(strands.vertex_thickness[9], 4e-3, 1e-9);
    assert_float_equal(strands.vertex_thickness[13], 1e-3, 1e-9);
    strands_frames_destroy(&frames);
    strands_destroy(&strands);
}

static void points_a_strand_may_be_asked_for(void **state)
{
    (void)state;
    Strands strands;
    StrandsReadOptions options = METRES;
    options.points_per_strand = 13;
    assert_int_equal(strands_read(&strands, "tests/data/curves.abc", &options, NULL, NULL),
                     RESULT_OK);
    assert_int_equal(strands_size(&strands, 3), 13); // the spline; straight segments are unchanged
    assert_int_equal(strands_size(&strands, 0), 3);
    strands_destroy(&strands);
}

static void a_groom_of_alembic_keeps_its_strands_and_frames(void **state)
{
    (void)state;
    StrandsFrames frames;
    StrandsReport report;
    Strands strands = read_data("tests/data/groom.abc", &frames, &report);
    assert_int_equal(strands.strand_count, 30);
    assert_int_equal(strands.vertex_count, 1440);
    assert_int_equal(frames.count, 6);
    assert_true(frames.fps == 24);
    assert_true(strands.strand_uv && strands.vertex_thickness && !strands.color);
    strands_frames_destroy(&frames);
    strands_destroy(&strands);
}

// unreal.abc: 4 strands with widths in centimetres and groups 0, 1, 0, 1, the last of them a guide;
// and 2 strands of group 5, given once for their object. Its unit is the centimetre.
static void unreals_attributes_are_read(void **state)
{
    (void)state;
    Strands strands;
    StrandsReport report;
    const StrandsReadOptions options = {.unit = 0.01f};
    assert_int_equal(strands_read(&strands, "tests/data/unreal.abc", &options, &report, NULL),
                     RESULT_OK);
    assert_int_equal(strands.strand_count, 5);
    assert_non_null(strstr(report.note, "1 guide left out (groom_guide)"));
    const float group[] = {0, 1, 0, 5, 5};
    assert_memory_equal(strands.strand_group, group, sizeof group);
    assert_float_equal(strands.position[4][1], 0.01, 1e-9);
    assert_float_equal(strands.vertex_thickness[0], 3e-4, 1e-9); // 0.03 cm
    assert_float_equal(strands.strand_uv[2][0], 0.2, 1e-7);
    assert_true(strands.color[3][0] == 0.25f && strands.color[4][1] == 0.125f);
    strands_destroy(&strands);
    // Widths are in centimetres, whatever the unit.
    assert_int_equal(strands_read(&strands, "tests/data/unreal.abc", &METRES, NULL, NULL),
                     RESULT_OK);
    assert_float_equal(strands.vertex_thickness[0], 3e-4, 1e-9);
    strands_destroy(&strands);
}

static void a_group_can_be_picked(void **state)
{
    (void)state;
    Error error = {""};
    Strands strands;
    assert_int_equal(strands_read(&strands, "tests/data/unreal.abc", &METRES, NULL, NULL),
                     RESULT_OK);
    assert_int_equal(strands_pick_group(&strands, 5, &error), RESULT_OK);
    assert_int_equal(strands.strand_count, 2);
    assert_float_equal(strands.position[0][0], 10, 1e-9);
    assert_int_equal(strands_pick_group(&strands, 2, &error), RESULT_BAD_INPUT);
    assert_string_equal(error.text, "no strand belongs to group 2: expected a group from 5 to 5");
    strands_destroy(&strands);
}

static Bytes read_file(const char *path)
{
    Bytes bytes;
    assert_int_equal(bytes_read_file(&bytes, path, NULL), RESULT_OK);
    return bytes;
}

static void damage(const char *path)
{
    Bytes bytes = read_file(path);
    Strands strands;
    for (size_t i = 5; i < 2 * bytes.size; ++i) {
        Error error = {""};
        bool cut = i < bytes.size;
        uint8_t *byte = &bytes.data[i % bytes.size], before = *byte;
        if (!cut) *byte ^= (uint8_t)(1 << i % 8);
        Result result =
            reading_copy(&strands, bytes.data, cut ? i : bytes.size, &METRES, NULL, &error);
        *byte = before;
        assert_true(result == RESULT_OK || result == RESULT_BAD_INPUT);
        if (cut) assert_int_equal(result, RESULT_BAD_INPUT);
        assert_true(result == RESULT_OK || (*error.text && !strchr(error.text, '\n')));
        strands_destroy(&strands);
    }
    bytes_destroy(&bytes);
}

static void cut_and_damaged_files_are_refused_in_one_line(void **state)
{
    (void)state;
    damage("tests/data/curves.abc");
    damage("tests/data/unreal.abc");
}

static void refuse(const uint8_t *data, size_t size, const char *says)
{
    Strands strands;
    Error error = {""};
    assert_int_equal(reading_copy(&strands, data, size, &METRES, NULL, &error), RESULT_BAD_INPUT);
    if (!strstr(error.text, says)) fail_msg("'%s' does not say '%s'", error.text, says);
}

static void what_is_no_groom_says_what_it_is(void **state)
{
    (void)state;
    Bytes bytes = read_file("tests/data/curves.abc"), mesh = read_file("tests/data/body.abc");
    bytes.data[5] = 0;
    refuse(bytes.data, bytes.size, "did not finish it");
    refuse(mesh.data, mesh.size, "meshes without hair: expected hair (pass a mesh with --mesh)");
    // A group with more parts than the file has bytes.
    bytes.data[5] = 0xff;
    uint64_t root;
    memcpy(&root, bytes.data + 8, 8);
    memset(bytes.data + root, 0xff, 7);
    refuse(bytes.data, bytes.size, "a group's parts need");
    bytes_destroy(&bytes);
    bytes_destroy(&mesh);
}

// The four numbers of groom_guide take 24 bytes; their count is at byte 700. The first object is
// left out, the second one is read.
static void an_object_whose_guides_do_not_fit_is_left_out(void **state)
{
    (void)state;
    Bytes bytes = read_file("tests/data/unreal.abc");
    Strands strands;
    StrandsReport report;
    StrandsReadOptions strict = METRES;
    strict.strict = true;
    assert_int_equal(bytes.data[700], 24);
    bytes.data[700] = 20;
    assert_int_equal(reading_copy(&strands, bytes.data, bytes.size, &METRES, &report, NULL),
                     RESULT_OK);
    assert_int_equal(strands.strand_count, 2);
    assert_non_null(strstr(report.note, "groom_guide: 2 numbers: expected 4, one for each curve"));
    assert_int_equal(report.flaws, 1);
    assert_int_equal(report.contents.left_out, 1);
    strands_destroy(&strands);
    assert_int_equal(reading_copy(&strands, bytes.data, bytes.size, &strict, NULL, NULL),
                     RESULT_BAD_INPUT);
    bytes_destroy(&bytes);
}

// One object has groom_width and the other has no widths.
static void widths_that_only_some_objects_have_are_left_out_with_a_line(void **state)
{
    (void)state;
    Bytes bytes = read_file("tests/data/unreal.abc");
    Strands strands;
    StrandsReport report;
    uint8_t *name = memmem(bytes.data, bytes.size, "groom_width", 11);
    name = memmem(name + 1, bytes.size - (size_t)(name + 1 - bytes.data), "groom_width", 11);
    assert_non_null(name);
    *name = 'x';
    assert_int_equal(reading_copy(&strands, bytes.data, bytes.size, &METRES, &report, NULL),
                     RESULT_OK);
    assert_null(strands.vertex_thickness);
    assert_non_null(
        strstr(report.note, "left out, since not all objects have it: thickness of vertices"));
    strands_destroy(&strands);
    bytes_destroy(&bytes);
}

// Files of Alembic 1.8: what each holds besides two good strands, and how many strands are read.
static void what_other_programs_write_is_read(void **state)
{
    (void)state;
    static const struct {
        const char *name, *says;
        uint32_t strands, features;
    } cases[] = {
        {"instances", "", 4, STRANDS_HAS_GROUP}, // an instance of two strands
        {"shown", "", 2, 0},                     // they say "visible" below a hidden parent
        {"later", "", 2, 0},                     // hidden in the first sample
        {"hidden", "all curves are hidden", 2, 0},
        {"nurbs", "(NURBS or Hermite curves", 2, 0},
        {"bezier5", "1 cubic curve of too few points", 3, 0},
        {"names", "", 3, STRANDS_HAS_GROUP},        // groom_group_name
        {"group_vertex", "", 3, STRANDS_HAS_GROUP}, // groom_group_id for each vertex
        {"rgba", "", 2, STRANDS_HAS_COLOR},
        {"uv3", "", 2, STRANDS_HAS_STRAND_UV},
        {"wide", "", 2, STRANDS_HAS_VERTEX_THICKNESS}, // a width among .arbGeomParams
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char path[100];
        StrandsReport report;
        snprintf(path, sizeof path, "tests/data/alembic/%s.abc", cases[i].name);
        Strands strands = read_data(path, NULL, &report);
        if (strands.strand_count != cases[i].strands || report.features != cases[i].features ||
            !strstr(report.note, cases[i].says))
            fail_msg("%s: %u strands, features %u, '%s'", path, strands.strand_count,
                     report.features, report.note);
        strands_destroy(&strands);
    }
}

// 24 frames a second, each with samples a quarter of a frame before, at, and after it. The second
// vertex of sample k is at x = 0.01 k.
static void samples_for_motion_blur_give_whole_frames(void **state)
{
    (void)state;
    StrandsReport report;
    StrandsFrames frames;
    Strands strands = read_data("tests/data/alembic/shutter.abc", &frames, &report);
    assert_int_equal(frames.count, 3);
    assert_int_equal(frames.first, 0);
    assert_float_equal(frames.fps, 24, 1e-9);
    for (uint32_t f = 0; f < 3; ++f)
        assert_true(frames.position[f * strands.vertex_count + 1][0] == 0.01f * (float)(3 * f + 1));
    strands_frames_destroy(&frames);
    strands_destroy(&strands);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)
    const struct CMUnitTest tests[] = {
        TEST(everything_that_strands_have_reads_back_to_the_bit),
        TEST(unit_and_axis_are_those_of_the_file),
        TEST(frames_are_samples_at_their_times),
        TEST(alembics_own_curves_are_read),
        TEST(points_a_strand_may_be_asked_for),
        TEST(a_groom_of_alembic_keeps_its_strands_and_frames),
        TEST(unreals_attributes_are_read),
        TEST(a_group_can_be_picked),
        TEST(cut_and_damaged_files_are_refused_in_one_line),
        TEST(what_is_no_groom_says_what_it_is),
        TEST(widths_that_only_some_objects_have_are_left_out_with_a_line),
        TEST(what_other_programs_write_is_read),
        TEST(samples_for_motion_blur_give_whole_frames),
        TEST(an_object_whose_guides_do_not_fit_is_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
