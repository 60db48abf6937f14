// SPDX-License-Identifier: MIT
// All uniform blocks in one ring buffer per context. Every content gets its own place, so queued
// draws still read what they were given, and the driver neither allocates memory nor waits. When
// the ring is full, it is orphaned (glBufferData without data), about once in 40 frames.
#pragma once

#include <epoxy/gl.h>

#include <stdbool.h>
#include <stddef.h>

enum { GPU_UNIFORMS_BINDINGS = 8, GPU_UNIFORMS_MOST = 1 << 14 };

// Sets the block at `binding` (< GPU_UNIFORMS_BINDINGS) to this content of `size` bytes, at most
// GPU_UNIFORMS_MOST, for all commands queued from now on. Does not upload unchanged content.
// Nothing else may bind uniform buffers.
void gpu_uniforms_set(GLuint binding, const void *data, size_t size);

// The ring of a context. NULL when memory is short. `lost`: the context, and with it the buffer, no
// longer exists.
typedef struct GpuUniforms GpuUniforms;
GpuUniforms *gpu_uniforms_create(void);
void gpu_uniforms_destroy(GpuUniforms *uniforms, bool lost);

// Sets the ring of this thread's current context; NULL if there is none.
void gpu_uniforms_use(GpuUniforms *uniforms);

// Somebody else may have bound uniform buffers, so upload all blocks again when they are set.
void gpu_uniforms_forget(void);
