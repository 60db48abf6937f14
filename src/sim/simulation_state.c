// SPDX-License-Identifier: MIT
#include "sim/simulation_state.h"
#include "base/float_planes.h"

#include "glsl/common/shared.h"

#include <endian.h>
#include <stdlib.h>
#include <string.h>

// Distance between successive particles of a strand in a buffer (hair.h).
enum { STRIDE = 4 * STRAND_TILE };

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
        for (uint32_t b = 0; b < section->hair.batch_count; ++b) {
            SolverBuffer buffers[SOLVER_MAX_BUFFERS];
            int count = solver_buffers(&section->solver, b, buffers);
            for (int k = 0; k < count; ++k)
                if (buffers[k].buffer != &section->hair.batches[b].position)
                    add_buffer(list, buffers[k].buffer);
        }
        for (uint32_t b = 0; section->sleep.hair && b < section->hair.batch_count; ++b) {
            add_buffer(list, &section->sleep.batches[b].anchors);
            add_buffer(list, &section->sleep.batches[b].calm);
        }
    }
    if (!list->failed) return RESULT_OK;
    free(list->buffers);
    return error_set(error, RESULT_FAILED, "no memory for the simulation's state");
}

// --- The state as bytes: a sequence of little-endian values.

// Writes to `stream`, or reads if `stream` is NULL. Reading beyond the end gives zeros and sets
// `failed`.
typedef struct Archive {
    FILE *stream;
    const uint8_t *at;
    size_t left;
    bool failed;
} Archive;

static void pass_bytes(Archive *archive, void *bytes, size_t size)
{
    if (archive->stream) {
        fwrite(bytes, 1, size, archive->stream);
        return;
    }
    if (size > archive->left) archive->failed = true;
    if (archive->failed) {
        memset(bytes, 0, size);
        return;
    }
    memcpy(bytes, archive->at, size);
    archive->at += size;
    archive->left -= size;
}

// Passes numbers of 4 bytes, integers or floats.
static void pass_words(Archive *archive, void *words, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        uint32_t word;
        memcpy(&word, (char *)words + 4 * i, 4);
        word = htole32(word);
        pass_bytes(archive, &word, 4);
        word = le32toh(word);
        memcpy((char *)words + 4 * i, &word, 4);
    }
}

// Passes an integer or a double of 8 bytes.
static void pass_long(Archive *archive, void *number)
{
    uint64_t bits;
    memcpy(&bits, number, 8);
    bits = htole64(bits);
    pass_bytes(archive, &bits, 8);
    bits = le64toh(bits);
    memcpy(number, &bits, 8);
}

static void pass_flag(Archive *archive, bool *flag)
{
    uint32_t word = *flag;
    pass_words(archive, &word, 1);
    *flag = word != 0;
}

static void pass_pose(Archive *archive, HeadPose *pose)
{
    pass_words(archive, pose->rotation, 4);
    pass_words(archive, pose->translation, 3);
}

static void pass_sleep(Archive *archive, Sleep *sleep)
{
    SolverStep *last = &sleep->last;
    pass_words(archive, &sleep->steps, 1);
    pass_words(archive, &sleep->due, 1);
    pass_words(archive, &sleep->checks, 1);
    pass_flag(archive, &sleep->asleep);
    if (!archive->stream) *last = (SolverStep){0};
    // Only the members that same_forces compares.
    pass_long(archive, &last->dt);
    pass_flag(archive, &last->first);
    pass_pose(archive, &last->head_old);
    pass_pose(archive, &last->head);
    pass_words(archive, last->gravity, 3);
    pass_words(archive, last->wind, 12);
}

// Passes everything except the buffers' contents. False if the number of buffers differs.
static bool pass_numbers(Archive *archive, Simulation *simulation, const BufferList *list)
{
    int64_t frame = simulation->frame;
    uint32_t count = list->count;
    pass_long(archive, &simulation->step);
    pass_long(archive, &frame);
    simulation->frame = (int)frame;
    pass_words(archive, &simulation->share, 1);
    for (uint32_t b = 0; b < simulation->scene->body_count; ++b) {
        pass_pose(archive, &simulation->bodies[b].head);
        pass_pose(archive, &simulation->bodies[b].step_head);
        pass_pose(archive, &simulation->bodies[b].step_head_before);
    }
    for (uint32_t i = 0; i < simulation->scene->section_count; ++i)
        pass_sleep(archive, &simulation->sections[i].sleep);
    pass_words(archive, &count, 1);
    return count == list->count && !archive->failed;
}

static bool write_buffer(Archive *archive, const GpuBuffer *buffer)
{
    size_t count = (size_t)buffer->size / sizeof(float);
    uint64_t size = (uint64_t)buffer->size, packed_size = 0;
    float *values = gpu_buffer_read(buffer);
    uint8_t *packed = malloc(float_planes_bound(count));
    if (values && packed) {
        packed_size = float_planes_pack(values, count, STRIDE, packed);
        pass_long(archive, &size);
        pass_long(archive, &packed_size);
        pass_bytes(archive, packed, (size_t)packed_size);
    }
    free(values);
    free(packed);
    return packed_size > 0;
}

// An upper bound of the state's size. The whole block is allocated at once, because growing a large
// block would copy it; the system provides memory only for pages that are written.
static size_t state_bound(const BufferList *list)
{
    size_t size = 1 << 20;
    for (uint32_t i = 0; i < list->count; ++i)
        size += 64 + float_planes_bound((size_t)list->buffers[i]->size / sizeof(float));
    return size;
}

Result simulation_state_save(Simulation *simulation, Bytes *state, Error *error)
{
    BufferList list;
    *state = (Bytes){0};
    TRY(list_buffers(&list, simulation, error));
    for (uint32_t i = 0; i < simulation->scene->section_count; ++i)
        inbetween_restore(&simulation->sections[i].inbetween);
    size_t room = state_bound(&list);
    char *data = malloc(room);
    Archive archive = {.stream = data ? fmemopen(data, room, "w") : NULL};
    bool good = archive.stream && pass_numbers(&archive, simulation, &list);
    for (uint32_t i = 0; i < list.count && good; ++i)
        good = write_buffer(&archive, list.buffers[i]);
    if (archive.stream) {
        long size = ftell(archive.stream);
        if (fclose(archive.stream) != 0 || size < 0) good = false;
        state->size = good ? (size_t)size : 0;
    }
    char *less = good ? realloc(data, state->size + 1) : NULL;
    state->data = (uint8_t *)(less ? less : data);
    free(list.buffers);
    if (good) return RESULT_OK;
    bytes_destroy(state);
    return error_set(error, RESULT_FAILED, "no memory for the simulation's state");
}

static bool read_buffer(Archive *archive, const GpuBuffer *buffer)
{
    size_t count = (size_t)buffer->size / sizeof(float);
    uint64_t size = 0, packed_size = 0;
    pass_long(archive, &size);
    pass_long(archive, &packed_size);
    if (archive->failed || size != (uint64_t)buffer->size || packed_size > archive->left)
        return false;
    float *values = malloc((size_t)buffer->size + 1);
    bool good =
        values && float_planes_unpack(values, count, STRIDE, archive->at, (size_t)packed_size);
    archive->at += packed_size;
    archive->left -= (size_t)packed_size;
    if (good) gpu_buffer_write(buffer, 0, values, buffer->size);
    free(values);
    return good;
}

// A solver's first pose puts the hair into its style, so it must come before the state is restored.
// Also sets everything that depends only on the time.
static void begin_sections(Simulation *simulation)
{
    double now = simulation_step_time(simulation, simulation->step);
    for (uint32_t i = 0; i < simulation->scene->section_count; ++i) {
        SimulationSection *section = &simulation->sections[i];
        inbetween_restore(&section->inbetween);
        bound_set_after(&section->bound, now);
        solver_pose(&section->solver, &section->body->step_head);
        section->posed = false;
        if (simulation->step > -simulation->schedule.settling)
            section->sleep.last.params_stamp =
                simulation_params_stamp(simulation, i, simulation->step - 1);
        section->sleep.last.shape = bound_body_shape(&section->body->mesh, now);
    }
    for (uint32_t b = 0; b < simulation->scene->body_count; ++b)
        moving_body_update_field(&simulation->bodies[b], now, now);
    simulation->time = simulation->share > 0
                           ? schedule_frame_time(&simulation->scene->run, simulation->frame)
                           : now;
}

Result simulation_state_restore(Simulation *simulation, const Bytes *state, Error *error)
{
    BufferList list;
    TRY(list_buffers(&list, simulation, error));
    Archive archive = {.at = state->data, .left = state->size};
    bool good = pass_numbers(&archive, simulation, &list);
    if (good) begin_sections(simulation);
    for (uint32_t i = 0; i < list.count && good; ++i) good = read_buffer(&archive, list.buffers[i]);
    for (uint32_t i = 0; i < simulation->scene->section_count && good; ++i)
        if (simulation->sections[i].inbetween.hair)
            inbetween_keep(&simulation->sections[i].inbetween, true);
    free(list.buffers);
    if (good && archive.left == 0) return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT, "the state belongs to another simulation");
}
