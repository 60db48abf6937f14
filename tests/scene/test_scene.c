// SPDX-License-Identifier: MIT
// Scene files: every key is read and written; errors.
#include "base/random.h"
#include "support/scene_reader.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <cmocka.h>

static void a_scene_file_says_all_that_flags_can_and_more(void **state)
{
    (void)state;
    Scene scene;
    Error error;
    assert_int_equal(scene_read(&scene, "tests/data/scene_full.json", &error), RESULT_OK);
    // nothing is added that the scene file does not name
    assert_int_equal(scene.run.scalp, SCALP_NONE);
    assert_int_equal(scene.run.frames, 90);
    assert_int_equal(scene.run.size[0], 640);
    assert_true(scene.run.background[3] == 0);
    assert_true(scene.run.gravity[1] == -3.71f && scene.gravity.keys.count == 0);
    assert_int_equal(scene.wind.keys.count, 2);
    assert_int_equal(scene.wind.keys.interpolation, INTERPOLATION_LINEAR);
    assert_int_equal(scene.bodies[0].head.rotation.keys.count, 2);
    assert_int_equal(scene.bodies[0].head.translation.keys.count, 2);
    assert_true(scene.bodies[0].head.translation.keys.time[0] == 1 &&
                scene.bodies[0].head.pivot[1] == 1.5f);
    assert_true(fabsf(scene.bodies[0].head.rotation.keys.value[4] - 1.57079633f) < 1e-6f);
    assert_int_equal(scene.eye.keys.count, 2);
    assert_int_equal(scene.target.keys.count, 0);
    assert_int_equal(scene.fov.keys.count, 1);
    assert_int_equal(scene.bodies[0].colliders.count, 3);
    assert_true(scene.bodies[0].colliders.list[0].world &&
                scene.bodies[0].colliders.list[0].numbers[7] == 0.05f);
    assert_true(!scene.bodies[0].colliders.list[1].world &&
                scene.bodies[0].colliders.list[1].numbers[3] == 0.09f);
    assert_true(scene.bodies[0].colliders.list[2].kind == COLLIDER_GROUND);
    assert_int_equal(scene.light_count, 4);
    assert_true(scene.lights[0].direction[1] == 1);
    assert_true(fabsf(scene.lights[0].color[1] - 0.2158605f) < 1e-5f);
    assert_true(scene.lights[1].direction[0] == -0.6f && scene.lights[1].direction[2] == 0.8f);
    const Light *point = &scene.lights[2], *spot = &scene.lights[3];
    assert_true(point->kind == LIGHT_POINT && point->position[1] == 2 && point->distance == 1);
    assert_true(spot->kind == LIGHT_SPOT && spot->direction[1] == -1 && spot->distance == 2.5f);
    assert_true(spot->inner_deg == 20 && spot->outer_deg == 30);
    assert_true(spot->radius == 0.25f && scene.lights[0].radius == 0);
    assert_true(scene.lights[0].shadow && !scene.lights[1].shadow && spot->shadow);
    scene_destroy(&scene);
}

static void a_section_overrides_the_top_level_and_flags_override_both(void **state)
{
    (void)state;
    Scene scene;
    assert_read(&scene, "tests/data/scene_full.json");
    assert_true(scene.sections[0].params.style == 0.75f);
    assert_true(scene.sections[1].params.style == 0.5f); // not given: the default
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
    assert_int_equal(scene.wind.keys.count, 0);
    assert_true(scene.run.wind[0] == 1);
    assert_int_equal(scene.fov.keys.count, 0);
    assert_int_equal(scene.eye.keys.count, 2);
    scene_destroy(&scene);
}

static void paths_in_a_scene_file_are_relative_to_its_folder(void **state)
{
    (void)state;
    Scene scene;
    assert_read(&scene, "tests/data/scene_full.json --stats here.json");
    assert_string_equal(scene.sections[0].file, "tests/data/hair/top.tfx");
    assert_string_equal(scene.sections[1].file, "/hair/beard.hair");
    assert_string_equal(scene.bodies[0].params.mesh, "tests/data/models/head.obj");
    assert_string_equal(scene.run.output, "tests/data/frames/");
    assert_string_equal(scene.run.stats, "here.json");
    scene_destroy(&scene);
}

static void a_preset_gives_way_to_what_is_said(void **state)
{
    Error error;
    static const struct {
        const char *arguments;
        Shadow shadow;
        int size, smooth;
    } cases[] = {{"a.tfx -o x/ --look plain", SHADOW_NONE, 256, 1},
                 {"a.tfx -o x/", SHADOW_DOM, 512, 2},
                 {"--look studio a.tfx -o x/ --look plain --shadow none", SHADOW_NONE, 256, 1},
                 {"--shadow approx a.tfx -o x/ --look plain", SHADOW_APPROX, 256, 1},
                 {"--quality final a.tfx -o x/ --look plain", SHADOW_DOM, 512, 3},
                 {"a.tfx -o x/ --quality final", SHADOW_DOM, 512, 3},
                 {"--shadow approx --smooth 2 a.tfx -o x/ --quality final", SHADOW_APPROX, 512, 2},
                 {"a.tfx -o x/ --quality final --shadow-size 100", SHADOW_DOM, 100, 3},
                 {"a.tfx -o x/ --look plain --quality final --quality draft", SHADOW_NONE, 256, 1}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        Scene scene;
        assert_read(&scene, cases[i].arguments);
        assert_int_equal(scene.run.shadow, cases[i].shadow);
        assert_int_equal(scene.run.shadow_size, cases[i].size);
        assert_int_equal(scene.sections[0].params.smooth, cases[i].smooth);
        scene_destroy(&scene);
    }
    Scene scene;
    assert_int_equal(
        read_scene(state, &scene,
                   "{\"sections\": [{\"file\": \"a\", \"smooth\": 5}, {\"file\": \"b\"}], "
                   "\"shadow\": \"approx\", \"quality\": \"final\"}",
                   &error),
        RESULT_OK);
    assert_int_equal(scene.run.quality, QUALITY_FINAL);
    assert_int_equal(scene.run.shadow, SHADOW_APPROX);
    assert_int_equal(scene.run.shadow_size, 512);
    assert_int_equal(scene.sections[0].params.smooth, 5);
    assert_int_equal(scene.sections[1].params.smooth, 3);
    scene_destroy(&scene);
}

// A scene file's look acts like that of a flag, and a flag replaces it. The other keys of the file
// take precedence over both.
static void a_look_is_said_by_the_scene_file_too(void **state)
{
    Scene scene;
    Error error;
    static const char TEXT[] = "{\"look\": \"plain\", \"tip_ratio\": 0.5, \"sections\": "
                               "[{\"file\": \"a\"}, {\"file\": \"b\", \"opacity\": 0.5}]}";
    assert_int_equal(read_scene(state, &scene, TEXT, &error), RESULT_OK);
    assert_int_equal(scene.run.look, LOOK_PLAIN);
    assert_int_equal(scene.run.tone_map, TONE_NONE);
    assert_false(scene.run.exposure.automatic);
    assert_int_equal(scene.light_count, 2);
    assert_int_equal(scene.sections[0].params.shading, SHADING_KAJIYA);
    assert_true(scene.sections[0].params.opacity == 0.6f);
    assert_true(scene.sections[0].params.tip_ratio == 0.5f);
    assert_true(scene.sections[1].params.opacity == 0.5f);
    scene_destroy(&scene);
    char line[600];
    snprintf(line, sizeof line, "%s -o x/ --look studio", write_scene(state, TEXT));
    assert_read(&scene, line);
    assert_int_equal(scene.run.look, LOOK_STUDIO);
    assert_int_equal(scene.run.tone_map, TONE_FILMIC);
    assert_true(scene.run.exposure.automatic);
    assert_int_equal(scene.light_count, 3);
    assert_int_equal(scene.sections[0].params.shading, SHADING_MARSCHNER);
    assert_true(scene.sections[0].params.opacity == 1);
    assert_true(scene.sections[0].params.tip_ratio == 0.5f);
    assert_true(scene.sections[1].params.opacity == 0.5f);
    scene_destroy(&scene);
    assert_int_equal(read_scene(state, &scene,
                                "{\"look\": \"plan\", \"sections\": [{\"file\": \"a\"}]}", &error),
                     RESULT_BAD_INPUT);
    assert_non_null(strstr(error.text, "look: got 'plan'"));
    scene_destroy(&scene);
}

// The studio's lights stand around the automatic camera: 25 degrees to the side, 10 degrees up.
static void lights_stand_around_the_automatic_camera(void **state)
{
    (void)state;
    static const char *const lines[] = {"a.tfx -o x/", "a.tfx -o x/ --eye 0,0,3",
                                        "a.tfx -o x/ --look plain",
                                        "a.tfx -o x/ --look plain --eye 0,0,3"};
    Light key[4];
    for (int i = 0; i < 4; ++i) {
        Scene scene;
        assert_read(&scene, lines[i]);
        key[i] = scene.lights[0];
        scene_destroy(&scene);
    }
    const float side = 25 * 0.01745329f, above = 10 * 0.01745329f, *fixed = key[1].direction,
                right[3] = {cosf(side), 0, -sinf(side)},
                back[3] = {sinf(side) * cosf(above), sinf(above), cosf(side) * cosf(above)},
                top[3] = {-sinf(side) * sinf(above), cosf(above), -cosf(side) * sinf(above)};
    for (int k = 0; k < 3; ++k)
        assert_true(fabsf(key[0].direction[k] - fixed[0] * right[k] - fixed[1] * top[k] -
                          fixed[2] * back[k]) < 1e-5f);
    assert_memory_equal(key[2].direction, key[3].direction, sizeof key[2].direction);
}

static void without_lights_the_look_has_some_and_an_empty_list_means_none(void **state)
{
    Scene scene;
    Error error;
    for (int look = 0; look < 2; ++look) {
        assert_read(&scene, look ? "a.tfx -o x/ --look plain" : "a.tfx -o x/");
        assert_true(scene.lights[0].shadow && scene.lights[1].shadow == !look);
        for (uint32_t i = 0; i < scene.light_count; i++) {
            const float *d = scene.lights[i].direction;
            assert_true(fabsf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2] - 1) < 1e-5f);
        }
        scene_destroy(&scene);
    }
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
    // The copy's relative paths would be relative to the copy's folder.
    char *folder;
    while ((folder = strstr(text, "tests/data/"))) memcpy(folder, "/////////////", 11);
    if (read_scene(state, &again, text, &error) != RESULT_OK) fail_msg("%s", error.text);
    char *second = dump(&again);
    assert_string_equal(text, second);
    free(text);
    free(second);
    scene_destroy(&again);
}

// Tracks of one object with keys at different times.
static void keys_are_written_at_their_own_times(void **state)
{
    Scene scene, again;
    Error error = {""};
    assert_int_equal(read_scene(state, &scene, "{\"sections\": [{\"file\": \"/a\"}]}", &error),
                     RESULT_OK);
    const float point[3] = {1, 2, 3}, fov[1] = {30};
    for (int i = 0; i < 3; ++i) {
        assert_int_equal(keyframes_append(&scene.eye.keys, 2 * i, point, 3, &error), RESULT_OK);
        assert_int_equal(keyframes_append(&scene.target.keys, 1 + i, point, 3, &error), RESULT_OK);
        assert_int_equal(keyframes_append(&scene.fov.keys, 3 * i, fov, 1, &error), RESULT_OK);
    }
    char *text = dump(&scene);
    if (read_scene(state, &again, text, &error) != RESULT_OK) fail_msg("%s", error.text);
    assert_int_equal(again.eye.keys.count, 3);
    assert_int_equal(again.target.keys.count, 3);
    assert_int_equal(again.fov.keys.count, 3);
    for (int i = 0; i < 3; ++i)
        assert_true(again.eye.keys.time[i] == 2 * i && again.target.keys.time[i] == 1 + i &&
                    again.fov.keys.time[i] == 3 * i);
    free(text);
    scene_destroy(&scene);
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
    const char *camera = "{\"sections\": [{\"file\": \"/a\"}], \"wind\": {\"formula\": [1, 0, "
                         "\"sin(t)\"]}, \"camera\": {\"eye\": [\"sin(t)\", 0.5, \"cos(t)\"], "
                         "\"fov\": \"30+t\", \"keys\": [{\"time\": 0, \"target\": [0, 9, 0]}]}}";
    if (read_scene(state, &scene, camera, &error) != RESULT_OK) fail_msg("%s", error.text);
    assert_written_again(state, &scene);
    scene_destroy(&scene);
    // A body's own list takes the place of the default's text, even when the list is empty.
    const char *bodies =
        "{\"colliders\": \"sphere:0,0,0,1\", \"bodies\": [{\"colliders\": [], "
        "\"sections\": [{\"file\": \"/a\"}]}, {\"sections\": [{\"file\": \"/b\"}]}]}";
    if (read_scene(state, &scene, bodies, &error) != RESULT_OK) fail_msg("%s", error.text);
    assert_int_equal(scene.bodies[0].colliders.count, 0);
    assert_int_equal(scene.bodies[1].colliders.count, 1);
    assert_written_again(state, &scene);
    scene_destroy(&scene);
}

// Exactly: if directions of light were normalised again, a few in a hundred would change by one
// unit in the last place.
static void directions_of_light_are_read_as_they_were_written(void **state)
{
    enum { COUNT = 200 };
    Error error = {{0}};
    Random random = random_create(1, 1);
    for (int i = 0; i < COUNT; ++i) {
        Scene scene, again;
        double way[3];
        char text[300];
        random_direction(&random, way);
        snprintf(text, sizeof text,
                 "{\"sections\": [{\"file\": \"/a\"}], \"lights\": [{\"type\": \"%s\", "
                 "\"direction\": [%.9g, %.9g, %.9g]%s}]}",
                 i % 2 ? "spot" : "directional", 7 * way[0], 7 * way[1], 7 * way[2],
                 i % 2 ? ", \"position\": [0, 1, 0]" : "");
        if (read_scene(state, &scene, text, &error) != RESULT_OK) fail_msg("%s", error.text);
        char *written = dump(&scene);
        if (read_scene(state, &again, written, &error) != RESULT_OK) fail_msg("%s", error.text);
        assert_memory_equal(again.lights[0].direction, scene.lights[0].direction,
                            sizeof scene.lights[0].direction);
        free(written);
        scene_destroy(&scene);
        scene_destroy(&again);
    }
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

static const struct {
    const char *text, *message;
} WRONG_FILES[] = {
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
     "sections[1]: unknown key 'darg': did you mean 'drag'?"},
    {"{\"sections\": [{\"file\": \"a\", \"fps\": 1}]}", "'fps' belongs to the top level"},
    {"{\"sections\": [{\"file\": \"a\", \"drag\": -1}]}",
     "sections[0].drag: got '-1', expected a number from 0 to 1000000 (1/s), or two such numbers, "
     "ROOT:TIP (nearest: 0)"},
    {"{" HAIR ", \"drag\": [[0, 1], [1]]}",
     "drag: got [[0,1],[1]], expected a number from 0 to 1000000, or points along the strand"},
    {"{" HAIR ", \"drag\": [[0.5, 1], [0.25, 3]]}", "drag: got '1@0.5:3@0.25'"},
    {"{" HAIR ", \"tip-ratio\": 1}", "unknown key 'tip-ratio': did you mean 'tip_ratio'?"},
    {"{" HAIR ", \"line\\nend\": 1}", "unknown key 'line\\nend'"},
    {"{" HAIR ", \"fps\": \"3/0\"}", "fps: got '3/0', expected a number from 0.001 to 10000"},
    {"{" HAIR ", \"fps\": null}", "fps: got null"},
    {"{" HAIR ", \"fps\": true}", "fps: got true"},
    {"{" HAIR ", \"fps\": 0}", "(nearest: 0.001)"},
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
    {"{" HAIR ", \"color\": \"rad\"}", "color: got 'rad'"},
    {"{" HAIR ", \"gravity\": 9.81}", "gravity: got 9.81, expected three numbers"},
    {"{" HAIR ", \"wind\": {}}", "wind: expected a key 'keys'"},
    {"{" HAIR ", \"wind\": {\"key\": []}}", "wind: unknown key 'key': did you mean 'keys'?"},
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
     "head.keys[0]: unknown key 'rotation': expected time"},
    {"{" HAIR ", \"head\": {\"keys\": [{\"time\": 0, \"rotate\": [0, 0, 0]}], "
     "\"interpolation\": \"cubic\"}}",
     "head.interpolation: got \"cubic\", expected one of \"smooth\" \"linear\""},
    {"{" HAIR ", \"head\": {\"rotate\": [0, 0, 0], \"pivot\": 1}}", "head.pivot: got 1"},
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
     "fov: given here and by 'camera'"},
    {"{" HAIR ", \"eye\": [0, 1, 2], \"camera\": {\"eye\": [\"t\", 0, 1]}}",
     "eye: given here and by 'camera'"},
    {"{" HAIR ", \"camera\": {}}", "camera: expected a key 'keys'"},
    {"{" HAIR ", \"camera\": {\"eye\": [0, \"1/(t-0.5)\", 1]}}",
     "camera.eye[1]: '1/(t-0.5)' is inf at t = 0.5, expected"},
    {"{" HAIR ", \"camera\": {\"target\": [0, \"sin(\", 1]}}", "camera.target[1]: got 'sin('"},
    {"{" HAIR ", \"camera\": {\"target\": [0, 1, \"1/t\"]}}",
     "camera.target[2]: '1/t' is inf at t = 0"},
    {"{" HAIR ", \"camera\": {\"target\": \"t\"}}",
     "camera.target: got \"t\", expected an array of three numbers or formulas of t"},
    {"{" HAIR ", \"frames\": 4, \"fps\": 1, \"camera\": {\"fov\": \"100*t\"}}",
     "camera.fov: '100*t' is 0 at t = 0, expected 1 to 170"},
    {"{" HAIR ", \"camera\": {\"fov\": \"30\", \"keys\": [{\"time\": 0, \"fov\": 30}]}}",
     "camera.fov: given here and by 'keys'"},
    {"{" HAIR ", \"wind\": {\"formula\": [1, \"1/t\", 0]}}",
     "wind.formula[1]: '1/t' is inf at t = 0, expected"},
    {"{" HAIR ", \"colliders\": [{\"sphere\": [1, 2, 3]}]}", "expected an array of 4 numbers"},
    {"{" HAIR ", \"colliders\": [{\"ground\": 1, \"frame\": \"head\"}]}",
     "colliders[0].frame: a ground cannot move with the head"},
    {"{" HAIR ", \"colliders\": [{}]}", "colliders[0]: expected one key"},
    {"{" HAIR ", \"colliders\": [{\"plane\": [0, 0, 0, 1]}]}",
     "plane: the direction is 0,0,0: expected another one"},
    {"{" HAIR ", \"colliders\": \"ground\"}", "colliders: got 'ground'"},
    {"{" HAIR ", \"lights\": {}}", "lights: got {}, expected an array"},
    {"{" HAIR ", \"lights\": [{}]}", "lights[0]: expected a key 'direction'"},
    {"{" HAIR ", \"lights\": [{\"direction\": [0, 0, 0]}]}", "expected a direction"},
    {"{" HAIR ", \"lights\": [{\"type\": \"point\", \"direction\": [0, 0, 1]}]}",
     "lights[0]: unknown key 'direction'"},
    {"{" HAIR ", \"lights\": [{\"type\": \"area\", \"direction\": [0, 0, 1]}]}",
     "lights[0].type: got \"area\""},
    {"{" HAIR ", \"lights\": [{\"type\": \"point\"}]}", "lights[0]: expected a key 'position'"},
    {"{" HAIR ", \"lights\": [{\"type\": \"point\", \"position\": [0, 0, 1], \"distance\": 0}]}",
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
    {"{" HAIR ", \"lights\": [{\"direction\": [0, 0, 1], \"radius\": 46}]}",
     "lights[0].radius: got 46"},
    {"{" HAIR ", \"lights\": [{\"direction\": [0, 0, 1], \"intensity\": -1}]}",
     "lights[0].intensity: got -1"},
    {"{" HAIR ", \"lights\": [1,2,3,4,5,6,7,8,9]}", "got 9 lights, expected 8 at most"},
    {"{" HAIR ", \"output\": \"x.mp4\", \"depth\": \"16\"}", "expected only one of them"},
    {"{" HAIR ", \"first\": 9, \"last\": 3}",
     "scene.json: --last 3: expected 9 or more, since --first is 9"},
    {"{" HAIR ", \"software\": true, \"require_hardware\": true}", "expected only one of them"},
};

static void wrong_scene_files_are_refused_with_place_and_expectation(void **state)
{
    for (size_t i = 0; i < sizeof WRONG_FILES / sizeof WRONG_FILES[0]; i++) {
        Scene scene;
        Error error = {{0}};
        Result result = read_scene(state, &scene, WRONG_FILES[i].text, &error);
        scene_destroy(&scene);
        if (result != RESULT_BAD_INPUT || !strstr(error.text, WRONG_FILES[i].message) ||
            !strstr(error.text, "scene.json") || strchr(error.text, '\n'))
            fail_msg("%s: status %d, '%s' lacks '%s'", WRONG_FILES[i].text, result, error.text,
                     WRONG_FILES[i].message);
    }
}

// The folder is shortened, not the name of the file.
static void messages_name_a_file_in_a_folder_with_a_long_name(void **state)
{
    char folder[201], name[256];
    Scene scene;
    Error error = {{0}};
    memset(folder, 'x', sizeof folder - 1);
    folder[sizeof folder - 1] = 0;
    assert_int_equal(mkdir(temporary_path(state, folder), 0777), 0);
    snprintf(name, sizeof name, "%s/scene_of_a_long_folder.json", folder);
    temporary_write(state, name, "{\"sections\": [{}]}", 0644);
    Result result = scene_read(&scene, temporary_path(state, name), &error);
    scene_destroy(&scene);
    assert_int_equal(result, RESULT_BAD_INPUT);
    const char *end = "/scene_of_a_long_folder.json: sections[0]: expected a key 'file'";
    if (!strstr(error.text, end)) fail_msg("'%s' lacks '%s'", error.text, end);
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

// Returns `before`, `count` times `unit`, then `after`.
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
    // Balanced brackets, as deep as the parser allows.
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
        cmocka_unit_test(a_scene_file_says_all_that_flags_can_and_more),
        cmocka_unit_test(a_section_overrides_the_top_level_and_flags_override_both),
        cmocka_unit_test(paths_in_a_scene_file_are_relative_to_its_folder),
        TEST(a_preset_gives_way_to_what_is_said),
        TEST(a_look_is_said_by_the_scene_file_too),
        TEST(lights_stand_around_the_automatic_camera),
        TEST(without_lights_the_look_has_some_and_an_empty_list_means_none),
        TEST(a_scene_file_is_known_by_its_content_and_stands_alone),
        TEST(keys_are_written_at_their_own_times),
        TEST(what_is_written_is_a_scene_file_of_the_same_scene),
        TEST(directions_of_light_are_read_as_they_were_written),
        cmocka_unit_test(a_file_name_that_is_no_utf_8_is_still_written),
        TEST(wrong_scene_files_are_refused_with_place_and_expectation),
        TEST(messages_name_a_file_in_a_folder_with_a_long_name),
        TEST(every_truncation_of_a_scene_file_is_refused),
        TEST(deep_and_huge_files_are_refused_in_one_short_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
