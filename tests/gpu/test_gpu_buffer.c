// SPDX-License-Identifier: MIT
// What the program writes to a buffer takes effect after everything queued before it, and before
// everything queued after it.
#include "gpu/gpu_buffer.h"
#include "gpu/shader.h"
#include "support/hair_fixture.h"
#include "support/test_glsl.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

enum { WORDS = 256, GROUP = 64, BEFORE = 1, ADDED = 10, WRITTEN = 77 };

static GLuint programs[2]; // TEXTURE 0 and 1

static int open_gpu(void **state)
{
    (void)state;
    shader_add_sources(TEST_GLSL_SOURCES);
    fixture_gpu();
    for (int texture = 0; texture < 2; ++texture) {
        Error error;
        const ShaderDefine defines[] = {{"TEXTURE", texture}, {NULL, 0}};
        if (shader_build_compute(&programs[texture], "probe_order.comp", defines, &error) !=
            RESULT_OK)
            fail_msg("%s", error.text);
    }
    return 0;
}

static int close_gpu(void **state)
{
    (void)state;
    for (int texture = 0; texture < 2; ++texture) shader_release(programs[texture]);
    return 0;
}

static void create(GpuBuffer *buffer, bool textured)
{
    uint32_t words[WORDS];
    for (int i = 0; i < WORDS; ++i) words[i] = BEFORE;
    assert_int_equal(gpu_buffer_create(buffer, &fixture_gpu()->limits, "words", sizeof words, words,
                                       textured ? GL_R32UI : 0, NULL),
                     RESULT_OK);
}

// Queues a pass that sets `to` to `from` + ADDED.
static void add(const GpuBuffer *to, const GpuBuffer *from, bool texture, int rounds)
{
    glUseProgram(programs[texture]);
    glUniform1i(0, rounds);
    gpu_buffer_bind_storage(to, 0);
    if (texture)
        gpu_buffer_bind_texture(from, 0);
    else
        gpu_buffer_bind_storage(from, 1);
    glDispatchCompute(WORDS / GROUP, 1, 1);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

static void expect(const GpuBuffer *buffer, uint32_t word, const char *what)
{
    uint32_t *words = gpu_buffer_read(buffer);
    assert_non_null(words);
    for (int i = 0; i < WORDS; ++i)
        if (words[i] != word) fail_msg("%s: word %d is %u, not %u", what, i, words[i], word);
    free(words);
}

static void overwrite(const GpuBuffer *buffer, bool clears)
{
    uint32_t words[WORDS];
    for (int i = 0; i < WORDS; ++i) words[i] = WRITTEN;
    if (clears)
        gpu_buffer_clear(buffer, WRITTEN);
    else
        gpu_buffer_write(buffer, 0, words, sizeof words);
}

// Overwrites a buffer that queued passes write or read. A slow pass keeps a GPU busy for some
// milliseconds, so that they wait. `moved`: other buffers are bound in their place meanwhile.
static void check(bool clears, bool textured, bool texture, bool moved)
{
    GpuBuffer buffer, result, others[2];
    const int slow = fixture_gpu()->software ? 100 : 2000000;
    create(&buffer, textured);
    create(&result, false);
    for (int i = 0; i < 2; ++i) create(&others[i], true);

    add(&others[0], &others[1], false, slow);
    add(&result, &buffer, texture, 0);
    if (moved) add(&others[0], &others[1], texture, 0);
    overwrite(&buffer, clears);
    expect(&result, BEFORE + ADDED, "read before it was overwritten");
    add(&result, &buffer, texture, 0);
    expect(&result, WRITTEN + ADDED, "read after it was overwritten");

    add(&others[0], &others[1], false, slow);
    add(&buffer, &others[1], texture, 0);
    if (moved) add(&others[0], &others[1], texture, 0);
    overwrite(&buffer, clears);
    expect(&buffer, WRITTEN, "written by a pass before");

    gpu_buffer_destroy(&buffer);
    gpu_buffer_destroy(&result);
    for (int i = 0; i < 2; ++i) gpu_buffer_destroy(&others[i]);
}

static void buffers_are_overwritten_in_the_order_of_the_queue(void **state)
{
    (void)state;
    for (int clears = 0; clears < 2; ++clears)
        for (int textured = 0; textured < 2; ++textured)
            for (int texture = 0; texture <= textured; ++texture)
                for (int moved = 0; moved < 2; ++moved) check(clears, textured, texture, moved);
}

static void a_part_is_overwritten_and_the_rest_stays(void **state)
{
    (void)state;
    const uint32_t some[3] = {4, 5, 6};
    for (int textured = 0; textured < 2; ++textured) {
        GpuBuffer buffer;
        create(&buffer, textured);
        gpu_buffer_write(&buffer, 8, some, sizeof some);
        uint32_t *words = gpu_buffer_read(&buffer);
        assert_non_null(words);
        for (int i = 0; i < WORDS; ++i)
            assert_int_equal(words[i], i >= 2 && i < 5 ? some[i - 2] : BEFORE);
        free(words);
        gpu_buffer_destroy(&buffer);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(buffers_are_overwritten_in_the_order_of_the_queue),
        cmocka_unit_test(a_part_is_overwritten_and_the_rest_stays),
    };
    return cmocka_run_group_tests(tests, open_gpu, close_gpu);
}
