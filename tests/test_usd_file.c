// SPDX-License-Identifier: MIT
// USD's text form. The expected files are written out: such files have been read by TinyUSDZ and by
// the parser of three.js, with the same numbers.
#include "strands_write.h"
#include "temporary.h"
#include "usd_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// Strand 0 of 2 vertices, strand 1 of 3.
static void make_uneven(Strands *strands)
{
    static const float positions[5][3] = {
        {0, 0, 0}, {0, 0.1f, 0}, {1, 0, 0}, {1, 1e-5f, 0}, {1.0000001f, 0.25f, -0.0f}};
    assert_int_equal(strands_create(strands, 2, 5, NULL), RESULT_OK);
    strands->first[1] = 2;
    strands->first[2] = 5;
    memcpy(strands->position, positions, sizeof positions);
}

static void assert_content(void **state, const char *name, const char *expected)
{
    Bytes bytes;
    assert_int_equal(bytes_read_file(&bytes, temporary_path(state, name), NULL), RESULT_OK);
    assert_string_equal((const char *)bytes.data, expected);
    bytes_destroy(&bytes);
}

static void a_still_is_one_prim_with_its_points(void **state)
{
    Strands strands;
    make_uneven(&strands);
    assert_int_equal(strands_write(temporary_path(state, "x.usda"), STRANDS_USD, &strands, NULL),
                     RESULT_OK);
    assert_content(state, "x.usda",
                   "#usda 1.0\n(\n    defaultPrim = \"Hair\"\n    doc = \"Tractrix\"\n"
                   "    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\n"
                   "def BasisCurves \"Hair\"\n{\n    uniform token type = \"linear\"\n"
                   "    uniform token wrap = \"nonperiodic\"\n"
                   "    int[] curveVertexCounts = [2, 3]\n"
                   "    point3f[] points = [(0, 0, 0), (0, 0.1, 0), (1, 0, 0), (1, 1e-05, 0), "
                   "(1.0000001, 0.25, -0)]\n"
                   "    float3[] extent = [(0, 0, 0), (1.0000001, 0.25, 0)]\n}\n");
    strands_destroy(&strands);
}

static void frames_are_time_samples(void **state)
{
    Strands strands;
    UsdWriter writer;
    make_uneven(&strands);
    const float width = 0.5f, color[1][4] = {{0.25f, 0.5f, 1, 0.75f}};
    const uint32_t section[] = {0, 3};
    UsdOptions options = {.metres_per_unit = 0.01,
                          .up_z = true,
                          .animated = true,
                          .fps = 29.97,
                          .first = 7,
                          .last = 9,
                          .look = {.width = &width, .color = color, .section = section}};
    strands.followers = 4;
    strands.both_ends_fixed = true;
    assert_int_equal(
        usd_writer_open(&writer, temporary_path(state, "x.usda"), &strands, &options, NULL),
        RESULT_OK);
    assert_int_equal(usd_writer_add(&writer, 7, (const float(*)[3])strands.position, NULL),
                     RESULT_OK);
    strands.position[0][2] = 8;
    assert_int_equal(usd_writer_add(&writer, 9, (const float(*)[3])strands.position, NULL),
                     RESULT_OK);
    assert_false(temporary_has(state, "x.usda")); // not before it is whole
    assert_int_equal(usd_writer_finish(&writer, NULL), RESULT_OK);
    assert_content(
        state, "x.usda",
        "#usda 1.0\n(\n    defaultPrim = \"Hair\"\n    doc = \"Tractrix\"\n"
        "    metersPerUnit = 0.01\n    startTimeCode = 7\n    endTimeCode = 9\n"
        "    timeCodesPerSecond = 29.97\n    framesPerSecond = 29.97\n    upAxis = \"Z\"\n)\n\n"
        "def BasisCurves \"Hair\" (\n    customData = {\n        dictionary tractrix = {\n"
        "            bool bothEndsFixed = 1\n            float followerRadius = 0\n"
        "            int followers = 4\n        }\n    }\n)\n"
        "{\n    uniform token type = \"linear\"\n    uniform token wrap = \"nonperiodic\"\n"
        "    int[] curveVertexCounts = [2, 3]\n"
        "    float[] widths = [0.5] (\n        interpolation = \"constant\"\n    )\n"
        "    color3f[] primvars:displayColor = [(0.25, 0.5, 1)] (\n"
        "        interpolation = \"constant\"\n    )\n"
        "    float[] primvars:displayOpacity = [0.75] (\n"
        "        interpolation = \"constant\"\n    )\n"
        "    int[] primvars:section = [0, 3] (\n        interpolation = \"uniform\"\n    )\n"
        "    point3f[] points.timeSamples = {\n"
        "        7: [(0, 0, 0), (0, 0.1, 0), (1, 0, 0), (1, 1e-05, 0), (1.0000001, 0.25, -0)],\n"
        "        9: [(0, 0, 8), (0, 0.1, 0), (1, 0, 0), (1, 1e-05, 0), (1.0000001, 0.25, -0)],\n"
        "    }\n    float3[] extent.timeSamples = {\n"
        "        7: [(-0.25, -0.25, -0.25), (1.2500001, 0.5, 0.25)],\n"
        "        9: [(-0.25, -0.25, -0.25), (1.2500001, 0.5, 8.25)],\n    }\n}\n");
    strands_destroy(&strands);
}

static void everything_that_strands_have_is_written(void **state)
{
    Strands strands;
    make_uneven(&strands);
    strands.strand_uv = calloc(2, sizeof *strands.strand_uv);
    strands.vertex_uv = calloc(5, sizeof *strands.vertex_uv);
    strands.strand_thickness = calloc(2, sizeof(float));
    strands.vertex_thickness = calloc(5, sizeof(float));
    strands.mobility = calloc(5, sizeof(float));
    strands.color = calloc(5, sizeof *strands.color);
    strands.strand_uv[1][0] = strands.vertex_uv[4][1] = 0.5f;
    for (int v = 0; v < 5; ++v) strands.color[v][3] = 1, strands.color[v][0] = 0.1f * (float)v;
    assert_int_equal(strands_write(temporary_path(state, "x.usda"), STRANDS_USD, &strands, NULL),
                     RESULT_OK);
    Bytes bytes;
    assert_int_equal(bytes_read_file(&bytes, temporary_path(state, "x.usda"), NULL), RESULT_OK);
    const char *text = (const char *)bytes.data;
    static const char *const parts[] = {
        "float[] widths = [0, 0, 0, 0, 0] (\n        interpolation = \"vertex\"",
        "color3f[] primvars:displayColor = [(0, 0, 0), (0.1, 0, 0), (0.2, 0, 0), ",
        "texCoord2f[] primvars:st = [(0, 0), (0.5, 0)] (\n        interpolation = \"uniform\"",
        "texCoord2f[] primvars:st1 = [(0, 0), (0, 0), (0, 0), (0, 0), (0, 0.5)] (",
        "float[] primvars:thickness = [0, 0] (\n        interpolation = \"uniform\"",
        "float[] primvars:mobility = [0, 0, 0, 0, 0] (\n        interpolation = \"vertex\""};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; ++i)
        if (!strstr(text, parts[i])) fail_msg("no '%s' in\n%s", parts[i], text);
    assert_null(strstr(text, "displayOpacity")); // all are opaque
    bytes_destroy(&bytes);
    strands_destroy(&strands);
}

static void a_file_that_is_not_finished_is_not_there(void **state)
{
    Strands strands;
    UsdWriter writer;
    Error error;
    const UsdOptions options = {.metres_per_unit = 1, .animated = true, .fps = 30};
    make_uneven(&strands);
    const char *path = temporary_path(state, "x.usda");
    assert_int_equal(usd_writer_open(&writer, path, &strands, &options, NULL), RESULT_OK);
    assert_int_equal(usd_writer_add(&writer, 0, (const float(*)[3])strands.position, NULL),
                     RESULT_OK);
    usd_writer_discard(&writer);
    usd_writer_discard(&writer);
    assert_int_equal(usd_writer_open(&writer, path, &strands, &options, NULL), RESULT_OK);
    assert_int_equal(usd_writer_finish(&writer, &error), RESULT_FAILED);
    assert_non_null(strstr(error.text, "no frame"));
    assert_int_equal(temporary_count_files(((Temporary *)*state)->folder), 0);
    strands_destroy(&strands);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)
    const struct CMUnitTest tests[] = {
        TEST(a_still_is_one_prim_with_its_points),
        TEST(frames_are_time_samples),
        TEST(everything_that_strands_have_is_written),
        TEST(a_file_that_is_not_finished_is_not_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
