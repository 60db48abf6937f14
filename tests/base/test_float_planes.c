// SPDX-License-Identifier: MIT
// Packed floats come back bit for bit.
#include "base/float_planes.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmocka.h>

static uint8_t *pack(const float *values, size_t count, size_t stride, size_t *size)
{
    uint8_t *packed = malloc(float_planes_bound(count));
    *size = float_planes_pack(values, count, stride, packed);
    assert_true(*size > 0 && *size <= float_planes_bound(count));
    return packed;
}

static void assert_same_after(const float *values, size_t count, size_t stride)
{
    size_t size;
    uint8_t *packed = pack(values, count, stride, &size);
    float *read = malloc(count * sizeof *read + 1);
    assert_true(float_planes_unpack(read, count, stride, packed, size));
    assert_memory_equal(read, values, count * sizeof *read);
    free(packed);
    free(read);
}

static void all_kinds_of_floats_come_back_bit_for_bit(void **state)
{
    (void)state;
    const uint32_t bits[] = {0,          0x80000000, 1,          0x80000001, 0x7f800000,
                             0xff800000, 0x7fc00000, 0xffffffff, 0x7fffffff, 0x3f800000,
                             0xbf800000, 0x00800000, 0x807fffff, 0x7f7fffff, 0xff7fffff};
    enum { COUNT = sizeof bits / sizeof *bits, MANY = 20000 };
    float values[COUNT];
    memcpy(values, bits, sizeof bits);
    for (size_t stride = 1; stride < COUNT + 2; ++stride)
        for (size_t count = 1; count <= COUNT; ++count) assert_same_after(values, count, stride);
    float *many = malloc(MANY * sizeof *many);
    for (uint32_t i = 0; i < MANY; ++i) {
        uint32_t any = i * 2654435761u ^ i << 7;
        memcpy(&many[i], &any, sizeof any);
    }
    assert_same_after(many, MANY, 3);
    free(many);
}

static void smooth_curves_take_fewer_bytes(void **state)
{
    (void)state;
    enum { COUNT = 30000 };
    float *values = malloc(COUNT * sizeof *values);
    size_t size;
    for (int i = 0; i < COUNT; ++i) values[i] = 1.5f + 0.1f * sinf(0.001f * (float)i);
    uint8_t *packed = pack(values, COUNT, 3, &size);
    // Neighbours differ by 3e-4, 2500 units of 2^-23: two planes of four are zeros.
    assert_true(size < COUNT * sizeof *values * 6 / 10);
    assert_same_after(values, COUNT, 3);
    free(packed);
    free(values);
}

// Puts the data at the end of a memory page that no other page follows, so that reading past the
// end crashes.
static void refuse_before_a_hole(const uint8_t *packed, size_t size, size_t count)
{
    size_t page = (size_t)sysconf(_SC_PAGESIZE), pages = (size + page - 1) / page * page;
    uint8_t *memory =
        // cppcheck-suppress invalidFunctionArg; -1 is what MAP_ANONYMOUS asks for
        mmap(NULL, pages + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    float *read = malloc(count * sizeof *read);
    assert_true(memory != MAP_FAILED && read != NULL);
    assert_int_equal(mprotect(memory + pages, page, PROT_NONE), 0);
    for (size_t cut = 0; cut < size; ++cut) {
        memcpy(memory + pages - cut, packed, cut);
        assert_false(float_planes_unpack(read, count, 3, memory + pages - cut, cut));
    }
    free(read);
    munmap(memory, pages + page);
}

static void what_was_not_packed_is_refused(void **state)
{
    (void)state;
    enum { COUNT = 300 };
    float values[COUNT], read[COUNT + 1];
    size_t size;
    for (int i = 0; i < COUNT; ++i) values[i] = (float)(i % 7);
    uint8_t *packed = pack(values, COUNT, 3, &size);
    for (size_t cut = 0; cut < size; ++cut) {
        // memory of its own, so that the sanitizer sees reads past the end
        uint8_t *part = malloc(cut + 1);
        memcpy(part, packed, cut);
        assert_false(float_planes_unpack(read, COUNT, 3, part, cut));
        free(part);
    }
    refuse_before_a_hole(packed, size, COUNT);
    assert_false(float_planes_unpack(read, COUNT + 1, 3, packed, size));
    assert_false(float_planes_unpack(read, COUNT - 1, 3, packed, size));
    free(packed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_kinds_of_floats_come_back_bit_for_bit),
        cmocka_unit_test(smooth_curves_take_fewer_bytes),
        cmocka_unit_test(what_was_not_packed_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
