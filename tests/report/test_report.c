// SPDX-License-Identifier: MIT
// Quoting words for shells, text from any bytes, images for browsers, and the parts of a page.
#include "base/utf8.h"
#include "report/picture.h"
#include "report/report.h"
#include "report/shell_words.h"

#include "image/png.h"
#include "support/temporary.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void expect_word(const char *word, const char *expected)
{
    const char *const words[] = {word, NULL};
    char *text = shell_join(words);
    assert_string_equal(text, expected);
    free(text);
}

static void words_are_quoted_where_needed(void **state)
{
    (void)state;
    expect_word("frames/a_0001.png", "frames/a_0001.png");
    expect_word("", "''");
    expect_word("two words", "'two words'");
    expect_word("it's", "'it'\\''s'");
    expect_word("$HOME`x`\"\\!*", "'$HOME`x`\"\\!*'");
    expect_word("~x", "'~x'");
    expect_word("=ls", "'=ls'");
    expect_word("Zopf_\xc3\xa4.png", "'Zopf_\xc3\xa4.png'");
    expect_word("a\nb\x1b'", "$'a\\012b\\033\\''");
    expect_word("\xff.png", "$'\\377.png'");
    expect_word("\xc2\x9b[2J", "$'\\302\\233[2J'"); // a control character that terminals obey
}

// A real shell reads all bytes back.
static void shells_read_words_back(void **state)
{
    (void)state;
    char word[256], line[64];
    for (int i = 1; i < 256; ++i) word[i - 1] = (char)i;
    word[255] = 0;
    const char *const words[] = {"printf", "%s", word, NULL};
    char *text = shell_join(words), *command = NULL;
    assert_true(asprintf(&command, "bash -s <<'END_OF_TEST' | od -An -v -tu1 -w1\n%s\nEND_OF_TEST",
                         text) > 0);
    FILE *stream = popen(command, "r");
    assert_non_null(stream);
    for (int i = 1; i < 256; ++i) {
        assert_non_null(fgets(line, sizeof line, stream));
        assert_int_equal(atoi(line), i);
    }
    assert_null(fgets(line, sizeof line, stream));
    assert_int_equal(pclose(stream), 0);
    free(command);
    free(text);
}

static void only_utf8_is_left(void **state)
{
    (void)state;
    static const char *const CASES[][2] = {
        {"plain", "plain"},
        {"\xe2\x82\xac\xf0\x9f\x98\x80", "\xe2\x82\xac\xf0\x9f\x98\x80"},
        {"a\xff"
         "b",
         "a\xef\xbf\xbd"
         "b"},
        {"\xc0\x80", "\xef\xbf\xbd\xef\xbf\xbd"},                 // a zero in two bytes
        {"\xed\xa0\x80", "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd"}, // a surrogate
        {"\xf4\x90\x80\x80", "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd"}, // above U+10FFFF
        {"\xe2\x82", "\xef\xbf\xbd\xef\xbf\xbd"}};                                // cut
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; ++i) {
        char *clean = utf8_clean(CASES[i][0], strlen(CASES[i][0]));
        assert_string_equal(clean, CASES[i][1]);
        free(clean);
    }
}

static void base64_is_that_of_the_standard(void **state)
{
    (void)state; // RFC 4648, section 10
    static const char *const CASES[][2] = {{"f", "Zg=="},           {"fo", "Zm8="},
                                           {"foo", "Zm9v"},         {"foob", "Zm9vYg=="},
                                           {"fooba", "Zm9vYmE="},   {"foobar", "Zm9vYmFy"},
                                           {"\xfb\xff\xfe", "+//+"}};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; ++i) {
        const Bytes bytes = {(uint8_t *)CASES[i][0], strlen(CASES[i][0])};
        json_t *value = report_base64(&bytes);
        assert_string_equal(json_string_value(value), CASES[i][1]);
        json_decref(value);
    }
}

static void pictures_have_8_bits(void **state)
{
    (void)state;
    Image deep, light, picture;
    const uint16_t levels[6] = {0, 128, 129, 65535, 257 * 200, 257 * 200 + 128};
    const uint8_t rounded[6] = {0, 0, 1, 255, 200, 200}; // 128 / 257 < 0.5 < 129 / 257
    assert_int_equal(image_create_kind(&deep, 2, 1, 3, IMAGE_16, NULL), RESULT_OK);
    memcpy(deep.pixels, levels, sizeof levels);
    assert_int_equal(picture_create(&picture, &deep, NULL), RESULT_OK);
    assert_memory_equal(picture.pixels, rounded, sizeof rounded);
    image_destroy(&picture);
    image_destroy(&deep);
    // premultiplied: half of the light at half of the alpha is full light; 0.5 becomes 187.5
    // An alpha above 1 is shown as 1, but the light is still divided by it: a third of full light.
    const float values[12] = {0.25f, 0.5f, 2, 0.5f, -1, 0, 0, 0, 0.5f, 0.5f, 0.5f, 1.5f};
    const uint8_t shown[12] = {188, 255, 255, 128, 0, 0, 0, 0, 156, 156, 156, 255};
    assert_int_equal(image_create_kind(&light, 3, 1, 4, IMAGE_FLOAT, NULL), RESULT_OK);
    memcpy(light.pixels, values, sizeof values);
    assert_int_equal(picture_create(&picture, &light, NULL), RESULT_OK);
    assert_memory_equal(picture.pixels, shown, sizeof shown);
    image_destroy(&picture);
    image_destroy(&light);
}

static void thumbnails_are_means_of_light(void **state)
{
    (void)state;
    Image picture, small;
    assert_int_equal(image_create(&picture, 40, 20, 4, NULL), RESULT_OK);
    for (size_t i = 0; i < 800; ++i) // columns of white, and of an invisible red
        memcpy(picture.pixels + 4 * i, i % 2 ? "\xff\0\0\0" : "\xff\xff\xff\xff", 4);
    assert_int_equal(picture_create_thumbnail(&small, &picture, 10, 10, NULL), RESULT_OK);
    assert_int_equal(small.width, 10);
    assert_int_equal(small.height, 5);
    for (size_t i = 0; i < 50; ++i)
        assert_memory_equal(small.pixels + 4 * i, "\xff\xff\xff\x80", 4);
    image_destroy(&small);
    for (size_t i = 0; i < 800; ++i)
        memcpy(picture.pixels + 4 * i, i % 2 ? "\xff\xff\xff\xff" : "\0\0\0\xff", 4);
    assert_int_equal(picture_create_thumbnail(&small, &picture, 10, 10, NULL), RESULT_OK);
    assert_int_equal(small.pixels[0], 188); // sRGB of half the light
    image_destroy(&small);
    assert_int_equal(picture_create_thumbnail(&small, &picture, 400, 400, NULL), RESULT_OK);
    assert_int_equal(small.width, 40);
    assert_memory_equal(small.pixels, picture.pixels, image_size(&picture));
    image_destroy(&small);
    image_destroy(&picture);
}

// Browsers would show such files in other colours than those that are compared.
static void files_with_gamma_are_not_plain(void **state)
{
    (void)state;
    Image image;
    Bytes png, changed;
    assert_int_equal(image_create(&image, 2, 2, 3, NULL), RESULT_OK);
    memset(image.pixels, 9, image_size(&image));
    assert_int_equal(png_encode(&image, NULL, &png, NULL), RESULT_OK);
    assert_true(picture_is_plain(&png));
    changed = (Bytes){calloc(1, png.size + 16), png.size + 16};
    memcpy(changed.data, png.data, 33);
    memcpy(changed.data + 33, "\0\0\0\4gAMA\0\0\0\1....", 16);
    memcpy(changed.data + 49, png.data + 33, png.size - 33);
    assert_false(picture_is_plain(&changed));
    const Bytes cut = {png.data, 20}, none = {NULL, 0}, other = {(uint8_t *)"PF\n1 1\n-1\n", 10};
    assert_true(picture_is_plain(&cut));
    assert_false(picture_is_plain(&none));
    assert_false(picture_is_plain(&other));
    bytes_destroy(&changed);
    bytes_destroy(&png);
    image_destroy(&image);
}

// --- Pages.

// The text of the page between `open` and the next `close`, in a buffer that the next call
// replaces.
static const char *between(const char *page, const char *open, const char *close)
{
    static char *text;
    const char *begin = strstr(page, open);
    free(text);
    text = NULL;
    if (!begin) return NULL;
    begin += strlen(open);
    const char *end = strstr(begin, close);
    assert_non_null(end);
    text = strndup(begin, (size_t)(end - begin));
    return text;
}

// Decodes valid base64 (RFC 4648).
static size_t decode_base64(uint8_t *to, const char *text)
{
    static const char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    uint32_t bits = 0, count = 0;
    uint8_t *begin = to;
    for (; *text && *text != '='; ++text) {
        const char *digit = strchr(DIGITS, *text);
        assert_non_null(digit);
        bits = bits << 6 | (uint32_t)(digit - DIGITS);
        count += 6;
        if (count >= 8) *to++ = (uint8_t)(bits >> (count -= 8));
    }
    return (size_t)(to - begin);
}

enum { IMAGES = 70, IMAGE_BYTES = 41000 }; // more than the first list and one block hold

static size_t image_bytes(int number, uint8_t *bytes)
{
    size_t size = number % 7 == 3 ? IMAGE_BYTES - (size_t)number : (size_t)number;
    for (size_t i = 0; i < size; ++i) bytes[i] = (uint8_t)(i * 7 + i / 251 + (size_t)number);
    return size;
}

static const ReportText *text_of(const char *stem, const char *suffix)
{
    char name[64];
    const ReportText *text = REPORT_TEXTS;
    snprintf(name, sizeof name, "%s.%s", stem, suffix);
    while (text->name && strcmp(text->name, name) != 0) ++text;
    assert_non_null(text->name);
    return text;
}

// Asserts that `page` is page.html with its words replaced: "page.X" and "kind.X" by those files,
// the policy by a list of the hashes of the styles and scripts.
static void expect_parts(const char *page, const char *kind)
{
    const char *from = text_of("page", "html")->text, *open;
    while ((open = strstr(from, "{{"))) {
        const char *close = strstr(open, "}}"), *dot = memchr(open, '.', (size_t)(close - open));
        assert_int_equal(strncmp(page, from, (size_t)(open - from)), 0);
        page += open - from;
        from = close + 2;
        if (dot) {
            char suffix[8];
            snprintf(suffix, sizeof suffix, "%.*s", (int)(close - dot - 1), dot + 1);
            const char *text = text_of(open[2] == 'k' ? kind : "page", suffix)->text;
            assert_int_equal(strncmp(page, text, strlen(text)), 0);
            page += strlen(text);
            continue;
        }
        char
            after[10]; // the text behind the word, which the policy, data and images do not contain
        snprintf(after, sizeof after, "%s", from);
        const char *end = strstr(page, after);
        assert_non_null(end);
        if (strncmp(open, "{{policy", 8) == 0) {
            char *policy = strndup(page, (size_t)(end - page));
            const char *const stems[] = {"page", kind}, *const suffixes[] = {"css", "js"};
            assert_non_null(strstr(policy, "default-src 'none';"));
            for (int i = 0; i < 4; ++i)
                assert_non_null(strstr(policy, text_of(stems[i / 2], suffixes[i % 2])->hash));
            free(policy);
        }
        page = end;
    }
    assert_string_equal(page, from);
}

// A page has the texts of its kind, its data and its images, all unchanged and without the omitted
// images.
static void pages_have_all_their_parts(void **state)
{
    static const char *const KINDS[] = {"compare", "bench"};
    static uint8_t bytes[IMAGE_BYTES], decoded[IMAGE_BYTES + 3];
    const char *path = temporary_path(state, "page.html");
    Error error = {{0}};
    for (int k = 0; k < 2; ++k) {
        Report report;
        Bytes page;
        int number;
        json_t *data = json_pack("{s: s, s: [i, f]}", "text", "</script><!-- {{images}} '\"",
                                 "list", -3, 0.125);
        assert_int_equal(report_open(&report, path, &error), RESULT_OK);
        for (int i = 0; i < IMAGES; ++i) {
            const Bytes file = {bytes, image_bytes(i, bytes)};
            assert_int_equal(report_add_image(&report, &file, &number, &error), RESULT_OK);
            assert_int_equal(number, i);
        }
        for (int i = 0; i < IMAGES; i += 5) report_omit_image(&report, i);
        assert_int_equal(report_close(&report, KINDS[k], data, &error), RESULT_OK);
        assert_int_equal(bytes_read_file(&page, path, &error), RESULT_OK);
        expect_parts((char *)page.data, KINDS[k]);
        json_t *read = json_loads(between((char *)page.data, "id=\"data\">", "</script>"), 0, NULL);
        assert_true(json_equal(read, data));
        for (int i = 0; i < IMAGES; ++i) {
            char open[64];
            snprintf(open, sizeof open, "<script type=\"text/plain\" id=\"image-%d\">", i);
            const char *text = between((char *)page.data, open, "</script>");
            assert_true((text == NULL) == (i % 5 == 0));
            if (!text) continue;
            size_t size = image_bytes(i, bytes);
            assert_int_equal(decode_base64(decoded, text), size);
            assert_memory_equal(decoded, bytes, size);
        }
        bytes_destroy(&page);
        json_decref(read);
        json_decref(data);
    }
}

// Without data, which means that memory was short, or with a scratch file on a full disk the page
// fails with a reason and its path, and the file of an earlier run stays.
static void pages_that_fail_leave_the_old_file(void **state)
{
    const char *path = temporary_path(state, "page.html");
    temporary_write(state, "page.html", "old", 0644);
    for (int full = 0; full < 2; ++full) {
        Report report;
        Bytes page;
        int number;
        const Bytes file = {(uint8_t *)"png", 3};
        Error error = {{0}};
        json_t *data = json_object();
        assert_int_equal(report_open(&report, path, &error), RESULT_OK);
        if (full) {
            fclose(report.images);
            report.images = fopen("/dev/full", "w+");
            assert_non_null(report.images);
        }
        assert_int_equal(report_add_image(&report, &file, &number, &error), RESULT_OK);
        assert_int_equal(report_close(&report, "compare", full ? data : NULL, &error),
                         RESULT_FAILED);
        assert_non_null(strstr(error.text, full ? path : "no memory"));
        if (full) assert_non_null(strstr(error.text, "No space left"));
        assert_int_equal(bytes_read_file(&page, path, &error), RESULT_OK);
        assert_string_equal((char *)page.data, "old");
        bytes_destroy(&page);
        json_decref(data);
    }
    assert_int_equal(temporary_count_files(((Temporary *)*state)->folder), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_are_quoted_where_needed),
        cmocka_unit_test(shells_read_words_back),
        cmocka_unit_test(only_utf8_is_left),
        cmocka_unit_test(base64_is_that_of_the_standard),
        cmocka_unit_test(pictures_have_8_bits),
        cmocka_unit_test(thumbnails_are_means_of_light),
        cmocka_unit_test(files_with_gamma_are_not_plain),
        cmocka_unit_test_setup_teardown(pages_have_all_their_parts, temporary_create,
                                        temporary_destroy),
        cmocka_unit_test_setup_teardown(pages_that_fail_leave_the_old_file, temporary_create,
                                        temporary_destroy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
