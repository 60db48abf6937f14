// SPDX-License-Identifier: MIT
// Which images a page embeds unchanged, and which it embeds as smaller JPEG files.
#include "compare/html.h"

#include "support/temporary.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum {
    EXACT_BYTES = 3 << 20
}; // size of an image in one of three pairs: one pair fits into 8 MiB, two do not

static Bytes make_bytes(size_t size, char letter)
{
    Bytes bytes = {.data = malloc(size + 1), .size = size};
    assert_non_null(bytes.data);
    memset(bytes.data, letter, size);
    return bytes;
}

static HtmlPair make_pair(bool equal)
{
    HtmlPair page = {.equal = equal};
    for (int i = 0; i < 2; ++i)
        page.side[i] = (HtmlSide){make_bytes(EXACT_BYTES, 'e'), make_bytes(30, 's'), json_object()};
    return page;
}

static int count(const char *text, const char *part)
{
    int n = 0;
    for (const char *at = text; (at = strstr(at, part)); ++at) ++n;
    return n;
}

static void the_worst_pairs_stay_exact(void **state)
{
    char name[] = "x.png";
    const double flips[] = {0.1, 0.3, 0.2, 0};
    const CompareLimits limits[LEVELS] = {0};
    Pair pair = {.name = name, .a = name, .b = name, .has_a = true, .has_b = true};
    const PairList list = {.pairs = &pair, .count = 4, .many = true};
    const char *path = temporary_path(state, "report.html");
    Html html;
    Bytes file;
    assert_int_equal(html_open(&html, path, NULL), RESULT_OK);
    for (int i = 0; i < 4; ++i) {
        HtmlPair page = make_pair(i == 3);
        Verdict verdict = {.outcome = OUTCOME_DIFFERENT, .measured = true};
        verdict.figures.flip = flips[i];
        assert_int_equal(html_add(&html, &pair, &verdict, &page, NULL), RESULT_OK);
        html_pair_destroy(&page);
    }
    assert_int_equal(html_close(&html, &list, limits, "tractrix-compare a b", NULL), RESULT_OK);
    assert_int_equal(bytes_read_file(&file, path, NULL), RESULT_OK);
    const char *text = (const char *)file.data;
    // Each pair has four numbers, in this order: B exact, B small, A exact, A small. The equal pair
    // has one image.
    assert_int_equal(count(text, "id=\"image-"), 7);
    for (int i = 0; i < 12; ++i) {
        char id[32];
        bool second = i / 4 == 1, exact = i % 2 == 0;
        snprintf(id, sizeof id, "id=\"image-%d\"", i);
        assert_int_equal(count(text, id), second == exact);
        snprintf(id, sizeof id, "\"image\":%d,", i);
        char last[32];
        snprintf(last, sizeof last, "\"image\":%d}", i);
        assert_int_equal(count(text, id) + count(text, last), second == exact);
    }
    assert_int_equal(count(text, "\"lossy\":true"), 5);
    assert_true(file.size > 2 * EXACT_BYTES && file.size < 3 * EXACT_BYTES);
    bytes_destroy(&file);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test_setup_teardown(
        the_worst_pairs_stay_exact, temporary_create, temporary_destroy)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
