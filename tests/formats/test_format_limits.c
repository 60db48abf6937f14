// SPDX-License-Identifier: MIT
// What a hair file may leave out, and the thresholds of a reader's guesses: defaults of every kind,
// and both sides of every threshold.
#include "formats/format.h"
#include "support/reading.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// --- Thresholds.

// The unit guessed for one strand of `length` units in a file of USC-HairSalon, which does not
// contain its unit.
static float guessed_unit(float length)
{
    const struct {
        uint32_t strands, size;
        float position[2][3];
    } data = {1, 2, {{0, 0, 0}, {0, length, 0}}};
    Strands strands;
    StrandsReport report;
    assert_int_equal(reading_copy(&strands, &data, sizeof data, NULL, &report, NULL), RESULT_OK);
    strands_destroy(&strands);
    return report.unit_used;
}

// The same for a text file; the strand starts at the origin.
static float guessed_unit_of_text(float length)
{
    char text[200];
    snprintf(text, sizeof text, "numStrands 1\nis sorted 1\nstrand 0 numVerts 2\n0 %.9g 0\n0 0 0\n",
             (double)length);
    Strands strands;
    StrandsReport report;
    assert_int_equal(reading_text(&strands, text, NULL, &report, NULL), RESULT_OK);
    strands_destroy(&strands);
    return report.unit_used;
}

// The height of a head, 0.35 m, times 10 and times 10 sqrt(1000); 5 units in text.
static void units_change_at_their_thresholds(void **state)
{
    (void)state;
    static const struct {
        float length, unit;
    } CASES[] = {{3.49f, 1}, {3.51f, 0.01f}, {110.6f, 0.01f}, {110.8f, 0.001f}},
      TEXTS[] = {{4.99f, 1}, {5.01f, 0.01f}, {400, 0.01f}};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++)
        assert_true(guessed_unit(CASES[i].length) == CASES[i].unit);
    for (size_t i = 0; i < sizeof TEXTS / sizeof *TEXTS; i++)
        assert_true(guessed_unit_of_text(TEXTS[i].length) == TEXTS[i].unit);
}

// Angles of up to a full turn are radians; one larger angle makes all three degrees.
static void angles_beyond_a_turn_are_degrees(void **state)
{
    (void)state;
    static const struct {
        const char *rotation;
        bool degrees;
    } CASES[] = {
        {"0 0 0", false},         {"6.28 6.28 6.28", false}, {"-6.2831855 0 0", false},
        {"0 6.2831855 0", false}, {"6.2835 0 0", false},     {"6.2842 0 0", true},
        {"0 6.6 0", true},        {"0 -6.6 1", true},        {"1 1 6.6", true},
        {"0 0 -90", true},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char text[300];
        float angle[3];
        snprintf(text, sizeof text,
                 "rotation %s numStrands 1 is sorted 1\nstrand 0 numVerts 2\n0 0 0\n0 0 1\n",
                 CASES[i].rotation);
        sscanf(CASES[i].rotation, "%f %f %f", &angle[0], &angle[1], &angle[2]);
        StrandsReport report;
        Strands strands = reading_good(text, &report);
        assert_int_equal(report.rotation_was_deg, CASES[i].degrees);
        float unit = CASES[i].degrees ? 0.0174532925f : 1, *tip = strands.position[1];
        // In any order of the three, a rotation about x or y alone takes z away from the tip.
        if (angle[2] == 0 && (angle[0] == 0 || angle[1] == 0))
            assert_true(fabsf(tip[2] - cosf(angle[0] * unit) * cosf(angle[1] * unit)) < 1e-6f);
        strands_destroy(&strands);
    }
}

// --- Binary TressFX.

enum { LINES = 2, SIZE = 3, COUNT = LINES * SIZE, TFX3_BYTES = 296, TFX4_BYTES = 160 };

// Two strands of three vertices; if `full`, with all possible arrays.
static Strands make_strands(bool full)
{
    Strands strands;
    assert_int_equal(strands_create(&strands, LINES, COUNT, NULL), RESULT_OK);
    for (uint32_t s = 0; s < LINES; s++) strands.first[s + 1] = SIZE * (s + 1);
    for (uint32_t v = 0; v < COUNT; v++)
        for (int k = 0; k < 3; k++) strands.position[v][k] = 0.1f * (float)v + 0.01f * (float)k;
    if (!full) return strands;
    strands.strand_uv = malloc(LINES * sizeof *strands.strand_uv);
    strands.strand_thickness = malloc(LINES * sizeof *strands.strand_thickness);
    strands.vertex_uv = malloc(COUNT * sizeof *strands.vertex_uv);
    strands.color = malloc(COUNT * sizeof *strands.color);
    for (int i = 0; i < 2 * LINES; i++) strands.strand_uv[i / 2][i % 2] = 0.1f * (float)i;
    for (int s = 0; s < LINES; s++) strands.strand_thickness[s] = 1 + (float)s;
    for (int i = 0; i < 2 * COUNT; i++) strands.vertex_uv[i / 2][i % 2] = 0.03f * (float)i;
    for (int i = 0; i < 4 * COUNT; i++) strands.color[i / 4][i % 4] = 0.02f * (float)i;
    return strands;
}

static Bytes make_file(void **state, FormatKind kind, const Strands *strands)
{
    Bytes bytes = {0};
    const char *path = temporary_path(state, "sample");
    assert_int_equal(format_write(path, kind, strands, NULL), RESULT_OK);
    assert_int_equal(bytes_read_file(&bytes, path, NULL), RESULT_OK);
    return bytes;
}

static void versions_3_and_4_are_taken_and_no_others(void **state)
{
    static const struct {
        FormatKind kind;
        float version;
        bool taken;
    } CASES[] = {
        {FORMAT_TFX3, 2.99f, false}, {FORMAT_TFX3, 3, true},     {FORMAT_TFX3, 3.9f, true},
        {FORMAT_TFX4, 4, true},      {FORMAT_TFX4, 4.9f, true},  {FORMAT_TFX4, 5, false},
        {FORMAT_TFX4, -4, false},    {FORMAT_TFX4, 4e8f, false},
    };
    Strands made = make_strands(true);
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        Bytes bytes = make_file(state, CASES[i].kind, &made);
        memcpy(bytes.data, &CASES[i].version, 4);
        Strands strands;
        StrandsReport report;
        Error error = {""};
        Result result = reading_copy(&strands, bytes.data, bytes.size, &METRES, &report, &error);
        assert_int_equal(result, CASES[i].taken ? RESULT_OK : RESULT_BAD_INPUT);
        if (CASES[i].taken) assert_int_equal(report.kind, CASES[i].kind);
        strands_destroy(&strands);
        bytes_destroy(&bytes);
    }
    strands_destroy(&made);
}

// An array of a file: where the header stores its offset, and its length in bytes.
typedef struct Position {
    FormatKind kind;
    size_t at, bytes;
} Position;

static const Position PLACES[] = {
    {FORMAT_TFX3, 144, 12 * COUNT}, {FORMAT_TFX3, 148, 4 * LINES}, {FORMAT_TFX3, 152, 8 * LINES},
    {FORMAT_TFX3, 156, 16 * COUNT}, {FORMAT_TFX3, 164, 8 * COUNT}, {FORMAT_TFX4, 12, 16 * COUNT},
    {FORMAT_TFX4, 16, 8 * LINES},   {FORMAT_TFX4, 20, 8 * COUNT},  {FORMAT_TFX4, 24, 4 * LINES},
    {FORMAT_TFX4, 28, 16 * COUNT},
};

static void assert_equal_arrays(const Strands *a, const Strands *b)
{
    assert_memory_equal(a->position, b->position, COUNT * sizeof *a->position);
    assert_memory_equal(a->strand_uv, b->strand_uv, LINES * sizeof *a->strand_uv);
    assert_memory_equal(a->strand_thickness, b->strand_thickness, LINES * sizeof(float));
    assert_memory_equal(a->vertex_uv, b->vertex_uv, COUNT * sizeof *a->vertex_uv);
    assert_memory_equal(a->color, b->color, COUNT * sizeof *a->color);
}

// Each array in turn is moved to the file's end, or its offset is set to 0.
static void arrays_may_lie_in_any_order(void **state)
{
    Strands made = make_strands(true);
    for (size_t i = 0; i < sizeof PLACES / sizeof *PLACES; i++) {
        const Position *place = &PLACES[i];
        Bytes bytes = make_file(state, place->kind, &made);
        uint32_t from, to = (uint32_t)bytes.size;
        memcpy(&from, bytes.data + place->at, 4);
        bytes.data = realloc(bytes.data, bytes.size + place->bytes);
        memcpy(bytes.data + to, bytes.data + from, place->bytes);
        memset(bytes.data + from, 255, place->bytes); // NaN
        memcpy(bytes.data + place->at, &to, 4);
        Strands strands;
        StrandsReport report;
        assert_int_equal(
            reading_copy(&strands, bytes.data, bytes.size + place->bytes, &METRES, &report, NULL),
            RESULT_OK);
        assert_true(strands_report_is_clean(&report));
        assert_equal_arrays(&strands, &made);
        strands_destroy(&strands);
        bytes_destroy(&bytes);
    }
    strands_destroy(&made);
}

// --- Cem Yuksel's HAIR.

enum { POINTS = 2, THICKNESS = 4, TRANSPARENCY = 8, COLOR = 16 };

// Two strands of three vertices; each array that the bits select has its own values.
static Result read_hair(Strands *strands, uint32_t arrays, uint32_t broken, StrandsReport *report)
{
    struct {
        char name[4];
        uint32_t strands, points, arrays, segments;
        float thickness, transparency, color[3];
        char info[88];
        float more[COUNT * 8];
    } data = {"HAIR", LINES, COUNT, POINTS | arrays, SIZE - 1, 7, 0.25f, {0.5f, 0.6f, 0.7f},
              "",     {0}};
    size_t count = 0;
    for (int i = 0; i < 3 * COUNT; i++) data.more[count++] = 0.1f * (float)i;
    for (int i = 0; (arrays & THICKNESS) && i < COUNT; i++) data.more[count++] = 1 + (float)i;
    for (int i = 0; (arrays & TRANSPARENCY) && i < COUNT; i++) data.more[count++] = 0.75f;
    for (int i = 0; (arrays & COLOR) && i < 3 * COUNT; i++) data.more[count++] = 0.125f;
    if (broken) data.more[broken] = NAN;
    return reading_copy(strands, &data, 128 + 4 * count, &METRES, report, NULL);
}

static void what_hair_files_leave_out_has_their_defaults(void **state)
{
    (void)state;
    static const struct {
        uint32_t arrays;
        bool colored;
        float color[4];
        float thickness; // of the last vertex; 0: none
    } CASES[] = {
        {0, false, {0}, 0},
        {THICKNESS, false, {0}, COUNT},
        {TRANSPARENCY, true, {0.5f, 0.6f, 0.7f, 0.25f}, 0},
        {COLOR, true, {0.125f, 0.125f, 0.125f, 0.75f}, 0},
        {COLOR | TRANSPARENCY, true, {0.125f, 0.125f, 0.125f, 0.25f}, 0},
        {THICKNESS | COLOR | TRANSPARENCY, true, {0.125f, 0.125f, 0.125f, 0.25f}, COUNT},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        Strands strands;
        StrandsReport report;
        assert_int_equal(read_hair(&strands, CASES[i].arrays, 0, &report), RESULT_OK);
        assert_true(strands_report_is_clean(&report));
        assert_int_equal(strands.color != NULL, CASES[i].colored);
        assert_int_equal(strands.vertex_thickness != NULL, CASES[i].thickness > 0);
        for (int v = 0; strands.color && v < COUNT; v++)
            assert_memory_equal(strands.color[v], CASES[i].color, sizeof CASES[i].color);
        if (strands.vertex_thickness)
            assert_true(strands.vertex_thickness[COUNT - 1] == CASES[i].thickness);
        strands_destroy(&strands);
    }
}

// The message names the vertex's first byte.
static void a_defect_is_reported_with_its_byte(void **state)
{
    (void)state;
    for (uint32_t number = 1; number < 3 * COUNT; number++) {
        Strands strands;
        StrandsReport report;
        assert_int_equal(read_hair(&strands, THICKNESS, number, &report), RESULT_OK);
        const Defect *defect = &report.defects[DEFECT_NOT_FINITE];
        assert_int_equal(defect->count, 1);
        assert_int_equal(defect->first_place, 128 + number / 3 * 12);
        assert_int_equal(strands.strand_count, 1);
        strands_destroy(&strands);
    }
}

// --- All kinds.

// Strands with positions only are read back without other attributes, except that text always has
// UVs and version 4 always has mobilities.
static void what_was_not_written_is_not_there(void **state)
{
    Strands made = make_strands(false);
    for (FormatKind kind = 0; kind < FORMAT_KINDS; kind++) {
        if (!FORMAT_TABLE[kind]->write) continue;
        Bytes bytes = make_file(state, kind, &made);
        Strands strands;
        StrandsReport report;
        assert_int_equal(reading_copy(&strands, bytes.data, bytes.size, NULL, &report, NULL),
                         RESULT_OK);
        const char *name = FORMAT_TABLE[kind]->name;
        if (strands.vertex_uv || strands.strand_thickness || strands.vertex_thickness ||
            strands.color || strands.followers || strands.follower_radius != 0 ||
            strands.both_ends_fixed || (strands.strand_uv && kind != FORMAT_TFX2) ||
            (strands.mobility && kind != FORMAT_TFX4) || report.unit_used != 1 || report.up_z)
            fail_msg("%s has more than was written", name);
        for (uint32_t s = 0; strands.strand_uv && s < LINES; s++)
            assert_true(strands.strand_uv[s][0] == 0 && strands.strand_uv[s][1] == 0);
        for (uint32_t v = 0; strands.mobility && v < COUNT; v++)
            assert_true(strands.mobility[v] == (v % SIZE ? 1.0f : 0.0f));
        strands_destroy(&strands);
        bytes_destroy(&bytes);
    }
    strands_destroy(&made);
}

#define CURVES(more)                                                                               \
    "def BasisCurves \"x\"\n{\nuniform token type = \"linear\"\n"                                  \
    "int[] curveVertexCounts = [2]\npoint3f[] points = [(0, 0, 0), (0, 0.5, 0)]\n" more "}\n"

#define PLY(more, vertex)                                                                          \
    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"                \
    "property float z\n" more "element edge 1\nproperty int vertex1\nproperty int vertex2\n"       \
    "end_header\n0 0 0" vertex "\n0 0.5 0" vertex "\n0 1\n"

#define RGB   "property float red\nproperty float green\nproperty float blue\n"
#define BYTES "property uchar red\nproperty uchar green\nproperty uchar blue\n"

// Defaults as the formats define them; 128/255 in sRGB is 0.2158605 in linear light.
static const struct {
    const char *text;
    float unit, tip[3];
    bool colored;
    float color[4];
} TEXTS[] = {
    {"#usda 1.0\n" CURVES(""), 0.01f, {0, 0.005f, 0}, false, {0}},
    {"#usda 1.0\n(\nmetersPerUnit = 1\n)\n" CURVES(""), 1, {0, 0.5f, 0}, false, {0}},
    {"#usda 1.0\n(\nupAxis = \"Z\"\n)\n" CURVES(""), 0.01f, {0, 0, -0.005f}, false, {0}},
    {"#usda 1.0\n(\ndoc = \"it says \\\"upAxis = 'Z'\\\" (\"\n)\n" CURVES(""),
     0.01f,
     {0, 0.005f, 0},
     false,
     {0}},
    {"#usda 1.0\n" CURVES("string a = \"\\\"\"\nstring b = \"}\\\\\"\nstring c = '\\''\n"
                          "string d = \"\"\"\"x\" \\\"\"\"\"\nfloat[] widths = [1]\n"),
     0.01f,
     {0, 0.005f, 0},
     false,
     {0}},
    {"#usda 1.0\n" CURVES("color3f[] primvars:displayColor = [(0.5, 0.25, 1)]\n"),
     0.01f,
     {0, 0.005f, 0},
     true,
     {0.5f, 0.25f, 1, 1}},
    {"#usda 1.0\n" CURVES("float[] primvars:displayOpacity = [0.5]\n"),
     0.01f,
     {0, 0.005f, 0},
     true,
     {1, 1, 1, 0.5f}},
    {PLY("", ""), 1, {0, 0.5f, 0}, false, {0}},
    {PLY(RGB, " 0.5 0.25 1"), 1, {0, 0.5f, 0}, true, {0.5f, 0.25f, 1, 1}},
    {PLY(RGB "property float alpha\n", " 0.5 0.25 1 0.5"),
     1,
     {0, 0.5f, 0},
     true,
     {0.5f, 0.25f, 1, 0.5f}},
    {PLY(BYTES, " 128 0 255"), 1, {0, 0.5f, 0}, true, {0.2158605f, 0, 1, 1}},
    {PLY(BYTES "property uchar alpha\n", " 128 0 255 51"),
     1,
     {0, 0.5f, 0},
     true,
     {0.2158605f, 0, 1, 0.2f}},
    {PLY("property uchar alpha\n", " 51"), 1, {0, 0.5f, 0}, false, {0}},
};

static void what_texts_leave_out_has_its_default(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof TEXTS / sizeof *TEXTS; i++) {
        Strands strands;
        StrandsReport report;
        Error error = {""};
        if (reading_text(&strands, TEXTS[i].text, NULL, &report, &error) != RESULT_OK)
            fail_msg("%s", error.text);
        bool good = report.unit_used == TEXTS[i].unit && strands.vertex_count == 2 &&
                    (strands.color != NULL) == TEXTS[i].colored;
        for (int k = 0; good && k < 3; k++)
            good = fabsf(strands.position[1][k] - TEXTS[i].tip[k]) < 1e-8f;
        for (int k = 0; good && strands.color && k < 4; k++)
            good = fabsf(strands.color[1][k] - TEXTS[i].color[k]) < 1e-6f;
        if (!good) fail_msg("read as something else: %s", TEXTS[i].text);
        strands_destroy(&strands);
    }
}

#define WITH_FILES(test) cmocka_unit_test_setup_teardown(test, temporary_create, temporary_destroy)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(units_change_at_their_thresholds),
        cmocka_unit_test(angles_beyond_a_turn_are_degrees),
        WITH_FILES(versions_3_and_4_are_taken_and_no_others),
        WITH_FILES(arrays_may_lie_in_any_order),
        cmocka_unit_test(what_hair_files_leave_out_has_their_defaults),
        cmocka_unit_test(a_defect_is_reported_with_its_byte),
        WITH_FILES(what_was_not_written_is_not_there),
        cmocka_unit_test(what_texts_leave_out_has_its_default),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
