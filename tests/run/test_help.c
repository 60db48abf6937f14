// SPDX-License-Identifier: MIT
// The text of --help and the manual page.
#include "base/params.h"
#include "run/render_help.h"

#include "version.h"

#include <jansson.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// Returns the output of --help TOPIC; the caller frees it.
static char *capture(const char *topic)
{
    char *text = NULL;
    size_t size = 0;
    Error error;
    FILE *stream = open_memstream(&text, &size);
    assert_int_equal(render_help(topic, stream, &error), RESULT_OK);
    fclose(stream);
    return text;
}

// Finds the place where the help describes the flag: at the start of a line or after the flag's
// letter. The help of other flags may mention it earlier.
static const char *find_entry(const char *help, const char *flag)
{
    for (const char *at = help; (at = strstr(at, flag)); ++at) {
        bool first = at - help >= 3 && strncmp(at - 3, "\n  ", 3) == 0;
        bool behind_letter = at - help >= 2 && strncmp(at - 2, ", ", 2) == 0;
        if ((first || behind_letter) && strchr(" \n", at[strlen(flag)])) return at;
    }
    return NULL;
}

static void help_names_every_flag_with_its_default(void **state)
{
    (void)state;
    char *help = capture("all"), *table = capture("markdown");
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
        char *one = capture(flag);
        assert_true(find_entry(one, flag) || strncmp(one + 2, flag, strlen(flag)) == 0);
        assert_null(strstr(one, "\n  -"));
        free(one);
    }
    free(help);
    free(table);
}

// tests/project/check_schema tests that the schema agrees with the program.
static void the_schema_has_every_parameter_with_its_help(void **state)
{
    (void)state;
    char *text = capture("schema");
    json_t *schema = json_loads(text, JSON_REJECT_DUPLICATES, NULL);
    const json_t *top = json_object_get(schema, "properties");
    const json_t *rules = json_object_get(schema, "definitions");
    const json_t *section = json_object_get(json_object_get(rules, "sectionObject"), "properties");
    for (size_t i = 0; i < PARAM_COUNT; i++) {
        const ParamInfo *info = &PARAM_TABLE[i];
        const char *help =
            json_string_value(json_object_get(json_object_get(rules, info->name), "description"));
        assert_non_null(json_object_get(top, info->name));
        assert_int_equal(json_object_get(section, info->name) != NULL,
                         info->scope == SCOPE_SECTION);
        // has its own definition with its own text
        if (strcmp(info->name, "colliders") == 0) continue;
        if (!help || strncmp(help, info->help, strlen(info->help)) != 0)
            fail_msg("%s: %s", info->name, help);
    }
    json_decref(schema);
    free(text);
}

static void help_is_at_most_96_columns_wide(void **state)
{
    (void)state;
    char *help = capture("all");
    for (char *line = help; *line; line += strcspn(line, "\n") + 1)
        assert_true(strcspn(line, "\n") <= 96);
    free(help);
}

static void the_man_page_has_no_bare_hyphen_and_names_the_version(void **state)
{
    (void)state;
    char *page = capture("man");
    assert_non_null(strstr(page, TRACTRIX_VERSION));
    assert_non_null(strstr(page, "\\-\\-camera\\-up"));
    assert_null(strstr(page, "--"));
    free(page);
}

static size_t count_lines(const char *text)
{
    size_t lines = 0;
    for (; *text; text++) lines += *text == '\n';
    return lines;
}

static void plain_help_fits_a_screen_and_names_the_topics(void **state)
{
    (void)state;
    char *help = capture(NULL);
    assert_true(count_lines(help) <= 66);
    assert_non_null(find_entry(help, "--algo"));
    assert_null(find_entry(help, "--lod-width"));
    assert_non_null(strstr(help, "scene, colors, all, man"));
    free(help);
}

static void topics_list_groups_and_solvers(void **state)
{
    (void)state;
    Error error;
    char *light = capture("light"), *rope = capture("rope"), *scene = capture("scene"),
         *colors = capture("colors");
    assert_non_null(find_entry(light, "--shadow-size"));
    assert_null(find_entry(light, "--algo"));
    assert_non_null(strstr(rope, "Simulation: rope:"));
    assert_non_null(find_entry(rope, "--rope-iterations"));
    assert_non_null(find_entry(rope, "--style-stiffness"));
    assert_null(find_entry(rope, "--poisson"));
    assert_non_null(strstr(scene, "\"lights\": "));
    assert_non_null(strstr(colors, "\n  dark-blond                  #8a7150\n"));
    assert_non_null(strstr(colors, "\n  red                         #ff0000, of hair #823f27\n"));
    free(light);
    free(rope);
    free(scene);
    free(colors);
    assert_int_equal(render_help("lite", stdout, &error), RESULT_USAGE);
    assert_non_null(strstr(error.text, "--help: no topic 'lite': expected input, output, "));
    assert_int_equal(render_help("colour", stdout, &error), RESULT_USAGE);
    assert_string_equal(error.text, "--help: no topic 'colour': did you mean 'color'?");
    assert_int_equal(render_help("solvers", stdout, &error), RESULT_USAGE);
    assert_string_equal(error.text, "--help: no topic 'solvers': did you mean 'sim'?");
    assert_int_equal(render_help("image", stdout, &error), RESULT_USAGE);
    assert_string_equal(error.text, "--help: no topic 'image': did you mean 'output'?");
    assert_int_equal(render_help("fibers", stdout, &error),
                     RESULT_USAGE); // nearer to "fibres" than to "files"
    assert_string_equal(error.text, "--help: no topic 'fibers': did you mean 'hair'?");
    assert_int_equal(render_help("lod-widht", stdout, &error), RESULT_USAGE);
    assert_non_null(strstr(error.text, "did you mean 'lod-width'?"));
    assert_int_equal(render_help("lite", stdout, &error), RESULT_USAGE);
    assert_non_null(strstr(error.text, "or an option's name"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(help_names_every_flag_with_its_default),
        cmocka_unit_test(the_schema_has_every_parameter_with_its_help),
        cmocka_unit_test(help_is_at_most_96_columns_wide),
        cmocka_unit_test(plain_help_fits_a_screen_and_names_the_topics),
        cmocka_unit_test(topics_list_groups_and_solvers),
        cmocka_unit_test(the_man_page_has_no_bare_hyphen_and_names_the_version),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
