// SPDX-License-Identifier: MIT
#include "draw/hair_read.h"

#include <stdlib.h>
#include <string.h>

enum { BUFFERS = 3 }; // of each batch

static Result make_room(HairRead *read, uint32_t count, Error *error)
{
    if (read->room >= count) return RESULT_OK;
    struct ReadBuffer *buffers = realloc(read->buffers, count * sizeof *buffers);
    if (!buffers) return error_set(error, RESULT_FAILED, "no memory for %u buffers of hair", count);
    memset(buffers + read->room, 0, (count - read->room) * sizeof *buffers);
    read->buffers = buffers;
    read->room = count;
    return RESULT_OK;
}

static const void *copy(struct ReadBuffer *buffer)
{
    if (buffer->room < buffer->size) {
        free(buffer->copy);
        buffer->copy = malloc((size_t)buffer->size);
        buffer->room = buffer->copy ? buffer->size : 0;
    }
    if (buffer->copy)
        glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)buffer->size, buffer->copy);
    return buffer->copy;
}

// Maps a buffer for reading. NULL on failure.
static const void *open_buffer(HairRead *read, const GpuBuffer *of)
{
    struct ReadBuffer *buffer = &read->buffers[read->count];
    buffer->buffer = of->buffer;
    buffer->size = of->size;
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, of->buffer);
    const void *data = read->copies ? copy(buffer)
                                    : glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0,
                                                       (GLsizeiptr)of->size, GL_MAP_READ_BIT);
    if (data) ++read->count;
    return data;
}

static bool open_batch(HairRead *read, DrawnHair *hair)
{
    const HairBatch *batch = hair->batch;
    hair->position = (const float(*)[4])open_buffer(read, &batch->position);
    hair->ids = open_buffer(read, &batch->strand_id);
    hair->paint =
        batch->paint.buffer ? (const uint32_t(*)[4])open_buffer(read, &batch->paint) : NULL;
    return hair->position && hair->ids && (hair->paint || !batch->paint.buffer);
}

Result hair_read_begin(HairRead *read, DrawnHair *hair, uint32_t count, Error *error)
{
    bool good = true;
    TRY(make_room(read, BUFFERS * count, error));
    read->count = 0;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    for (uint32_t i = 0; i < count && good; ++i) good = open_batch(read, &hair[i]);
    if (good) return RESULT_OK;
    hair_read_end(read);
    return error_set(error, RESULT_FAILED, "the positions of hair cannot be read");
}

void hair_read_end(HairRead *read)
{
    while (read->count) {
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, read->buffers[--read->count].buffer);
        if (!read->copies) glUnmapBuffer(GL_SHADER_STORAGE_BUFFER);
    }
}

void hair_read_destroy(HairRead *read)
{
    hair_read_end(read);
    for (uint32_t i = 0; i < read->room; ++i) free(read->buffers[i].copy);
    free(read->buffers);
    *read = (HairRead){0};
}
