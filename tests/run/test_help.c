// SPDX-License-Identifier: MIT
// What --help and the manual page say.
#include "base/params.h"
#include "run/help.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// All that `write` prints; the caller frees it.
static char *capture(void (*write)(FILE *stream))
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    write(stream);
    fclose(stream);
    return text;
}

static void write_man(FILE *stream)
{
    help_write_man(stream, "1.2.3");
}

// Where the help describes the flag: at the begin of a line, or behind the letter that stands for
// it. Other flags' help may name it before.
static const char *find_entry(const char *help, const char *flag)
{
    for (const char *at = help; (at = strstr(at, flag)); ++at) {
        bool first = strncmp(at - 3, "\n  ", 3) == 0, behind_letter = strncmp(at - 2, ", ", 2) == 0;
        if ((first || behind_letter) && strchr(" \n", at[strlen(flag)])) return at;
    }
    return NULL;
}

static void help_names_every_flag_with_its_default(void **state)
{
    (void)state;
    char *help = capture(help_write_text), *table = capture(help_write_markdown);
    for (size_t i = 0; i < PARAM_COUNT; i++) {
        const ParamInfo *info = &PARAM_TABLE[i];
        char flag[64], shown[80];
        snprintf(flag, sizeof flag, "--%s", info->name);
        for (char *at = flag; *at; at++) *at = *at == '_' ? '-' : *at;
        const char *entry = find_entry(help, flag);
        if (!entry) fail_msg("--help lacks %s", flag);
        assert_non_null(strstr(table, flag));
        snprintf(shown, sizeof shown, "default %s]", info->default_text);
        const char *next = strstr(entry, "\n  --"), *found = strstr(entry, shown);
        if (info->default_text[0] && info->kind != PARAM_BOOL) assert_non_null(found);
        if (info->default_text[0] && info->kind != PARAM_BOOL && next) assert_true(found < next);
    }
    free(help);
    free(table);
}

static void help_is_at_most_96_columns_wide(void **state)
{
    (void)state;
    char *help = capture(help_write_text);
    for (char *line = help; *line; line += strcspn(line, "\n") + 1)
        assert_true(strcspn(line, "\n") <= 96);
    free(help);
}

static void the_man_page_has_no_bare_hyphen_and_names_the_version(void **state)
{
    (void)state;
    char *page = capture(write_man);
    assert_non_null(strstr(page, "1.2.3"));
    assert_non_null(strstr(page, "\\-\\-camera\\-up"));
    assert_null(strstr(page, "--"));
    free(page);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(help_names_every_flag_with_its_default),
        cmocka_unit_test(help_is_at_most_96_columns_wide),
        cmocka_unit_test(the_man_page_has_no_bare_hyphen_and_names_the_version),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
