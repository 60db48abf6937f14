// SPDX-License-Identifier: MIT
// Calls of OpenGL are counted by kind and by frame.
#include "gpu/gl_count.h"
#include "gpu/gpu.h"
#include "support/hair_fixture.h"

#include <epoxy/gl.h>

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { FRAMES_MOST = 8, BYTES = 64 }; // of the mean, see gl_count.h

static int open_gpu(void **state)
{
    (void)state;
    fixture_gpu();
    return 0;
}

static char *print(void)
{
    char *text = NULL;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    gl_count_print(stream);
    fclose(stream);
    return text;
}

// Frame i makes i calls of one function and 2 of another; the mean goes over the last eight frames
// that are between two ends.
static void the_mean_is_that_of_the_last_frames(void **state)
{
    (void)state;
    glUseProgram(0); // see reads_are_told_apart
    glFinish();
    gl_count_start();
    for (int frame = 1; frame <= 30; ++frame) {
        for (int i = 0; i < frame; ++i) glUseProgram(0);
        glFinish();
        glFinish();
        gl_count_frame();
        char *text = print(), name[2][64];
        double mean = 0, calls, blocking, by_name[2];
        int count = frame - 1 < FRAMES_MOST ? frame - 1 : FRAMES_MOST;
        for (int k = 0; k < count; ++k) mean += (double)(frame - k) / count;
        if (frame == 1) {
            assert_string_equal(text, "");
        } else {
            assert_int_equal(sscanf(text,
                                    "%lf calls a frame, %lf blocking, 0 late reads, 0 waits, 0 "
                                    "unordered in all %lf %63s %lf %63s",
                                    &calls, &blocking, &by_name[0], name[0], &by_name[1], name[1]),
                             6);
            assert_true(fabs(calls - mean - 2) < 5e-3); // printed with four digits
            assert_true(blocking == 2);
            int most = mean > 2 ? 0 : 1; // the most frequent function comes first
            assert_non_null(strstr(name[most], "glUseProgram"));
            assert_true(fabs(by_name[most] - mean) < 5e-3);
            assert_non_null(strstr(name[1 - most], "glFinish"));
            assert_true(by_name[1 - most] == 2);
        }
        free(text);
    }
    gl_count_stop();
    GlCounts counts = gl_count_get();
    glFinish();
    gl_count_frame();
    assert_int_equal(gl_count_get().calls, counts.calls);
}

// Reads wait for the GPU unless a fence behind the writing command was waited for, and need a
// barrier if a shader has run.
static void reads_are_told_apart(void **state)
{
    char bytes[BYTES];
    GLuint buffers[2];
    GlCounts c;
    (void)state;
    glGenBuffers(2, buffers);
    for (int i = 0; i < 2; ++i) {
        GLenum target = i ? GL_COPY_WRITE_BUFFER : GL_COPY_READ_BUFFER;
        glBindBuffer(target, buffers[i]);
        glBufferData(target, BYTES, NULL, GL_STREAM_READ);
    }
    // libepoxy makes calls of its own when it looks up a function for the first time.
    glGetBufferSubData(GL_COPY_READ_BUFFER, 0, BYTES, bytes);
    gl_count_start();
    c = gl_count_get();
    assert_true(c.calls == 0 && c.blocking == 0 && c.late == 0 && c.waits == 0 && c.unordered == 0);
    glGetBufferSubData(GL_COPY_READ_BUFFER, 0, BYTES, bytes);
    c = gl_count_get();
    assert_true(c.calls == 1 && c.blocking == 1 && c.late == 0 && c.unordered == 0);

    // A copy, a fence behind it that was waited for: the read is late.
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, BYTES);
    GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glGetBufferSubData(GL_COPY_WRITE_BUFFER, 0, BYTES, bytes);
    assert_int_equal(gl_count_get().blocking, 2);
    glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, 1000000000);
    glGetBufferSubData(GL_COPY_WRITE_BUFFER, 0, BYTES, bytes);
    glGetBufferSubData(GL_COPY_READ_BUFFER, 0, BYTES, bytes); // nothing wrote it before the fence
    c = gl_count_get();
    assert_int_equal(c.late, 1);
    assert_int_equal(c.blocking, 3);
    assert_true(c.waits <= 1);
    glDeleteSync(fence);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, BYTES); // behind the fence
    void *mapped = glMapBufferRange(GL_COPY_WRITE_BUFFER, 0, BYTES, GL_MAP_READ_BIT);
    assert_non_null(mapped);
    glUnmapBuffer(GL_COPY_WRITE_BUFFER);
    assert_int_equal(gl_count_get().blocking, 4);
    glMapBufferRange(GL_COPY_WRITE_BUFFER, 0, BYTES, GL_MAP_WRITE_BIT);
    glUnmapBuffer(GL_COPY_WRITE_BUFFER);
    assert_int_equal(gl_count_get().blocking, 5);
    glMapBufferRange(GL_COPY_WRITE_BUFFER, 0, BYTES,
                     GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT);
    glUnmapBuffer(GL_COPY_WRITE_BUFFER);
    c = gl_count_get();
    assert_int_equal(c.blocking, 5);
    assert_int_equal(c.unordered, 0);

    // A shader, then reads without and with the barrier.
    glDispatchCompute(0, 1, 1);
    glGetBufferSubData(GL_COPY_READ_BUFFER, 0, BYTES, bytes);
    assert_int_equal(gl_count_get().unordered, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, BYTES);
    assert_int_equal(gl_count_get().unordered, 2);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetBufferSubData(GL_COPY_READ_BUFFER, 0, BYTES, bytes);
    assert_int_equal(gl_count_get().unordered, 2);
    gl_count_stop();
    gl_count_start(); // begins at 0 again
    assert_int_equal(gl_count_get().calls, 0);
    gl_count_stop();
    glDeleteBuffers(2, buffers);
    while (glGetError()) continue; // a dispatch without a program is an error
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_mean_is_that_of_the_last_frames),
        cmocka_unit_test(reads_are_told_apart),
    };
    return cmocka_run_group_tests(tests, open_gpu, NULL);
}
