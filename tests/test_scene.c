// SPDX-License-Identifier: MIT
#include "help.h"
#include "scene.h"
#include "scene_param.h"
#include "temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { ARGUMENTS_MAX = 32 };

// Reads a command line given as one text, split at blanks, behind the program's name.
static Result read_arguments(Scene *scene, const char *line, Error *error)
{
    char copy[2000];
    snprintf(copy, sizeof copy, "%s", line);
    char *argv[ARGUMENTS_MAX + 1] = {"tractrix-render"};
    int argc = 1;
    char *rest = copy;
    for (char *word; (word = strsep(&rest, " "));)
        if (*word) argv[argc++] = word;
    return scene_from_arguments(scene, argc, argv, error);
}

static void assert_read(Scene *scene, const char *line)
{
    Error error = {{0}};
    if (read_arguments(scene, line, &error) != RESULT_OK) fail_msg("%s: %s", line, error.text);
}

static void assert_refused(const char *line, Result expected, const char *message)
{
    Scene scene;
    Error error = {{0}};
    Result result = read_arguments(&scene, line, &error);
    scene_destroy(&scene);
    if (result != expected || !strstr(error.text, message))
        fail_msg("%s: status %d, '%s' lacks '%s'", line, result, error.text, message);
    assert_null(strchr(error.text, '\n'));
}

// A scene file in the test's folder.
static const char *write_scene(void **state, const char *text)
{
    temporary_write(state, "scene.json", text, 0644);
    return temporary_path(state, "scene.json");
}

static Result read_scene(void **state, Scene *scene, const char *text, Error *error)
{
    return scene_read(scene, write_scene(state, text), error);
}

static void *params_of(Scene *scene, const ParamInfo *info)
{
    return info->scope == SCOPE_RUN ? (void *)&scene->run : (void *)&scene->sections[0].params;
}

static void assert_prints(Scene *scene, const ParamInfo *info, const char *expected)
{
    char *text = param_format(info, params_of(scene, info));
    if (!text || strcmp(text, expected) != 0)
        fail_msg("%s is %s, expected %s", info->name, text, expected);
    free(text);
}

// A valid value that is not the default and, alone, in no conflict with another.
static const char *sample(const ParamInfo *info, char text[64])
{
    static const char *const TEXTS[] = {
        [PARAM_BOOL] = "true",          [PARAM_VEC3] = "1,2,3",      [PARAM_COLOR] = "#010203",
        [PARAM_BACKGROUND] = "#010203", [PARAM_AUTO_VEC3] = "1,2,3", [PARAM_UNIT] = "in",
        [PARAM_SIZE] = "32x24",         [PARAM_TEXT] = "word",       [PARAM_PATH] = "/some/where/",
    };
    bool whole =
        info->kind == PARAM_INT || info->kind == PARAM_UINT || info->kind == PARAM_AUTO_INT;
    if (info->kind == PARAM_CHOICE) return info->choices[1];
    if (strcmp(info->name, "colliders") == 0) return "ground:0;sphere:1,2,3,4";
    if (!whole && info->kind != PARAM_FLOAT && info->kind != PARAM_AUTO_FLOAT)
        return TEXTS[info->kind];
    double least = fmax(info->minimum, -1);
    if (whole)
        snprintf(text, 64, "%.0f", least + 2);
    else
        param_format_float((float)(least + 0.375), text, 64);
    return text;
}

static void every_row_is_set_by_its_flag_and_by_nothing_else(void **state)
{
    (void)state;
    for (size_t i = 0; i < PARAM_COUNT; i++) {
        const ParamInfo *info = &PARAM_TABLE[i];
        char buffer[64], name[64], line[200];
        const char *value = sample(info, buffer);
        snprintf(name, sizeof name, "%s", info->name);
        for (char *at = name; *at; at++) *at = *at == '_' ? '-' : *at;
        for (int form = 0; form < 2; form++) {
            const char *between = form ? "=" : info->kind == PARAM_BOOL ? NULL : " ";
            snprintf(line, sizeof line, "hair.tfx -o o/ --%s%s%s", name, between ? between : "",
                     between ? value : "");
            Scene scene;
            assert_read(&scene, line);
            for (size_t j = 0; j < PARAM_COUNT; j++) {
                const ParamInfo *other = &PARAM_TABLE[j];
                bool output = strcmp(other->name, "output") == 0;
                assert_prints(&scene, other, j == i ? value : output ? "o/" : other->default_text);
            }
            scene_destroy(&scene);
        }
    }
}

static void every_row_is_set_by_its_key_in_a_scene_file(void **state)
{
    for (size_t i = 0; i < PARAM_COUNT; i++) {
        const ParamInfo *info = &PARAM_TABLE[i];
        char buffer[64];
        const char *value = sample(info, buffer);
        Scene scene = {0};
        Error error = {{0}};
        assert_int_equal(read_scene(state, &scene, "{\"sections\": [{\"file\": \"a\"}]}", &error),
                         RESULT_OK);
        assert_int_equal(param_parse(info, params_of(&scene, info), value, &error), RESULT_OK);
        json_t *json = scene_write_param(info, params_of(&scene, info));
        char *text = json_dumps(json, JSON_ENCODE_ANY | JSON_REAL_PRECISION(9));
        json_decref(json);
        scene_destroy(&scene);
        char file[300];
        snprintf(file, sizeof file, "{\"sections\": [{\"file\": \"a\"}], \"%s\": %s}", info->name,
                 text);
        free(text);
        if (read_scene(state, &scene, file, &error) != RESULT_OK) fail_msg("%s", error.text);
        assert_prints(&scene, info, value);
        scene_destroy(&scene);
    }
}

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

static void help_and_version_win_over_all_but_wrong_flags_before_them(void **state)
{
    (void)state;
    static const struct {
        const char *line;
        SceneRequest request;
    } LINES[] = {{"--help", REQUEST_HELP},
                 {"-h", REQUEST_HELP},
                 {"-qh", REQUEST_HELP},
                 {"--help=man", REQUEST_MAN},
                 {"--help=markdown", REQUEST_MARKDOWN},
                 {"--version", REQUEST_VERSION},
                 {"missing.json --fps x --help", REQUEST_HELP}};
    for (size_t i = 0; i < sizeof LINES / sizeof LINES[0]; i++) {
        Scene scene;
        assert_read(&scene, LINES[i].line);
        assert_int_equal(scene.request, LINES[i].request);
        scene_destroy(&scene);
    }
    assert_refused("--halp --help", RESULT_USAGE, "unknown flag --halp (nearest: --help");
    assert_refused("--help=html", RESULT_USAGE, "--help: expected text, man or markdown");
}

static void flags_may_stand_anywhere_and_values_may_look_like_flags(void **state)
{
    (void)state;
    Scene scene;
    assert_read(&scene, "a.tfx --gravity -1,-2,-3 -qo out/ b.hair --last=-1 --no-strict -- -c.tfx");
    assert_int_equal(scene.request, REQUEST_RUN);
    assert_int_equal(scene.section_count, 3);
    assert_string_equal(scene.sections[0].file, "a.tfx");
    assert_string_equal(scene.sections[1].file, "b.hair");
    assert_string_equal(scene.sections[2].file, "-c.tfx");
    assert_true(scene.run.gravity[0] == -1 && scene.run.gravity[2] == -3);
    assert_true(scene.run.quiet);
    assert_string_equal(scene.run.output, "out/");
    scene_destroy(&scene);
}

static void the_last_of_equal_flags_counts_and_no_takes_back(void **state)
{
    (void)state;
    Scene scene;
    assert_read(&scene, "a.tfx -o x/ --fps 24 --software --fps=25 --no-software -oy/");
    assert_true(scene.run.fps == 25);
    assert_false(scene.run.software);
    assert_string_equal(scene.run.output, "y/");
    scene_destroy(&scene);
}

static void section_flags_reach_every_section(void **state)
{
    (void)state;
    Scene scene;
    assert_read(&scene, "a.tfx b.tfx -o x/ --drag 3 --algo none");
    for (int i = 0; i < 2; i++) {
        assert_true(scene.sections[i].params.drag == 3);
        assert_string_equal(scene.sections[i].params.algo, "none");
    }
    scene_destroy(&scene);
}

static void output_is_needed_only_to_draw(void **state)
{
    (void)state;
    Scene scene;
    assert_read(&scene, "a.tfx --check");
    scene_destroy(&scene);
    assert_read(&scene, "--list-devices");
    scene_destroy(&scene);
    assert_refused("a.tfx", RESULT_USAGE, "no output");
}

static void wrong_command_lines_are_refused_with_the_nearest_name(void **state)
{
    (void)state;
    static const struct {
        const char *line, *message;
    } LINES[] = {
        {"", "no hair"},
        {"-o x/", "no hair"},
        {"a.tfx -o x/ --algoo split", "unknown flag --algoo (nearest: --algo;"},
        {"a.tfx -o x/ --camra-up 0,1,0", "(nearest: --camera-up;"},
        {"a.tfx -o x/ --no-sofware", "(nearest: --software;"},
        {"a.tfx -o x/ --no-fps", "--no-fps: only flags without a value"},
        {"a.tfx -o x/ --no-quiet=true", "--no-quiet: takes no value"},
        {"a.tfx -o x/ --quiet=maybe", "--quiet: got 'maybe', expected true or false"},
        {"a.tfx -o x/ -x", "-x: unknown flag"},
        {"a.tfx -o x/ -5", "-5: unknown flag"},
        {"a.tfx -o", "-o: expected a value"},
        {"a.tfx --fps", "--fps: expected a value"},
        {"a.tfx --output --fps 30", "--output: expected a value before the next flag"},
        {"a.tfx -o x/ --fps 0", "--fps: got '0', expected a number from 1 to 10000 (1/s)"},
        {"a.tfx -o x/ --opacity nan", "--opacity: got 'nan'"},
        {"a.tfx -o x/ --up w", "expected y or z"},
        {"a.tfx -o x/ --backend elg", "(nearest: egl)"},
        {"a.tfx -o x/ -q -v", "--quiet and --verbose exclude each other"},
        {"a.tfx -o x/ --software --require-hardware", "exclude each other"},
        {"a.tfx -o x/ --backend osmesa --device 1", "exclude each other"},
        {"a.tfx -o x/ --backend osmesa --require-hardware", "exclude each other"},
        {"a.tfx -o x/ --first 120", "--first 120: expected 0 to 119"},
        {"a.tfx -o x/ --frames 10 --last 10", "--last 10: expected 0 to 9"},
        {"a.tfx -o x/ --first 5 --last 4", "--last 4 is before --first 5"},
        {"a.tfx -o x/ --camera-up 0,0,0", "--camera-up 0,0,0"},
        {"a.tfx -o x/ --eye 1,2,3 --target 1,2,3", "--eye and --target are the same point"},
        {"a.tfx -o x_%d_%d.png", "expected one %d"},
        {"a.tfx -o x_%s.png", "expected one %d"},
        {"a.tfx -o x_%5d.png", "expected one %d"},
        {"a.tfx -o x_%004d.png", "expected one %d"},
        {"a.tfx -o x_%d%%.png", "expected one %d"},
        {"a.tfx -o x_%", "expected one %d"},
    };
    for (size_t i = 0; i < sizeof LINES / sizeof LINES[0]; i++)
        assert_refused(LINES[i].line, RESULT_USAGE, LINES[i].message);
    Scene scene;
    assert_read(&scene, "a.tfx -o x_%04d.png --first 119 --last 119");
    scene_destroy(&scene);
    assert_read(&scene, "a.tfx -o 50%/");
    scene_destroy(&scene);
}

static void a_scene_file_says_all_that_flags_can_and_more(void **state)
{
    (void)state;
    Scene scene;
    Error error;
    assert_int_equal(scene_read(&scene, "tests/data/scene_full.json", &error), RESULT_OK);
    assert_int_equal(scene.run.frames, 90);
    assert_int_equal(scene.run.size[0], 640);
    assert_true(scene.run.background[3] == 0);
    assert_true(scene.run.gravity[1] == -3.71f && scene.gravity.count == 0);
    assert_int_equal(scene.wind.count, 2);
    assert_int_equal(scene.wind.interpolation, INTERPOLATION_LINEAR);
    assert_int_equal(scene.head.rotation.count, 2);
    assert_int_equal(scene.head.translation.count, 2);
    assert_true(scene.head.translation.time[0] == 1 && scene.head.pivot[1] == 1.5f);
    assert_true(fabsf(scene.head.rotation.value[4] - 1.57079633f) < 1e-6f);
    assert_int_equal(scene.eye.count, 2);
    assert_int_equal(scene.target.count, 0);
    assert_int_equal(scene.fov.count, 1);
    assert_int_equal(scene.colliders.count, 3);
    assert_true(scene.colliders.list[0].world && scene.colliders.list[0].numbers[7] == 0.05f);
    assert_true(!scene.colliders.list[1].world && scene.colliders.list[1].numbers[3] == 0.09f);
    assert_true(scene.colliders.list[2].kind == COLLIDER_GROUND);
    assert_int_equal(scene.light_count, 4);
    assert_true(scene.lights[0].direction[1] == 1);
    assert_true(fabsf(scene.lights[0].color[1] - 0.2158605f) < 1e-5f);
    assert_true(scene.lights[1].direction[0] == -0.6f && scene.lights[1].direction[2] == 0.8f);
    const Light *point = &scene.lights[2], *spot = &scene.lights[3];
    assert_true(point->kind == LIGHT_POINT && point->position[1] == 2 && point->distance == 1);
    assert_true(spot->kind == LIGHT_SPOT && spot->direction[1] == -1 && spot->distance == 2.5f);
    assert_true(spot->inner_deg == 20 && spot->outer_deg == 30);
    assert_true(scene.lights[0].shadow && !scene.lights[1].shadow && spot->shadow);
    scene_destroy(&scene);
}

static void a_section_overrides_the_top_level_and_flags_override_both(void **state)
{
    (void)state;
    Scene scene;
    assert_read(&scene, "tests/data/scene_full.json");
    assert_true(scene.sections[0].params.style == 0.75f);
    assert_true(scene.sections[1].params.style == 0.5f); // nobody says: the default
    assert_true(scene.sections[1].params.drag == 2);
    assert_true(scene.sections[0].params.color[0] == 64 / 255.0f);
    assert_true(scene.sections[1].params.color[0] == 0.5f);
    assert_int_equal(scene.sections[1].params.up, UP_Z);
    scene_destroy(&scene);
    assert_read(&scene,
                "--style 0.125 --frames 7 tests/data/scene_full.json --wind 1,0,0 --fov 20");
    assert_true(scene.sections[0].params.style == 0.125f);
    assert_true(scene.sections[1].params.style == 0.125f);
    assert_int_equal(scene.run.frames, 7);
    assert_int_equal(scene.wind.count, 0);
    assert_true(scene.run.wind[0] == 1);
    assert_int_equal(scene.fov.count, 0);
    assert_int_equal(scene.eye.count, 2);
    scene_destroy(&scene);
}

static void paths_in_a_scene_file_are_relative_to_its_folder(void **state)
{
    (void)state;
    Scene scene;
    assert_read(&scene, "tests/data/scene_full.json --stats here.json");
    assert_string_equal(scene.sections[0].file, "tests/data/hair/top.tfx");
    assert_string_equal(scene.sections[1].file, "/hair/beard.hair");
    assert_string_equal(scene.run.mesh, "tests/data/models/head.obj");
    assert_string_equal(scene.run.output, "tests/data/frames/");
    assert_string_equal(scene.run.stats, "here.json");
    scene_destroy(&scene);
}

static void without_lights_there_are_two_and_an_empty_list_means_none(void **state)
{
    Scene scene;
    Error error;
    assert_read(&scene, "a.tfx -o x/");
    assert_true(scene.lights[0].intensity > scene.lights[1].intensity);
    assert_true(scene.lights[0].shadow && !scene.lights[1].shadow);
    for (int i = 0; i < 2; i++) {
        const float *d = scene.lights[i].direction;
        assert_true(fabsf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2] - 1) < 1e-6f);
    }
    scene_destroy(&scene);
    assert_int_equal(
        read_scene(state, &scene, "{\"sections\": [{\"file\": \"a\"}], \"lights\": []}", &error),
        RESULT_OK);
    assert_int_equal(scene.light_count, 0);
    scene_destroy(&scene);
}

static void a_scene_file_is_known_by_its_content_and_stands_alone(void **state)
{
    temporary_write(state, "scene", " \n{\"sections\": [{\"file\": \"a.tfx\"}]}", 0644);
    temporary_write(state, "hair", "numStrands 0\n", 0644);
    char line[700];
    Scene scene;
    snprintf(line, sizeof line, "%s -o x/", temporary_path(state, "scene"));
    assert_read(&scene, line);
    assert_string_equal(scene.sections[0].file, temporary_path(state, "a.tfx"));
    scene_destroy(&scene);
    snprintf(line, sizeof line, "%s -o x/", temporary_path(state, "hair"));
    assert_read(&scene, line);
    assert_string_equal(scene.sections[0].file, temporary_path(state, "hair"));
    scene_destroy(&scene);
    snprintf(line, sizeof line, "%s %s -o x/", temporary_path(state, "hair"),
             temporary_path(state, "scene"));
    assert_refused(line, RESULT_USAGE, "is a scene file: expected no other file");
    assert_refused("missing.json -o x/", RESULT_BAD_INPUT, "missing.json: No such file");
}

static char *dump(const Scene *scene)
{
    json_t *json = scene_to_json(scene);
    assert_non_null(json);
    char *text = json_dumps(json, JSON_INDENT(1) | JSON_REAL_PRECISION(9));
    json_decref(json);
    return text;
}

static void assert_written_again(void **state, const Scene *scene)
{
    Scene again;
    Error error = {{0}};
    char *text = dump(scene);
    // Relative paths would be read as relative to the folder of the copy.
    char *folder;
    while ((folder = strstr(text, "tests/data/"))) memcpy(folder, "/////////////", 11);
    if (read_scene(state, &again, text, &error) != RESULT_OK) fail_msg("%s", error.text);
    char *second = dump(&again);
    assert_string_equal(text, second);
    free(text);
    free(second);
    scene_destroy(&again);
}

static void what_is_written_is_a_scene_file_of_the_same_scene(void **state)
{
    Scene scene;
    Error error = {{0}};
    assert_int_equal(scene_read(&scene, "tests/data/scene_full.json", &error), RESULT_OK);
    assert_written_again(state, &scene);
    scene_destroy(&scene);
    const char *formulas =
        "{\"sections\": [{\"file\": \"/a\"}], \"head\": {\"translate\": [\"0.1*sin(t)\", 0.25, "
        "\"t^2\"], \"pivot\": [0, 1, 0], \"keys\": [{\"time\": 0, \"rotate\": [0, 9, 0]}]}}";
    if (read_scene(state, &scene, formulas, &error) != RESULT_OK) fail_msg("%s", error.text);
    assert_written_again(state, &scene);
    scene_destroy(&scene);
}

static void a_file_name_that_is_no_utf_8_is_still_written(void **state)
{
    (void)state;
    Scene scene;
    assert_read(&scene, "h\xff.tfx -o x/");
    char *text = dump(&scene);
    assert_non_null(strstr(text, "\"h?.tfx\""));
    free(text);
    scene_destroy(&scene);
}

#define HAIR "\"sections\": [{\"file\": \"a\"}]"

static void wrong_scene_files_are_refused_with_place_and_expectation(void **state)
{
    static const struct {
        const char *text, *message;
    } FILES[] = {
        {"", "scene.json:"},
        {"{\n\"fps\": 30,\n}", "scene.json:3:"},
        {"{\n\n\"fps\" 30}", "scene.json:3:"},
        {"{" HAIR ", \"fps\": 30,\n\"fps\": 31}", "scene.json:2:"},
        {"{" HAIR ", \"fps\": 1e999}", "scene.json:1:"},
        {"{" HAIR ", \"fps\": NaN}", "scene.json:1:"},
        {"{" HAIR ", \"output\": \"\xff\"}", "scene.json:1:"},
        {"{" HAIR ", \"output\": \"a\\u0000b\"}", "scene.json:1:"},
        {"[]", "got [], expected an object"},
        {"{}", "scene.json: expected a key 'sections'"},
        {"{\"sections\": []}", "sections: got [], expected an array of 1"},
        {"{\"sections\": {}}", "sections: got {}"},
        {"{\"sections\": [3]}", "sections[0]: got 3, expected an object"},
        {"{\"sections\": [{}]}", "sections[0]: expected a key 'file'"},
        {"{\"sections\": [{\"file\": \"\"}]}", "sections[0].file: got \"\""},
        {"{\"sections\": [{\"file\": 1}]}", "sections[0].file: got 1"},
        {"{\"sections\": [{\"file\": \"a\"}, {\"file\": \"b\", \"darg\": 1}]}",
         "sections[1]: unknown key 'darg' (nearest: 'drag')"},
        {"{\"sections\": [{\"file\": \"a\", \"fps\": 1}]}", "'fps' belongs to the top level"},
        {"{\"sections\": [{\"file\": \"a\", \"drag\": -1}]}",
         "sections[0].drag: got '-1', expected a number from 0 to 1000000 (1/s) (nearest: 0)"},
        {"{" HAIR ", \"tip-ratio\": 1}", "unknown key 'tip-ratio' (nearest: 'tip_ratio')"},
        {"{" HAIR ", \"line\\nend\": 1}", "unknown key 'line?end'"},
        {"{" HAIR ", \"fps\": \"30\"}", "fps: got \"30\", expected a number from 1 to 10000"},
        {"{" HAIR ", \"fps\": null}", "fps: got null"},
        {"{" HAIR ", \"fps\": true}", "fps: got true"},
        {"{" HAIR ", \"fps\": 0}", "(nearest: 1)"},
        {"{" HAIR ", \"frames\": 1.5}", "a whole number"},
        {"{" HAIR ", \"frames\": 99999999999}", "(nearest: 10000000)"},
        {"{" HAIR ", \"strict\": 1}", "strict: got 1, expected true or false"},
        {"{" HAIR ", \"algo\": 1}", "algo: got 1, expected a string: a name"},
        {"{" HAIR ", \"backend\": \"elg\"}", "backend: got 'elg'"},
        {"{" HAIR ", \"size\": [640]}", "size: got [640], expected WxH"},
        {"{" HAIR ", \"size\": [640, 0]}", "size: got '640x0'"},
        {"{" HAIR ", \"eye\": [1, 2]}", "eye: got [1,2], expected auto or three numbers"},
        {"{" HAIR ", \"eye\": [1, 2, \"3\"]}", "eye: got [1,2,\"3\"]"},
        {"{" HAIR ", \"color\": [0, 0, 2]}", "color: got '0,0,2'"},
        {"{" HAIR ", \"color\": \"red\"}", "color: got 'red'"},
        {"{" HAIR ", \"gravity\": 9.81}", "gravity: got 9.81, expected three numbers"},
        {"{" HAIR ", \"wind\": {}}", "wind: expected a key 'keys'"},
        {"{" HAIR ", \"wind\": {\"key\": []}}", "wind: unknown key 'key' (nearest: 'keys')"},
        {"{" HAIR ", \"wind\": {\"keys\": []}}", "wind.keys: got []"},
        {"{" HAIR ", \"wind\": {\"keys\": [{}]}}", "wind.keys[0]: expected a key 'time'"},
        {"{" HAIR ", \"wind\": {\"keys\": [{\"time\": 0}]}}", "expected a key 'value' beside"},
        {"{" HAIR ", \"wind\": {\"keys\": [{\"time\": 0, \"value\": [0, 0]}]}}",
         "wind.keys[0].value: got [0,0]"},
        {"{" HAIR ", \"wind\": {\"keys\": [{\"time\": 0, \"value\": [0, 0, 1e7]}]}}",
         "wind.keys[0].value[2]: got 10000000.0, expected a number from -1000000"},
        {"{" HAIR ", \"wind\": {\"keys\": [{\"time\": \"0\", \"value\": [0, 0, 0]}]}}",
         "wind.keys[0].time: got \"0\""},
        {"{" HAIR ", \"wind\": {\"keys\": [{\"time\": 1, \"value\": [0, 0, 0]}, "
         "{\"time\": 1, \"value\": [0, 0, 0]}]}}",
         "wind.keys[1].time: got 1, expected more than 1"},
        {"{" HAIR ", \"head\": {\"keys\": [{\"time\": 0, \"rotation\": [0, 0, 0]}]}}",
         "head.keys[0]: unknown key 'rotation' (nearest: 'rotate')"},
        {"{" HAIR ", \"head\": {\"keys\": [{\"time\": 0, \"rotate\": [0, 0, 0]}], "
         "\"interpolation\": \"cubic\"}}",
         "head.interpolation: got \"cubic\", expected one of \"smooth\" \"linear\""},
        {"{" HAIR ", \"head\": {\"keys\": [], \"pivot\": 1}}", "head.pivot: got 1"},
        {"{" HAIR ", \"head\": 1}", "head: got 1, expected an object"},
        {"{" HAIR ", \"head\": {}}", "head: expected a key 'keys'"},
        {"{" HAIR ", \"head\": {\"rotate\": [0, \"30*sin(6 t)\", 0]}}",
         "head.rotate[1]: got '30*sin(6 t)', expected a formula of t"},
        {"{" HAIR ", \"head\": {\"rotate\": [0, true, 0]}}",
         "head.rotate[1]: got true, expected a number or a formula of t"},
        {"{" HAIR ", \"head\": {\"rotate\": 7}}", "head.rotate: got 7, expected an array of three"},
        {"{" HAIR ", \"head\": {\"translate\": [0, \"1/(t-0.5)\", 0]}}",
         "head.translate[1]: '1/(t-0.5)' is inf at t = 0.5"},
        {"{" HAIR ", \"head\": {\"rotate\": [0, 1, 0], "
         "\"keys\": [{\"time\": 0, \"rotate\": [0, 0, 0]}]}}",
         "head.rotate: given here and by 'keys'"},
        {"{" HAIR ", \"camera\": {\"keys\": [{\"time\": 0, \"fov\": 180}]}}",
         "camera.keys[0].fov: got 180, expected a number from 1 to 170 (nearest: 170)"},
        {"{" HAIR ", \"fov\": 20, \"camera\": {\"keys\": [{\"time\": 0, \"fov\": 30}]}}",
         "fov: given here and by the keys of 'camera'"},
        {"{" HAIR ", \"colliders\": [{\"sphere\": [1, 2, 3]}]}", "expected an array of 4 numbers"},
        {"{" HAIR ", \"colliders\": [{\"ground\": 1, \"frame\": \"head\"}]}",
         "colliders[0].frame: a ground always"},
        {"{" HAIR ", \"colliders\": [{}]}", "colliders[0]: expected one key"},
        {"{" HAIR ", \"colliders\": [{\"plane\": [0, 0, 0, 1]}]}", "plane: expected a direction"},
        {"{" HAIR ", \"colliders\": \"ground\"}", "colliders: got 'ground'"},
        {"{" HAIR ", \"lights\": {}}", "lights: got {}, expected an array"},
        {"{" HAIR ", \"lights\": [{}]}", "lights[0]: expected a key 'direction'"},
        {"{" HAIR ", \"lights\": [{\"direction\": [0, 0, 0]}]}", "expected a direction"},
        {"{" HAIR ", \"lights\": [{\"type\": \"point\", \"direction\": [0, 0, 1]}]}",
         "lights[0]: unknown key 'direction'"},
        {"{" HAIR ", \"lights\": [{\"type\": \"area\", \"direction\": [0, 0, 1]}]}",
         "lights[0].type: got \"area\""},
        {"{" HAIR ", \"lights\": [{\"type\": \"point\"}]}", "lights[0]: expected a key 'position'"},
        {"{" HAIR
         ", \"lights\": [{\"type\": \"point\", \"position\": [0, 0, 1], \"distance\": 0}]}",
         "lights[0].distance: got 0"},
        {"{" HAIR ", \"lights\": [{\"type\": \"spot\", \"position\": [0, 0, 1]}]}",
         "lights[0]: expected a key 'direction'"},
        {"{" HAIR ", \"lights\": [{\"type\": \"spot\", \"position\": [0, 0, 1], "
         "\"direction\": [0, 0, -1], \"inner\": 50}]}",
         "'inner' is 50 deg, expected less than 'outer', 45 deg"},
        {"{" HAIR ", \"lights\": [{\"direction\": [0, 0, 1], \"color\": 7}]}",
         "lights[0].color: got 7"},
        {"{" HAIR ", \"lights\": [{\"direction\": [0, 0, 1], \"shadow\": 1}]}",
         "lights[0].shadow: got 1, expected true or false"},
        {"{" HAIR ", \"lights\": [{\"direction\": [0, 0, 1], \"intensity\": -1}]}",
         "lights[0].intensity: got -1"},
        {"{" HAIR ", \"lights\": [1,2,3,4,5,6,7,8,9]}", "got 9 lights, expected 8 at most"},
        {"{" HAIR ", \"output\": \"x.pfm\", \"tone_map\": \"filmic\"}",
         "--tone-map and .pfm files exclude each other"},
        {"{" HAIR ", \"raster\": \"blocks\", \"aov\": \"depth\"}", "exclude each other"},
        {"{" HAIR ", \"output\": \"x.mp4\", \"depth\": \"16\"}", "exclude each other"},
        {"{" HAIR ", \"first\": 9, \"last\": 3}", "scene.json: --last 3 is before --first 9"},
        {"{" HAIR ", \"software\": true, \"require_hardware\": true}", "exclude each other"},
    };
    for (size_t i = 0; i < sizeof FILES / sizeof FILES[0]; i++) {
        Scene scene;
        Error error = {{0}};
        Result result = read_scene(state, &scene, FILES[i].text, &error);
        scene_destroy(&scene);
        if (result != RESULT_BAD_INPUT || !strstr(error.text, FILES[i].message) ||
            !strstr(error.text, "scene.json") || strchr(error.text, '\n'))
            fail_msg("%s: status %d, '%s' lacks '%s'", FILES[i].text, result, error.text,
                     FILES[i].message);
    }
}

static void flags_may_mend_a_combination_that_a_scene_file_has(void **state)
{
    char line[400];
    snprintf(line, sizeof line, "%s -o x/",
             write_scene(state, "{" HAIR ", \"frames\": 10, \"last\": 20}"));
    assert_refused(line, RESULT_USAGE, "--last 20: expected 0 to 9 (or -1), since --frames is 10");
    strcat(line, " --frames 30");
    Scene scene;
    assert_read(&scene, line);
    assert_int_equal(scene.run.last, 20);
    scene_destroy(&scene);
}

static void every_truncation_of_a_scene_file_is_refused(void **state)
{
    Scene scene;
    Error error;
    FILE *file = fopen("tests/data/scene_full.json", "r");
    char text[4000];
    size_t size = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    while (size > 0 && text[size - 1] != '}') size--;
    while (size-- > 0) {
        text[size] = 0;
        assert_int_equal(read_scene(state, &scene, text, &error), RESULT_BAD_INPUT);
        scene_destroy(&scene);
    }
}

// `before`, `count` times `unit`, `after`.
static char *repeat(const char *before, const char *unit, size_t count, const char *after)
{
    size_t length = strlen(unit);
    char *text = malloc(strlen(before) + length * count + strlen(after) + 1);
    char *at = stpcpy(text, before);
    for (size_t i = 0; i < count; i++) at = stpcpy(at, unit);
    strcpy(at, after);
    return text;
}

static void deep_and_huge_files_are_refused_in_one_short_line(void **state)
{
    char *texts[] = {
        repeat("", "[", 1000000, ""),
        repeat("{" HAIR ", \"head\": ", "{\"keys\":", 100000, ""),
        repeat("{" HAIR ", \"head\": ", "[", 2000, ""),
        repeat("{" HAIR ", \"eye\": [0", ",0", 1000000, "]}"),
        repeat("{" HAIR ", \"", "k", 1000000, "\": 1}"),
        repeat("{" HAIR ", \"color\": \"", "#", 1000000, "\"}"),
        repeat("{" HAIR ", \"head\": \"", "\xc3\xa4", 100000, "\"}"),
        repeat("{\"sections\": [{\"file\": \"a\"}", ",{\"file\": \"a\"}", 100000, "]}"),
    };
    // Balanced, and as deep as the parser allows.
    char *closed = repeat(texts[2], "]", 2000, "}");
    free(texts[2]);
    texts[2] = closed;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        Scene scene;
        Error error = {{0}};
        assert_int_equal(read_scene(state, &scene, texts[i], &error), RESULT_BAD_INPUT);
        assert_true(strlen(error.text) < 500);
        assert_null(strchr(error.text, '\n'));
        scene_destroy(&scene);
        free(texts[i]);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_row_is_set_by_its_flag_and_by_nothing_else),
        TEST(every_row_is_set_by_its_key_in_a_scene_file),
        cmocka_unit_test(help_names_every_flag_with_its_default),
        cmocka_unit_test(help_is_at_most_96_columns_wide),
        cmocka_unit_test(the_man_page_has_no_bare_hyphen_and_names_the_version),
        cmocka_unit_test(help_and_version_win_over_all_but_wrong_flags_before_them),
        cmocka_unit_test(flags_may_stand_anywhere_and_values_may_look_like_flags),
        cmocka_unit_test(the_last_of_equal_flags_counts_and_no_takes_back),
        cmocka_unit_test(section_flags_reach_every_section),
        cmocka_unit_test(output_is_needed_only_to_draw),
        cmocka_unit_test(wrong_command_lines_are_refused_with_the_nearest_name),
        cmocka_unit_test(a_scene_file_says_all_that_flags_can_and_more),
        cmocka_unit_test(a_section_overrides_the_top_level_and_flags_override_both),
        cmocka_unit_test(paths_in_a_scene_file_are_relative_to_its_folder),
        TEST(without_lights_there_are_two_and_an_empty_list_means_none),
        TEST(a_scene_file_is_known_by_its_content_and_stands_alone),
        TEST(what_is_written_is_a_scene_file_of_the_same_scene),
        cmocka_unit_test(a_file_name_that_is_no_utf_8_is_still_written),
        TEST(wrong_scene_files_are_refused_with_place_and_expectation),
        TEST(flags_may_mend_a_combination_that_a_scene_file_has),
        TEST(every_truncation_of_a_scene_file_is_refused),
        TEST(deep_and_huge_files_are_refused_in_one_short_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
