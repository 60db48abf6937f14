// SPDX-License-Identifier: MIT
// The floor's height and extent.
#include "scene/floor.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static Scene scene;
static Framing framing;

static int open_scene(void **state)
{
    (void)state;
    Error error = {{0}};
    memset(&framing, 0, sizeof framing);
    outline_add(&framing.all, (const float[][3]){{-1, 2, 4}, {3, 3, 7}}, 2);
    return scene_create(&scene, &error) != RESULT_OK;
}

static int close_scene(void **state)
{
    (void)state;
    scene_destroy(&scene);
    return 0;
}

static void there_is_none_unless_asked_for(void **state)
{
    (void)state;
    assert_int_equal(floor_find(&scene, &framing).kind, FLOOR_NONE);
}

static void it_lies_just_below_all_that_stands_on_it(void **state)
{
    (void)state;
    scene.run.floor = FLOOR_PLANE;
    Floor floor = floor_find(&scene, &framing);
    assert_int_equal(floor.kind, FLOOR_PLANE);
    assert_float_equal(floor.middle[0], 1, 0);
    assert_float_equal(floor.middle[1], 1.99, 1e-6); // a hundredth of the height
    assert_float_equal(floor.middle[2], 5.5, 0);
    assert_float_equal(floor.whole, 2.5 + 1.01, 1e-6); // half of the 4 x 3 diagonal, the height
    assert_true(floor.faded > floor.whole);
}

static void it_is_the_ground_that_hair_falls_on(void **state)
{
    (void)state;
    Error error = {{0}};
    const char *shapes = "ground:-1;plane:0,1,0,8;ground:0.5;sphere:0,9,0,1";
    scene.run.floor = FLOOR_SHADOW;
    assert_int_equal(colliders_parse(&scene.bodies[0].colliders, shapes, &error), RESULT_OK);
    assert_float_equal(floor_find(&scene, &framing).middle[1], 0.5, 0);
}

static void it_lies_where_the_scene_says(void **state)
{
    (void)state;
    Error error = {{0}};
    scene.run.floor = FLOOR_PLANE;
    scene.run.floor_height = (AutoFloat){.value = -7};
    assert_int_equal(colliders_parse(&scene.bodies[0].colliders, "ground:-1", &error), RESULT_OK);
    assert_float_equal(floor_find(&scene, &framing).middle[1], -7, 0);
    assert_float_equal(floor_find(&scene, &framing).whole, 2.5 + 10, 1e-6);
}

int main(void)
{
#define WITH_SCENE(test) cmocka_unit_test_setup_teardown(test, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(there_is_none_unless_asked_for),
        WITH_SCENE(it_lies_just_below_all_that_stands_on_it),
        WITH_SCENE(it_is_the_ground_that_hair_falls_on),
        WITH_SCENE(it_lies_where_the_scene_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
