// SPDX-License-Identifier: MIT
#include "gpu/gpu_buffer.h"

#include <stdlib.h>

static int64_t texel_size(GLenum format)
{
    switch (format) {
    case GL_RGBA32F:
    case GL_RGBA32UI:
        return 16;
    case GL_RGB32F:
        return 12;
    case GL_RG32F:
    case GL_RG32UI:
        return 8;
    default:
        return 4;
    }
}

static Result check_size(int64_t most, const GpuLimits *limits, const char *what, int64_t size,
                         GLenum format, Error *error)
{
    if (format && limits->texture_texels * texel_size(format) < most)
        most = limits->texture_texels * texel_size(format);
    if (size <= most) return RESULT_OK;
    return error_set(
        error, RESULT_FAILED,
        "%s: %lld bytes in one buffer: expected at most %lld, the limit of this driver", what,
        (long long)size, (long long)most);
}

static Result fill(GpuBuffer *buffer, const char *what, const void *data, GLenum texel_format,
                   Error *error)
{
    int64_t size = buffer->size;
    glGenBuffers(1, &buffer->buffer);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    glBufferData(GL_SHADER_STORAGE_BUFFER, (GLsizeiptr)(size ? size : 16), data, GL_DYNAMIC_COPY);
    if (texel_format) {
        glGenTextures(1, &buffer->texture);
        glBindTexture(GL_TEXTURE_BUFFER, buffer->texture);
        glTexBuffer(GL_TEXTURE_BUFFER, texel_format, buffer->buffer);
    }
    Result result = gpu_check(what, error);
    if (result != RESULT_OK) gpu_buffer_destroy(buffer);
    return result;
}

Result gpu_buffer_create(GpuBuffer *buffer, const GpuLimits *limits, const char *what, int64_t size,
                         const void *data, GLenum texel_format, Error *error)
{
    *buffer = (GpuBuffer){.size = size};
    TRY(check_size(limits->storage_block, limits, what, size, texel_format, error));
    return fill(buffer, what, data, texel_format, error);
}

Result gpu_buffer_create_pieces(GpuBuffer *buffer, const GpuLimits *limits, const char *what,
                                int64_t size, GLenum texel_format, Error *error)
{
    *buffer = (GpuBuffer){.size = size};
    TRY(check_size(INT64_MAX, limits, what, size, texel_format, error));
    return fill(buffer, what, NULL, texel_format, error);
}

Result gpu_buffer_reserve(GpuBuffer *buffer, const GpuLimits *limits, const char *what,
                          int64_t size, GLenum texel_format, Error *error)
{
    if (buffer->size >= size) return RESULT_OK;
    gpu_buffer_destroy(buffer);
    return gpu_buffer_create(buffer, limits, what, size, NULL, texel_format, error);
}

void gpu_buffer_destroy(GpuBuffer *buffer)
{
    if (buffer->texture) glDeleteTextures(1, &buffer->texture);
    if (buffer->buffer) glDeleteBuffers(1, &buffer->buffer);
    *buffer = (GpuBuffer){0};
}

void gpu_buffer_clear(const GpuBuffer *buffer, uint32_t word)
{
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer->buffer);
    glClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, (GLsizeiptr)buffer->size,
                         GL_RED_INTEGER, GL_UNSIGNED_INT, &word);
}

// Writes by way of a buffer of its own and a copy, which the GPU executes in order.
static void write_copy(int64_t at, const void *data, int64_t size)
{
    GLuint staging;
    glGenBuffers(1, &staging);
    glBindBuffer(GL_COPY_READ_BUFFER, staging);
    glBufferData(GL_COPY_READ_BUFFER, (GLsizeiptr)size, data, GL_STREAM_DRAW);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, (GLintptr)at,
                        (GLsizeiptr)size);
    glDeleteBuffers(1, &staging);
}

// NVIDIA's driver 580 does not let glBufferSubData wait for queued passes that use the buffer, if
// it has no texture and was bound as storage only, at a point where another buffer is bound now;
// no barrier helps (tests/gpu/test_gpu_buffer.c).
void gpu_buffer_write(const GpuBuffer *buffer, int64_t at, const void *data, int64_t size)
{
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffer->buffer);
    if (buffer->texture)
        glBufferSubData(GL_COPY_WRITE_BUFFER, (GLintptr)at, (GLsizeiptr)size, data);
    else
        write_copy(at, data, size);
}

void *gpu_buffer_read(const GpuBuffer *buffer)
{
    void *content = malloc((size_t)buffer->size + 1);
    if (!content) return NULL;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_COPY_READ_BUFFER, buffer->buffer);
    glGetBufferSubData(GL_COPY_READ_BUFFER, 0, (GLsizeiptr)buffer->size, content);
    if (glGetError() == GL_NO_ERROR) return content;
    free(content);
    return NULL;
}

void gpu_buffer_bind_storage(const GpuBuffer *buffer, GLuint binding)
{
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer->buffer);
}

void gpu_buffer_bind_texture(const GpuBuffer *buffer, GLuint unit)
{
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_BUFFER, buffer->texture);
}
