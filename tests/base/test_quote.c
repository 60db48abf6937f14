// SPDX-License-Identifier: MIT
// A quoted message is one line without control characters, whatever its bytes are, and keeps its
// beginning and its end.
#include "base/error.h"
#include "base/quote.h"
#include "base/utf8.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void bytes_that_do_not_stand_on_a_line_are_named(void **state)
{
    static const char *const CASES[][2] = {
        {"", ""},
        {"a b's \"c\" 100% \\n", "a b's \"c\" 100% \\n"},
        {"two\nlines\r\n\tthree", "two\\nlines\\r\\n\\tthree"},
        {"\033[31mred\033[0m\a\b\177", "\\x1b[31mred\\x1b[0m\\x07\\x08\\x7f"},
        {"\xc2\x9b"
         "31m C1",
         "\\xc2\\x9b31m C1"}, // CSI in UTF-8
        {"\x9b"
         "31m",
         "\\x9b31m"}, // CSI as a byte
        {"Grüße, 頭髪, \xf0\x9f\x92\x87", "Grüße, 頭髪, \xf0\x9f\x92\x87"},
        {"\xff\xfe \xc3", "\\xff\\xfe \\xc3"},                   // invalid UTF-8, or cut off
        {"\xc0\xaf \xed\xa0\x80", "\\xc0\\xaf \\xed\\xa0\\x80"}, // overlong, half a surrogate pair
        {"a\xe2\x80\xae"
         "gnp.exe",
         "a\\xe2\\x80\\xaegnp.exe"}, // right-to-left override
        {"a\xe2\x80\xa8"
         "b",
         "a\\xe2\\x80\\xa8b"}, // line separator
        {"\xef\xbb\xbfmark", "\\xef\\xbb\\xbfmark"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; ++i) {
        Error error;
        assert_string_equal(quote(CASES[i][0]).text, CASES[i][1]);
        // quoting twice equals quoting once
        assert_string_equal(quote(CASES[i][1]).text, CASES[i][1]);
        error_set(&error, RESULT_BAD_INPUT, "%s: it", CASES[i][0]);
        assert_int_equal(strncmp(error.text, CASES[i][1], strlen(CASES[i][1])), 0);
    }
}

static void a_long_text_keeps_its_ends_and_whole_characters(void **state)
{
    char text[900], line[64];
    (void)state;
    for (size_t length = 0; length < 200; ++length)
        for (int kind = 0; kind < 3; ++kind) {
            static const char *const PIECES[] = {"x", "ü", "\033"};
            static const size_t BYTES[] = {1, 2, 4};
            text[0] = 0;
            strcat(text, "/begin/");
            for (size_t i = 0; i < length; ++i) strcat(text, PIECES[kind]);
            strcat(text, ": the end");
            memset(line, 'Z', sizeof line);
            quote_line(line, sizeof line, text);
            assert_true(strlen(line) < sizeof line);
            assert_int_equal(strncmp(line, "/begin/", 7), 0);
            assert_string_equal(line + strlen(line) - 9, ": the end");
            assert_int_equal(strstr(line, "...") != NULL, 16 + length * BYTES[kind] >= sizeof line);
            for (size_t at = 0; line[at];) {
                size_t bytes = utf8_visible(line + at, strlen(line + at));
                assert_true(bytes > 0);
                at += bytes;
            }
        }
}

// A path may have 4096 bytes, but the reason behind it is the important part.
static void a_long_path_leaves_the_reason(void **state)
{
    char path[4096];
    Error error;
    (void)state;
    memset(path, 'd', sizeof path - 1);
    path[sizeof path - 1] = 0;
    memcpy(path, "/home", 5);
    memcpy(path + sizeof path - 1 - 9, "/hair.tfx", 9);
    error_set(&error, RESULT_BAD_INPUT, "%s: line 3: expected a number", path);
    assert_int_equal(strncmp(error.text, "/home", 5), 0);
    assert_non_null(strstr(error.text, "/hair.tfx: line 3: expected a number"));
    error_prefix(&error, RESULT_BAD_INPUT, "%s: ", path);
    assert_non_null(strstr(error.text, "line 3: expected a number"));
    assert_true(strlen(error.text) < sizeof error.text);
}

static void random_bytes_become_a_line(void **state)
{
    uint32_t seed = 1;
    (void)state;
    for (int turn = 0; turn < 20000; ++turn) {
        char text[90], line[32];
        size_t length = (size_t)turn % (sizeof text - 1);
        for (size_t i = 0; i < length; ++i) {
            seed = seed * 1664525 + 1013904223;
            text[i] = (char)((seed >> 24) ? seed >> 24 : 1);
        }
        text[length] = 0;
        quote_line(line, sizeof line, text);
        for (size_t at = 0; line[at];) {
            size_t bytes = utf8_visible(line + at, strlen(line + at));
            assert_true(bytes > 0);
            at += bytes;
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bytes_that_do_not_stand_on_a_line_are_named),
        cmocka_unit_test(a_long_text_keeps_its_ends_and_whole_characters),
        cmocka_unit_test(a_long_path_leaves_the_reason),
        cmocka_unit_test(random_bytes_become_a_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
