// SPDX-License-Identifier: MIT
// Users of equal programs share one, and only a few unused programs are kept. Artificial errors of
// functions, by which tests imitate other drivers.
#include "base/random.h"
#include "gpu/gpu.h"
#include "gpu/shader.h"
#include "support/needed.h"
#include "support/test_glsl.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

// --- Files that include others.

enum { FILES = 40, FILES_MOST = 32 };

// Builds file `first` of a chain in which each file includes the next one. Each has `texts[k]` with
// k = 0 for all files but the last one, where k = 1.
static Result build_chain(int first, const char *const texts[2], Error *error)
{
    static GlslSource sources[FILES + 1];
    static char names[FILES][24], contents[FILES][200];
    GLuint program;
    for (int i = 0; i < FILES; ++i) {
        snprintf(names[i], sizeof names[i], "chain_%d.comp", i);
        if (i + 1 < FILES)
            snprintf(contents[i], sizeof contents[i], "// first\n#include \"chain_%d.comp\"\n%s",
                     i + 1, texts[0]);
        else
            snprintf(contents[i], sizeof contents[i], "%s", texts[1]);
        sources[i] = (GlslSource){names[i], contents[i]};
    }
    shader_add_sources(sources);
    shader_assume_ulps(0); // artificial errors would include one more file
    Result result = shader_build_compute(&program, names[first], NULL, error);
    shader_assume_ulps(gpu.ulps);
    shader_add_sources(TEST_GLSL_SOURCES);
    if (result == RESULT_OK) shader_release(program);
    return result;
}

#define MAIN "layout(local_size_x = 1) in;\nvoid main() {}\n"

// An error in a shader names the file that has it, and its line in this file.
static void errors_in_shaders_have_a_place(void **state)
{
    static const struct {
        int first;
        const char *texts[2], *message;
    } cases[] = {
        {FILES - FILES_MOST, {"", MAIN}, NULL},
        {FILES - FILES_MOST - 1, {"", MAIN}, "glsl/chain_39.comp: too many includes"},
        {FILES - 3, {"", "\nint x = y;\n" MAIN}, "glsl/chain_39.comp:2: "},
        {FILES - 2, {"int x = y;\n", MAIN}, "glsl/chain_38.comp:3: "},
        {FILES - 2, {"", "#include \"nowhere.glsl\"\n"}, "glsl/nowhere.glsl: no such shader file"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        Error error = {{0}};
        Result result = build_chain(cases[i].first, cases[i].texts, &error);
        const char *message = cases[i].message ? cases[i].message : "";
        assert_int_equal(result, cases[i].message ? RESULT_FAILED : RESULT_OK);
        if (!strstr(error.text, message)) fail_msg("'%s' lacks '%s'", error.text, message);
        assert_null(strchr(error.text, '\n'));
    }
}

// --- Artificial errors of functions.

enum { GROUPS = 64, FUNCTIONS = 10, RESULTS = 4 * FUNCTIONS * GROUPS };

// Fills `y` with the results of all functions, [group][function][4].
static void run_functions(int ulps, const float x[4 * GROUPS], float y[RESULTS])
{
    GLuint program, buffers[2];
    shader_assume_ulps(ulps);
    NEEDED(shader_build_compute(&program, "probe_perturb.comp", NULL, error));
    shader_assume_ulps(gpu.ulps);
    glGenBuffers(2, buffers);
    for (GLuint i = 0; i < 2; ++i) {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, buffers[i]);
        glBufferData(GL_SHADER_STORAGE_BUFFER, (i ? RESULTS : 4 * GROUPS) * sizeof *x, i ? NULL : x,
                     GL_STREAM_READ);
    }
    glUseProgram(program);
    glDispatchCompute(GROUPS, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, RESULTS * sizeof *y, y);
    glUseProgram(0);
    glDeleteBuffers(2, buffers);
    shader_release(program);
}

// Each result is moved by so many units in the last place, about half of them upwards, except for
// results that are exact on every driver.
static void functions_have_the_artificial_error_that_was_asked_for(void **state)
{
    enum { ULPS = 5 };
    static float x[4 * GROUPS], exact[RESULTS], moved[RESULTS];
    int up[FUNCTIONS] = {0}, down[FUNCTIONS] = {0};
    Random random = random_create(1, 0);
    (void)state;
    for (int i = 0; i < 4 * GROUPS; ++i) x[i] = (float)(0.01 + 0.98 * random_real(&random));
    const float special[] = {0, 1, -1, INFINITY, -INFINITY, NAN, 88, -80};
    memcpy(x, special, sizeof special);
    run_functions(0, x, exact);
    run_functions(ULPS, x, moved);
    for (int i = 0; i < RESULTS; ++i) {
        int32_t a, b;
        float size = fabsf(exact[i]);
        memcpy(&a, &exact[i], sizeof a);
        memcpy(&b, &moved[i], sizeof b);
        if (isnan(size))
            assert_true(isnan(moved[i]));
        else if (size <= 1e-30f || size >= 1e30f || exact[i] == 1)
            assert_int_equal(a, b);
        else
            assert_int_equal(abs(a - b), ULPS);
        if (a != b && !isnan(size)) ++*(b > a ? &up[i / 4 % FUNCTIONS] : &down[i / 4 % FUNCTIONS]);
    }
    for (int k = 0; k < FUNCTIONS; ++k) assert_true(up[k] > GROUPS && down[k] > GROUPS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_same_files_and_macros_are_one_program),
        cmocka_unit_test(the_number_of_kept_unused_programs_is_limited),
        cmocka_unit_test(what_fails_is_not_kept),
        cmocka_unit_test(errors_in_shaders_have_a_place),
        cmocka_unit_test(functions_have_the_artificial_error_that_was_asked_for),
    };
    return cmocka_run_group_tests_name("shader", tests, open_gpu, close_gpu);
}
