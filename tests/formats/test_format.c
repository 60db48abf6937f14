// SPDX-License-Identifier: MIT
// The table of hair file formats: written files are recognised and read back exactly.
#include "base/bytes.h"
#include "base/random.h"
#include "formats/format.h"
#include "formats/strands_read.h"
#include "gen/strands_make.h"
#include "image/image.h"
#include "strands/strands.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const StrandsReadOptions METRES = {.unit = 1.0f};

// Awkward numbers: random bits of floats of normal size.
static Strands make_awkward(void)
{
    StrandsRecipe recipe = strands_make_recipe(STRANDS_STYLE_CURLS);
    recipe.count = 40;
    recipe.vertices = 9;
    Strands strands;
    assert_int_equal(strands_make(&strands, &recipe, NULL), RESULT_OK);
    Random random = random_create(1, 2);
    for (uint32_t v = 0; v < strands.vertex_count; v++)
        for (int i = 0; i < 3; i++)
            strands.position[v][i] *= (float)(1.0 + 1e-3 * random_real(&random));
    strands.position[0][0] = -0.0f;
    return strands;
}

static Strands read_back(void **state, FormatKind kind, const Strands *strands,
                         const StrandsReadOptions *options)
{
    Error error = {""};
    Strands back;
    const char *path = temporary_path(state, "hair");
    if (format_write(path, kind, strands, &error) != RESULT_OK) fail_msg("%s", error.text);
    if (strands_read(&back, path, options, NULL, &error) != RESULT_OK) fail_msg("%s", error.text);
    assert_int_equal(back.strand_count, strands->strand_count);
    assert_memory_equal(back.first, strands->first, 4 * (size_t)(strands->strand_count + 1));
    return back;
}

static void rows_of_the_table_are_complete(void **state)
{
    (void)state;
    char words[] = FORMAT_WORDS, text[400];
    int written = 0, word_count = 0;
    for (char *at = words; *at; at++) word_count += *at == '|';
    for (FormatKind kind = 0; kind < FORMAT_KINDS; kind++) {
        const Format *format = FORMAT_TABLE[kind];
        assert_true(format && format->match && format->read && format->suffix[0] == '.');
        if (format->write) assert_int_equal(kind, written++); // names are in the order of kinds
        format_list_names(text, sizeof text);
        assert_non_null(strstr(text, format->name));
        format_list_suffixes(text, sizeof text);
        assert_true(!format->write || strstr(text, format->suffix));
    }
    assert_int_equal(written, word_count);
}

static void reading_back_gives_the_same_bits(void **state)
{
    Strands strands = make_awkward();
    for (FormatKind kind = 0; kind < FORMAT_KINDS; kind++) {
        if (!FORMAT_TABLE[kind]->write) continue;
        Strands back = read_back(state, kind, &strands, &METRES);
        assert_memory_equal(back.position, strands.position, 12 * (size_t)strands.vertex_count);
        if (FORMAT_TABLE[kind]->features & STRANDS_HAS_STRAND_UV)
            assert_memory_equal(back.strand_uv, strands.strand_uv,
                                8 * (size_t)strands.strand_count);
        strands_destroy(&back);
    }
    strands_destroy(&strands);
}

// Strands of 2 to 5 vertices, of equal size if `even`, with all attributes of the format.
static Strands make_full(const Format *format, uint32_t count, bool even)
{
    Strands strands;
    Random random = random_create(count, even);
    assert_int_equal(strands_create(&strands, count, 5 * count, NULL), RESULT_OK);
    for (uint32_t s = 0; s < count; s++)
        strands.first[s + 1] = strands.first[s] + (even ? 3 : 2 + random_below(&random, 4));
    strands.vertex_count = strands.first[count];
    for (uint32_t v = 0; v < strands.vertex_count; v++)
        for (int i = 0; i < 3; i++)
            strands.position[v][i] = (float)v * 0.01f + 0.003f * (float)random_real(&random);
    if (format->features & STRANDS_HAS_FOLLOWERS) strands.followers = STRANDS_MAX_FOLLOWERS;
    if (format->features & STRANDS_HAS_FOLLOWER_RADIUS) strands.follower_radius = 1e6f;
    if (format->features & STRANDS_HAS_VERTEX_THICKNESS) {
        strands.vertex_thickness = calloc(strands.vertex_count, sizeof(float));
        for (uint32_t v = 0; v < strands.vertex_count; v++)
            strands.vertex_thickness[v] = 1e-5f * (float)(1 + v % 7);
    }
    if (format->features & STRANDS_HAS_COLOR) { // multiples of 1/255, which all formats can hold
        strands.color = malloc(strands.vertex_count * sizeof *strands.color);
        for (uint32_t v = 0; v < strands.vertex_count; v++)
            for (uint32_t k = 0; k < 4; k++) {
                double level = (37 * v + 91 * k) % 256 / 255.0;
                strands.color[v][k] = (float)(k < 3 ? image_linear_from_srgb(level) : level);
            }
    }
    return strands;
}

// Tests every format and count, especially counts whose bytes look like the start of a text file
// (35 is '#', 118 is 'v', 108 is 'l').
static void what_is_written_is_known_again_and_read_back(void **state)
{
    static const uint32_t COUNTS[] = {1,   2,   9,   10,  13,  32,  35,          47,
                                      80,  102, 103, 108, 111, 115, 118,         123,
                                      147, 255, 256, 291, 374, 547, 9 * 256 + 35};
    for (FormatKind kind = 0; kind < FORMAT_KINDS; kind++) {
        const Format *format = FORMAT_TABLE[kind];
        for (size_t i = 0; format->write && i < sizeof COUNTS / sizeof *COUNTS; i++) {
            Strands strands = make_full(format, COUNTS[i], format->equal_sizes);
            StrandsReport report;
            Strands back;
            Error error = {""};
            const char *path = temporary_path(state, "hair");
            if (format_write(path, kind, &strands, &error) != RESULT_OK) fail_msg("%s", error.text);
            if (strands_read(&back, path, &METRES, &report, &error) != RESULT_OK)
                fail_msg("%s, %u strands: %s", format->name, COUNTS[i], error.text);
            if (report.kind != kind)
                fail_msg("%u strands of %s: taken for %s", COUNTS[i], format->name,
                         FORMAT_TABLE[report.kind]->name);
            assert_int_equal(back.strand_count, strands.strand_count);
            assert_memory_equal(back.first, strands.first, 4 * (size_t)(strands.strand_count + 1));
            assert_memory_equal(back.position, strands.position, 12 * (size_t)strands.vertex_count);
            assert_int_equal(back.followers, strands.followers);
            assert_true(back.follower_radius == strands.follower_radius);
            if (strands.color && !back.color) fail_msg("%s: no colours", format->name);
            for (uint32_t v = 0; strands.color && v < strands.vertex_count; v++)
                for (int k = 0; k < 4; k++)
                    // HAIR files store 1 - opacity, which is rounded to 2^-24 at most.
                    if (fabsf(back.color[v][k] - strands.color[v][k]) > (k == 3 ? 0x1p-24f : 0))
                        fail_msg("%s: colour %d of vertex %u: %.9g, not %.9g", format->name, k, v,
                                 (double)back.color[v][k], (double)strands.color[v][k]);
            if (strands.vertex_thickness)
                assert_memory_equal(back.vertex_thickness, strands.vertex_thickness,
                                    4 * (size_t)strands.vertex_count);
            strands_destroy(&strands);
            strands_destroy(&back);
        }
    }
}

// Files that start with a count instead of a signature, with every first byte, against all formats;
// `floats`: numbers per vertex.
static void every_first_byte_of_a_count_is_told_from_text(void **state)
{
    (void)state;
    for (int floats = 3; floats <= 7; floats += 4)
        for (uint32_t count = 1; count <= 600; count++) {
            size_t words = 1 + count * (size_t)(1 + 2 * floats);
            uint32_t *file = calloc(words + 1, 4);
            file[0] = count;
            for (uint32_t s = 0; s < count; s++) file[1 + s * (size_t)(1 + 2 * floats)] = 2;
            Bytes bytes = {(uint8_t *)file, 4 * words};
            FormatKind kind = format_detect(&bytes),
                       expected = floats == 3 ? FORMAT_SALON_DATA : FORMAT_SALON_BIN;
            if (kind != expected)
                fail_msg("%u strands: %s", count,
                         kind < FORMAT_KINDS ? FORMAT_TABLE[kind]->name : "unknown");
            free(file);
        }
}

static void more_followers_than_all_formats_hold_are_refused(void **state)
{
    Error error = {""};
    Strands strands = make_awkward(), back;
    const char *path = temporary_path(state, "hair");
    static const FormatKind kinds[] = {FORMAT_TFX2, FORMAT_TFX3, FORMAT_USD, FORMAT_NPZ};
    strands.followers = 2000000000;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        assert_int_equal(format_write(path, kinds[i], &strands, &error), RESULT_OK);
        assert_int_equal(strands_read(&back, path, &METRES, NULL, &error), RESULT_BAD_INPUT);
        assert_non_null(strstr(error.text, "followers"));
    }
    strands_destroy(&strands);
}

static void what_was_written_in_metres_is_guessed_to_be_metres(void **state)
{
    static const FormatKind kinds[] = {FORMAT_TFX2, FORMAT_TFX3, FORMAT_TFX4, FORMAT_HAIR};
    Strands strands = make_awkward();
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        Strands back = read_back(state, kinds[i], &strands, NULL);
        assert_memory_equal(back.position, strands.position, 12 * (size_t)strands.vertex_count);
        strands_destroy(&back);
    }
    strands_destroy(&strands);
}

static void followers_and_fixed_ends_survive_where_the_kind_holds_them(void **state)
{
    Strands strands = make_awkward();
    strands.followers = 3;
    strands.both_ends_fixed = true;
    strands.follower_radius = 0.0123f;
    Strands text = read_back(state, FORMAT_TFX2, &strands, &METRES);
    assert_int_equal(text.followers, 3);
    assert_true(text.both_ends_fixed);
    assert_true(text.follower_radius == 0.0123f);
    Strands tfx3 = read_back(state, FORMAT_TFX3, &strands, &METRES);
    assert_int_equal(tfx3.followers, 3);
    assert_true(tfx3.both_ends_fixed);
    Strands tfx4 = read_back(state, FORMAT_TFX4, &strands, &METRES);
    assert_true(tfx4.mobility[0] == 0.0f && tfx4.mobility[1] == 1.0f && tfx4.mobility[8] == 0.0f);
    strands_destroy(&text);
    strands_destroy(&tfx3);
    strands_destroy(&tfx4);
    strands_destroy(&strands);
}

// Strand 0 of 2 vertices, strand 1 of 3.
static Strands make_uneven(void)
{
    Strands strands;
    assert_int_equal(strands_create(&strands, 2, 5, NULL), RESULT_OK);
    strands.first[1] = 2;
    strands.first[2] = 5;
    for (uint32_t v = 0; v < 5; v++) strands.position[v][1] = 0.1f * (float)v;
    return strands;
}

static void uneven_strands_go_into_text_and_hair_only(void **state)
{
    Strands strands = make_uneven();
    Error error;
    for (FormatKind kind = FORMAT_TFX4; kind <= FORMAT_TFX3; kind++) {
        assert_int_equal(format_write(temporary_path(state, "x"), kind, &strands, &error),
                         RESULT_FAILED);
        assert_non_null(strstr(error.text, "strand 1 has 3 vertices, strand 0 has 2"));
        assert_false(temporary_has(state, "x"));
    }
    Strands text = read_back(state, FORMAT_TFX2, &strands, &METRES);
    Strands hair = read_back(state, FORMAT_HAIR, &strands, &METRES);
    assert_memory_equal(hair.position, strands.position, 12 * 5);
    strands_destroy(&text);
    strands_destroy(&hair);
    strands_destroy(&strands);
}

// The array of transparencies, bit 3 of the header's word at byte 12, is written only if it says
// something; one vertex is enough.
static void hair_files_have_transparency_only_if_hair_is_transparent(void **state)
{
    Strands strands = make_uneven();
    strands.color = malloc(strands.vertex_count * sizeof *strands.color);
    assert_non_null(strands.color);
    for (uint32_t v = 0; v < strands.vertex_count; v++)
        for (int k = 0; k < 4; k++) strands.color[v][k] = k < 3 ? 0.25f : 1;
    for (uint32_t clear = 0; clear <= strands.vertex_count; clear++) { // the last: none
        if (clear < strands.vertex_count) strands.color[clear][3] = 0.5f;
        Strands back = read_back(state, FORMAT_HAIR, &strands, &METRES);
        Bytes file;
        assert_int_equal(bytes_read_file(&file, temporary_path(state, "hair"), NULL), RESULT_OK);
        assert_int_equal(file.data[12] >> 3 & 1, clear < strands.vertex_count);
        assert_memory_equal(back.color, strands.color, strands.vertex_count * sizeof *back.color);
        bytes_destroy(&file);
        strands_destroy(&back);
        if (clear < strands.vertex_count) strands.color[clear][3] = 1;
    }
    strands_destroy(&strands);
}

static Strands read_obj(void **state, const char *text, Result expected, Error *error)
{
    Strands strands;
    temporary_write(state, "x.obj", text, 0644);
    Result result = strands_read(&strands, temporary_path(state, "x.obj"), &METRES, NULL, error);
    if (result != expected) fail_msg("%s: %d, %s", text, result, error->text);
    return strands;
}

static void lines_of_obj_files_are_strands(void **state)
{
    Error error = {""};
    Strands a = read_obj(state,
                         "# a\nmtllib x\nv 0 0 0\nv 0 1 0 1 0 0\nv 0 2 0\nvt 0 0\nl 1 2/1 3\n"
                         "v 5 0 0\nv 5 1 0\nl -2 -1 # b\nf 1 2 3\nl 3 \\\n2\n",
                         RESULT_OK, &error);
    assert_int_equal(a.strand_count, 3);
    assert_int_equal(strands_size(&a, 0), 3);
    assert_int_equal(strands_size(&a, 1), 2);
    assert_true(a.position[3][0] == 5 && a.position[4][1] == 1 && a.position[6][1] == 1);
    // Edges in any order and direction: the end with the lower number is the root.
    static const char *const orders[] = {"l 1 2\nl 4 5\nl 2 3\nl 5 6\n",
                                         "l 2 3\nl 1 2\nl 5 6\nl 4 5\n",
                                         "l 1 2\nl 3 2\nl 4 5\nl 6 5\n"};
    for (size_t i = 0; i < sizeof orders / sizeof *orders; ++i) {
        char text[200];
        snprintf(text, sizeof text, "v 0 0 0\nv 0 1 0\nv 0 2 0\nv 1 0 0\nv 1 1 0\nv 1 2 0\n%s",
                 orders[i]);
        Strands chains = read_obj(state, text, RESULT_OK, NULL);
        assert_int_equal(chains.strand_count, 2);
        for (int v = 0; v < 6; ++v)
            assert_true(chains.position[v][0] == (float)(v / 3) &&
                        chains.position[v][1] == (float)(v % 3));
        strands_destroy(&chains);
    }
    Strands edges = read_obj(state, "v 0 0 0\nv 0 1 0\nv 0 2 0\nl 1 2\nl 2 3\nl 1 3\n", RESULT_OK,
                             &error); // two edges of one strand, and an edge of another
    assert_int_equal(edges.strand_count, 2);
    assert_int_equal(strands_size(&edges, 0), 3);
    strands_destroy(&a);
    strands_destroy(&edges);
}

static void broken_obj_files_are_refused_with_their_line(void **state)
{
    static const struct {
        const char *text, *says;
    } cases[] = {{"v 0 0 0\nv 0 1 0\nf 1 2 1\n", "a mesh of 2 vertices and 1 faces"},
                 {"v 0 0 0\nv 0 1 0\nl 1 3\n", "x.obj:3: "},
                 {"v 0 0 0\nl 1 0\n", "x.obj:2: "},
                 {"v 0 0 0\nl 1 -2\n", "x.obj:2: "},
                 {"v 0 0 0\nl 1 x\n", "x.obj:2: "},
                 {"v 0 0 0\nv 0 1 0\nl 1/1 2/x\n", "x.obj:3: "},
                 {"v 0 0 0\nl 1\n", "x.obj:2: a line of 1 vertices"},
                 {"v 0 0 0\nl\n", "x.obj:2: "},
                 {"l 1 2\nv 0 0 0\nv 0 1 0\n", "x.obj:1: "},
                 {"v 0 0\nv 0 1 0\nl 1 2\n", "x.obj:1: "},
                 {"v 0 a 0\nv 0 1 0\nl 1 2\n", "x.obj:1: "},
                 {"v 0 0 0\nv 0 nan 0\nl 1 2\n", "x.obj:2: 1 strand"},
                 {"#usda 1.0\n", "no BasisCurves"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Error error = {""};
        read_obj(state, cases[i].text, RESULT_BAD_INPUT, &error);
        if (!strstr(error.text, cases[i].says)) fail_msg("%s: %s", cases[i].text, error.text);
    }
}

static void what_a_kind_cannot_hold_is_known(void **state)
{
    (void)state;
    Strands strands = make_awkward();
    char text[300];
    assert_int_equal(strands_features(&strands), STRANDS_HAS_STRAND_UV);
    strands.followers = 2;
    strands.follower_radius = 0.01f;
    strands.vertex_thickness = calloc(strands.vertex_count, sizeof(float));
    uint32_t features = strands_features(&strands);
    strands_features_describe(features & ~FORMAT_TABLE[FORMAT_TFX3]->features, text, sizeof text);
    assert_string_equal(text, "thickness of vertices, radius of followers");
    strands_features_describe(features & ~FORMAT_TABLE[FORMAT_USD]->features, text, sizeof text);
    assert_string_equal(text, "");
    strands_features_describe(UINT32_MAX, text, sizeof text);
    assert_true(strlen(text) < sizeof text - 1);
    strands_destroy(&strands);
}

static void other_kinds_can_only_be_read(void **state)
{
    Strands strands = make_uneven();
    Error error;
    const char *path = temporary_path(state, "x");
    assert_int_equal(format_write(path, FORMAT_SALON_BIN, &strands, &error), RESULT_FAILED);
    assert_non_null(strstr(error.text, "can be read but not written"));
    assert_int_equal(temporary_count_files(((Temporary *)*state)->folder), 0);
    strands_destroy(&strands);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)
    const struct CMUnitTest tests[] = {
        TEST(rows_of_the_table_are_complete),
        TEST(reading_back_gives_the_same_bits),
        TEST(what_is_written_is_known_again_and_read_back),
        TEST(every_first_byte_of_a_count_is_told_from_text),
        TEST(more_followers_than_all_formats_hold_are_refused),
        TEST(what_was_written_in_metres_is_guessed_to_be_metres),
        TEST(followers_and_fixed_ends_survive_where_the_kind_holds_them),
        TEST(uneven_strands_go_into_text_and_hair_only),
        TEST(hair_files_have_transparency_only_if_hair_is_transparent),
        TEST(lines_of_obj_files_are_strands),
        TEST(broken_obj_files_are_refused_with_their_line),
        TEST(what_a_kind_cannot_hold_is_known),
        TEST(other_kinds_can_only_be_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
