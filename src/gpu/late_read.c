// SPDX-License-Identifier: MIT
#include "gpu/late_read.h"

static const GLuint64 SLICE_NS = 1000000000;

static void drop_fence(LateRead *read)
{
    if (read->fence) glDeleteSync(read->fence);
    read->fence = NULL;
}

Result late_read_begin(LateRead *read, const char *what, int64_t size, Error *error)
{
    drop_fence(read);
    if (read->room >= size) return RESULT_OK;
    late_read_destroy(read);
    glGenBuffers(1, &read->buffer);
    glBindBuffer(GL_COPY_WRITE_BUFFER, read->buffer);
    glBufferData(GL_COPY_WRITE_BUFFER, (GLsizeiptr)size, NULL, GL_STREAM_READ);
    read->room = size;
    Result result = gpu_check(what, error);
    if (result != RESULT_OK) late_read_destroy(read);
    return result;
}

void late_read_buffer(LateRead *read, int64_t at, const GpuBuffer *from, int64_t size)
{
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_COPY_READ_BUFFER, from->buffer);
    glBindBuffer(GL_COPY_WRITE_BUFFER, read->buffer);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, (GLintptr)at,
                        (GLsizeiptr)size);
}

void late_read_pixels(LateRead *read, int64_t at, GLuint frame, int width, int height, GLenum type)
{
    glBindFramebuffer(GL_READ_FRAMEBUFFER, frame);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, read->buffer);
    glReadPixels(0, 0, width, height, GL_RGBA, type, (void *)(intptr_t)at);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
}

void late_read_send(LateRead *read)
{
    read->fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glFlush();
}

static bool arrived(const LateRead *read)
{
    GLenum state = GL_TIMEOUT_EXPIRED;
    while (read->fence && state == GL_TIMEOUT_EXPIRED)
        state = glClientWaitSync(read->fence, GL_SYNC_FLUSH_COMMANDS_BIT, SLICE_NS);
    return state == GL_ALREADY_SIGNALED || state == GL_CONDITION_SATISFIED;
}

Result late_read_open(LateRead *read, const char *what, const void **bytes, Error *error)
{
    *bytes = NULL;
    bool here = arrived(read);
    drop_fence(read);
    glBindBuffer(GL_COPY_READ_BUFFER, read->buffer);
    if (here)
        *bytes = glMapBufferRange(GL_COPY_READ_BUFFER, 0, (GLsizeiptr)read->room, GL_MAP_READ_BIT);
    if (*bytes) return RESULT_OK;
    TRY(gpu_check(what, error));
    return error_set(error, RESULT_FAILED, "%s: the driver cannot map the buffer", what);
}

void late_read_close(LateRead *read)
{
    glBindBuffer(GL_COPY_READ_BUFFER, read->buffer);
    glUnmapBuffer(GL_COPY_READ_BUFFER);
}

void late_read_destroy(LateRead *read)
{
    drop_fence(read);
    if (read->buffer) glDeleteBuffers(1, &read->buffer);
    *read = (LateRead){0};
}
