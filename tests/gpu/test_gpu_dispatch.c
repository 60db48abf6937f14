// SPDX-License-Identifier: MIT
// Every item is processed exactly once, however few groups per dimension a driver allows; and a GL
// error is reported with the pass that caused it.
#include "gpu/gpu_buffer.h"
#include "gpu/gpu_dispatch.h"
#include "gpu/gpu_timer.h"
#include "gpu/shader.h"
#include "support/hair_fixture.h"
#include "support/test_glsl.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static int open_gpu(void **state)
{
    (void)state;
    fixture_gpu();
    shader_add_sources(TEST_GLSL_SOURCES);
    return 0;
}

// Runs probe_lanes.comp, which adds 1 to visits[layer][lane] of `count` lanes and `layers` layers.
static uint32_t *run_lanes(int most_groups, uint32_t count, uint32_t layers)
{
    GLuint program;
    Error error;
    GpuBuffer visits;
    GpuLimits limits = fixture_gpu()->limits;
    limits.work_groups = most_groups;
    const ShaderDefine defines[] = {{"GROUP_SIZE", 8}, {NULL, 0}};
    if (shader_build_compute(&program, "probe_lanes.comp", defines, &error) != RESULT_OK)
        fail_msg("%s", error.text);
    assert_int_equal(
        gpu_buffer_create(&visits, &limits, "visits", (int64_t)count * layers * 4, NULL, 0, &error),
        RESULT_OK);
    gpu_buffer_clear(&visits, 0);
    gpu_buffer_bind_storage(&visits, 0);
    glUseProgram(program);
    glUniform1i(0, (GLint)count);
    gpu_dispatch(&limits, count, 8, layers);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    uint32_t *read = gpu_buffer_read(&visits);
    assert_non_null(read);
    gpu_buffer_destroy(&visits);
    shader_release(program);
    return read;
}

static void every_item_is_worked_on_once_however_few_groups_stand_side_by_side(void **state)
{
    (void)state;
    static const struct {
        int most;
        uint32_t count, layers;
    } cases[] = {{65535, 1, 1}, {65535, 1000, 1}, {1, 9, 1},    {3, 24, 1},  {3, 25, 1},
                 {7, 1000, 1},  {7, 999, 3},      {4, 4099, 2}, {1000, 1, 5}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        uint32_t *visits = run_lanes(cases[i].most, cases[i].count, cases[i].layers);
        for (uint32_t k = 0; k < cases[i].count * cases[i].layers; ++k)
            if (visits[k] != 1) fail_msg("case %zu: item %u: %u visits", i, k, visits[k]);
        free(visits);
    }
}

static void no_items_are_no_dispatch(void **state)
{
    (void)state;
    Error error;
    gpu_dispatch(&fixture_gpu()->limits, 0, 8, 1);
    assert_int_equal(gpu_check("nothing", &error), RESULT_OK);
}

static void an_error_is_told_with_the_pass_that_made_it(void **state)
{
    (void)state;
    GpuTimer timer;
    Error error;
    gpu_timer_create(&timer, false, fixture_gpu()->software);
    gpu_timer_begin(&timer, "draw_one");
    gpu_timer_end(&timer);
    gpu_timer_begin(&timer, "draw_two");
    glBindBuffer(0, 0); // no such target
    gpu_timer_end(&timer);
    gpu_timer_begin(&timer, "draw_three");
    glMemoryBarrier(0x40000000); // no such bit
    gpu_timer_end(&timer);
    assert_int_equal(gpu_check("drawing", &error), RESULT_FAILED);
    assert_string_equal(error.text, "drawing: pass draw_two: OpenGL error 0x0500 (invalid enum)");
    assert_int_equal(gpu_check("drawing", &error), RESULT_OK);
    glBindBuffer(0, 0);
    assert_int_equal(gpu_check("drawing", &error), RESULT_FAILED);
    assert_string_equal(error.text, "drawing: OpenGL error 0x0500 (invalid enum)");
    gpu_timer_destroy(&timer);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_item_is_worked_on_once_however_few_groups_stand_side_by_side),
        cmocka_unit_test(no_items_are_no_dispatch),
        cmocka_unit_test(an_error_is_told_with_the_pass_that_made_it),
    };
    return cmocka_run_group_tests(tests, open_gpu, NULL);
}
