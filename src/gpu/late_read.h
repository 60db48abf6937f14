// SPDX-License-Identifier: MIT
// Bytes on their way back from the GPU: they are copied to a buffer behind all that is queued, and
// a fence tells when they have arrived, so that nobody has to wait for more than that.
#pragma once

#include "gpu/gpu_buffer.h"

// A zeroed struct has nothing under way and may be destroyed.
typedef struct LateRead {
    GLuint buffer;
    int64_t room; // bytes
    GLsync fence; // NULL: nothing has been sent
} LateRead;

// Makes room for so many bytes and begins anew. RESULT_FAILED with `what` if memory is short.
Result late_read_begin(LateRead *read, const char *what, int64_t size, Error *error);

// Queues copies to byte `at`: of the first `size` bytes of a buffer, which shaders may have
// written, or of the framebuffer's pixels as RGBA of type `type`.
void late_read_buffer(LateRead *read, int64_t at, const GpuBuffer *from, int64_t size);
void late_read_pixels(LateRead *read, int64_t at, GLuint frame, int width, int height, GLenum type);

// Sets the fence, and has the driver begin with all that is queued.
void late_read_send(LateRead *read);

// The bytes, once they are there, until late_read_close. Also the fence is gone then. RESULT_FAILED
// with `what` if they do not come.
Result late_read_open(LateRead *read, const char *what, const void **bytes, Error *error);
void late_read_close(LateRead *read);
void late_read_destroy(LateRead *read);
