// SPDX-License-Identifier: MIT
// Uniform blocks, all in one buffer of the context: a ring in which every content has a place of
// its own, so that a draw that is queued still reads what it was given, and no driver allocates
// memory or waits for it. When the ring is full the driver is asked for a new one (glBufferData
// without data), which it has once the old one has been read: once in some 40 frames.
#pragma once

#include <epoxy/gl.h>

#include <stdbool.h>
#include <stddef.h>

enum { GPU_UNIFORMS_BINDINGS = 8, GPU_UNIFORMS_MOST = 1 << 14 };

// Gives the block at `binding` (< GPU_UNIFORMS_BINDINGS) this content of `size` bytes, at most
// GPU_UNIFORMS_MOST, for all that is queued from now on. Nothing is uploaded if it has it. Nothing
// else may bind uniform buffers.
void gpu_uniforms_set(GLuint binding, const void *data, size_t size);

// The ring of a context. NULL when memory is short. `lost`: the context is gone, and the buffer
// with it.
typedef struct GpuUniforms GpuUniforms;
GpuUniforms *gpu_uniforms_create(void);
void gpu_uniforms_destroy(GpuUniforms *uniforms, bool lost);

// From now on this thread's blocks lie in that ring, its current context's; NULL: in none.
void gpu_uniforms_use(GpuUniforms *uniforms);

// Somebody else has bound uniform buffers: all that is set from now on is uploaded again.
void gpu_uniforms_forget(void);
