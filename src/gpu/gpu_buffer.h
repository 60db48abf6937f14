// SPDX-License-Identifier: MIT
// GL buffers, and buffer textures through which shaders read them.
#pragma once

#include "base/error.h"
#include "gpu/gpu.h"

#include <epoxy/gl.h>

// `texture` is a buffer texture of the buffer, 0 if there is none. On CPU drivers, a fetch of a
// vec4 from it takes a quarter of the time of a load from a storage buffer.
typedef struct GpuBuffer {
    GLuint buffer, texture;
    int64_t size; // bytes
} GpuBuffer;

// Creates a buffer of `size` bytes with `data` (NULL: undefined) and, if `texel_format` is not 0
// (GL_RGBA32F, GL_R32UI, ...), its texture. RESULT_FAILED, naming `what`, if it exceeds the
// driver's limits or memory is short.
Result gpu_buffer_create(GpuBuffer *buffer, const GpuLimits *limits, const char *what, int64_t size,
                         const void *data, GLenum texel_format, Error *error);

// The same for a buffer that shaders read as a texture and write by ranges (glBindBufferRange)
// within the driver's limit.
Result gpu_buffer_create_pieces(GpuBuffer *buffer, const GpuLimits *limits, const char *what,
                                int64_t size, GLenum texel_format, Error *error);

// Makes sure that the buffer has at least `size` bytes. A smaller buffer is replaced, with
// undefined content. Otherwise like gpu_buffer_create.
Result gpu_buffer_reserve(GpuBuffer *buffer, const GpuLimits *limits, const char *what,
                          int64_t size, GLenum texel_format, Error *error);
void gpu_buffer_destroy(GpuBuffer *buffer);

// Sets every 4 bytes to `word`. Only queues GPU work.
void gpu_buffer_clear(const GpuBuffer *buffer, uint32_t word);

// Replaces the bytes from `at` to `at + size`, after everything that was queued before has used
// them. Only queues GPU work.
void gpu_buffer_write(const GpuBuffer *buffer, int64_t at, const void *data, int64_t size);

// A copy of the content after all earlier passes, which the caller frees. NULL when memory is
// short, here or in the driver, or if an earlier call left an error. Waits for the GPU.
void *gpu_buffer_read(const GpuBuffer *buffer);

// Binds the buffer as storage at a BIND_..._OUT point, or its texture at a BIND_ texture unit
// (glsl/common/shared.h).
void gpu_buffer_bind_storage(const GpuBuffer *buffer, GLuint binding);
void gpu_buffer_bind_texture(const GpuBuffer *buffer, GLuint unit);
