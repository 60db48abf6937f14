// SPDX-License-Identifier: MIT
#include "sim/simulation_state.h"
#include "base/float_planes.h"

#include "glsl/common/shared.h"

#include <endian.h>
#include <stdlib.h>
#include <string.h>

// Particles follow each other in a strand at this distance (hair.h).
enum { STRIDE = 4 * STRAND_TILE };

// --- The buffers that are the state.

typedef struct BufferList {
    const GpuBuffer **buffers;
    uint32_t count, room;
    bool failed;
} BufferList;

static void add_buffer(BufferList *list, const GpuBuffer *buffer)
{
    if (list->count == list->room) {
        uint32_t room = 2 * list->room + 16;
        const GpuBuffer **more = realloc(list->buffers, room * sizeof *more);
        if (!more) {
            list->failed = true;
            return;
        }
        list->buffers = more;
        list->room = room;
    }
    list->buffers[list->count++] = buffer;
}

static void add_solver_buffers(BufferList *list, const SimulationSection *section, uint32_t batch)
{
    SolverBuffer buffers[SOLVER_MAX_BUFFERS];
    int count = solver_buffers(&section->solver, batch, buffers);
    for (int i = 0; i < count; ++i)
        if (buffers[i].buffer != &section->hair.batches[batch].position)
            add_buffer(list, buffers[i].buffer);
}

static Result list_buffers(BufferList *list, const Simulation *simulation, Error *error)
{
    *list = (BufferList){0};
    for (uint32_t i = 0; i < simulation->scene->section_count; ++i) {
        const SimulationSection *section = &simulation->sections[i];
        if (solver_is_static(section->solver.type)) continue;
        for (uint32_t b = 0; b < section->hair.batch_count; ++b) {
            add_buffer(list, &section->hair.batches[b].position);
            if (section->inbetween.hair) add_buffer(list, &section->inbetween.earlier[b]);
        }
        for (uint32_t b = 0; b < section->hair.batch_count; ++b)
            add_solver_buffers(list, section, b);
        for (uint32_t b = 0; section->sleep.hair && b < section->hair.batch_count; ++b) {
            add_buffer(list, &section->sleep.batches[b].anchors);
            add_buffer(list, &section->sleep.batches[b].calm);
        }
    }
    if (!list->failed) return RESULT_OK;
    free(list->buffers);
    return error_set(error, RESULT_FAILED, "no memory for the simulation's state");
}

// --- Little-endian values one behind the other. Reading beyond the end gives zeros and is found by
// `failed`.

static void put_u64(FILE *stream, uint64_t value)
{
    value = htole64(value);
    fwrite(&value, sizeof value, 1, stream);
}

static void put_u32(FILE *stream, uint32_t value)
{
    value = htole32(value);
    fwrite(&value, sizeof value, 1, stream);
}

static void put_float(FILE *stream, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_u32(stream, bits);
}

static void put_pose(FILE *stream, const HeadPose *pose)
{
    for (int i = 0; i < 4; ++i) put_float(stream, pose->rotation[i]);
    for (int i = 0; i < 3; ++i) put_float(stream, pose->translation[i]);
}

// What of a step tells whether the next one is like it.
static void put_last_step(FILE *stream, const SolverStep *step)
{
    uint64_t bits;
    memcpy(&bits, &step->dt, sizeof bits);
    put_u64(stream, bits);
    put_u32(stream, step->first);
    put_pose(stream, &step->head_old);
    put_pose(stream, &step->head);
    for (int i = 0; i < 3; ++i) put_float(stream, step->gravity[i]);
    for (int i = 0; i < 12; ++i) put_float(stream, step->wind[i / 3][i % 3]);
}

static void put_sleep(FILE *stream, const Sleep *sleep)
{
    const int32_t numbers[] = {sleep->steps, sleep->due, sleep->looks, sleep->asleep};
    for (int i = 0; i < 4; ++i) put_u32(stream, (uint32_t)numbers[i]);
    put_last_step(stream, &sleep->last);
}

typedef struct Cursor {
    const uint8_t *at;
    size_t left;
    bool failed;
} Cursor;

static const uint8_t *take(Cursor *cursor, size_t size)
{
    static const uint8_t zeros[8];
    if (size > cursor->left) cursor->failed = true;
    if (cursor->failed) return zeros;
    const uint8_t *at = cursor->at;
    cursor->at += size;
    cursor->left -= size;
    return at;
}

static uint64_t take_u64(Cursor *cursor)
{
    uint64_t value;
    memcpy(&value, take(cursor, sizeof value), sizeof value);
    return le64toh(value);
}

static uint32_t take_u32(Cursor *cursor)
{
    uint32_t value;
    memcpy(&value, take(cursor, sizeof value), sizeof value);
    return le32toh(value);
}

static float take_float(Cursor *cursor)
{
    uint32_t bits = take_u32(cursor);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static HeadPose take_pose(Cursor *cursor)
{
    HeadPose pose = {0};
    for (int i = 0; i < 4; ++i) pose.rotation[i] = take_float(cursor);
    for (int i = 0; i < 3; ++i) pose.translation[i] = take_float(cursor);
    return pose;
}

static SolverStep take_last_step(Cursor *cursor)
{
    SolverStep step = {0};
    uint64_t bits = take_u64(cursor);
    memcpy(&step.dt, &bits, sizeof bits);
    step.first = take_u32(cursor) != 0;
    step.head_old = take_pose(cursor);
    step.head = take_pose(cursor);
    for (int i = 0; i < 3; ++i) step.gravity[i] = take_float(cursor);
    for (int i = 0; i < 12; ++i) step.wind[i / 3][i % 3] = take_float(cursor);
    return step;
}

static void take_sleep(Cursor *cursor, Sleep *sleep)
{
    sleep->steps = (int)take_u32(cursor);
    sleep->due = (int)take_u32(cursor);
    sleep->looks = (int)take_u32(cursor);
    sleep->asleep = take_u32(cursor) != 0;
    sleep->last = take_last_step(cursor);
}

// ---

static bool put_buffer(FILE *stream, const GpuBuffer *buffer)
{
    size_t count = (size_t)buffer->size / sizeof(float), packed_size = 0;
    float *values = malloc((size_t)buffer->size + 1);
    uint8_t *packed = malloc(float_planes_bound(count));
    if (values && packed) {
        glBindBuffer(GL_COPY_READ_BUFFER, buffer->buffer);
        glGetBufferSubData(GL_COPY_READ_BUFFER, 0, (GLsizeiptr)buffer->size, values);
        packed_size = float_planes_pack(values, count, STRIDE, packed);
        put_u64(stream, (uint64_t)buffer->size);
        put_u64(stream, packed_size);
        fwrite(packed, 1, packed_size, stream);
    }
    free(values);
    free(packed);
    return packed_size > 0;
}

static bool put_state(FILE *stream, const Simulation *simulation, const BufferList *list)
{
    put_u64(stream, (uint64_t)simulation->step);
    put_u64(stream, (uint64_t)simulation->frame);
    put_float(stream, simulation->share);
    put_pose(stream, &simulation->head);
    put_pose(stream, &simulation->step_head);
    put_pose(stream, &simulation->step_head_before);
    for (uint32_t i = 0; i < simulation->scene->section_count; ++i)
        put_sleep(stream, &simulation->sections[i].sleep);
    put_u32(stream, list->count);
    bool good = true;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    for (uint32_t i = 0; i < list->count && good; ++i) good = put_buffer(stream, list->buffers[i]);
    return good;
}

Result simulation_state_save(Simulation *simulation, Bytes *state, Error *error)
{
    BufferList list;
    *state = (Bytes){0};
    if (list_buffers(&list, simulation, error) != RESULT_OK) return RESULT_FAILED;
    for (uint32_t i = 0; i < simulation->scene->section_count; ++i)
        inbetween_restore(&simulation->sections[i].inbetween);
    char *data = NULL;
    FILE *stream = open_memstream(&data, &state->size);
    bool good = stream && put_state(stream, simulation, &list);
    if (stream && fclose(stream) != 0) good = false;
    state->data = (uint8_t *)data;
    free(list.buffers);
    if (good) return RESULT_OK;
    bytes_destroy(state);
    return error_set(error, RESULT_FAILED, "no memory for the simulation's state");
}

static bool take_buffer(Cursor *cursor, const GpuBuffer *buffer)
{
    size_t count = (size_t)buffer->size / sizeof(float);
    if (take_u64(cursor) != (uint64_t)buffer->size) return false;
    uint64_t packed_size = take_u64(cursor);
    if (packed_size > cursor->left) return false;
    const uint8_t *packed = take(cursor, (size_t)packed_size);
    float *values = malloc((size_t)buffer->size + 1);
    bool good = values && !cursor->failed &&
                float_planes_unpack(values, count, STRIDE, packed, (size_t)packed_size);
    if (good) {
        glBindBuffer(GL_COPY_WRITE_BUFFER, buffer->buffer);
        glBufferSubData(GL_COPY_WRITE_BUFFER, 0, (GLsizeiptr)buffer->size, values);
    }
    free(values);
    return good;
}

// A solver's first pose puts the hair into its style: it is made before the state is put in its
// place.
static void begin_sections(Simulation *simulation)
{
    for (uint32_t i = 0; i < simulation->scene->section_count; ++i) {
        SimulationSection *section = &simulation->sections[i];
        inbetween_restore(&section->inbetween);
        solver_pose(&section->solver, &simulation->step_head);
        section->posed = false;
    }
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
}

Result simulation_state_restore(Simulation *simulation, const Bytes *state, Error *error)
{
    BufferList list;
    if (list_buffers(&list, simulation, error) != RESULT_OK) return RESULT_FAILED;
    Cursor cursor = {.at = state->data, .left = state->size};
    simulation->step = (int64_t)take_u64(&cursor);
    simulation->frame = (int)take_u64(&cursor);
    simulation->share = take_float(&cursor);
    simulation->head = take_pose(&cursor);
    simulation->step_head = take_pose(&cursor);
    simulation->step_head_before = take_pose(&cursor);
    for (uint32_t i = 0; i < simulation->scene->section_count; ++i)
        take_sleep(&cursor, &simulation->sections[i].sleep);
    bool good = take_u32(&cursor) == list.count && !cursor.failed;
    if (good) begin_sections(simulation);
    for (uint32_t i = 0; i < list.count && good; ++i) good = take_buffer(&cursor, list.buffers[i]);
    for (uint32_t i = 0; i < simulation->scene->section_count && good; ++i)
        if (simulation->sections[i].inbetween.hair)
            inbetween_keep_later(&simulation->sections[i].inbetween);
    free(list.buffers);
    if (good && cursor.left == 0) return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT, "the state is not of this simulation");
}
