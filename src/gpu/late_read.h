// SPDX-License-Identifier: MIT
// Reads bytes from the GPU without blocking. They are copied to a buffer after everything that is
// queued; a fence tells when they have arrived, so the program waits for no later work.
#pragma once

#include "gpu/gpu_buffer.h"

// A zeroed struct has no read in progress and may be destroyed.
typedef struct LateRead {
    GLuint buffer;
    int64_t room; // bytes
    GLsync fence; // NULL if nothing was sent
} LateRead;

// Allocates `size` bytes and starts a new read. RESULT_FAILED with `what` if memory is short.
Result late_read_begin(LateRead *read, const char *what, int64_t size, Error *error);

// Queues copies to byte `at`: the first `size` bytes of a buffer (shaders may have written it), or
// the framebuffer's pixels as RGBA of type `type`.
void late_read_buffer(LateRead *read, int64_t at, const GpuBuffer *from, int64_t size);
void late_read_pixels(LateRead *read, int64_t at, GLuint frame, int width, int height, GLenum type);

// Sets the fence and flushes the queue.
void late_read_send(LateRead *read);

// Waits for the bytes, which are valid until late_read_close, and deletes the fence. RESULT_FAILED
// with `what` if they do not arrive.
Result late_read_open(LateRead *read, const char *what, const void **bytes, Error *error);
void late_read_close(LateRead *read);
void late_read_destroy(LateRead *read);
