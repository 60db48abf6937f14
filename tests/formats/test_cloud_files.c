// SPDX-License-Identifier: MIT
// Files of points: .ply of every kind, .npy and .npz, and files that do not contain hair.
#include "formats/format.h"
#include "formats/npy_array.h"
#include "formats/zip.h"
#include "support/reading.h"
#include "support/temporary.h"

#include <libdeflate.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// File contents that are built up piece by piece.
typedef struct Pile {
    uint8_t data[8192];
    size_t size;
} Pile;

static void pile_text(Pile *pile, const char *text)
{
    memcpy(pile->data + pile->size, text, strlen(text));
    pile->size += strlen(text);
}

// The low `size` bytes of a number, most significant first if `big`.
static void pile_number(Pile *pile, uint64_t value, int size, bool big)
{
    for (int i = 0; i < size; i++)
        pile->data[pile->size++] = (uint8_t)(value >> (8 * (big ? size - 1 - i : i)));
}

static void pile_float(Pile *pile, float value, bool big)
{
    uint32_t bits;
    memcpy(&bits, &value, 4);
    pile_number(pile, bits, 4, big);
}

static Strands read_well(const void *data, size_t size, const StrandsReadOptions *options,
                         StrandsReport *report)
{
    Strands strands;
    Error error = {""};
    if (reading_copy(&strands, data, size, options, report, &error) != RESULT_OK)
        fail_msg("%.60s: %s", (const char *)data, error.text);
    return strands;
}

static void refuse(const void *data, size_t size, const StrandsReadOptions *options,
                   const char *says)
{
    Strands strands;
    Error error = {""};
    Result result = reading_copy(&strands, data, size, options, NULL, &error);
    if (result != RESULT_BAD_INPUT && result != RESULT_USAGE)
        fail_msg("%.60s: %d", (const char *)data, result);
    if (!strstr(error.text, says)) fail_msg("'%s' does not say '%s'", error.text, says);
    assert_null(strchr(error.text, '\n'));
}

// --- .ply

// Every type, lists, an unknown element before the vertices and one after, x after y.
static void binary_ply_of_every_type_is_read_in_both_byte_orders(void **state)
{
    (void)state;
    for (int big = 0; big < 2; big++) {
        Pile pile = {.size = 0};
        pile_text(&pile, "ply\r\nformat ");
        pile_text(&pile, big ? "binary_big_endian" : "binary_little_endian");
        pile_text(&pile,
                  " 1.0\r\ncomment end_header\r\nelement junk 2\r\n"
                  "property list uchar double a\r\nproperty int8 b\r\nelement vertex 3\r\n"
                  "property uint16 w\r\nproperty double y\r\nproperty short x\r\n"
                  "property list ushort int l\r\nproperty float32 z\r\nproperty uchar red\r\n"
                  "property uchar green\r\nproperty uchar blue\r\nelement strand 1\r\n"
                  "property uint nsegs\r\nproperty char c\r\nend_header\r\n");
        for (int i = 0; i < 2; i++) {
            pile_number(&pile, (uint64_t)i, 1, big);
            if (i) pile_number(&pile, 77, 8, big);
            pile_number(&pile, 255, 1, big);
        }
        for (int v = 0; v < 3; v++) {
            double y = 0.25 * v;
            uint64_t bits;
            memcpy(&bits, &y, 8);
            pile_number(&pile, 9, 2, big);
            pile_number(&pile, bits, 8, big);
            pile_number(&pile, (uint16_t)(-v), 2, big);
            pile_number(&pile, 1, 2, big);
            pile_number(&pile, 12345, 4, big);
            pile_float(&pile, 0.5f, big);
            pile_number(&pile, 0xff8000, 3, true);
        }
        pile_number(&pile, 2, 4, big);
        pile_number(&pile, 0, 1, big);
        StrandsReport report;
        Strands strands = read_well(pile.data, pile.size, &METRES, &report);
        assert_int_equal(strands.strand_count, 1);
        assert_int_equal(strands_size(&strands, 0), 3);
        assert_true(strands.position[2][0] == -2 && strands.position[2][1] == 0.5f);
        assert_true(strands.position[2][2] == 0.5f && strands.color[1][0] == 1);
        assert_true(strands.color[1][1] > 0.2158f && strands.color[1][1] < 0.2159f); // sRGB
        assert_true(strands.color[1][2] == 0 && strands.color[1][3] == 1);
        assert_true(strands_report_is_clean(&report));
        strands_destroy(&strands);
        for (size_t cut = 0; cut < pile.size; cut++) refuse(pile.data, cut, &METRES, "FILE");
    }
}

#define PLY(more) "ply\nformat ascii 1.0\n" more
#define XYZ       "property float x\nproperty float y\nproperty float z\n"

static void text_ply_with_edges_is_read(void **state)
{
    (void)state;
    const char *text = PLY("element vertex 5\n" XYZ
                           "property float red\nproperty float green\nproperty float blue\n"
                           "element edge 3\nproperty int vertex1\nproperty int vertex2\n"
                           "end_header\n0 0 0 1 0 0\n0 1 0 .5 0 0\n5 0 0 1 1 1\n5 1 0 1 1 1\n\n"
                           "5 2\n0 1 1 1\n0 1\n3 2\n3 4\n");
    StrandsReport report;
    Strands strands = read_well(text, strlen(text), &METRES, &report);
    assert_int_equal(strands.strand_count, 2);
    assert_int_equal(strands_size(&strands, 1), 3);
    assert_true(strands.color[1][0] == 0.5f && strands.position[4][1] == 2);
    assert_string_equal(report.note, "");
    strands_destroy(&strands);
}

// Red, green, blue and alpha with 16 bits, and with 8: each is divided by its largest value.
static void colours_of_whole_numbers_are_shares_of_their_largest(void **state)
{
    (void)state;
    static const struct {
        const char *type, *alpha;
        int most, most_alpha;
    } cases[] = {{"ushort", "ushort", 65535, 65535},
                 {"uchar", "ushort", 255, 65535},
                 {"ushort", "uchar", 65535, 255},
                 {"uchar", "uchar", 255, 255}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[600];
        int most = cases[i].most, alpha = cases[i].most_alpha;
        snprintf(text, sizeof text,
                 PLY("element vertex 2\n" XYZ "property %s red\nproperty %s green\n"
                     "property %s blue\nproperty %s alpha\nelement strand 1\n"
                     "property ushort nsegs\nend_header\n0 0 0 %d 0 %d %d\n0 1 0 %d %d 0 %d\n1\n"),
                 cases[i].type, cases[i].type, cases[i].type, cases[i].alpha, most, most / 5,
                 alpha / 5, most, most, alpha);
        Strands strands = read_well(text, strlen(text), &METRES, &(StrandsReport){0});
        const float *a = strands.color[0], *b = strands.color[1];
        // 0.2 in sRGB is ((0.2 + 0.055) / 1.055)^2.4
        assert_true(a[0] == 1 && a[1] == 0 && fabsf(a[2] - 0.0331048f) < 1e-6f);
        assert_true(fabsf(a[3] - 0.2f) < 1e-7f);
        assert_true(b[0] == 1 && b[1] == 1 && b[2] == 0 && b[3] == 1);
        strands_destroy(&strands);
    }
}

// `strands` of `points` points each, with roots far apart; `odd` adds a point to the first strand.
static char *make_cloud(int strands, int points, bool odd)
{
    char *text = malloc((size_t)(strands * points + 8) * 32 + 200), *at = text;
    at += sprintf(at, PLY("element vertex %d\n" XYZ "end_header\n"), strands * points + odd);
    for (int s = 0; s < strands; s++)
        for (int v = 0; v < points + (odd && s == 0); v++)
            at += sprintf(at, "%g %g 0\n", 0.3 * s, 0.01 * v);
    return text;
}

static void bare_points_become_strands(void **state)
{
    (void)state;
    StrandsReport report;
    char *text = make_cloud(6, 12, false), *odd = make_cloud(6, 12, true);
    Strands strands = read_well(text, strlen(text), &METRES, &report);
    assert_int_equal(strands.strand_count, 6);
    assert_string_equal(report.note, "12 points per strand, found from gaps between points: "
                                     "set --points-per-strand if this is wrong");
    strands_destroy(&strands);
    StrandsReadOptions options = {.unit = 1, .points_per_strand = 24};
    strands = read_well(text, strlen(text), &options, &report);
    assert_int_equal(strands.strand_count, 3);
    assert_string_equal(report.note, "");
    strands_destroy(&strands);
    options.points_per_strand = 7;
    refuse(text, strlen(text), &options, "72 points cannot be divided into strands of 7 points");
    refuse(
        odd, strlen(odd), &METRES,
        "the gaps between its 73 points do not show it (5 gaps): expected --points-per-strand N");
    free(text);
    free(odd);
    const char *line = PLY("element vertex 4\n" XYZ "end_header\n0 0 0 0 1 0 0 2 0 0 3 0\n");
    refuse(line, strlen(line), &METRES, "(0 gaps)");
}

static void malformed_ply_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *says;
    } cases[] = {
        {"ply\nformed\n", "FILE:2: expected format"},
        {"ply\nformat ascii 2.0\n", "FILE:2: expected 1.0"},
        {"ply\nformat binary 1.0\n", "FILE:2: expected ascii, binary_little_endian"},
        {PLY("element vertex 3\nproperty floot x\n"), "FILE:4: expected a type"},
        {PLY("element vertex -1\n"), "FILE:3: expected a number of elements"},
        {PLY("property float x\n"), "before the first element"},
        {PLY("element vertex 1\nproperty float x\nend_header\n0\n"), "without x, y and z"},
        {PLY("element v 1\nproperty float x\nend_header\n0\n"), "no vertices"},
        {PLY("element vertex 4000000000\n" XYZ "end_header\n0 0 0\n"),
         "need at least 24000000000 bytes"},
        {PLY("element vertex 2\n" XYZ "end_header\n0 0 0\n0 x 0\n"), "FILE:9: expected a number"},
        {PLY("element vertex 2\n" XYZ "element face 1\nproperty list uchar int i\nend_header\n"),
         "a mesh of 1 faces, not hair: expected hair (pass a mesh with --mesh)"},
        {PLY("element vertex 2\n" XYZ "element edge 1\nproperty int vertex1\nproperty int vertex2\n"
             "end_header\n0 0 0\n0 1 0\n0 2\n"),
         "edge 0 joins vertices 0 and 2: expected two consecutive vertices"},
        {PLY("element vertex 2\n" XYZ "element strand 1\nproperty ushort nsegs\nend_header\n"
             "0 0 0\n0 1 0\n2\n"),
         "the strands need at least 3 vertices, but the file has 2"},
        {PLY("element vertex 3\n" XYZ "element strand 1\nproperty ushort nsegs\nend_header\n"
             "0 0 0\n0 1 0\n0 2 0\n1\n"),
         "the strands need 2 vertices in all, but the file has 3"},
        {PLY("element vertex 1\nproperty list float int i\n"), "a list's count is a float"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        refuse(cases[i].text, strlen(cases[i].text), &METRES, cases[i].says);
    const char *told = PLY("element vertex 2\n" XYZ "element strand 1\nproperty ushort nsegs\n"
                           "end_header\n0 0 0\n0 1 0\n1\n");
    refuse(told, strlen(told), &(StrandsReadOptions){.points_per_strand = 2}, "has no effect");
}

// Rows without properties take no bytes: forty thousand million of them must take no time.
#define NOTHING(name) "element " name " 4000000000\n"
static void rows_of_nothing_are_passed_over(void **state)
{
    (void)state;
    Error error = {""};
    Strands strands;
    const char *text =
        PLY("element vertex 2\n" XYZ "element strand 1\nproperty ushort nsegs\n" NOTHING("a")
                NOTHING("b") NOTHING("c") NOTHING("d") NOTHING("e") NOTHING("f") NOTHING("g")
                    NOTHING("h") NOTHING("i") NOTHING("j") "end_header\n0 0 0\n0 1 0\n1\n");
    assert_int_equal(reading_text(&strands, text, &METRES, &(StrandsReport){0}, &error), RESULT_OK);
    assert_int_equal(strands.strand_count, 1);
    strands_destroy(&strands);
}

// --- .npy

static void pile_header(Pile *pile, int version, const char *dict)
{
    size_t size = strlen(dict);
    pile_text(pile, "\x93NUMPY");
    pile_number(pile, (uint64_t)version, 2, false);
    pile_number(pile, size, version == 1 ? 2 : 4, false);
    pile_text(pile, dict);
}

static Pile make_npy(int version, const char *dict)
{
    Pile pile = {.size = 0};
    pile_header(&pile, version, dict);
    return pile;
}

// Two strands of two points, x = 1 .. 12 in C order.
static void npy_of_every_float_and_order_is_read(void **state)
{
    (void)state;
    static const char *const types[] = {"<f2", ">f2", "<f4", ">f4", "<f8", ">f8"};
    for (int type = 0; type < 6; type++)
        for (int version = 1; version <= 3; version++)
            for (int fortran = 0; fortran < 2; fortran++) {
                char dict[200];
                snprintf(dict, sizeof dict,
                         "{'descr': '%s', 'fortran_order': %s, 'shape': (2, 2, 3), }", types[type],
                         fortran ? "True" : "False");
                Pile pile = make_npy(version, dict);
                for (int i = 0; i < 12; i++) {
                    int c = fortran ? (i % 2) * 6 + (i / 2 % 2) * 3 + i / 4 : i;
                    double wide = c + 1;
                    float single = (float)wide;
                    uint64_t bits = 0;
                    if (type / 2 == 0) { // 2^e (1 + m / 1024)
                        int e = c + 1 >= 8 ? 3 : c + 1 >= 4 ? 2 : c + 1 >= 2 ? 1 : 0;
                        bits = (uint64_t)((e + 15) << 10) + (uint64_t)((c + 1) * 1024 >> e) - 1024;
                    }
                    if (type / 2 == 1) memcpy(&bits, &single, 4);
                    if (type / 2 == 2) memcpy(&bits, &wide, 8);
                    pile_number(&pile, bits, 2 << (type / 2), type % 2);
                }
                StrandsReport report;
                Strands strands = read_well(pile.data, pile.size, &METRES, &report);
                assert_int_equal(strands.strand_count, 2);
                for (int i = 0; i < 12; i++)
                    assert_true(strands.position[i / 3][i % 3] == (float)(i + 1));
                assert_true(strands_report_is_clean(&report));
                strands_destroy(&strands);
                for (size_t cut = 0; cut < pile.size; cut++)
                    refuse(pile.data, cut, &METRES, "FILE");
            }
}

// NumPy's specification (NEP 1): the dictionary, spaces up to a multiple of 64, a line end.
static void a_written_header_is_padded_by_spaces(void **state)
{
    (void)state;
    static const struct {
        uint64_t shape[3];
        uint32_t axes;
        const char *dict;
    } CASES[] = {
        {{7}, 1, "{'descr': '<f4', 'fortran_order': False, 'shape': (7,), }"},
        {{7, 3}, 2, "{'descr': '<f4', 'fortran_order': False, 'shape': (7, 3), }"},
        {{4000000000, 1000000, 3},
         3,
         "{'descr': '<f4', 'fortran_order': False, 'shape': (4000000000, 1000000, 3), }"},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; ++i) {
        char header[NPY_HEADER_SIZE];
        memset(header, 0x7f, sizeof header); // whatever stood there before
        size_t size = npy_array_header(header, "<f4", CASES[i].shape, CASES[i].axes),
               length = strlen(CASES[i].dict);
        assert_int_equal(size % 64, 0);
        assert_true(size >= 10 + length + 1 && size < 10 + length + 1 + 64);
        assert_memory_equal(header, "\x93NUMPY\1\0", 8);
        assert_int_equal((uint8_t)header[8] + 256 * (uint8_t)header[9], size - 10);
        assert_memory_equal(header + 10, CASES[i].dict, length);
        for (size_t k = 10 + length; k < size - 1; ++k) assert_int_equal(header[k], ' ');
        assert_int_equal(header[size - 1], '\n');
    }
}

// Every half float below the smallest normal one, 2^-14, and some above: exactly m 2^-24.
static void small_halves_are_read_exactly(void **state)
{
    (void)state;
    enum { COUNT = 1100 };
    static Pile pile;
    for (int sign = 0; sign < 2; sign++) {
        pile = make_npy(1, "{'descr': '<f2', 'fortran_order': False, 'shape': (1, 1100, 3), }");
        for (int m = 0; m < COUNT; m++) {
            pile_number(&pile, (uint64_t)(m | sign << 15), 2, false);
            // y makes neighbours distinct: m below 2048 is 2^e (1 + k / 1024).
            int e = 10;
            while (m && m >> e == 0) e--;
            pile_number(&pile, m ? (uint64_t)((e + 15) << 10 | (m - (1 << e)) << (10 - e)) : 0, 2,
                        false);
            pile_number(&pile, 0, 2, false);
        }
        Strands strands = read_well(pile.data, pile.size, &METRES, &(StrandsReport){0});
        assert_int_equal(strands.vertex_count, COUNT);
        for (int m = 0; m < COUNT; m++) {
            // From 1024 on the exponent is 1, which gives (1024 + m % 1024) 2^-24 again.
            float expected = ldexpf((float)m, -24);
            assert_true(strands.position[m][0] == (sign ? -expected : expected));
            assert_true(strands.position[m][1] == (float)m);
        }
        strands_destroy(&strands);
    }
}

static void other_npy_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *dict, *says;
    } cases[] = {
        {"{'descr': '|O', 'fortran_order': False, 'shape': (2, 2, 3), }", "pickled Python objects"},
        {"{'descr': [('x', '<f4')], 'fortran_order': False, 'shape': (2,), }", "(several fields)"},
        {"{'descr': '<c8', 'fortran_order': False, 'shape': (2, 2, 3), }", "type '<c8'"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2, 3), }", "need 12 times 4"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (0, 2, 3), }", "(0, 2, 3)"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (), }", "elements need 1 times 4"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (4294967295, 4294967295, 4294967295), "
         "}",
         "does not fit into memory"},
        {"{'descr': '<f4', 'fortran_order': Maybe, 'shape': (2, 2, 3), }", "header is damaged"},
        {"{'descr': '<f4', 'shape': (2, 2, 3), }", "header is damaged"},
        {"{'descr': '<f4', 'fortran_order': False, 'shape': (2, -2, 3), }", "header is damaged"},
        {"[]", "header is damaged"},
        {"", "header is damaged"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Pile pile = make_npy(1, cases[i].dict);
        refuse(pile.data, pile.size, &METRES, cases[i].says);
    }
    Pile pile = make_npy(4, "{}");
    refuse(pile.data, pile.size, &METRES, "version 4.0 of .npy");
    pile = make_npy(1, "{'descr': '<i4', 'fortran_order': False, 'shape': (1, 2, 3), }");
    for (int i = 0; i < 6; i++) pile_number(&pile, (uint64_t)i, 4, false);
    refuse(pile.data, pile.size, &METRES, "elements that are not floats with the shape (1, 2, 3)");
}

// --- .npz as other programs write it: deflated, with data descriptors after the data, and zip64.

typedef struct Archive {
    Pile pile, directory;
    int count;
} Archive;

static void put_name(Pile *pile, const char *name)
{
    pile_text(pile, name);
}

static void add_deflated(Archive *archive, const char *name, const Pile *file, uint64_t claimed)
{
    uint8_t packed[8192];
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(6);
    size_t size =
        libdeflate_deflate_compress(compressor, file->data, file->size, packed, sizeof packed);
    libdeflate_free_compressor(compressor);
    uint32_t crc = libdeflate_crc32(0, file->data, file->size);
    Pile *pile = &archive->pile, *directory = &archive->directory;
    size_t at = pile->size, length = strlen(name);
    pile_number(pile, 0x04034b50, 4, false);
    pile_number(pile, 20 | 8u << 16 | 8ull << 32, 6, false); // sizes follow; deflated
    pile_number(pile, 0, 8, false);                          // date, checksum
    pile_number(pile, 0, 8, false);                          // sizes
    pile_number(pile, length | 4ull << 16, 4, false);
    put_name(pile, name);
    pile_number(pile, 0x0000cafe, 4, false); // an extra field
    memcpy(pile->data + pile->size, packed, size);
    pile->size += size;
    pile_number(pile, 0x08074b50, 4, false);
    pile_number(pile, crc, 4, false);
    pile_number(pile, size | (uint64_t)file->size << 32, 8, false);
    pile_number(directory, 0x02014b50, 4, false);
    pile_number(directory, 20 | 20u << 16 | 8ull << 32, 6, false);
    pile_number(directory, 8, 2, false);
    pile_number(directory, 0, 4, false);
    pile_number(directory, crc, 4, false);
    pile_number(directory, UINT32_MAX, 4, false);
    pile_number(directory, UINT32_MAX, 4, false);
    pile_number(directory, length | 20ull << 16, 4, false);
    pile_number(directory, 0, 6, false);
    pile_number(directory, 0, 4, false);
    pile_number(directory, at, 4, false);
    put_name(directory, name);
    pile_number(directory, 1 | 16u << 16, 4, false);
    pile_number(directory, claimed ? claimed : file->size, 8, false);
    pile_number(directory, size, 8, false);
    archive->count++;
}

static void end_archive(Archive *archive)
{
    Pile *pile = &archive->pile;
    size_t at = pile->size;
    memcpy(pile->data + at, archive->directory.data, archive->directory.size);
    pile->size += archive->directory.size;
    pile_number(pile, 0x06054b50, 4, false);
    pile_number(pile, 0, 4, false);
    pile_number(pile, (uint64_t)archive->count * 0x10001, 4, false);
    pile_number(pile, archive->directory.size, 4, false);
    pile_number(pile, at, 4, false);
    pile_number(pile, 4, 2, false);
    pile_text(pile, "note");
}

// A directory that declares more files than the archive has bytes for is refused before anything is
// read.
static void a_directory_has_room_for_its_files(void **state)
{
    (void)state;
    Archive archive = {.count = 0};
    Pile file = make_npy(1, "{'descr': '|u1', 'fortran_order': False, 'shape': (0,), }");
    add_deflated(&archive, "empty.npy", &file, 0);
    archive.count = 1000;
    end_archive(&archive);
    refuse(archive.pile.data, archive.pile.size, &METRES, "the zip directory need 1000 times 46 ");
}

static Pile make_floats(const char *shape, int count)
{
    char dict[100];
    snprintf(dict, sizeof dict, "{'descr': '<f4', 'fortran_order': False, 'shape': %s, }", shape);
    Pile pile = make_npy(1, dict);
    for (int i = 0; i < count; i++) pile_float(&pile, 0.125f * (float)i, false);
    return pile;
}

// The letter of the up axis in both byte orders and as one byte: its position in the word differs.
static void the_axis_that_is_up_is_read_in_every_byte_order(void **state)
{
    (void)state;
    static const struct {
        const char *descr, *bytes;
        int size;
        bool z, good;
    } cases[] = {
        {"<U1", "z\0\0\0", 4, true, true},  {">U1", "\0\0\0z", 4, true, true},
        {">U1", "\0\0\0y", 4, false, true}, {"|S1", "Z", 1, true, true},
        {"|S1", "Y", 1, false, true},       {">U1", "z\0\0\0", 4, true, false},
        {"<U1", "\0\0\0z", 4, true, false}, {"<U2", "z\0\0\0\0\0\0\0", 8, true, false},
        {"<U1", "x\0\0\0", 4, true, false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Archive archive = {.count = 0};
        Pile points = make_floats("(1, 2, 3)", 6);
        char dict[100];
        snprintf(dict, sizeof dict, "{'descr': '%s', 'fortran_order': False, 'shape': (), }",
                 cases[i].descr);
        Pile up = make_npy(1, dict);
        memcpy(up.data + up.size, cases[i].bytes, (size_t)cases[i].size);
        up.size += (size_t)cases[i].size;
        add_deflated(&archive, "points.npy", &points, 0);
        add_deflated(&archive, "up.npy", &up, 0);
        end_archive(&archive);
        if (!cases[i].good) {
            refuse(archive.pile.data, archive.pile.size, &METRES, "'up': expected 'y' or 'z'");
            continue;
        }
        Strands strands =
            read_well(archive.pile.data, archive.pile.size, &METRES, &(StrandsReport){0});
        // (0.375, 0.5, 0.625) in the file
        assert_true(strands.position[1][1] == (cases[i].z ? 0.625f : 0.5f));
        assert_true(strands.position[1][2] == (cases[i].z ? -0.5f : 0.625f));
        strands_destroy(&strands);
    }
}

static void deflated_npz_is_read(void **state)
{
    (void)state;
    Archive archive = {.count = 0};
    Pile points = make_floats("(5, 3)", 15), radius = make_floats("(5,)", 5);
    Pile sizes = make_npy(2, "{'descr': '|u1', 'fortran_order': False, 'shape': (2,), }");
    Pile frames = make_floats("(2, 5, 3)", 30), other = make_floats("(2, 3)", 6);
    Pile up = make_npy(1, "{'descr': '<U1', 'fortran_order': False, 'shape': (), }");
    pile_number(&sizes, 2 | 3 << 8, 2, false);
    pile_number(&up, 'z', 4, false);
    add_deflated(&archive, "other.npy", &other, 0);
    add_deflated(&archive, "points.npy", &points, 0);
    add_deflated(&archive, "sizes.npy", &sizes, 0);
    add_deflated(&archive, "radius.npy", &radius, 0);
    add_deflated(&archive, "frames.npy", &frames, 0);
    add_deflated(&archive, "up.npy", &up, 0);
    end_archive(&archive);
    StrandsReport report;
    Strands strands = read_well(archive.pile.data, archive.pile.size, &METRES, &report);
    assert_int_equal(strands.strand_count, 2);
    assert_int_equal(strands_size(&strands, 1), 3);
    assert_true(strands.position[4][0] == 1.5f && strands.position[4][1] == 1.75f); // z up
    assert_true(strands.vertex_thickness[4] == 1.0f);
    assert_int_equal(report.samples, 2);
    assert_string_equal(report.note, "not read: other.npy");
    strands_destroy(&strands);
    for (size_t cut = 0; cut < archive.pile.size; cut++) {
        Result result = reading_copy(&strands, archive.pile.data, cut, &METRES, NULL, NULL);
        if (cut + 4 < archive.pile.size) assert_int_equal(result, RESULT_BAD_INPUT);
        strands_destroy(&strands);
    }
    for (size_t at = 0; at < archive.pile.size; at++)
        for (int bit = 0; bit < 8; bit++) {
            archive.pile.data[at] ^= (uint8_t)(1 << bit);
            reading_copy(&strands, archive.pile.data, archive.pile.size, &METRES, NULL, NULL);
            strands_destroy(&strands);
            archive.pile.data[at] ^= (uint8_t)(1 << bit);
        }
}

static void npz_that_lies_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *name, *shape, *says;
        int count;
        uint64_t claimed;
    } cases[] = {
        {"positions.npy", "(2, 2, 3)", "unpacks to 1099511627776 bytes", 12, 1ull << 40},
        {"positions.npy", "(2, 2, 3)", "does not unpack to 10 bytes", 12, 10},
        {"x.npy", "(2, 2)",
         "no array of floats with the shape (strands, points, 3): there is x (2, 2): expected one, "
         "or the arrays points and sizes",
         4, 0},
        {"positions.npy", "(2, 2, 3)", "FILE: positions.npy: byte", 3, 0},
        {"points.npy", "(3, 3)", "where its strands end (3 points): expected --points-per-strand",
         9, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Archive archive = {.count = 0};
        Pile file = make_floats(cases[i].shape, cases[i].count);
        add_deflated(&archive, cases[i].name, &file, cases[i].claimed);
        end_archive(&archive);
        refuse(archive.pile.data, archive.pile.size, &METRES, cases[i].says);
    }
    Archive archive = {.count = 0};
    Pile positions = make_floats("(2, 2, 3)", 12), uv = make_floats("(3, 2)", 6);
    add_deflated(&archive, "curves.npy", &positions, 0);
    add_deflated(&archive, "uv.npy", &uv, 0);
    end_archive(&archive);
    refuse(archive.pile.data, archive.pile.size, &METRES,
           "'uv' has shape (3, 2): expected (2, 2) numbers");
    refuse(archive.pile.data, archive.pile.size, &(StrandsReadOptions){.array = "nix"},
           "no array 'nix'");
    refuse(archive.pile.data, archive.pile.size, &(StrandsReadOptions){.array = "uv"},
           "(3, 2): expected floats with the shape (strands, points, 3)");
}

// --- Files without hair.

static void files_of_other_programs_are_named_with_what_converts_them(void **state)
{
    (void)state;
    static const struct {
        const char *begin, *says;
    } cases[] = {
        {"\x89HDF\r\n", "HDF5, as in old Alembic files"},
        {"PXR-USDC......", "binary USD (.usdc): convert it: usdcat FILE -o x.usda"},
        {"BLENDER-v304", "a Blender file (.blend)"},
        {"\x28\xb5\x2f\xfd....", "compressed by zstd, as Blender files"},
        {"\x1f\x8b\x08...", "compressed by gzip"},
        {"//Maya ASCII 2023 scene\n", "a Maya scene (.ma)"},
        {"FOR8....MAYA", "a Maya scene (.mb)"},
        {"Kaydara FBX Binary  ", "FBX"},
        {"; FBX 7.3.0 project file", "FBX"},
        {"gl"
         "TF\x02...",
         "GLB"},
        {" {\n \"asset\": {\"version\": \"2.0\"}}", "GLTF"},
        {"# XGen Description File\n", "an XGen description"},
        {"PK\x03\x04................xx........scene.usdc", "a USD package (.usdz)"},
        {"PK\x03\x04................xx........readme.txt", "a zip archive: unpack it"},
        {"v 0 0 0\nv 1 0 0\nf 1 2 1\n", "a mesh of 2 vertices and 1 faces, not hair: "
                                        "expected hair (pass a mesh with --mesh); tractrix-gen fur "
                                        "grows hair on a mesh"},
        {"v 0 0 0\nv 1 0 0\n", "a Wavefront file of 2 vertices without lines (l) and faces"},
        {"strand,x,y,z\n0,1.5,-2,3e-2\n",
         "a table of numbers, not a hair file: save it with numpy"},
        {"0 1\n 2; 3\r\n", "a table of numbers, not a hair file"},
        {"hello\n2 3 x\n", "not a hair file: expected USD"},
        {"hello\n2\n", "not a hair file: expected USD"},
        {"hello", "not a hair file: expected USD"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        refuse(cases[i].begin, strlen(cases[i].begin), &METRES, cases[i].says);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(binary_ply_of_every_type_is_read_in_both_byte_orders),
        cmocka_unit_test(text_ply_with_edges_is_read),
        cmocka_unit_test(colours_of_whole_numbers_are_shares_of_their_largest),
        cmocka_unit_test(bare_points_become_strands),
        cmocka_unit_test(malformed_ply_is_refused),
        cmocka_unit_test(rows_of_nothing_are_passed_over),
        cmocka_unit_test(npy_of_every_float_and_order_is_read),
        cmocka_unit_test(a_written_header_is_padded_by_spaces),
        cmocka_unit_test(small_halves_are_read_exactly),
        cmocka_unit_test(other_npy_is_refused),
        cmocka_unit_test(the_axis_that_is_up_is_read_in_every_byte_order),
        cmocka_unit_test(deflated_npz_is_read),
        cmocka_unit_test(a_directory_has_room_for_its_files),
        cmocka_unit_test(npz_that_lies_is_refused),
        cmocka_unit_test(files_of_other_programs_are_named_with_what_converts_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
