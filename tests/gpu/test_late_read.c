// SPDX-License-Identifier: MIT
// Bytes that are read back late are those of the moment of the request, complete and at their
// places, even if the buffer is reused. Buffers grow only.
#include "gpu/gpu_buffer.h"
#include "gpu/gpu_dispatch.h"
#include "gpu/late_read.h"
#include "gpu/shader.h"
#include "support/hair_fixture.h"
#include "support/test_glsl.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WORDS = 3000 };

static int open_gpu(void **state)
{
    (void)state;
    fixture_gpu();
    shader_add_sources(TEST_GLSL_SOURCES);
    return 0;
}

static GpuBuffer make_buffer(uint32_t word)
{
    GpuBuffer buffer;
    assert_int_equal(
        gpu_buffer_create(&buffer, &fixture_gpu()->limits, "words", 4 * WORDS, NULL, 0, NULL),
        RESULT_OK);
    gpu_buffer_clear(&buffer, word);
    return buffer;
}

static void begin(LateRead *read, int64_t size)
{
    Error error = {""};
    if (late_read_begin(read, "words", size, &error) != RESULT_OK) fail_msg("%s", error.text);
}

static const uint32_t *open_read(LateRead *read)
{
    Error error = {""};
    const void *bytes = NULL;
    if (late_read_open(read, "words", &bytes, &error) != RESULT_OK) fail_msg("%s", error.text);
    assert_non_null(bytes);
    assert_null(read->fence);
    return bytes;
}

static void what_is_written_behind_the_copy_does_not_count(void **state)
{
    (void)state;
    LateRead read = {0};
    GpuBuffer words = make_buffer(7);
    begin(&read, 4 * WORDS);
    late_read_buffer(&read, 0, &words, 4 * WORDS);
    late_read_send(&read);
    gpu_buffer_clear(&words, 8);
    const uint32_t *bytes = open_read(&read);
    for (int i = 0; i < WORDS; ++i) assert_int_equal(bytes[i], 7);
    late_read_close(&read);
    // The same buffer, which contained other bytes before.
    begin(&read, 4 * WORDS);
    late_read_buffer(&read, 0, &words, 4 * WORDS);
    late_read_send(&read);
    bytes = open_read(&read);
    for (int i = 0; i < WORDS; ++i) assert_int_equal(bytes[i], 8);
    late_read_close(&read);
    late_read_destroy(&read);
    gpu_buffer_destroy(&words);
}

static void several_buffers_lie_where_they_were_put(void **state)
{
    (void)state;
    LateRead read = {0};
    GpuBuffer a = make_buffer(1), b = make_buffer(2), c = make_buffer(3);
    begin(&read, 4 * 100);
    late_read_buffer(&read, 0, &a, 4 * 10);
    late_read_buffer(&read, 4 * 10, &b, 4 * 60);
    late_read_buffer(&read, 4 * 70, &c, 4 * 30);
    late_read_send(&read);
    const uint32_t *bytes = open_read(&read);
    for (int i = 0; i < 100; ++i) assert_int_equal(bytes[i], i < 10 ? 1 : i < 70 ? 2 : 3);
    late_read_close(&read);
    // A larger buffer, a smaller one, and a request whose result is never read.
    for (int i = 0; i < 6; ++i) {
        int count = i % 2 ? 50 : 2000 + i;
        begin(&read, 4 * (int64_t)count);
        assert_true(read.room >= 4 * (int64_t)count);
        late_read_buffer(&read, 0, i % 3 == 0 ? &a : i % 3 == 1 ? &b : &c, 4 * (int64_t)count);
        late_read_send(&read);
        if (i == 2) continue;
        bytes = open_read(&read);
        for (int k = 0; k < count; ++k) assert_int_equal(bytes[k], i % 3 + 1);
        late_read_close(&read);
    }
    late_read_destroy(&read);
    gpu_buffer_destroy(&a), gpu_buffer_destroy(&b), gpu_buffer_destroy(&c);
}

// Writes of shaders arrive in the copy: probe_lanes.comp adds 1 to each word.
static void what_shaders_have_stored_arrives(void **state)
{
    (void)state;
    LateRead read = {0};
    GLuint program;
    Error error = {""};
    const ShaderDefine defines[] = {{"GROUP_SIZE", 8}, {NULL, 0}};
    GpuBuffer words = make_buffer(40);
    if (shader_build_compute(&program, "probe_lanes.comp", defines, &error) != RESULT_OK)
        fail_msg("%s", error.text);
    gpu_buffer_bind_storage(&words, 0);
    glUseProgram(program);
    glUniform1i(0, WORDS);
    for (int i = 0; i < 3; ++i) {
        gpu_dispatch(&fixture_gpu()->limits, WORDS, 8, 1);
        begin(&read, 4 * WORDS);
        late_read_buffer(&read, 0, &words, 4 * WORDS);
        late_read_send(&read);
        const uint32_t *bytes = open_read(&read);
        for (int k = 0; k < WORDS; ++k) assert_int_equal(bytes[k], 41 + i);
        late_read_close(&read);
    }
    late_read_destroy(&read);
    gpu_buffer_destroy(&words);
    shader_release(program);
}

// Pixels start at the lower left; each quarter of the framebuffer has its own colour.
static void pixels_come_as_they_were_drawn(void **state)
{
    (void)state;
    enum { SIDE = 8 };
    GLuint frame, texture;
    LateRead read = {0};
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, SIDE, SIDE);
    glGenFramebuffers(1, &frame);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    assert_int_equal(glCheckFramebufferStatus(GL_FRAMEBUFFER), GL_FRAMEBUFFER_COMPLETE);
    glEnable(GL_SCISSOR_TEST);
    for (int i = 0; i < 4; ++i) {
        glScissor(i % 2 * SIDE / 2, i / 2 * SIDE / 2, SIDE / 2, SIDE / 2);
        const float color[4] = {(float)i / 255, 1, 0, 51.0f / 255};
        glClearBufferfv(GL_COLOR, 0, color);
    }
    glDisable(GL_SCISSOR_TEST);
    begin(&read, 16 + 4 * SIDE * SIDE);
    late_read_pixels(&read, 16, frame, SIDE, SIDE, GL_UNSIGNED_BYTE);
    late_read_send(&read);
    const uint8_t *bytes = (const uint8_t *)open_read(&read) + 16;
    for (int y = 0; y < SIDE; ++y)
        for (int x = 0; x < SIDE; ++x) {
            const uint8_t *at = bytes + 4 * (y * SIDE + x);
            assert_int_equal(at[0], x / (SIDE / 2) + 2 * (y / (SIDE / 2)));
            assert_true(at[1] == 255 && at[2] == 0 && at[3] == 51);
        }
    late_read_close(&read);
    late_read_destroy(&read);
    glDeleteFramebuffers(1, &frame);
    glDeleteTextures(1, &texture);
}

static void nothing_that_was_sent_is_an_error_with_its_name(void **state)
{
    (void)state;
    LateRead read = {0};
    Error error = {""};
    const void *bytes = &read;
    late_read_destroy(&read);
    begin(&read, 64);
    assert_int_equal(late_read_open(&read, "the counts", &bytes, &error), RESULT_FAILED);
    assert_null(bytes);
    assert_non_null(strstr(error.text, "the counts"));
    GLuint buffer = read.buffer;
    assert_true(glIsBuffer(buffer));
    late_read_destroy(&read);
    assert_false(glIsBuffer(buffer));
    assert_true(read.buffer == 0 && read.room == 0);
}

// A buffer that is large enough keeps its place and its content.
static void only_a_smaller_buffer_is_replaced(void **state)
{
    (void)state;
    GpuBuffer words = make_buffer(7);
    const GpuLimits *limits = &fixture_gpu()->limits;
    GLuint name = words.buffer;
    for (int64_t size = 4 * WORDS - 4; size <= 4 * WORDS; size += 4) {
        uint32_t last = 0;
        assert_int_equal(gpu_buffer_reserve(&words, limits, "words", size, 0, NULL), RESULT_OK);
        assert_int_equal(words.buffer, name);
        assert_int_equal(words.size, 4 * WORDS);
        glBindBuffer(GL_COPY_READ_BUFFER, words.buffer);
        glGetBufferSubData(GL_COPY_READ_BUFFER, 4 * WORDS - 4, 4, &last);
        assert_int_equal(last, 7);
    }
    assert_int_equal(gpu_buffer_reserve(&words, limits, "words", 4 * WORDS + 4, 0, NULL),
                     RESULT_OK);
    assert_int_equal(words.size, 4 * WORDS + 4);
    gpu_buffer_destroy(&words);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_a_smaller_buffer_is_replaced),
        cmocka_unit_test(what_is_written_behind_the_copy_does_not_count),
        cmocka_unit_test(several_buffers_lie_where_they_were_put),
        cmocka_unit_test(what_shaders_have_stored_arrives),
        cmocka_unit_test(pixels_come_as_they_were_drawn),
        cmocka_unit_test(nothing_that_was_sent_is_an_error_with_its_name),
    };
    return cmocka_run_group_tests(tests, open_gpu, NULL);
}
