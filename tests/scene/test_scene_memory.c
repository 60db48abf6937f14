// SPDX-License-Identifier: MIT
// A scene that is written while memory is short. jansson gets an allocator of this test: the usual
// one (json.c) has a reserve, so that one failing malloc does not reach the writer of scenes.
#include "support/scene_reader.h"

#include <limits.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

static int allocations_left; // before one that fails

static void *allocate_or_fail(size_t size)
{
    return allocations_left-- == 0 ? NULL : malloc(size);
}

// In turn, one allocation fails each time: the result is then nothing, never a scene without a
// part.
static void a_scene_is_written_whole_or_not_at_all(void **state)
{
    (void)state;
    Scene scene;
    json_malloc_t allocates;
    json_free_t releases;
    assert_read(&scene, "tests/data/scene_full.json");
    json_get_alloc_funcs(&allocates, &releases);
    json_set_alloc_funcs(allocate_or_fail, free);
    allocations_left = INT_MAX;
    json_t *whole = scene_to_json(&scene);
    int all = INT_MAX - allocations_left, failed = 0;
    assert_non_null(whole);
    for (int i = 0; i < all; ++i) {
        allocations_left = i;
        json_t *json = scene_to_json(&scene);
        failed += !json;
        if (json && !json_equal(json, whole)) fail_msg("allocation %d fails, a part is lost", i);
        json_decref(json);
    }
    assert_true(failed > all / 2);
    json_decref(whole);
    json_set_alloc_funcs(allocates, releases);
    scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_scene_is_written_whole_or_not_at_all)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
