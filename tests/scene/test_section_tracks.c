// SPDX-License-Identifier: MIT
// Parameters of a section by keys and formulas: reading, parameters that may not change, flags,
// writing.
#include "scene/scene.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static Result read_scene(void **state, Scene *scene, const char *keys, Error *error)
{
    char text[2000];
    snprintf(text, sizeof text,
             "{\"frames\": 60, \"fps\": 30, \"sections\": [{\"file\": \"a.tfx\"%s}]}", keys);
    temporary_write(state, "s.json", text, 0644);
    return scene_read(scene, temporary_path(state, "s.json"), error);
}

static Scene read_good(void **state, const char *keys)
{
    Scene scene;
    Error error = {""};
    if (read_scene(state, &scene, keys, &error) != RESULT_OK) fail_msg("%s", error.text);
    return scene;
}

static void keys_and_formulas_give_values(void **state)
{
    Scene scene = read_good(
        state,
        ", \"style\": {\"keys\": [{\"time\": 0, \"value\": 0.5}, {\"time\": 2, \"value\": 0.1}],"
        " \"interpolation\": \"linear\"}, \"drag\": {\"formula\": \"3 + t\"},"
        " \"melanin\": {\"keys\": [{\"time\": 0, \"value\": 1}]},"
        " \"color\": {\"keys\": [{\"time\": 0, \"value\": \"#ff0000\"}, {\"time\": 1, \"value\": "
        "[0, 0, 1]}]}");
    SectionParams params = scene.sections[0].params;
    const SectionTracks *tracks = &scene.sections[0].tracks;
    assert_int_equal(tracks->count, 4);
    // The values at time 0.
    assert_true(params.style == 0.5f && params.drag == 3 && params.color[0] == 1);
    assert_true(!params.melanin.automatic && params.melanin.value == 1);
    uint64_t stamp = section_tracks_stamp(tracks, &params);
    section_tracks_apply(tracks, 1, &params);
    assert_true(fabsf(params.style - 0.3f) < 1e-6f && params.drag == 4);
    assert_true(params.color[0] == 0 && params.color[2] == 1);
    assert_true(section_tracks_stamp(tracks, &params) != stamp);
    section_tracks_apply(tracks, 0, &params);
    assert_true(section_tracks_stamp(tracks, &params) == stamp);
    params.color[2] = 0.5f; // the last component alone
    assert_true(section_tracks_stamp(tracks, &params) != stamp);
    section_tracks_greatest(tracks, 2, 61, &params);
    assert_true(params.style == 0.5f && params.drag == 5);
    // The scene can be written and read back.
    json_t *json = scene_to_json(&scene),
           *section = json_array_get(json_object_get(json, "sections"), 0);
    assert_string_equal(
        json_string_value(json_object_get(json_object_get(section, "drag"), "formula")), "3 + t");
    assert_int_equal(json_array_size(json_object_get(json_object_get(section, "color"), "keys")),
                     2);
    json_decref(json);
    scene_destroy(&scene);
}

static void keys_for_all_sections_give_way_to_a_sections_own(void **state)
{
    temporary_write(
        state, "s.json",
        "{\"drag\": {\"keys\": [{\"time\": 0, \"value\": 0}, {\"time\": 1, \"value\": 4}], "
        "\"interpolation\": \"linear\"}, \"style\": {\"formula\": \"t/4\"}, "
        "\"sections\": [{\"file\": \"a.tfx\"}, "
        "{\"file\": \"b.tfx\", \"drag\": 2, \"style\": 0.5}]}",
        0644);
    Scene scene;
    Error error;
    assert_int_equal(scene_read(&scene, temporary_path(state, "s.json"), &error), RESULT_OK);
    assert_int_equal(scene.sections[0].tracks.count, 2);
    section_tracks_apply(&scene.sections[0].tracks, 0.25, &scene.sections[0].params);
    assert_true(scene.sections[0].params.drag == 1 && scene.sections[0].params.style == 0.0625f);
    assert_int_equal(scene.sections[1].tracks.count, 0);
    assert_true(scene.sections[1].params.drag == 2 && scene.sections[1].params.style == 0.5f);
    scene_destroy(&scene);
}

static void a_flag_replaces_keys(void **state)
{
    Scene scene = read_good(state, ", \"style\": {\"formula\": \"0.5\"}");
    scene_destroy(&scene);
    char *arguments[] = {
        "tractrix-render", (char *)temporary_path(state, "s.json"), "--style", "0.2", "-o", "x/"};
    Error error = {""};
    if (scene_from_arguments(&scene, 6, arguments, &error) != RESULT_OK) fail_msg("%s", error.text);
    assert_int_equal(scene.sections[0].tracks.count, 0);
    assert_true(scene.sections[0].params.style == 0.2f);
    scene_destroy(&scene);
}

// Every number may change over time, unless a documented reason forbids it.
static void what_cannot_change_is_refused_with_a_reason(void **state)
{
    for (size_t i = 0; i < PARAM_COUNT; ++i) {
        const ParamInfo *info = &PARAM_TABLE[i];
        const char *why = section_tracks_refusal(info);
        char keys[200];
        Scene scene;
        Error error = {""};
        if (info->scope != SCOPE_SECTION || !params_owned_by(info, "split")) continue;
        bool color = info->kind == PARAM_COLOR || info->kind == PARAM_AUTO_COLOR;
        snprintf(keys, sizeof keys, ", \"%s\": {\"keys\": [{\"time\": 0, \"value\": %s}]}",
                 info->name,
                 color                                      ? "[0.5, 0.5, 0.5]"
                 : info->minimum <= 1 && info->maximum >= 1 ? "1"
                                                            : "0.01");
        Result result = read_scene(state, &scene, keys, &error);
        if (why) {
            assert_int_equal(result, RESULT_BAD_INPUT);
            if (!strstr(error.text, why))
                fail_msg("%s: '%s' lacks '%s'", info->name, error.text, why);
        } else if (result != RESULT_OK) {
            fail_msg("%s: %s", info->name, error.text);
        } else {
            assert_int_equal(scene.sections[0].tracks.count, 1);
        }
        scene_destroy(&scene);
    }
}

static void wrong_tracks_are_refused(void **state)
{
    static const char *const cases[][2] = {
        {", \"style\": {}", "expected a key 'keys'"},
        {", \"style\": {\"keys\": [{\"time\": 0, \"value\": 2}]}", "got 2"},
        {", \"style\": {\"formula\": \"2*t\"}", "'2*t' is 1.0"},
        {", \"style\": {\"formula\": \"1/0*t\"}", "expected 0 to 1"},
        {", \"style\": {\"formula\": \"nonsense(t)\"}", "nonsense"},
        {", \"style\": {\"formula\": \"0.1\", \"keys\": []}",
         "keys: got [], expected an array of one or more keys"},
        {", \"color\": {\"formula\": \"1\"}", "a color has no formula"},
        {", \"style\": {\"keys\": [{\"time\": 1, \"value\": 0}, {\"time\": 1, \"value\": 0}]}",
         "expected more than 1"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        Scene scene;
        Error error = {""};
        assert_int_equal(read_scene(state, &scene, cases[i][0], &error), RESULT_BAD_INPUT);
        if (!strstr(error.text, cases[i][1])) fail_msg("%s: %s", cases[i][0], error.text);
        scene_destroy(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(keys_and_formulas_give_values, temporary_create,
                                        temporary_destroy),
        cmocka_unit_test_setup_teardown(keys_for_all_sections_give_way_to_a_sections_own,
                                        temporary_create, temporary_destroy),
        cmocka_unit_test_setup_teardown(a_flag_replaces_keys, temporary_create, temporary_destroy),
        cmocka_unit_test_setup_teardown(what_cannot_change_is_refused_with_a_reason,
                                        temporary_create, temporary_destroy),
        cmocka_unit_test_setup_teardown(wrong_tracks_are_refused, temporary_create,
                                        temporary_destroy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
