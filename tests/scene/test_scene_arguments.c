// SPDX-License-Identifier: MIT
// Scenes from the command line; every parameter from command line and scene file.
#include "base/decimal.h"
#include "scene/effects.h"
#include "scene/scene_param.h"
#include "support/scene_reader.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void *params_of(Scene *scene, const ParamInfo *info)
{
    return scene_params(scene, info->scope, 0);
}

static void assert_prints(Scene *scene, const ParamInfo *info, const char *expected)
{
    char *text = params_format(info, params_of(scene, info));
    if (!text || strcmp(text, expected) != 0)
        fail_msg("%s is %s, expected %s", info->name, text, expected);
    free(text);
}

// A valid value that differs from the default and causes no conflict by itself.
static const char *sample(const ParamInfo *info, char text[64])
{
    static const char *const TEXTS[] = {
        [PARAM_BOOL] = "true",       [PARAM_VEC3] = "1,2,3",
        [PARAM_COLOR] = "#010203",   [PARAM_BACKGROUND] = "#010203",
        [PARAM_AUTO_VEC3] = "1,2,3", [PARAM_AUTO_COLOR] = "#010203",
        [PARAM_UNIT] = "in",         [PARAM_SIZE] = "32x24",
        [PARAM_PART] = "2/3",        [PARAM_RATE] = "24000/1001",
        [PARAM_TEXT] = "word",       [PARAM_PATH] = "/some/where/",
    };
    bool whole =
        info->kind == PARAM_INT || info->kind == PARAM_UINT || info->kind == PARAM_AUTO_INT;
    if (info->kind == PARAM_CHOICE) return info->choices[1];
    if (strcmp(info->name, "colliders") == 0) return "ground:0;sphere:1,2,3,4";
    if (!whole && info->kind != PARAM_FLOAT && info->kind != PARAM_TURN &&
        info->kind != PARAM_PROFILE && info->kind != PARAM_AUTO_FLOAT)
        return TEXTS[info->kind];
    double least = fmax(info->minimum, -1);
    if (whole)
        snprintf(text, 64, "%.0f", fmin(least + 2, info->maximum));
    else
        decimal_format((float)(least + 0.375), text, 64);
    return text;
}

// Options that some other options require; without them, those have no effect, which is an error.
static const char *find_condition(const ParamInfo *info)
{
    static const struct {
        const char *names, *condition;
    } CONDITIONS[] = {
        {" collide friction collision_margin ", "--colliders ground:0"},
        {" collide_mesh mesh_unit mesh_up mesh_color mesh_shading sdf_resolution sdf_cache ",
         "--mesh /m.obj"},
        {" mesh_rest mesh_fps mesh_start mesh_motion ", "--mesh /m.npz"},
        {" environment_strength environment_turn environment_background ", "--environment /e.pfm"},
        {" gust gust_period gust_repeat wind_spread wind_shelter ", "--wind 1,0,0"},
        {" export_followers ", "--export x.usda"},
        {" exr_layers exr_float ", "--output x_%d.exr"},
        {" turn_lights ease_in ease_out ", "--turntable 360 --frames 120"},
        {" turntable ", "--frames 120"},
        {" shadow_size shadow_opacity ", "--shadow dom"},
        {" shadow_spacing ", "--shadow approx"},
        {" floor_height floor_color ", "--floor plane"},
        {" refraction roughness lobes azimuthal_roughness ", "--shading marschner"},
        {" ambient diffuse specular1 exponent1 specular2 exponent2 ", "--shading kajiya"},
        {" tip_color ", "--tip-length 1"},
        {" melanin_redness ", "--melanin 1"},
        {" curve ", "--smooth 2"},
        {" lod_start lod_min ", "--lod-end 5"},
    };
    char name[64];
    snprintf(name, sizeof name, " %s ", info->name);
    for (size_t i = 0; i < sizeof CONDITIONS / sizeof *CONDITIONS; i++)
        if (strstr(CONDITIONS[i].names, name)) return CONDITIONS[i].condition;
    return "";
}

// Whether the flag is in the conditions or in the line that all cases share.
static bool is_said(const ParamInfo *info, const char *line)
{
    char flag[64];
    snprintf(flag, sizeof flag, " --%s ", info->name);
    for (char *at = flag + 3; *at; at++) *at = *at == '_' ? '-' : *at;
    return strstr(line, flag) || strcmp(info->name, "output") == 0;
}

// Whether the default of `other` changes if `info` is given, or if what `info` requires is given.
static bool gives_way(const ParamInfo *other, const ParamInfo *info)
{
    static const struct {
        const char *other, *to;
    } PAIRS[] = {
        {"file_colors", "color"},    {"file_colors", "transmission"},
        {"file_colors", "melanin"},  {"file_colors", "melanin_redness"},
        {"file_opacity", "opacity"}, {"file_opacity", "file_colors"},
    };
    // What only rod has requires --algo rod, which keeps its shape without a style.
    if (strcmp(other->name, "style") == 0 && strcmp(info->owner, "rod") == 0) return true;
    for (size_t i = 0; i < sizeof PAIRS / sizeof *PAIRS; i++)
        if (strcmp(PAIRS[i].other, other->name) == 0 && strcmp(PAIRS[i].to, info->name) == 0)
            return true;
    return false;
}

static void every_row_is_set_by_its_flag_and_by_nothing_else(void **state)
{
    (void)state;
    for (size_t i = 0; i < PARAM_COUNT; i++) {
        const ParamInfo *info = &PARAM_TABLE[i];
        char buffer[64], name[64], line[300], said[100];
        const char *value = sample(info, buffer);
        if (strcmp(info->name, "quality") == 0 || strcmp(info->name, "look") == 0)
            continue; // they stand for several parameters
        snprintf(name, sizeof name, "%s", info->name);
        for (char *at = name; *at; at++) *at = *at == '_' ? '-' : *at;
        for (int form = 0; form < 2; form++) {
            const char *between = form ? "=" : info->kind == PARAM_BOOL ? NULL : " ";
            snprintf(said, sizeof said, " %s%s%.*s ", find_condition(info),
                     *info->owner ? " --algo " : "", (int)strcspn(info->owner, " "), info->owner);
            snprintf(line, sizeof line, "hair.tfx -o o/%s--%s%s%s", said, name,
                     between ? between : "", between ? value : "");
            Scene scene;
            assert_read(&scene, line);
            for (size_t j = 0; j < PARAM_COUNT; j++) {
                const ParamInfo *other = &PARAM_TABLE[j];
                if (gives_way(other, info)) continue;
                if (j == i || !is_said(other, said))
                    assert_prints(&scene, other, j == i ? value : other->default_text);
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
        assert_int_equal(params_parse(info, params_of(&scene, info), value, &error), RESULT_OK);
        json_t *json = scene_param_write(info, params_of(&scene, info));
        char *text = json_dumps(json, JSON_ENCODE_ANY | JSON_REAL_PRECISION(9));
        json_decref(json);
        scene_destroy(&scene);
        char file[300];
        const char *algo = *info->owner ? info->owner : "split";
        snprintf(file, sizeof file,
                 "{\"sections\": [{\"file\": \"a\", \"algo\": \"%.*s\"}], \"%s\": %s}",
                 (int)strcspn(algo, " "), algo, info->name, text);
        free(text);
        if (read_scene(state, &scene, file, &error) != RESULT_OK) fail_msg("%s", error.text);
        if (strcmp(info->name, "algo") != 0) assert_prints(&scene, info, value);
        scene_destroy(&scene);
    }
}

static void help_and_version_win_over_all_but_wrong_flags_before_them(void **state)
{
    (void)state;
    static const struct {
        const char *line;
        SceneRequest request;
        const char *topic;
    } LINES[] = {{"--help", REQUEST_HELP, NULL},
                 {"-h", REQUEST_HELP, NULL},
                 {"-qh", REQUEST_HELP, NULL},
                 {"--help=man", REQUEST_HELP, "man"},
                 {"--help color", REQUEST_HELP, "color"},
                 {"-h all", REQUEST_HELP, "all"},
                 {"--version", REQUEST_VERSION, NULL},
                 {"missing.json --fps x --help", REQUEST_HELP, NULL}};
    for (size_t i = 0; i < sizeof LINES / sizeof LINES[0]; i++) {
        Scene scene;
        assert_read(&scene, LINES[i].line);
        assert_int_equal(scene.request, LINES[i].request);
        if (LINES[i].topic) assert_non_null(scene.topic);
        if (!LINES[i].topic) assert_null(scene.topic);
        scene_destroy(&scene);
    }
    assert_refused("--halp --help", RESULT_USAGE, "--halp: no such option: did you mean '--help'?");
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

static void a_turntable_needs_no_angle(void **state)
{
    (void)state;
    static const struct {
        const char *line;
        float angle, fps, sim_rate;
        int frames;
        uint32_t files;
    } LINES[] = {
        {"a.tfx -o x/ --turntable", 360, 30, 60, 180, 1},
        {"--turntable a.tfx -o x/", 360, 30, 60, 180, 1},
        {"--turntable b.tfx a.tfx -o x/", 360, 30, 60, 180, 2},
        {"a.tfx --turntable -o x/", 360, 30, 60, 180, 1},
        {"a.tfx -o x/ --turntable 90", 90, 30, 60, 180, 1},
        {"a.tfx -o x/ --turntable -45.5", -45.5f, 30, 60, 180, 1},
        {"a.tfx -o x/ --turntable=90", 90, 30, 60, 180, 1},
        {"a.tfx -o x/ --turntable 0", 0, 60, 0, 120, 1},
        {"a.tfx -o x/ --turntable --fps 24", 360, 24, 0, 120, 1},
        {"a.tfx -o x/ --turntable --frames 48", 360, 60, 0, 48, 1},
        {"a.tfx -o x/ --turntable --speed 0.5", 360, 30, 0, 180, 1},
        {"a.tfx -o x/ --turntable --sim-rate 120", 360, 30, 120, 180, 1},
    };
    for (size_t i = 0; i < sizeof LINES / sizeof *LINES; i++) {
        Scene scene;
        assert_read(&scene, LINES[i].line);
        assert_true(scene.run.turntable == LINES[i].angle && scene.run.fps == LINES[i].fps);
        assert_true(scene.run.sim_rate == LINES[i].sim_rate);
        assert_int_equal(scene.run.frames, LINES[i].frames);
        assert_int_equal(scene.section_count, LINES[i].files);
        scene_destroy(&scene);
    }
}

static void one_name_is_one_frame(void **state)
{
    (void)state;
    static const struct {
        const char *line;
        int first, last, frames;
    } LINES[] = {
        {"a.tfx -o x.png", 0, 0, 120},
        {"a.tfx -o x.pfm --first 30", 30, 30, 120},
        {"a.tfx -o x.png --first 119", 119, 119, 120},
        {"a.tfx -o x.png --turntable --first 45", 45, 45, 180},
        {"a.tfx -o x.png --last 3", 0, 3, 120},    // one name for several images: refused later
        {"a.tfx -o x.png --frames 20", 0, -1, 20}, // the same
        {"a.tfx -o x.png --cache y.cache", 0, -1, 120}, // the cache holds all frames
        {"a.tfx -o x.png --contact-sheet 3x2", 0, -1, 120},
        {"a.tfx -o x_%d.png", 0, -1, 120},
        {"a.tfx -o 50%%.png", 0, 0, 120}, // %% stands for a percent sign
        {"a.tfx -o 50%%_%d.png", 0, -1, 120},
        {"a.tfx -o x.mp4", 0, -1, 120},
    };
    for (size_t i = 0; i < sizeof LINES / sizeof *LINES; i++) {
        Scene scene;
        assert_read(&scene, LINES[i].line);
        assert_int_equal(scene.run.first, LINES[i].first);
        assert_int_equal(scene.run.last, LINES[i].last);
        assert_int_equal(scene.run.frames, LINES[i].frames);
        scene_destroy(&scene);
    }
}

// A file's colours compete with the scene's, and so do opacities: the more specific statement wins.
static void colors_of_files_give_way_to_what_is_named(void **state)
{
    static const struct {
        const char *keys, *shared, *flags;
        bool colors, opacity;
    } CASES[] = {
        {"", "", "", true, true},
        {"", "", " --color red", false, true},
        {"", "", " --albedo red", false, true},
        {"", "", " --transmission red", false, true},
        {"", "", " --melanin 1", false, true},
        {"", "", " --opacity 0.5", true, false},
        {"", "", " --no-file-colors", false, false},
        {"", "", " --no-file-colors --file-opacity", false, true},
        {"", "", " --color red --file-colors", true, true},
        {"", ", \"color\": \"#ff0000\"", "", false, true},
        {", \"file_colors\": true", ", \"color\": \"#ff0000\"", "", true, true},
        {", \"file_colors\": true", "", " --color red", false, true},
        {", \"color\": \"#ff0000\", \"file_colors\": true", "", "", true, true},
        {", \"opacity\": 0.5", "", " --file-opacity", true, true},
        {", \"file_colors\": false", "", "", false, false},
        {", \"file_colors\": false", "", " --file-colors", true, true},
        {"", ", \"file_colors\": false", " --file-colors", true, true},
        {", \"look\": \"plain\"", "", "", true, true},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        bool inner = strstr(CASES[i].keys, "look") == NULL;
        char file[400], line[600];
        Scene scene;
        snprintf(file, sizeof file, "{\"sections\": [{\"file\": \"a\"%s}]%s%s}",
                 inner ? CASES[i].keys : "", inner ? "" : CASES[i].keys, CASES[i].shared);
        snprintf(line, sizeof line, "%s -o x/%s", write_scene(state, file), CASES[i].flags);
        assert_read(&scene, line);
        print_message("%s%s%s\n", CASES[i].keys, CASES[i].shared, CASES[i].flags);
        assert_int_equal(scene.sections[0].params.file_colors, CASES[i].colors);
        assert_int_equal(scene.sections[0].params.file_opacity, CASES[i].opacity);
        scene_destroy(&scene);
    }
}

// Of color, transmission and melanin the most specific statement wins, and the replaced ones no
// longer change over time.
static void a_color_ends_what_it_replaces(void **state)
{
#define KEYS(at_0, at_1)                                                                           \
    "{\"keys\": [{\"time\": 0, \"value\": " at_0 "}, {\"time\": 1, \"value\": " at_1 "}]}"
#define RED   "\"#ff0000\""
#define GREEN "\"#00ff00\""
    static const struct {
        const char *keys, *shared, *flags;
        bool transmission, melanin; // whether they have an effect
        uint32_t tracks;
    } CASES[] = {
        {", \"transmission\": " RED, "", " --color blond", false, false, 0},
        {", \"transmission\": " KEYS(RED, GREEN), "", " --color blond", false, false, 0},
        {", \"melanin\": 2", "", " --color blond", false, false, 0},
        {", \"melanin\": " KEYS("1", "2"), "", " --color blond", false, false, 0},
        {", \"melanin\": {\"formula\": \"t\"}", "", " --color blond", false, false, 0},
        {", \"melanin\": " KEYS("1", "2"), "", " --transmission red", true, false, 0},
        {", \"color\": " RED, ", \"melanin\": " KEYS("1", "2"), "", false, false, 0},
        {", \"color\": " KEYS(RED, GREEN), ", \"melanin\": 2", "", false, false, 1},
        {", \"transmission\": " KEYS(RED, GREEN), "", "", true, false, 1},
        {", \"melanin\": " KEYS("1", "2"), "", " --drag 2", false, true, 1},
        {", \"melanin\": " KEYS("1", "2"), "", " --melanin 3", false, true, 0},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char file[400], line[600];
        Scene scene;
        snprintf(file, sizeof file, "{\"sections\": [{\"file\": \"a\"%s}]%s}", CASES[i].keys,
                 CASES[i].shared);
        snprintf(line, sizeof line, "%s -o x/%s", write_scene(state, file), CASES[i].flags);
        assert_read(&scene, line);
        print_message("%s%s%s\n", CASES[i].keys, CASES[i].shared, CASES[i].flags);
        SectionParams *params = &scene.sections[0].params;
        section_tracks_apply(&scene.sections[0].tracks, 1, params);
        assert_int_equal(params->transmission.automatic, !CASES[i].transmission);
        assert_int_equal(params->melanin.automatic, !CASES[i].melanin);
        assert_int_equal(scene.sections[0].tracks.count, CASES[i].tracks);
        scene_destroy(&scene);
    }
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
        {"a.tfx -o x/ --algoo split", "--algoo: no such option: did you mean '--algo'?"},
        {"a.tfx -o x/ --camra-up 0,1,0", "did you mean '--camera-up'?"},
        {"a.tfx -o x/ --no-sofware", "--no-sofware: no such option: did you mean '--no-software'?"},
        {"a.tfx -o x/ --wibble 3", "--wibble: no such option: see --help"},
        {"a.tfx -o x/ --no-fps", "--no-fps: --fps takes a value"},
        {"a.tfx -o x/ --no-quiet=true", "--no-quiet: got 'true', expected no value"},
        {"a.tfx -o x/ --quiet=maybe", "--quiet: got 'maybe', expected true or false"},
        {"a.tfx -o x/ -x", "-x: no such option: see --help"},
        {"a.tfx -o x/ -5", "-5: no such option"},
        {"a.tfx -o", "-o: no value: expected PATH"},
        {"a.tfx --fps", "--fps: no value: expected X"},
        {"a.tfx --output --fps 30", "--output: no value: expected PATH"},
        {"a.tfx -o x/ --fps 0", "--fps: got '0', expected a number from 0.001 to 10000 (1/s)"},
        {"a.tfx -o x/ --opacity nan", "--opacity: got 'nan'"},
        {"a.tfx -o x/ --up w", "expected auto, y or z"},
        {"a.tfx -o x/ --backend elg", "(nearest: egl)"},
        {"a.tfx -o x/ -q -v", "--quiet and --verbose: expected only one of them"},
        {"a.tfx -o x/ --software --require-hardware", "expected only one of them"},
        {"a.tfx -o x/ --backend osmesa --device 1", "expected only one of them"},
        {"a.tfx -o x/ --backend osmesa --require-hardware", "expected only one of them"},
        {"a.tfx -o x/ --turntable=9x", "--turntable: got '9x', expected a number from"},
        {"a.tfx -o x/ --first 120", "--first 120: expected 0 to 119"},
        {"a.tfx -o x.png --first 120", "--first 120: expected 0 to 119"},
        {"a.tfx -o x/ --frames 10 --last 10", "--last 10: expected 0 to 9"},
        {"a.tfx -o x/ --first 5 --last 4", "--last 4: expected 5 or more, since --first is 5"},
        {"a.tfx -o x/ --camera-up 0,0,0", "--camera-up: got 0,0,0, expected a direction"},
        {"a.tfx -o x/ --eye 1,2,3 --target 1,2,3",
         "--eye and --target: the same point: expected two points"},
        {"a.tfx -o x/ --eye 0,2,3 --target -0,2,3",
         "--eye and --target: the same point: expected two points"},
    };
    for (size_t i = 0; i < sizeof LINES / sizeof LINES[0]; i++)
        assert_refused(LINES[i].line, RESULT_USAGE, LINES[i].message);
    Scene scene;
    assert_read(&scene, "a.tfx -o x_%04d.png --first 119 --last 119");
    scene_destroy(&scene);
    assert_read(&scene, "a.tfx -o 50%/");
    scene_destroy(&scene);
}

static void flags_without_effect_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *line, *message;
    } LINES[] = {
        {"a.tfx -o x/ --rope-iterations 5",
         "--rope-iterations: --algo hybrid has no such parameter"},
        {"a.tfx b.tfx -o x/ --algo chain --rope-damping 0", "--rope-damping: --algo chain has no"},
        {"a.tfx -o x/ --collide --scalp none", "--collide: has no effect: no --colliders"},
        {"a.tfx -o x/ --mesh m.obj --no-collide-mesh --friction 1", "--friction: has no effect"},
        {"a.tfx -o x/ --no-collide-mesh --friction 1", "--mesh or --scalp to collide with"},
        {"a.tfx -o x/ --friction 1 --colliders ground:0 --no-collide", "effect: --no-collide"},
        {"a.tfx -o x/ --collide-mesh --scalp none", "--collide-mesh: has no effect: there is no"},
        {"a.tfx -o x/ --sdf-resolution 99", "there is no --mesh"},
        {"a.tfx -o x/ --sdf-resolution 99 --mesh m.obj --no-collide-mesh", "--no-collide-mesh"},
        {"a.tfx -o x/ --mesh m.ply --mesh-fps 24", "--mesh-fps: has no effect: --mesh does not"},
        {"a.tfx -o x/ --gust 1", "--gust: has no effect: there is no --wind"},
        {"a.tfx -o x/ --wind 1,0,0 --gust 0 --gust-period 3", "--gust is 0"},
        {"a.tfx -o x/ --shadow none --shadow-size 99",
         "--shadow-size: has no effect: --shadow is none"},
        {"a.tfx -o x/ --shadow dom --shadow-spacing 9", "only --shadow approx uses it"},
        {"a.tfx -o x/ --raster quads --oit none --oit-layers 9", "--oit is none"},
        {"a.tfx -o x/ --floor-color 0,0,0", "--floor-color: has no effect"},
        {"a.tfx -o x/ --ease-in 0.5", "there is no --turntable"},
        {"a.tfx -o x/ --no-turn-lights", "--turn-lights: has no effect"},
        {"a.tfx -o x/ --followers 0 --follow interpolate", "--followers is 0"},
        {"a.tfx -o x/ --look plain --roughness 9", "only --shading marschner uses it"},
        {"a.tfx -o x/ --shading marschner --exponent2 9", "only --shading kajiya uses it"},
        {"a.tfx -o x/ --style 0 --rest hanging", "--rest: has no effect: --style is 0"},
        {"a.tfx -o x/ --teleport none --teleport-angle 9", "--teleport is none"},
        {"a.tfx -o x/ --smooth 1 --curve bspline", "--smooth is 1"},
        {"a.tfx -o x/ --eye 0,0,3 --margin 0.5", "--eye is given"},
        {"a.tfx -o x/ --tip-length 0 --tip-color red", "--tip-length is 0"},
        {"a.tfx -o x/ --scatter none --scatter-cells 9", "--scatter is none"},
        {"a.tfx -o x/ --lod-width 1 --lod-start 1", "--lod-start: has no effect: --lod-end is 0"},
        {"a.tfx -o x/ --lod-min 0.5", "--lod-min: has no effect: --lod-end and --lod-width are 0"},
    };
    for (size_t i = 0; i < sizeof LINES / sizeof LINES[0]; i++)
        assert_refused(LINES[i].line, RESULT_USAGE, LINES[i].message);
    Scene scene;
    assert_read(&scene, "a.tfx -o x/ --lod-width 1 --lod-min 0.5"); // one of the two suffices
    scene_destroy(&scene);
}

static void one_section_that_has_the_parameter_is_enough(void **state)
{
    char line[600];
    snprintf(line, sizeof line, "%s -o x/ --rope-iterations 7",
             write_scene(state, "{\"sections\": [{\"file\": \"a\"}, "
                                "{\"file\": \"b\", \"algo\": \"rope\"}]}"));
    Scene scene;
    assert_read(&scene, line);
    assert_int_equal(scene.sections[1].params.rope_iterations, 7);
    scene_destroy(&scene);
    strcat(line, " --algo split");
    assert_refused(line, RESULT_USAGE, "--rope-iterations: --algo split has no such parameter");
}

static void keys_of_another_solver_are_refused_unless_the_command_line_has_it(void **state)
{
    static const char ONE[] = "{\"sections\": [{\"file\": \"a\"}, "
                              "{\"file\": \"b\", \"rope_iterations\": 7}]}";
    static const char SHARED[] = "{\"rope_iterations\": 7, \"sections\": [{\"file\": \"a\"}, "
                                 "{\"file\": \"b\", \"algo\": \"chain\"}]}";
    char line[600];
    snprintf(line, sizeof line, "%s -o x/", write_scene(state, ONE));
    assert_refused(line, RESULT_USAGE,
                   "scene.json: sections[1].rope_iterations: algo 'hybrid' has no such parameter");
    strcat(line, " --algo rope");
    Scene scene;
    assert_read(&scene, line);
    scene_destroy(&scene);
    snprintf(line, sizeof line, "%s -o x/", write_scene(state, SHARED));
    assert_refused(line, RESULT_USAGE, "scene.json: rope_iterations: no section's algo has");
}

static void keys_without_effect_are_a_warning_of_one_line(void **state)
{
    static const char TEXT[] =
        "{\"look\": \"plain\", \"shadow_size\": 99, \"friction\": 0.1, \"gust\": 0.5, "
        "\"sections\": "
        "[{\"file\": \"a\"}, {\"file\": \"b\", \"roughness\": 9, \"collide\": true}]}";
    Scene scene = {0};
    Error error = {{0}};
    char *said = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&said, &size);
    assert_int_equal(read_scene(state, &scene, TEXT, &error), RESULT_OK);
    effects_warn(&scene, stream);
    fclose(stream);
    assert_non_null(strstr(said, "scene.json: friction: has no effect: no --colliders"));
    assert_non_null(strstr(said, "scene.json: shadow_size: has no effect: --shadow is none\n"));
    assert_non_null(strstr(said, "scene.json: sections[1].roughness: has no effect: only "));
    size_t lines = 0;
    for (const char *at = said; *at; at++) lines += *at == '\n';
    assert_int_equal(lines, 3);
    free(said);
    scene_destroy(&scene);
}

static void flags_may_mend_a_combination_that_a_scene_file_has(void **state)
{
    char line[400];
    snprintf(line, sizeof line, "%s -o x/",
             write_scene(state, "{"
                                "\"sections\": [{\"file\": \"a\"}]"
                                ", \"frames\": 10, \"last\": 20}"));
    assert_refused(line, RESULT_USAGE, "--last 20: expected 0 to 9 (or -1), since --frames is 10");
    strcat(line, " --frames 30");
    Scene scene;
    assert_read(&scene, line);
    assert_int_equal(scene.run.last, 20);
    scene_destroy(&scene);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, temporary_create, temporary_destroy)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_row_is_set_by_its_flag_and_by_nothing_else),
        TEST(every_row_is_set_by_its_key_in_a_scene_file),
        cmocka_unit_test(help_and_version_win_over_all_but_wrong_flags_before_them),
        cmocka_unit_test(flags_may_stand_anywhere_and_values_may_look_like_flags),
        cmocka_unit_test(the_last_of_equal_flags_counts_and_no_takes_back),
        cmocka_unit_test(a_turntable_needs_no_angle),
        cmocka_unit_test(one_name_is_one_frame),
        cmocka_unit_test(section_flags_reach_every_section),
        TEST(colors_of_files_give_way_to_what_is_named),
        TEST(a_color_ends_what_it_replaces),
        cmocka_unit_test(output_is_needed_only_to_draw),
        cmocka_unit_test(wrong_command_lines_are_refused_with_the_nearest_name),
        TEST(flags_may_mend_a_combination_that_a_scene_file_has),
        cmocka_unit_test(flags_without_effect_are_refused),
        TEST(one_section_that_has_the_parameter_is_enough),
        TEST(keys_of_another_solver_are_refused_unless_the_command_line_has_it),
        TEST(keys_without_effect_are_a_warning_of_one_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
