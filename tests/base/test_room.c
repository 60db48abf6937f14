// SPDX-License-Identifier: MIT
#include "base/room.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include <cmocka.h>

#if !defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__ // they replace malloc
static long page_faults(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_minflt;
}

static void use_block(size_t bytes)
{
    void *volatile block = malloc(bytes);
    assert_non_null(block);
    memset(block, 1, bytes);
    free(block);
}

// Must come first: freeing a larger block has the same effect.
static void pages_of_freed_blocks_are_used_again(void **state)
{
    enum { BYTES = 1 << 20, PAGES = BYTES / 4096, FEW = PAGES / 16 };
    (void)state;
    room_keep_freed();
    use_block(BYTES);
    long before = page_faults();
    use_block(BYTES);
    assert_in_range(page_faults() - before, 0, FEW);
}
#endif

static void arrays_of_all_sizes_can_be_written_to_their_end(void **state)
{
    (void)state;
    const size_t counts[] = {1, 1000, (2 << 20) / 12, (2 << 20) / 12 + 1, 1000000};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; ++i) {
        uint8_t *memory = room_new(counts[i], 12);
        assert_non_null(memory);
        memset(memory, 1, counts[i] * 12);
        free(memory);
    }
}

static void an_array_is_replaced_only_if_it_is_too_small(void **state)
{
    (void)state;
    uint32_t *array = NULL;
    size_t room = 0;
    assert_true(room_make(&array, &room, 100, sizeof *array));
    assert_int_equal(room, 100);
    array[99] = 7;
    const uint32_t *first = array;
    assert_true(room_make(&array, &room, 60, sizeof *array));
    assert_ptr_equal(array, first);
    assert_int_equal(room, 100);
    assert_int_equal(array[99], 7);
    assert_true(room_make(&array, &room, 1000000, sizeof *array));
    assert_int_equal(room, 1000000);
    memset(array, 1, room * sizeof *array);
    free(array);
}

static void sizes_that_no_memory_has_fail(void **state)
{
    (void)state;
    char *array = NULL;
    size_t room = 0;
    assert_null(room_new(SIZE_MAX / 2, 4));
    assert_null(room_new(SIZE_MAX, 1));
    assert_true(room_make(&array, &room, 10, 1));
    assert_false(room_make(&array, &room, SIZE_MAX / 4, 8));
    assert_null(array);
    assert_int_equal(room, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#if !defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__
        cmocka_unit_test(pages_of_freed_blocks_are_used_again),
#endif
        cmocka_unit_test(arrays_of_all_sizes_can_be_written_to_their_end),
        cmocka_unit_test(an_array_is_replaced_only_if_it_is_too_small),
        cmocka_unit_test(sizes_that_no_memory_has_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
