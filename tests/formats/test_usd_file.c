// SPDX-License-Identifier: MIT
// USD's text form. The expected files are given in full: TinyUSDZ and the parser of three.js have
// read such files with equal numbers.
#include "formats/format.h"
#include "formats/strands_read.h"
#include "formats/usd_write.h"
#include "support/reading.h"
#include "support/temporary.h"

#include <math.h>
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
    assert_int_equal(format_write(temporary_path(state, "x.usda"), FORMAT_USD, &strands, NULL),
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
    CurvesOptions options = {.metres_per_unit = 0.01,
                             .up_z = true,
                             .animated = true,
                             .fps = 29.97,
                             .first = 7,
                             .last = 9,
                             .look = {.width = &width, .color = color}};
    strands.followers = 4;
    strands.both_ends_fixed = true;
    strands.strand_group = calloc(2, sizeof *strands.strand_group);
    strands.strand_group[1] = 3;
    assert_int_equal(
        usd_writer_open(&writer, temporary_path(state, "x.usda"), &strands, &options, NULL),
        RESULT_OK);
    assert_int_equal(usd_writer_add(&writer, 7, (const float(*)[3])strands.position, NULL),
                     RESULT_OK);
    strands.position[0][2] = 8;
    assert_int_equal(usd_writer_add(&writer, 9, (const float(*)[3])strands.position, NULL),
                     RESULT_OK);
    assert_false(temporary_has(state, "x.usda")); // not before it is complete
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

// The uneven strands with all attributes.
static void make_rich(Strands *made)
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
    *made = strands;
}

static void everything_that_strands_have_is_written(void **state)
{
    Strands strands;
    make_rich(&strands);
    assert_int_equal(format_write(temporary_path(state, "x.usda"), FORMAT_USD, &strands, NULL),
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
    const CurvesOptions options = {.metres_per_unit = 1, .animated = true, .fps = 30};
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

// --- Reading.

static Strands read_text(const char *text, size_t size, StrandsReport *report, Result expected,
                         Error *error)
{
    Strands strands;
    // of exact size, so that the sanitizer sees reads past the end
    Bytes bytes = {malloc(size + 1), size};
    memcpy(bytes.data, text, size);
    bytes.data[size] = 0;
    Result result = strands_read_bytes(&strands, "FILE", &bytes, NULL, report, error);
    bytes_destroy(&bytes);
    if (result != expected) fail_msg("%.*s: %d, %s", (int)size, text, result, error->text);
    return strands;
}

static void what_is_written_is_read_to_the_bit(void **state)
{
    Strands strands, back;
    Error error = {""};
    make_rich(&strands);
    strands.followers = 7;
    strands.follower_radius = 0.0123f;
    strands.both_ends_fixed = true;
    strands.color[2][3] = 0.25f;
    strands.mobility[1] = 1; // an unusual mobility on its own
    strands.strand_thickness[1] = 0.1f;
    strands.vertex_thickness[3] = 1e-4f;
    const char *path = temporary_path(state, "x.usda");
    assert_int_equal(format_write(path, FORMAT_USD, &strands, &error), RESULT_OK);
    const StrandsReadOptions strict = {.strict = true};
    if (strands_read(&back, path, &strict, NULL, &error) != RESULT_OK) fail_msg("%s", error.text);
    assert_memory_equal(back.first, strands.first, 3 * sizeof(uint32_t));
    assert_memory_equal(back.position, strands.position, 5 * sizeof *back.position);
    assert_memory_equal(back.strand_uv, strands.strand_uv, 2 * sizeof *back.strand_uv);
    assert_memory_equal(back.vertex_uv, strands.vertex_uv, 5 * sizeof *back.vertex_uv);
    assert_memory_equal(back.strand_thickness, strands.strand_thickness, 2 * sizeof(float));
    assert_memory_equal(back.vertex_thickness, strands.vertex_thickness, 5 * sizeof(float));
    assert_memory_equal(back.mobility, strands.mobility, 5 * sizeof(float));
    assert_memory_equal(back.color, strands.color, 5 * sizeof *back.color);
    assert_int_equal(back.followers, 7);
    assert_true(back.follower_radius == 0.0123f && back.both_ends_fixed);
    strands_destroy(&strands);
    strands_destroy(&back);
}

// As other programs write files: comments, parents, other prims, several curves, frames, z up.
static const char FOREIGN[] =
    "#usda 1.0\n(\n    \"a (comment) = {\"\n    doc = \"\"\"three\n \"quotes\" \"\"\"\n"
    "    subLayers = [\n    ]\n    comment = @a(b.usd@\n    metersPerUnit = 0.1\n    upAxis = "
    "\"Z\"\n)\n"
    "def Xform \"World\" (\n    prepend apiSchemas = [\"X\"]\n    kind = \"group\"\n)\n{\n"
    "    token visibility\n    def Mesh \"m\"\n    {\n        point3f[] points = [(9, 9, 9)]\n"
    "        double3 xformOp:translate = (0, 1, 2)\n"
    "        uniform token[] xformOpOrder = [\"xformOp:translate\"]\n    }\n"
    "    def BasisCurves \"a\" (\n        variants = { string x = \"}\" }\n    )\n    {\n"
    "        rel material:binding = </World/m> # of all\n"
    "        uniform token type = \"linear\"\n        int[] curveVertexCounts = [2]\n"
    "        float[] widths = [0.5] (\n            interpolation = \"constant\"\n        )\n"
    "        point3f[] points.timeSamples = {\n            -1.5: [(0, 0, 0), (0, 0, 1)],\n"
    "            2: [(5, 5, 5), (6, 6, 6)],\n        }\n    }\n"
    "    def Scope \"s\" { def BasisCurves \"b\" {\n"
    "        vector3f[] velocities = None; uniform token type = \"linear\"\n"
    "        point3f[] points = [(1, 0, 0), (1, 2, 0), (1, 2, 4)]\n"
    "        int[] curveVertexCounts = [3]\n        float[] widths = [1, 2, 3]\n    } }\n}\n";

static void curves_of_other_programs_are_read(void **state)
{
    (void)state;
    Error error = {""};
    StrandsReport report;
    Strands strands = read_text(FOREIGN, strlen(FOREIGN), &report, RESULT_OK, &error);
    assert_int_equal(strands.strand_count, 2);
    assert_int_equal(strands_size(&strands, 1), 3);
    assert_false(report.unit_guessed);
    assert_int_equal(report.samples, 2);
    assert_true(strands.position[1][1] == 0.1f && strands.position[1][2] == 0); // z is up
    assert_true(strands.position[4][1] == 0.4f && strands.position[4][2] == -0.2f);
    assert_true(strands.vertex_thickness[0] == 0.05f && strands.vertex_thickness[1] == 0.05f);
    assert_true(strands.vertex_thickness[4] == 0.3f);
    strands_destroy(&strands);
}

static void assert_fibre(const Fibre *fibre, double modulus, double poisson, double density,
                         double radius)
{
    // Numbers are stored as float32, and converted to the file's unit before and after.
    const double pairs[4][2] = {{fibre->youngs_modulus, modulus},
                                {fibre->poisson, poisson},
                                {fibre->density, density},
                                {fibre->radius, radius}};
    for (int i = 0; i < 4; ++i)
        assert_true(fabs(pairs[i][0] - pairs[i][1]) <= 2e-7 * fabs(pairs[i][1]));
}

static void the_material_of_fibres_is_in_the_files_unit(void **state)
{
    Strands strands, back;
    UsdWriter writer;
    Error error = {""};
    make_uneven(&strands);
    strands.fibre = (Fibre){3.5e9, 0.45, 1300, 35e-6};
    const char *path = temporary_path(state, "x.usda");
    const CurvesOptions options = {.metres_per_unit = 0.01};
    assert_int_equal(usd_writer_open(&writer, path, &strands, &options, NULL), RESULT_OK);
    usd_writer_add(&writer, 0, (const float(*)[3])strands.position, NULL);
    assert_int_equal(usd_writer_finish(&writer, NULL), RESULT_OK);
    Bytes bytes;
    assert_int_equal(bytes_read_file(&bytes, path, NULL), RESULT_OK);
    const char *text = (const char *)bytes.data;
    assert_non_null(strstr(text,
                           "def BasisCurves \"Hair\" (\n    prepend apiSchemas = "
                           "[\"MaterialBindingAPI\", \"PhysicsCurvesDeformableSimAPI\"]\n)\n"));
    assert_non_null(strstr(text, "    rel material:binding:physics = </Hair/Fibre>\n"
                                 "    float[] physics:thicknesses = [0.007]\n    uniform token "
                                 "physics:thicknesses:elementType = \"constant\"\n"));
    assert_non_null(strstr(text, "    def Material \"Fibre\" (\n        prepend apiSchemas = "
                                 "[\"PhysicsMaterialAPI\", "
                                 "\"PhysicsCurvesDeformableMaterialAPI\"]\n    )\n    {\n"
                                 "        float physics:density = 0.0013\n"
                                 "        float physics:poissonsRatio = 0.45\n"
                                 "        float physics:youngsModulus = 3.5e+07\n    }\n}\n"));
    bytes_destroy(&bytes);
    if (strands_read(&back, path, NULL, NULL, &error) != RESULT_OK) fail_msg("%s", error.text);
    assert_fibre(&back.fibre, 3.5e9, 0.45, 1300, 35e-6);
    strands_destroy(&strands);
    strands_destroy(&back);
}

// Grams and decimetres; materials that parents bind, the one for physics before the other; numbers
// that no material has.
static void materials_of_other_programs_are_read(void **state)
{
    (void)state;
    static const char head[] =
        "#usda 1.0\n(\n metersPerUnit = 0.1\n kilogramsPerUnit = 0.001\n)\n"
        "def Xform \"W\" {\n rel material:binding:physics = </W/M/P>\n"
        "def BasisCurves \"x\"\n{\n rel material:binding = </W/M/Q>\n"
        "uniform token type = \"linear\"\nint[] curveVertexCounts = [2]\n"
        "point3f[] points = [(0, 0, 0), (0, 1, 0)]\nfloat[] physics:thicknesses = [0.0008]\n}\n"
        "def Scope \"M\" {\n"
        "def Material \"Q\" {\nfloat physics:density = 5\n}\ndef Material \"P\" {\n";
    static const struct {
        const char *values;
        double modulus, poisson, density;
    } cases[] = {
        // E: g/(dm s^2) are 0.01 Pa; density: g/dm^3 are kg/m^3
        {"float physics:youngsModulus = 2e11\nfloat physics:poissonsRatio = 0\n"
         "float physics:density = 1200\n",
         2e9, 0, 1200},
        {"float physics:youngsModulus = 2e11\nfloat physics:poissonsRatio = 0.6\n"
         "float physics:density = -inf\n",
         2e9, -1, 0},
        {"float physics:youngsModulus = None\nfloat physics:density = 1200\n", 0, -1, 1200},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char text[1000];
        Error error = {""};
        int size = snprintf(text, sizeof text, "%s%s}\n}\n}\n", head, cases[i].values);
        Strands strands = read_text(text, (size_t)size, NULL, RESULT_OK, &error);
        assert_fibre(&strands.fibre, cases[i].modulus, cases[i].poisson, cases[i].density, 40e-6);
        strands_destroy(&strands);
    }
}

#define CURVES(more)                                                                               \
    "#usda 1.0\ndef BasisCurves \"x\"\n{\nuniform token type = \"linear\"\n"                       \
    "int[] curveVertexCounts = [2]\npoint3f[] points = [(0, 0, 0), (0, 1, 0)]\n" more "}\n"

// Strings in triple quotes may contain lines and quotes of any form.
static void long_strings_are_skipped_whole(void **state)
{
    (void)state;
    Error error = {""};
    static const char text[] =
        "#usda 1.0\n(\n    doc = \"\"\"a \"quoted\" word ) {\nline\"\"\"\n)\n"
        "def BasisCurves \"x\"\n{\nuniform token type = \"linear\"\n"
        "string note = \"\"\"one \" } two\"\"\"\n"
        "int[] curveVertexCounts = [2]\n"
        "point3f[] points = [(0, 0, 0), (0, 1, 0)]\n}\n";
    Strands strands = read_text(text, strlen(text), NULL, RESULT_OK, &error);
    assert_int_equal(strands.strand_count, 1);
    strands_destroy(&strands);
}

static void what_would_give_other_hair_is_refused_with_its_line(void **state)
{
    (void)state;
    static const struct {
        const char *text, *says;
    } cases[] = {
        {"#usda 1.0\n", "FILE:2: no BasisCurves"},
        {CURVES("float xformOp:shear = 3\nuniform token[] xformOpOrder = [\"xformOp:shear\"]\n"),
         "FILE:7: 'xformOp:shear': unknown kind of transform"},
        {CURVES("float3 xformOp:scale = (1, 0, 1)\n"
                "uniform token[] xformOpOrder = [\"!invert!xformOp:scale\"]\n"),
         "FILE:7: 'xformOp:scale' has no inverse"},
        {CURVES("uniform token type = \"cubic\"\nuniform token basis = \"hermite\"\n"),
         "1 object of curves left out (NURBS or Hermite curves, or of an unknown basis)"},
        {CURVES("point3f[] points.timeSamples = { 1: [(0, 0, 0), (0, 1, 0)], 0: [] }\n"),
         "FILE:7: time sample 0: expected a time after"},
        {CURVES("point3f[] points.timeSamples = { x: [] }\n"), "FILE:7: expected a time, got 'x'"},
        {"#usda 1.0\n(\nsubLayers = [@a.usda@]\n)\n", "FILE:3: subLayers are not read: expected"},
        {"#usda 1.0\ndef \"x\" (\nprepend references = @a.usda@\n)\n{\n}\n",
         "FILE:3: references are not read"},
        {"#usda 1.0\ndef \"x\" (\ninherits = </a>\n)\n{\n}\n", "FILE:3: inherits are not read"},
        {"#usda 1.0\ndef \"x\"\n{\nvariantSet \"v\" = {\n}\n}\n", "FILE:4: variants are not read"},
        {"#usda 1.0\ndef PointInstancer \"p\"\n{\ndef BasisCurves \"x\"\n{\n"
         "point3f[] points = [(0, 0, 0)]\n}\n}\n",
         "1 object of curves left out (instances of a PointInstancer)"},
        {CURVES("uniform token wrap = \"periodic\"\n"), "left out (closed curves)"},
        {CURVES("int[] curveVertexCounts = [3]\n"), "FILE:7: curveVertexCounts: 1 numbers"},
        {CURVES("int[] curveVertexCounts = [1]\n"), "FILE:6: points: 6 numbers"},
        {CURVES("int[] curveVertexCounts = [1.5]\n"), "FILE:7: curveVertexCounts"},
        {CURVES("int[] curveVertexCounts = [-1]\n"), "FILE:7: curveVertexCounts"},
        {CURVES("point3f[] points = [(0, 0)]\n"), "FILE:7: points: 2 numbers"},
        {CURVES("point3f[] points = [(0, x, 0)]\n"), "FILE:7: expected a number, got 'x'"},
        {CURVES("= 3\n"), "FILE:7: unexpected '='"},
        {"#usda 1.0\n(\nmetersPerUnit = 0\n)\n" CURVES(""), "metersPerUnit"},
        {"#usda 1.0\ndef BasisCurves {}\n", "FILE:2: expected a prim's name"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        Error error = {""};
        read_text(cases[i].text, strlen(cases[i].text), NULL, RESULT_BAD_INPUT, &error);
        if (!strstr(error.text, cases[i].says)) fail_msg("%s: %s", cases[i].text, error.text);
    }
}

// Reads strands in metres and compares the vertices, three coordinates each.
static void check_vertices(const char *text, uint32_t strand_count, const float *wanted,
                           uint32_t count)
{
    Error error = {""};
    Strands strands = read_text(text, strlen(text), NULL, RESULT_OK, &error);
    assert_int_equal(strands.strand_count, strand_count);
    assert_int_equal(strands.vertex_count, count);
    for (uint32_t i = 0; i < 3 * count; ++i) {
        float got = strands.position[i / 3][i % 3];
        if (fabsf(got - wanted[i]) > 1e-6f)
            fail_msg("%s: number %u is %g, not %g", text, i, (double)got, (double)wanted[i]);
    }
    strands_destroy(&strands);
}

#define METRIC "#usda 1.0\n(\nmetersPerUnit = 1\nupAxis = \"Y\"\n)\n"
#define CUBIC(more, counts, points)                                                                \
    METRIC "def BasisCurves \"x\"\n{\n" more "int[] curveVertexCounts = " counts "\n"              \
           "point3f[] points = " points "\n}\n"

// Expected values by hand: a Bezier curve at t = 0, 1/4, ... 1; p(1/2) = (a + 3 b + 3 c + d) / 8.
// Splines through evenly spaced points of a line are that line; pinned splines reach its ends.
static void cubic_curves_become_points_on_them(void **state)
{
    (void)state;
    static const float bezier[] = {0, 0,        0,       0.15625f, 0.5625f, 0, 0.5f, 0.75f,
                                   0, 0.84375f, 0.5625f, 0,        1,       0, 0};
    check_vertices(CUBIC("", "[4]", "[(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)]"), 1, bezier, 5);
    static const float inner[] = {0, 1, 0, 0, 1.5f, 0, 0, 2, 0};
    static const float whole[] = {0, 0, 0, 0, 0.5f, 0,    0, 1, 0, 0, 1.5f,
                                  0, 0, 2, 0, 0,    2.5f, 0, 0, 3, 0};
#define LINE                "[(0, 0, 0), (0, 1, 0), (0, 2, 0), (0, 3, 0)]"
#define SPLINE(basis, more) "uniform token basis = \"" basis "\"\n" more
#define PINNED              "uniform token wrap = \"pinned\"\n"
    check_vertices(CUBIC(SPLINE("bspline", ""), "[4]", LINE), 1, inner, 3);
    check_vertices(CUBIC(SPLINE("catmullRom", ""), "[4]", LINE), 1, inner, 3);
    check_vertices(CUBIC(SPLINE("bspline", PINNED), "[4]", LINE), 1, whole, 7);
    check_vertices(CUBIC(SPLINE("catmullRom", PINNED), "[4]", LINE), 1, whole, 7);
    // B-spline: (a + 4 b + c) / 6 at a joint; Catmull-Rom: (-a + 9 b + 9 c - d) / 16 half-way
    // between two points.
    static const float bent[] = {0, 1, 0, 0.5f, 1.25f - 0.125f, 0, 1, 1, 0};
    check_vertices(
        CUBIC(SPLINE("catmullRom", ""), "[4]", "[(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)]"), 1,
        bent, 3);
    static const float joint[] = {1.0f / 6, 5.0f / 6, 0,        0.5f, 23.0f / 24,
                                  0,        5.0f / 6, 5.0f / 6, 0};
    check_vertices(
        CUBIC(SPLINE("bspline", ""), "[4]", "[(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)]"), 1,
        joint, 3);
}

static void attributes_of_cubic_curves_go_to_their_points(void **state)
{
    (void)state;
    Error error = {""};
    const char *text = CUBIC(
        "float[] widths = [1, 3] (\ninterpolation = \"varying\"\n)\n"
        "color3f[] primvars:displayColor = [(1, 0, 0), (0, 1, 0)] (interpolation = \"vertex\")\n"
        "int[] primvars:displayColor:indices = [0, 0, 1, 1]\n"
        "texCoord2f[] primvars:st = [(0.25, 0.5)] (interpolation = \"constant\")\n",
        "[4]", "[(0, 0, 0), (0, 1, 0), (0, 2, 0), (0, 3, 0)]");
    Strands strands = read_text(text, strlen(text), NULL, RESULT_OK, &error);
    static const float widths[] = {1, 1.5f, 2, 2.5f, 3};
    assert_memory_equal(strands.vertex_thickness, widths, sizeof widths);
    assert_true(strands.color[2][0] == 0.5f && strands.color[4][1] == 1);
    assert_true(strands.strand_uv[0][0] == 0.25f && strands.strand_uv[0][1] == 0.5f);
    strands_destroy(&strands);
}

#define MOVED(parent, own)                                                                         \
    METRIC "def Xform \"a\"\n{\n" parent "def BasisCurves \"x\"\n{\n" own                          \
           "uniform token type = \"linear\"\nint[] curveVertexCounts = [2]\n"                      \
           "point3f[] points = [(1, 2, 3), (1, 2, 4)]\n}\n}\n"
#define ORDER(names) "uniform token[] xformOpOrder = [" names "]\n"

static void transforms_act_in_their_order(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        float first[3], second[3];
    } cases[] = {
        {MOVED("double3 xformOp:translate = (10, 0, 0)\n" ORDER("\"xformOp:translate\""), ""),
         {11, 2, 3},
         {11, 2, 4}},
        {MOVED("double3 xformOp:translate = (10, 0, 0)\nfloat3 xformOp:scale = (2, 2, 2)\n" ORDER(
                   "\"xformOp:translate\", \"xformOp:scale\""),
               ""),
         {12, 4, 6},
         {12, 4, 8}}, // the last of the list acts first
        {MOVED("float3 xformOp:scale = (2, 2, 2)\n" ORDER("\"xformOp:scale\""),
               "double3 xformOp:translate = (10, 0, 0)\n" ORDER("\"xformOp:translate\"")),
         {22, 4, 6},
         {22, 4, 8}},
        {MOVED("float3 xformOp:scale = (2, 2, 2)\n" ORDER("\"xformOp:scale\""),
               "double3 xformOp:translate = (10, 0, 0)\n" ORDER(
                   "\"!resetXformStack!\", \"xformOp:translate\"")),
         {11, 2, 3},
         {11, 2, 4}},
        {MOVED("", "float xformOp:rotateZ = 90\n" ORDER("\"xformOp:rotateZ\"")),
         {-2, 1, 3},
         {-2, 1, 4}},
        {MOVED("", "float3 xformOp:rotateXYZ = (90, 0, 90)\n" ORDER("\"xformOp:rotateXYZ\"")),
         {3, 1, 2},
         {4, 1, 2}}, // x first: (1, -3, 2)
        {MOVED("", "float3 xformOp:rotateZYX = (90, 0, 90)\n" ORDER("\"xformOp:rotateZYX\"")),
         {-2, -3, 1},
         {-2, -4, 1}}, // z first: (-2, 1, 3)
        {MOVED("", "quatf xformOp:orient = (0.70710678, 0, 0, 0.70710678)\n" ORDER(
                       "\"xformOp:orient\"")),
         {-2, 1, 3},
         {-2, 1, 4}},
        {MOVED("", "matrix4d xformOp:transform = ( (0, 1, 0, 0), (-1, 0, 0, 0), (0, 0, 1, 0), "
                   "(5, 6, 7, 1) )\n" ORDER("\"xformOp:transform\"")),
         {3, 7, 10},
         {3, 7, 11}},
        {MOVED("",
               "double3 xformOp:translate:pivot = (1, 2, 0)\nfloat xformOp:rotateZ = 90\n" ORDER(
                   "\"xformOp:translate:pivot\", \"xformOp:rotateZ\", "
                   "\"!invert!xformOp:translate:pivot\"")),
         {1, 2, 3},
         {1, 2, 4}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        float wanted[6];
        memcpy(wanted, cases[i].first, 12);
        memcpy(wanted + 3, cases[i].second, 12);
        check_vertices(cases[i].text, 1, wanted, 2);
    }
}

static StrandsFrames read_frames(void **state, const char *text, Strands *strands, char note[400])
{
    StrandsFrames frames;
    StrandsReport report;
    Error error = {""};
    temporary_write(state, "x.usda", text, 0644);
    if (strands_read_frames(strands, &frames, temporary_path(state, "x.usda"), NULL, &report,
                            &error) != RESULT_OK)
        fail_msg("%s: %s", text, error.text);
    memcpy(note, report.note, 400);
    return frames;
}

static void all_times_of_points_and_transforms_are_frames(void **state)
{
    static const char text[] =
        "#usda 1.0\n(\nmetersPerUnit = 1\ntimeCodesPerSecond = 30\n)\n"
        "def Xform \"a\"\n{\ndouble3 xformOp:translate.timeSamples = {\n1: (0, 0, 0),\n"
        "3: (4, 0, 0)\n}\n" ORDER("\"xformOp:translate\"") "def BasisCurves \"x\"\n{\n"
                                                           "uniform token type = \"linear\"\nint[] "
                                                           "curveVertexCounts = [2]\n"
                                                           "point3f[] points.timeSamples = {\n2: "
                                                           "[(0, 0, 0), (0, 1, 0)],\n"
                                                           "4: [(0, 0, 2), (0, 1, 2)],\n}\n}\n}\n";
    Strands strands;
    char note[400];
    StrandsFrames frames = read_frames(state, text, &strands, note);
    assert_int_equal(frames.count, 4);
    assert_int_equal(frames.first, 1);
    assert_true(frames.fps == 30);
    static const float x[] = {0, 2, 4, 4}, z[] = {0, 0, 1, 2};
    for (int f = 0; f < 4; ++f) {
        assert_true(frames.position[2 * f][0] == x[f] && frames.position[2 * f][2] == z[f]);
        assert_true(frames.position[2 * f + 1][1] == 1);
    }
    strands_frames_destroy(&frames);
    strands_destroy(&strands);
    char uneven[sizeof text];
    memcpy(uneven, text, sizeof text);
    memcpy(strstr(uneven, "4: [(0"), "9: [(0", 6); // 1, 2, 3, 9
    frames = read_frames(state, uneven, &strands, note);
    assert_int_equal(frames.count, 9);
    assert_non_null(strstr(
        note, "unequal intervals: frames are interpolated at equal ones, from time code 1 to 9"));
    strands_frames_destroy(&frames);
    strands_destroy(&strands);
}

// 120 degrees about (1, 1, 1) from time 1 to 3; at time 2 there is a sample of the translation.
static void orientations_take_the_shortest_way(void **state)
{
    static const char *const ENDS[] = {"0.5, 0.5, 0.5, 0.5", "-0.5, -0.5, -0.5, -0.5"};
    static const float TIPS[3][3] = {{0, 1, 0}, {-1 / 3.0f, 2 / 3.0f, 2 / 3.0f}, {0, 0, 1}};
    for (int i = 0; i < 2; ++i) {
        char text[1000], note[400];
        Strands strands;
        snprintf(
            text, sizeof text,
            "#usda 1.0\n(\nmetersPerUnit = 1\ntimeCodesPerSecond = 24\n)\n"
            "def BasisCurves \"x\"\n{\nuniform token type = \"linear\"\n"
            "int[] curveVertexCounts = [2]\npoint3f[] points = [(0, 0, 0), (0, 1, 0)]\n"
            "double3 xformOp:translate.timeSamples = {1: (0, 0, 0), 2: (5, 0, 0), 3: (0, 0, 0)}\n"
            "quatf xformOp:orient.timeSamples = {1: (1, 0, 0, 0), 3: (%s)}\n" ORDER(
                "\"xformOp:translate\", \"xformOp:orient\"") "}\n",
            ENDS[i]);
        StrandsFrames frames = read_frames(state, text, &strands, note);
        assert_int_equal(frames.count, 3);
        for (int f = 0; f < 3; ++f)
            for (int k = 0; k < 3; ++k) {
                float moved = f == 1 && k == 0 ? 5 : 0;
                assert_float_equal(frames.position[2 * f][k], moved, 1e-6);
                assert_float_equal(frames.position[2 * f + 1][k], moved + TIPS[f][k], 1e-6);
            }
        strands_frames_destroy(&frames);
        strands_destroy(&strands);
    }
}

static void what_is_not_drawn_is_left_out_and_counted(void **state)
{
    (void)state;
#define PRIM(specifier, meta, more)                                                                \
    specifier " BasisCurves \"x\" " meta "\n{\nuniform token type = \"linear\"\n"                  \
              "int[] curveVertexCounts = [2]\npoint3f[] points = [(0, 0, 0), (0, 1, 0)]\n" more    \
              "}\n"
    const char *text = METRIC PRIM("def", "", "") PRIM("def", "(active = false)", "")
        PRIM("over", "", "") PRIM("class", "", "") PRIM(
            "def", "", "uniform token purpose = \"guide\"\n") "def Xform \"a\"\n{\ntoken "
                                                              "visibility = \"invisible\"\n" PRIM(
                                                                  "def", "",
                                                                  "") "}\n"
                                                                      "def NurbsCurves "
                                                                      "\"n\"\n{\n}\n" PRIM(
                                                                          "def", "(kind = \"x\")",
                                                                          "float xformOp:rotateX "
                                                                          "= 9\n");
    StrandsReport report;
    Error error = {""};
    Strands strands = read_text(text, strlen(text), &report, RESULT_OK, &error);
    assert_int_equal(strands.strand_count, 2);
    assert_string_equal(
        report.note,
        "1 transform without xformOpOrder has no effect; 3 objects of curves left out (inactive or "
        "abstract); 2 objects of curves left out (hidden, or of purpose guide or proxy); 1 object "
        "of curves left out (NURBS or Hermite curves, or of an unknown basis)");
    assert_int_equal(report.contents.count, 8);
    assert_int_equal(report.contents.left_out, 6);
    strands_destroy(&strands);
}

// What one bad part costs: how many strands are left, and what is said. With --strict it costs the
// file, unless `says` is "".
static void one_bad_part_does_not_cost_the_whole(void **state)
{
    (void)state;
#define OTHER(text) "def BasisCurves \"other\"\n{\n" text "}\n"
#define REST        "int[] curveVertexCounts = [2]\npoint3f[] points = [(0, 0, 0), (0, 1, 0)]\n"
    static const struct {
        const char *text, *says;
        uint32_t strands;
    } cases[] = {
        {CURVES("uniform token[] xformOpOrder = [\"xformOp:scale\"]\n"),
         "1 operation of xformOpOrder has no value", 1},
        {CURVES("matrix4d xformOp:transform = None\n"
                "uniform token[] xformOpOrder = [\"xformOp:transform\"]\n"),
         "1 operation of xformOpOrder has no value", 1},
        {CURVES("uniform token type = \"cubic\"\n"), "1 cubic curve of too few points", 1},
        {CURVES("float[] widths = [1, 2, 3]\n"), "/x: widths: 3 numbers, which do not fit", 1},
        {CURVES("texCoord2f[] primvars:st = [(1, 2)]\nint[] primvars:st:indices = [1]\n"),
         "/x: primvars:st: 2 numbers, which do not fit", 1},
        {CURVES("") OTHER("uniform token wrap = \"periodic\"\n" REST), "(closed curves)", 1},
        {CURVES("") OTHER(REST "int[] curveVertexCounts = [3]\n"),
         "(its arrays do not fit:12: curveVertexCounts: 1 numbers", 1},
        {CURVES("") "def Material \"m\" (references = @a.usda@)\n{\n}\n", "1 reference", 1},
        {CURVES("") "def Camera \"c\"\n{\nvariantSet \"v\" = { \"a\" { float f = 1 } }\n}\n",
         "1 reference", 1},
        {CURVES("int[] primvars:skel:jointIndices = [0]\n"), "a skeleton (UsdSkel) moves 1", 1},
        {CURVES("int[] curveVertexCounts.timeSamples = { 1: [2], 2: [1, 1] }\n"),
         "the numbers of points of 1 object change", 1},
        {CURVES("/* a \" { */ asset a = @@@x@y@@@ // }\n"), "", 1},
        {CURVES("uniform token visibility = \"invisible\"\n"), "", 1}, // all hair is hidden
        {"#usda 1.0\ndef Xform \"a\"\n{\n" OTHER(
             "uniform token type = \"linear\"\n" REST) "}\ndef Xform \"b\" (\ninstanceable = "
                                                       "true\nreferences = </a>\n)\n{\n}\n",
         "", 2},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        Error error = {""};
        StrandsReport report;
        StrandsReadOptions strict = {.strict = true};
        Strands strands =
            read_text(cases[i].text, strlen(cases[i].text), &report, RESULT_OK, &error);
        assert_int_equal(strands.strand_count, cases[i].strands);
        if (!strstr(report.note, cases[i].says)) fail_msg("%s: %s", cases[i].text, report.note);
        strands_destroy(&strands);
        Result result = reading_text(&strands, cases[i].text, &strict, NULL, &error);
        if ((result == RESULT_OK) != !*cases[i].says) fail_msg("%s: %d", cases[i].text, result);
        strands_destroy(&strands);
    }
}

static void objects_are_groups_and_can_be_chosen(void **state)
{
    (void)state;
    const char *text = METRIC OTHER("float[] primvars:Cd = [1, 1, 1]\n" REST) CURVES("");
    StrandsReport report;
    Strands strands;
    StrandsReadOptions options = {.objects = "!oth*"};
    assert_int_equal(reading_text(&strands, text, NULL, &report, NULL), RESULT_OK);
    assert_int_equal(strands.strand_count, 2);
    assert_true(strands.strand_group[0] == 0 && strands.strand_group[1] == 1);
    assert_non_null(strstr(report.note, "not all objects have it: colours"));
    assert_string_equal(report.contents.object[1].path, "/x");
    strands_destroy(&strands);
    assert_int_equal(reading_text(&strands, text, &options, &report, NULL), RESULT_OK);
    assert_int_equal(strands.strand_count, 1);
    assert_null(strands.strand_group);
    strands_destroy(&strands);
    options.objects = "/other,none";
    assert_int_equal(reading_text(&strands, text, &options, &report, NULL), RESULT_OK);
    assert_true(strands.color[0][0] == 1);
    strands_destroy(&strands);
    options.objects = "none";
    assert_int_equal(reading_text(&strands, text, &options, &report, NULL), RESULT_BAD_INPUT);
}

static void every_truncation_and_damage_is_survived(void **state)
{
    (void)state;
    size_t size = strlen(FOREIGN);
    char *text = strdup(FOREIGN);
    static const char marks[] = "\0(){}[]\"'=:,@<#9";
    for (size_t cut = 5; cut + 2 < size; ++cut) {
        Error error = {""};
        read_text(FOREIGN, cut, NULL, RESULT_BAD_INPUT, &error);
        assert_true(error.text[0] != 0);
    }
    for (size_t at = 5; at < size; ++at)
        for (size_t mark = 0; mark < sizeof marks - 1; ++mark) {
            Strands strands;
            const Bytes bytes = {(uint8_t *)text, size};
            text[at] = marks[mark];
            strands_read_bytes(&strands, "FILE", &bytes, NULL, NULL, NULL);
            strands_destroy(&strands);
            text[at] = FOREIGN[at];
        }
    char *deep = malloc(100000), *end = deep + sprintf(deep, "#usda 1.0\n");
    for (int i = 0; i < 5000; ++i) end += sprintf(end, "def X \"x\"\n{\n");
    Error error = {""};
    read_text(deep, strlen(deep), NULL, RESULT_BAD_INPUT, &error);
    assert_non_null(strstr(error.text, "deep"));
    free(deep);
    free(text);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)
    const struct CMUnitTest tests[] = {
        TEST(a_still_is_one_prim_with_its_points),
        TEST(frames_are_time_samples),
        TEST(everything_that_strands_have_is_written),
        TEST(what_is_written_is_read_to_the_bit),
        TEST(curves_of_other_programs_are_read),
        TEST(the_material_of_fibres_is_in_the_files_unit),
        TEST(materials_of_other_programs_are_read),
        TEST(long_strings_are_skipped_whole),
        TEST(what_would_give_other_hair_is_refused_with_its_line),
        TEST(one_bad_part_does_not_cost_the_whole),
        TEST(objects_are_groups_and_can_be_chosen),
        TEST(cubic_curves_become_points_on_them),
        TEST(attributes_of_cubic_curves_go_to_their_points),
        TEST(transforms_act_in_their_order),
        TEST(all_times_of_points_and_transforms_are_frames),
        TEST(orientations_take_the_shortest_way),
        TEST(what_is_not_drawn_is_left_out_and_counted),
        TEST(every_truncation_and_damage_is_survived),
        TEST(a_file_that_is_not_finished_is_not_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
