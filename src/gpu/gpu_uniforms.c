// SPDX-License-Identifier: MIT
#include "gpu/gpu_uniforms.h"

#include <assert.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { RING_BYTES = 1 << 18 };

// The content of a binding.
typedef struct Block {
    size_t size; // 0 if empty
    unsigned char data[GPU_UNIFORMS_MOST];
} Block;

struct GpuUniforms {
    GLuint buffer; // 0 if not created yet
    size_t step;   // alignment of offsets
    size_t at;     // offset of the next content
    Block blocks[GPU_UNIFORMS_BINDINGS];
};

// The ring of this thread's current context.
static _Thread_local GpuUniforms *ring;

static size_t round_up(size_t size)
{
    return (size + ring->step - 1) / ring->step * ring->step;
}

// Orphans the buffer and starts at its beginning. Queued draws keep the uniforms they were given.
static void begin(void)
{
    glBindBuffer(GL_UNIFORM_BUFFER, ring->buffer);
    glBufferData(GL_UNIFORM_BUFFER, RING_BYTES, NULL, GL_STREAM_DRAW);
    ring->at = 0;
}

static void create(void)
{
    GLint step = 0;
    glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &step);
    ring->step = step > 16 ? (size_t)step : 16;
    glGenBuffers(1, &ring->buffer);
    begin();
}

static void upload(GLuint binding)
{
    const Block *block = &ring->blocks[binding];
    glBindBufferRange(GL_UNIFORM_BUFFER, binding, ring->buffer, (GLintptr)ring->at,
                      (GLsizeiptr)block->size);
    glBufferSubData(GL_UNIFORM_BUFFER, (GLintptr)ring->at, (GLsizeiptr)block->size, block->data);
    ring->at += round_up(block->size);
}

void gpu_uniforms_set(GLuint binding, const void *data, size_t size)
{
    assert(binding < GPU_UNIFORMS_BINDINGS && size > 0 && size <= GPU_UNIFORMS_MOST);
    Block *block = &ring->blocks[binding];
    if (block->size == size && memcmp(block->data, data, size) == 0) return;
    memcpy(block->data, data, size);
    block->size = size;
    if (!ring->buffer) create();
    if (ring->at + round_up(size) <= RING_BYTES) {
        upload(binding);
        return;
    }
    begin(); // the contents of the other bindings are gone, too
    for (GLuint i = 0; i < GPU_UNIFORMS_BINDINGS; ++i)
        if (ring->blocks[i].size) upload(i);
}

GpuUniforms *gpu_uniforms_create(void)
{
    return calloc(1, sizeof(GpuUniforms));
}

void gpu_uniforms_destroy(GpuUniforms *uniforms, bool lost)
{
    if (ring == uniforms) ring = NULL;
    if (uniforms && uniforms->buffer && !lost) glDeleteBuffers(1, &uniforms->buffer);
    free(uniforms);
}

void gpu_uniforms_use(GpuUniforms *uniforms)
{
    ring = uniforms;
}

void gpu_uniforms_forget(void)
{
    for (GLuint i = 0; i < GPU_UNIFORMS_BINDINGS; ++i) ring->blocks[i].size = 0;
}
