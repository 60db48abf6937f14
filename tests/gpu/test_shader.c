// SPDX-License-Identifier: MIT
// Users of equal programs share one, and only a few unused programs are kept.
#include "gpu/gpu.h"
#include "gpu/shader.h"
#include "support/needed.h"
#include "support/test_glsl.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

static Gpu gpu;

static int open_gpu(void **state)
{
    (void)state;
    NEEDED(gpu_create(&gpu, &(GpuOptions){0}, error));
    shader_add_sources(TEST_GLSL_SOURCES);
    return 0;
}

static int close_gpu(void **state)
{
    (void)state;
    gpu_destroy(&gpu);
    return 0;
}

static GLuint build(int group_size)
{
    const ShaderDefine defines[] = {{"GROUP_SIZE", group_size}, {NULL, 0}};
    GLuint program;
    NEEDED(shader_build_compute(&program, "probe_lanes.comp", defines, error));
    assert_true(glIsProgram(program));
    return program;
}

static void the_same_files_and_macros_are_one_program(void **state)
{
    (void)state;
    GLuint first = build(8), second = build(8), other = build(16);
    assert_int_equal(first, second);
    assert_int_not_equal(first, other);
    shader_assume_ulps(gpu.ulps + 1);
    GLuint rounded = build(8);
    shader_assume_ulps(gpu.ulps);
    assert_int_not_equal(first, rounded);
    shader_release(first);
    shader_release(second);
    assert_int_equal(build(8), first); // it had no user but was kept
    shader_release(first);
    shader_release(other);
    shader_release(rounded);
    shader_use_programs(NULL);
    shader_release(0); // without a stock, too
    shader_use_programs(gpu.programs);
}

static uint32_t count_programs(void)
{
    uint32_t count = 0;
    for (const GLuint *p = stock_next(gpu.programs, NULL); p; p = stock_next(gpu.programs, p)) {
        assert_true(glIsProgram(*p));
        ++count;
    }
    return count;
}

// All programs of the context, whose names are small numbers that drivers may reuse.
static uint32_t count_live(void)
{
    uint32_t count = 0;
    for (GLuint name = 1; name < 4096; ++name) count += glIsProgram(name);
    return count;
}

// Also if a device has drawn many scenes of different kinds.
static void the_number_of_kept_unused_programs_is_limited(void **state)
{
    (void)state;
    GLuint used = build(1);
    uint32_t most = gpu.programs->most, others = count_live() - count_programs();
    shader_release(build(2));
    for (int i = 3; i < 3 + 2 * (int)most; ++i) shader_release(build(i));
    assert_int_equal(count_programs(), most + 1);
    assert_true(glIsProgram(used));
    assert_int_equal(count_live(), count_programs() + others);
    assert_int_equal(build(1), used);
    shader_release(used);
    shader_release(used);
    shader_release(0); // nothing
    assert_int_equal(count_programs(), most);
}

static void what_fails_is_not_kept(void **state)
{
    static const ShaderDefine wrong[] = {{"GROUP_SIZE", 0}, {NULL, 0}};
    GLuint program = 1;
    Error error;
    uint32_t before = count_programs();
    (void)state;
    for (int i = 0; i < 2; ++i) {
        assert_int_equal(shader_build_compute(&program, "probe_lanes.comp", wrong, &error),
                         RESULT_FAILED);
        assert_int_equal(program, 0);
    }
    assert_int_equal(count_programs(), before);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_same_files_and_macros_are_one_program),
        cmocka_unit_test(the_number_of_kept_unused_programs_is_limited),
        cmocka_unit_test(what_fails_is_not_kept),
    };
    return cmocka_run_group_tests_name("shader", tests, open_gpu, close_gpu);
}
