// SPDX-License-Identifier: MIT
// The table of parameters: defaults, names, values as text and back.
#include "base/params.h"
#include "base/suggest.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// All structs of parameters, and the one that a row belongs to.
typedef struct Params {
    RunParams run;
    BodyParams body;
    SectionParams section;
} Params;

static void *params_of(Params *params, const ParamInfo *info)
{
    return info->scope == SCOPE_RUN    ? (void *)&params->run
           : info->scope == SCOPE_BODY ? (void *)&params->body
                                       : (void *)&params->section;
}

static void create(Params *params)
{
    Error error = {{0}};
    assert_int_equal(params_create_run(&params->run, &error), RESULT_OK);
    assert_int_equal(params_create_body(&params->body, &error), RESULT_OK);
    assert_int_equal(params_create_section(&params->section, &error), RESULT_OK);
}

static void destroy(Params *params)
{
    params_destroy_run(&params->run);
    params_destroy_body(&params->body);
    params_destroy_section(&params->section);
}

static void assert_prints(const ParamInfo *info, const void *params, const char *expected)
{
    char *text = params_format(info, params);
    assert_non_null(text);
    assert_string_equal(text, expected);
    free(text);
}

static void every_default_is_valid_and_prints_as_the_table_has_it(void **state)
{
    (void)state;
    Params params;
    create(&params);
    for (size_t i = 0; i < PARAM_COUNT; i++)
        assert_prints(&PARAM_TABLE[i], params_of(&params, &PARAM_TABLE[i]),
                      PARAM_TABLE[i].default_text);
    assert_int_equal(params.run.frames, 120);
    assert_int_equal(params.run.size[1], 960);
    assert_true(params.run.eye.automatic);
    assert_true(params.run.gravity[1] == -9.81f);
    assert_string_equal(params.section.algo, "hybrid");
    destroy(&params);
    destroy(&params);
}

static void rows_are_found_by_field_and_flag_and_names_are_unique(void **state)
{
    (void)state;
    for (size_t i = 0; i < PARAM_COUNT; i++) {
        const ParamInfo *info = &PARAM_TABLE[i];
        assert_ptr_equal(params_find(info->name), info);
    }
    assert_ptr_equal(params_find("camera-up"), params_find("camera_up"));
    assert_null(params_find("camera"));
    assert_null(params_find(""));
}

static void groups_stand_together_and_texts_fit_their_place(void **state)
{
    (void)state;
    for (size_t i = 0; i < PARAM_COUNT; i++) {
        const ParamInfo *info = &PARAM_TABLE[i];
        if (i > 0) assert_true(info->group >= PARAM_TABLE[i - 1].group);
        size_t length = strlen(info->help);
        assert_in_range(length, 1, 200);
        assert_true(info->help[length - 1] != '.');
        assert_true(info->minimum <= info->maximum);
        assert_int_equal(info->kind == PARAM_CHOICE, info->choices[0] != NULL);
    }
}

// A flag of each kind, a valid value and its printed form.
static const struct {
    const char *name, *text, *printed;
} VALID[] = {
    {"strict", "true", "true"},
    {"strict", "false", "false"},
    {"frames", "1", "1"},
    {"frames", "+7", "7"},
    {"last", "-1", "-1"},
    {"seed", "4294967295", "4294967295"},
    {"fps", "23.976", "24000/1001"},
    {"fps", "1e3", "1000"},
    {"fps", " 24 ", "24"},
    {"style", "0.1", "0.1"},
    {"style", "1e-30", "1e-30"},
    {"style", "0.9:0.3", "0.9:0.3"},
    {"style", "0.9 : 0.5 : 0.1", "0.9:0.5@0.5:0.1"},
    {"style", "0.9:0.6@0.3:0.3", "0.9:0.6@0.3:0.3"},
    {"style", "0.9@0.1:0.3@0.7", "0.9@0.1:0.3@0.7"},
    {"style", "0.333333343", "0.33333334"},
    {"gravity", "0, -9.81, 1e-3", "0,-9.81,0.001"},
    {"color", "#A0b1C2", "#a0b1c2"},
    {"color", "1,0,0.2", "#ff0033"},
    {"color", "Auburn", "#693527"},
    {"color", "grey", "#7c7974"},
    {"background", "white", "#ffffff"},
    {"color", "0.1,0.5,0.9", "0.1,0.5,0.9"},
    {"background", "transparent", "transparent"},
    {"background", "#000000", "#000000"},
    {"background", "0.1,0.5,0.9", "0.1,0.5,0.9"},
    {"radius", "auto", "auto"},
    {"radius", "0.00004", "4e-05"},
    {"eye", "auto", "auto"},
    {"eye", "1,2,-3", "1,2,-3"},
    {"unit", "cm", "cm"},
    {"unit", "0.0254", "in"},
    {"unit", "0.3048", "0.3048"},
    {"unit", "auto", "auto"},
    {"size", "640x480", "640x480"},
    {"size", "1x16384", "1x16384"},
    {"up", "z", "z"},
    {"backend", "osmesa", "osmesa"},
    {"algo", "", ""},
    {"algo", "split", "split"},
    {"mesh", "a b/\xc3\xa4.obj", "a b/\xc3\xa4.obj"},
};

static void values_print_in_their_shortest_form_and_read_back(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof VALID / sizeof VALID[0]; i++) {
        const ParamInfo *info = params_find(VALID[i].name);
        Params params, again;
        create(&params);
        create(&again);
        Error error = {{0}};
        assert_int_equal(params_parse(info, params_of(&params, info), VALID[i].text, &error),
                         RESULT_OK);
        assert_prints(info, params_of(&params, info), VALID[i].printed);
        assert_int_equal(params_parse(info, params_of(&again, info), VALID[i].printed, &error),
                         RESULT_OK);
        assert_prints(info, params_of(&again, info), VALID[i].printed);
        destroy(&params);
        destroy(&again);
    }
}

static void floats_read_back_to_the_same_bits(void **state)
{
    (void)state;
    const ParamInfo *info = params_find("drag");
    Error error = {{0}};
    for (uint32_t bits = 1; bits < 0x49742400; bits += 99991 * 13) { // up to 1e6
        SectionParams params = {0}, again = {0};
        memcpy(&params.drag, &bits, sizeof bits);
        char *text = params_format(info, &params);
        assert_int_equal(params_parse(info, &again, text, &error), RESULT_OK);
        assert_memory_equal(&params.drag, &again.drag, sizeof again.drag);
        free(text);
    }
}

// Invalid values, and what the message must contain.
static const struct {
    const char *name, *text, *expected;
} INVALID[] = {
    {"strict", "yes", "got 'yes', expected true or false"},
    {"strict", "", "got ''"},
    {"frames", "0", "got '0', expected a whole number from 1 to 10000000 (nearest: 1)"},
    {"frames", "99999999999999999999", "(nearest: 10000000)"},
    {"style", "0.5:1.5",
     "got '0.5:1.5', expected a number from 0 to 1, or two such numbers, ROOT:TIP"},
    {"style", "0.5:", "got '0.5:'"},
    {"frames", "1.5", "a whole number"},
    {"frames", "1e3", "a whole number"},
    {"frames", "12 13", "a whole number"},
    {"last", "-2", "(nearest: -1)"},
    {"seed", "-1", "(nearest: 0)"},
    {"fps", "abc", "got 'abc', expected a number from 0.001 to 10000 (1/s)"},
    {"fps", "", "expected a number"},
    {"fps", "30fps", "expected a number"},
    {"fps", "nan", "expected a number"},
    {"fps", "inf", "expected a number"},
    {"fps", "-inf", "expected a number"},
    {"fps", "0x20", "expected a number"},
    {"fps", "1e999", "(nearest: 10000)"},
    {"fps", "30,", "expected a number"},
    {"gravity", "1,2", "three numbers x,y,z"},
    {"gravity", "1,2,3,4", "three numbers"},
    {"gravity", "1,nan,3", "three numbers"},
    {"gravity", "1,,3", "three numbers"},
    {"color", "#12345", "#rrggbb"},
    {"color", "#12345g", "#rrggbb"},
    {"color", "blnod",
     "expected a name (--help colors), #rrggbb or r,g,b from 0 to 1 (nearest: blond)"},
    {"background", "greeen", "(nearest: green)"},
    {"background", "tranparent", "(nearest: transparent)"},
    {"transmission", "atuo", "(nearest: auto)"},
    {"transmission", "blnod", "(nearest: blond)"},
    {"exposure", "atuo", "(nearest: auto)"},
    {"eye", "atuo", "(nearest: auto)"},
    {"followers", "auto4", "(nearest: auto)"},
    {"unit", "mmm", "(nearest: mm)"},
    {"collide_mesh", "flase", "(nearest: false)"},
    {"color", "x1,2,3", "expected a name"},
    {"color", "0,0,1.5", "(nearest: 1)"},
    {"color", "transparent", "#rrggbb"},
    {"background", "clear", "or transparent"},
    {"radius", "0", "(nearest: 1e-07)"},
    {"radius", "automatic", "auto or a number"},
    {"eye", "auto,auto,auto", "auto or three numbers"},
    {"unit", "km", "auto, m, cm, mm, in or a number"},
    {"unit", "-1", "nearest"},
    {"size", "640", "WxH"},
    {"size", "640X480", "WxH"},
    {"size", "0x480", "WxH"},
    {"size", "20000x480", "(nearest: 16384)"},
    {"size", "640.5x480", "WxH"},
    {"up", "x", "got 'x', expected auto, y or z"},
    {"scatter", "dual", "'dual' was removed: use 'grid' instead"},
    {"backend", "elg", "expected auto, egl or osmesa (nearest: egl)"},
    {"fps", "two\nlines\x7f", "got 'two\\nlines\\x7f'"},
};

static void wrong_values_are_refused_by_name_and_change_nothing(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof INVALID / sizeof INVALID[0]; i++) {
        const ParamInfo *info = params_find(INVALID[i].name);
        Params params;
        create(&params);
        Error error = {{0}};
        assert_int_equal(params_parse(info, params_of(&params, info), INVALID[i].text, &error),
                         RESULT_USAGE);
        if (!strstr(error.text, INVALID[i].expected))
            fail_msg("%s: '%s' lacks '%s'", INVALID[i].name, error.text, INVALID[i].expected);
        assert_prints(info, params_of(&params, info), info->default_text);
        destroy(&params);
    }
}

static void a_long_wrong_value_is_cut_in_the_message(void **state)
{
    (void)state;
    char text[5000];
    memset(text, 'a', sizeof text);
    text[sizeof text - 1] = 0;
    RunParams params = {0};
    Error error = {{0}};
    assert_int_equal(params_parse(params_find("fps"), &params, text, &error), RESULT_USAGE);
    assert_true(strlen(error.text) < 200);
    assert_non_null(strstr(error.text, "aaa...', expected"));
    assert_int_equal(params_parse(params_find("backend"), &params, text, &error), RESULT_USAGE);
}

static void a_copy_owns_its_texts(void **state)
{
    (void)state;
    SectionParams params, copy;
    Error error = {{0}};
    assert_int_equal(params_create_section(&params, &error), RESULT_OK);
    params.style = 0.25f;
    assert_int_equal(params_copy_section(&copy, &params, &error), RESULT_OK);
    params_destroy_section(&params);
    assert_string_equal(copy.algo, "hybrid");
    assert_true(copy.style == 0.25f);
    params_destroy_section(&copy);
    params_destroy_section(&copy);
}

static void the_nearest_name_is_suggested_if_it_is_near(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"drag", "gust", "gust_period", "wind_spread", "fps"};
    assert_string_equal(suggest_nearest("darg", NAMES, 5), "drag");
    assert_string_equal(suggest_nearest("FPS", NAMES, 5), "fps");
    assert_string_equal(suggest_nearest("gust-perod", NAMES, 5), "gust_period");
    assert_string_equal(suggest_nearest("windspread", NAMES, 5), "wind_spread");
    assert_string_equal(suggest_nearest("gus", NAMES, 5), "gust");
    assert_null(suggest_nearest("", NAMES, 5));
    assert_null(suggest_nearest("gu", NAMES, 5));
    assert_null(suggest_nearest("wind", NAMES, 2));
    assert_null(suggest_nearest("fpx5", NAMES, 5));
    static const char *const SOLVERS[] = {"split", "spring", "none"};
    assert_null(suggest_nearest("verlet", SOLVERS, 3));
    assert_string_equal(suggest_nearest("spilt", SOLVERS, 3), "split");
    static const char *const FRAMES[] = {"drag", "frames"};
    assert_string_equal(suggest_nearest("fram", FRAMES, 2), "frames");
    static const char *const COLORS[] = {"tip_color", "color", "pixel-tolerance", "size"};
    assert_string_equal(suggest_nearest("tolerance", COLORS, 4), "pixel-tolerance");
    assert_string_equal(suggest_nearest("hair-color", COLORS, 4), "color");
    assert_string_equal(suggest_nearest("tip-colors", COLORS, 4), "tip_color");
    assert_null(suggest_nearest("oversize", COLORS, 4));
    assert_null(suggest_nearest("ce", COLORS, 4));
    assert_null(suggest_nearest("drag", NAMES, 0));
    char word[1000];
    memset(word, 'w', sizeof word);
    word[sizeof word - 1] = 0;
    assert_null(suggest_nearest(word, NAMES, 5));
}

static void words_that_are_near_nothing_get_the_list(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"drag", "gust", "fps"};
    char text[32];
    assert_string_equal(suggest_words(text, sizeof text, "dragg", NAMES, 3),
                        "did you mean 'drag'?");
    assert_string_equal(suggest_words(text, sizeof text, "wind", NAMES, 3),
                        "expected drag, gust or fps");
    assert_string_equal(suggest_words(text, 20, "wind", NAMES, 3), "");
    assert_string_equal(suggest_words(text, sizeof text, "wind", NAMES, 1), "expected drag");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_default_is_valid_and_prints_as_the_table_has_it),
        cmocka_unit_test(rows_are_found_by_field_and_flag_and_names_are_unique),
        cmocka_unit_test(groups_stand_together_and_texts_fit_their_place),
        cmocka_unit_test(values_print_in_their_shortest_form_and_read_back),
        cmocka_unit_test(floats_read_back_to_the_same_bits),
        cmocka_unit_test(wrong_values_are_refused_by_name_and_change_nothing),
        cmocka_unit_test(a_long_wrong_value_is_cut_in_the_message),
        cmocka_unit_test(a_copy_owns_its_texts),
        cmocka_unit_test(the_nearest_name_is_suggested_if_it_is_near),
        cmocka_unit_test(words_that_are_near_nothing_get_the_list),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
