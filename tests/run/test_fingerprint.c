// SPDX-License-Identifier: MIT
// The fingerprint that identifies the scene of a frame changes with every input and every
// parameter, unless a documented reason exempts it.
#include "run/fingerprint.h"
#include "support/head_formulas.h"
#include "support/temporary.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

typedef struct World {
    Scene scene;
    Assets assets;
    Framing framing;
    Gpu gpu;
    float exposure;
    const char *maker;
    int frame;
} World;

typedef struct Numbers {
    char image[FINGERPRINT_BYTES], hair[FINGERPRINT_BYTES];
} Numbers;

static const float POSITIONS[4][3] = {{0, 0, 0}, {0, -0.1f, 0}, {0.1f, 0, 0}, {0.1f, -0.1f, 0}};

// Two strands in front of a mesh of one triangle. `algo`: of the only section.
static void create(World *world, const char *algo)
{
    SectionParams params;
    *world = (World){.frame = 1, .gpu = {.renderer = "a driver", .version = "4.5"}};
    assert_int_equal(scene_create(&world->scene, NULL), RESULT_OK);
    assert_int_equal(params_create_section(&params, NULL), RESULT_OK);
    assert_int_equal(params_parse(params_find("algo"), &params, algo, NULL), RESULT_OK);
    assert_int_equal(scene_add_section(&world->scene, "x.tfx", &params, NULL), RESULT_OK);
    params_destroy_section(&params);
    Assets *assets = &world->assets;
    *assets = (Assets){.section_count = 1, .body_count = 1};
    assets->meshes = calloc(1, sizeof *assets->meshes);
    assert_non_null(assets->meshes);
    assets->strands = calloc(1, sizeof *assets->strands);
    assert_int_equal(strands_create(assets->strands, 2, 4, NULL), RESULT_OK);
    memcpy(assets->strands->position, POSITIONS, sizeof POSITIONS);
    assets->strands->first[1] = 2;
    assets->strands->first[2] = 4;
    assert_int_equal(mesh_create(assets->meshes, 3, 1, NULL), RESULT_OK);
    outline_frame(&world->framing, &world->scene, assets->strands, NULL);
}

static void destroy(World *world)
{
    scene_destroy(&world->scene);
    assets_destroy(&world->assets);
}

static Numbers numbers_of(const World *world)
{
    Fingerprint fingerprint;
    Numbers numbers = {.image = "", .hair = ""};
    assert_int_equal(fingerprint_create(&fingerprint, &world->scene, &world->assets,
                                        &world->framing, world->exposure, &world->gpu, world->maker,
                                        NULL),
                     RESULT_OK);
    fingerprint_of_image(numbers.image, &fingerprint, world->frame);
    fingerprint_of_hair(numbers.hair, &fingerprint, world->frame);
    fingerprint_destroy(&fingerprint);
    return numbers;
}

static bool is_exempt(const char *name)
{
    for (size_t i = 0; i < FINGERPRINT_EXEMPT_COUNT; ++i)
        if (strcmp(FINGERPRINT_EXEMPT[i].name, name) == 0) return true;
    return false;
}

static void *params_of(World *world, const ParamInfo *info)
{
    return scene_params(&world->scene, info->scope, 0);
}

// Changes the value of the parameter.
static void change(World *world, const ParamInfo *info)
{
    static const char *const WORDS[] = {"true",  "false", "1,2,3",   "0.1,0.2,0.3", "transparent",
                                        "64x48", "2/3",   "90",      "7",           "0.25",
                                        "0.01",  "cm",    "1000000", "2",           "1"};
    void *params = params_of(world, info);
    char *before = params_format(info, params), *after = NULL;
    const char *text = info->kind == PARAM_PATH ? "assets/curls.tfx" : "frame";
    bool is_text = info->kind == PARAM_PATH || info->kind == PARAM_TEXT;
    if (is_text) assert_int_equal(params_parse(info, params, text, NULL), RESULT_OK);
    for (int i = 0; info->choices[i]; ++i)
        if (strcmp(info->choices[i], before) != 0)
            assert_int_equal(params_parse(info, params, info->choices[i], NULL), RESULT_OK);
    for (size_t i = 0; i < sizeof WORDS / sizeof *WORDS && !is_text && !info->choices[0]; ++i) {
        params_parse(info, params, WORDS[i], NULL); // invalid values change nothing
        after = params_format(info, params);
        bool changed = strcmp(before, after) != 0;
        free(after);
        if (changed) break;
    }
    after = params_format(info, params);
    if (strcmp(before, after) == 0) fail_msg("%s: no other value was found", info->name);
    free(before);
    free(after);
}

static void each_parameter_counts_or_is_exempt_for_a_reason(void **state)
{
    (void)state;
    for (size_t i = 0; i < PARAM_COUNT; ++i) {
        const ParamInfo *info = &PARAM_TABLE[i];
        World world;
        char owner[40] = "split";
        if (*info->owner) sscanf(info->owner, "%39s", owner);
        create(&world, owner);
        Numbers before = numbers_of(&world);
        change(&world, info);
        Numbers after = numbers_of(&world);
        bool image = strcmp(before.image, after.image) != 0,
             hair = strcmp(before.hair, after.hair) != 0;
        bool exempt = is_exempt(info->name),
             followers = strcmp(info->name, "export_followers") == 0;
        // A map's contents count, not its path.
        bool counts = !exempt || strcmp(info->name, "color_map") == 0;
        if (image != counts)
            fail_msg("%s %s an image's number", info->name, image ? "changes" : "keeps");
        if (hair != (counts || followers))
            fail_msg("%s %s a hair file's number", info->name, hair ? "changes" : "keeps");
        destroy(&world);
    }
}

static void what_is_exempt_is_a_parameter_and_has_a_reason(void **state)
{
    (void)state;
    for (size_t i = 0; i < FINGERPRINT_EXEMPT_COUNT; ++i) {
        if (!params_find(FINGERPRINT_EXEMPT[i].name))
            fail_msg("%s is no parameter", FINGERPRINT_EXEMPT[i].name);
        assert_true(strlen(FINGERPRINT_EXEMPT[i].reason) > 10);
    }
}

static void nothing(World *world)
{
    (void)world;
}
static void move_vertex(World *world)
{
    world->assets.strands->position[3][1] += 1e-6f;
}
static void cut_strands(World *world)
{
    world->assets.strands->first[1] = 1;
}
static void fix_ends(World *world)
{
    world->assets.strands->both_ends_fixed = true;
}
static void ask_followers(World *world)
{
    world->assets.strands->followers = 3;
}
static void ask_radius(World *world)
{
    world->assets.strands->follower_radius = 0.1f;
}
static void move_mesh(World *world)
{
    world->assets.meshes[0].position[2][0] += 1;
}
static void turn_triangle(World *world)
{
    world->assets.meshes[0].triangle[0][1] = 2;
}
static void other_driver(World *world)
{
    strcpy(world->gpu.renderer, "another driver");
}
static void other_version(World *world)
{
    strcpy(world->gpu.version, "4.6");
}
static void other_maker(World *world)
{
    world->maker = "someone";
}
static void move_head(World *world)
{
    head_set_translation(&world->scene.bodies[0].head, "t", "t", "t");
}
static void dim_light(World *world)
{
    world->scene.lights[0].intensity *= 0.5f;
}
static void drop_light(World *world)
{
    --world->scene.light_count;
}
static void next_frame(World *world)
{
    ++world->frame;
}
static void rename_hair(World *world)
{
    world->scene.sections[0].file[0] = 'y';
}
static void other_exposure(World *world)
{
    world->exposure = 1;
}
static void move_camera(World *world)
{
    world->framing.eye[2] += 1;
}
static void other_processor(World *world)
{
    strcpy(world->gpu.processor, "another");
}
static void color_strands(World *world)
{
    world->assets.strands->color = calloc(4, sizeof(float[4]));
}
static void thicken(World *world)
{
    world->assets.strands->strand_thickness = calloc(2, sizeof(float));
}
static void map_strands(World *world)
{
    world->assets.strands->strand_uv = calloc(2, sizeof(float[2]));
}

// Lights that turn with the camera differ from frame to frame, and the number of frames decides by
// how much.
static void turn(World *world)
{
    world->scene.run.turntable = 360;
    world->scene.run.turn_lights = true;
}

static void turn_longer(World *world)
{
    turn(world);
    world->scene.run.frames *= 2;
}

static void every_input_counts(void **state)
{
    static const struct {
        const char *name;
        void (*change)(World *world);
        bool image, hair;
    } CASES[] = {
        {"nothing", nothing, false, false},
        {"a vertex", move_vertex, true, true},
        {"strands", cut_strands, true, true},
        {"fixed ends", fix_ends, true, true},
        {"followers", ask_followers, true, true},
        {"their radius", ask_radius, true, true},
        {"colors", color_strands, true, true},
        {"thickness", thicken, true, true},
        {"texture coordinates", map_strands, true, true},
        {"mesh", move_mesh, true, true},
        {"triangle", turn_triangle, true, true},
        {"driver", other_driver, true, true},
        {"its version", other_version, true, true},
        {"processor", other_processor, false, false}, // render farms have different processors
        {"maker of the cache", other_maker, true, true},
        {"head", move_head, true, true},
        {"light", dim_light, true, true},
        {"fewer lights", drop_light, true, true},
        {"frame", next_frame, true, true},
        {"name of the hair file", rename_hair, false, false},
        {"exposure", other_exposure, true, false},
        {"camera", move_camera, true, false},
    };
    (void)state;
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; ++i) {
        World world;
        create(&world, "split");
        Numbers before = numbers_of(&world);
        CASES[i].change(&world);
        Numbers after = numbers_of(&world);
        if ((strcmp(before.image, after.image) != 0) != CASES[i].image)
            fail_msg("%s: image", CASES[i].name);
        if ((strcmp(before.hair, after.hair) != 0) != CASES[i].hair)
            fail_msg("%s: hair", CASES[i].name);
        destroy(&world);
    }
}

// --frames, --first and --caption file count only where they change what a frame shows.
static void what_a_frame_shows_counts(void **state)
{
    World one, two;
    (void)state;
    create(&one, "split");
    create(&two, "split");
    turn(&one);
    turn_longer(&two);
    assert_string_not_equal(numbers_of(&one).image, numbers_of(&two).image);
    one.frame = two.frame = 0; // frame 0 is equal in both
    assert_string_equal(numbers_of(&one).image, numbers_of(&two).image);
    two.scene.run.frames = one.scene.run.frames;
    two.scene.run.first = 30;
    one.frame = two.frame = 40;
    assert_string_equal(numbers_of(&one).image, numbers_of(&two).image);
    one.scene.run.aov = two.scene.run.aov = AOV_DEPTH;
    one.scene.run.turntable = two.scene.run.turntable = 90;
    one.scene.run.eye = two.scene.run.eye = (AutoVec3){.value = {1, 2, 3}};
    for (int i = 0; i < 2; ++i) {
        World *world = i ? &two : &one;
        assert_int_equal(params_parse(params_find("caption"), &world->scene.run, "file", NULL),
                         RESULT_OK);
    }
    rename_hair(&two);
    assert_string_not_equal(numbers_of(&one).image, numbers_of(&two).image);
    destroy(&one);
    destroy(&two);
}

// The grey of a depth image depends on the depths of the whole sequence.
static void the_depths_of_all_frames_count_in_a_depth_image(void **state)
{
    (void)state;
    for (int aov = AOV_NONE; aov <= AOV_DEPTH; aov += AOV_DEPTH - AOV_NONE) {
        World near, far;
        create(&near, "split");
        create(&far, "split");
        near.scene.run.aov = far.scene.run.aov = aov;
        near.frame = far.frame = 0;
        turn(&near);
        turn(&far);
        far.scene.run.frames = 1; // the camera does not come to the other sides
        bool same = strcmp(numbers_of(&near).image, numbers_of(&far).image) == 0;
        assert_int_equal(same, aov != AOV_DEPTH);
        destroy(&near);
        destroy(&far);
    }
}

static void the_content_of_a_map_counts(void **state)
{
    World world;
    const char *path = temporary_path(state, "map.png");
    create(&world, "split");
    assert_int_equal(
        params_parse(params_find("color_map"), &world.scene.sections[0].params, path, NULL),
        RESULT_OK);
    Numbers numbers[3];
    for (int i = 0; i < 3; ++i) {
        FILE *file = fopen(path, "w");
        fputs(i == 1 ? "red" : "green", file);
        fclose(file);
        numbers[i] = numbers_of(&world);
    }
    assert_string_not_equal(numbers[0].image, numbers[1].image);
    assert_string_equal(numbers[0].image, numbers[2].image);
    unlink(path);
    Fingerprint fingerprint;
    Error error;
    assert_int_equal(fingerprint_create(&fingerprint, &world.scene, &world.assets, &world.framing,
                                        0, &world.gpu, NULL, &error),
                     RESULT_BAD_INPUT);
    assert_non_null(strstr(error.text, "map.png"));
    fingerprint_destroy(&fingerprint);
    destroy(&world);
}

static void the_content_of_an_environment_counts(void **state)
{
    (void)state;
    static EnvironmentPart parts[ENVIRONMENT_PARTS];
    World world;
    create(&world, "split");
    Numbers none = numbers_of(&world);
    world.assets.environment.parts = parts;
    Numbers dark = numbers_of(&world);
    parts[ENVIRONMENT_PARTS - 1].light[2] = 1;
    Numbers lit = numbers_of(&world);
    world.assets.environment.parts = NULL;
    assert_string_not_equal(none.image, dark.image);
    assert_string_not_equal(dark.image, lit.image);
    // The image that is drawn as background: finer than the parts.
    Image *shown = &world.assets.environment.image;
    assert_int_equal(image_create(shown, 4, 2, 3, NULL), RESULT_OK);
    memset(shown->pixels, 0, image_size(shown));
    Numbers black = numbers_of(&world);
    shown->pixels[image_size(shown) - 1] = 1;
    Numbers bright = numbers_of(&world);
    assert_string_not_equal(none.image, black.image);
    assert_string_not_equal(black.image, bright.image);
    destroy(&world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_parameter_counts_or_is_exempt_for_a_reason),
        cmocka_unit_test(what_is_exempt_is_a_parameter_and_has_a_reason),
        cmocka_unit_test(the_content_of_an_environment_counts),
        cmocka_unit_test(every_input_counts),
        cmocka_unit_test(what_a_frame_shows_counts),
        cmocka_unit_test(the_depths_of_all_frames_count_in_a_depth_image),
        cmocka_unit_test_setup_teardown(the_content_of_a_map_counts, temporary_create,
                                        temporary_destroy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
