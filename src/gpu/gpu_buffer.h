// SPDX-License-Identifier: MIT
// GL buffers, and the buffer textures through which shaders read them.
#pragma once

#include "base/error.h"
#include "gpu/gpu.h"

#include <epoxy/gl.h>

// `texture` shows the buffer as a buffer texture, 0: there is none. CPU drivers fetch a vec4 from
// one in a quarter of the time that a load from a storage buffer takes.
typedef struct GpuBuffer {
    GLuint buffer, texture;
    int64_t size; // bytes
} GpuBuffer;

// Makes a buffer of `size` bytes with `data` (NULL: undefined) and, if `texel_format` is not 0
// (GL_RGBA32F, GL_R32UI, ...), its texture. RESULT_FAILED with `what` in the message if it is
// larger than the driver allows or memory is short.
Result gpu_buffer_create(GpuBuffer *buffer, const GpuLimits *limits, const char *what, int64_t size,
                         const void *data, GLenum texel_format, Error *error);

// The same for a buffer that shaders write by ranges (glBindBufferRange), each no larger than the
// driver allows, and read as a texture.
Result gpu_buffer_create_pieces(GpuBuffer *buffer, const GpuLimits *limits, const char *what,
                                int64_t size, GLenum texel_format, Error *error);

// A buffer of at least `size` bytes: a smaller one is made anew, its content undefined. Otherwise
// as gpu_buffer_create.
Result gpu_buffer_reserve(GpuBuffer *buffer, const GpuLimits *limits, const char *what,
                          int64_t size, GLenum texel_format, Error *error);
void gpu_buffer_destroy(GpuBuffer *buffer);

// Sets every 4 bytes to `word`. Only queues GPU work.
void gpu_buffer_clear(const GpuBuffer *buffer, uint32_t word);

// A copy of the content, to be freed; NULL when memory is short, here or in the driver, or an
// earlier call has left an error. Waits for the GPU.
void *gpu_buffer_read(const GpuBuffer *buffer);

// Binds as storage at a BIND_..._OUT point, or the texture at a BIND_ texture unit
// (glsl/common/shared.h).
void gpu_buffer_bind_storage(const GpuBuffer *buffer, GLuint binding);
void gpu_buffer_bind_texture(const GpuBuffer *buffer, GLuint unit);
