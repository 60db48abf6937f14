// SPDX-License-Identifier: MIT
#include "cache.h"
#include "cache_scene.h"
#include "float_planes.h"

#include <endian.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <time.h>
#include <unistd.h>

static const char MAGIC[] = "TRXCACHE", TRAILER[] = "TRXINDEX";

// A frame's payload: rotation and translation of the head, then the packed positions.
enum { HEAD_BYTES = 28, TRAILER_BYTES = 16, STRIDE = 3 };

static uint64_t count_particles(const Simulation *simulation)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < simulation->scene->section_count; ++i)
        count += simulation->sections[i].hair.particle_count;
    return count;
}

static double now_ms(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return 1e3 * (double)time.tv_sec + 1e-6 * (double)time.tv_nsec;
}

static bool add_offset(uint64_t **offsets, uint32_t *count, uint32_t *room, uint64_t offset)
{
    if (*count == *room) {
        uint32_t larger = 2 * *room + 64;
        uint64_t *more = realloc(*offsets, larger * sizeof *more);
        if (!more) return false;
        *offsets = more;
        *room = larger;
    }
    (*offsets)[(*count)++] = offset;
    return true;
}

// --- Writing.

static Result fail_to_write(const CacheWriter *writer, int reason, Error *error)
{
    return error_set(error, RESULT_FAILED, "%s: cannot write: %s", writer->path, strerror(reason));
}

// Puts what was written before the file's eyes; the reason if some of it could not be.
static Result flush(CacheWriter *writer, Error *error)
{
    errno = 0;
    if (fflush(writer->stream) == 0 && !ferror(writer->stream)) return RESULT_OK;
    return fail_to_write(writer, errno ? errno : EIO, error);
}

static Result open_stream(CacheWriter *writer, const char *path, const Simulation *simulation,
                          Error *error)
{
    uint64_t count = count_particles(simulation);
    *writer = (CacheWriter){.path = strdup(path),
                            .positions = malloc(count * sizeof *writer->positions + 1),
                            .payload = malloc(HEAD_BYTES + float_planes_bound(3 * count))};
    if (!writer->path || !writer->positions || !writer->payload)
        return error_set(error, RESULT_FAILED, "no memory for frames of %llu particles",
                         (unsigned long long)count);
    int descriptor = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0) return fail_to_write(writer, errno, error);
    writer->stream = fdopen(descriptor, "r+b");
    if (!writer->stream) {
        close(descriptor);
        return fail_to_write(writer, ENOMEM, error);
    }
    if (flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "%s: another process is writing it", path);
}

static Result cut(CacheWriter *writer, uint64_t size, Error *error)
{
    if (ftruncate(fileno(writer->stream), (off_t)size) != 0 ||
        fseeko(writer->stream, (off_t)size, SEEK_SET) != 0)
        return fail_to_write(writer, errno, error);
    writer->at = size;
    return RESULT_OK;
}

static void append(CacheWriter *writer, const char *tag, uint32_t number, const void *payload,
                   size_t size)
{
    chunk_write(writer->stream, tag, number, payload, size);
    writer->at += CHUNK_HEADER_BYTES + size;
}

static Result write_beginning(CacheWriter *writer, const Simulation *simulation,
                              const Strands *strands, Error *error)
{
    Bytes scene = {0}, hair = {0};
    Result result = cache_scene_describe(&scene, simulation, error);
    if (result == RESULT_OK) result = cache_hair_describe(&hair, simulation, strands, error);
    if (result == RESULT_OK) {
        chunk_file_begin(writer->stream, MAGIC);
        writer->at += CHUNK_FILE_HEADER_BYTES;
        append(writer, "SCEN", 0, scene.data, scene.size);
        append(writer, "HAIR", 0, hair.data, hair.size);
        result = flush(writer, error);
    }
    bytes_destroy(&scene);
    bytes_destroy(&hair);
    return result;
}

Result cache_writer_open(CacheWriter *writer, const char *path, const Simulation *simulation,
                         const Strands *strands, Error *error)
{
    Result result = open_stream(writer, path, simulation, error);
    if (result == RESULT_OK) result = cut(writer, 0, error);
    if (result == RESULT_OK) result = write_beginning(writer, simulation, strands, error);
    if (result != RESULT_OK) cache_writer_close(writer);
    return result;
}

Result cache_writer_continue(CacheWriter *writer, const CacheReader *reader, uint32_t frame_count,
                             const Simulation *simulation, Error *error)
{
    Chunk last;
    Result result =
        chunk_find((ChunkFile *)&reader->file, reader->offsets[frame_count - 1], &last, error);
    if (result != RESULT_OK) return result;
    result = open_stream(writer, reader->file.path, simulation, error);
    for (uint32_t i = 0; i < frame_count && result == RESULT_OK; ++i)
        if (!add_offset(&writer->offsets, &writer->frame_count, &writer->room, reader->offsets[i]))
            result = error_set(error, RESULT_FAILED, "no memory for an index");
    if (result == RESULT_OK) result = cut(writer, chunk_end(&last), error);
    if (result != RESULT_OK) cache_writer_close(writer);
    return result;
}

static void put_float(uint8_t *bytes, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    bits = htole32(bits);
    memcpy(bytes, &bits, sizeof bits);
}

static void put_head(uint8_t *bytes, const HeadPose *head)
{
    for (int i = 0; i < 4; ++i) put_float(bytes + 4 * i, head->rotation[i]);
    for (int i = 0; i < 3; ++i) put_float(bytes + 16 + 4 * i, head->translation[i]);
}

static Result read_positions(CacheWriter *writer, const Simulation *simulation, Error *error)
{
    float(*positions)[3] = writer->positions;
    Result result = RESULT_OK;
    for (uint32_t i = 0; i < simulation->scene->section_count && result == RESULT_OK; ++i) {
        result = hair_read_positions(&simulation->sections[i].hair, positions, error);
        positions += simulation->sections[i].hair.particle_count;
    }
    return result;
}

Result cache_writer_add(CacheWriter *writer, const Simulation *simulation, Error *error)
{
    size_t count = (size_t)(3 * count_particles(simulation));
    Result result = read_positions(writer, simulation, error);
    if (result != RESULT_OK) return result;
    double begin_ms = now_ms();
    put_head(writer->payload, &simulation->head);
    size_t size = float_planes_pack((const float *)writer->positions, count, STRIDE,
                                    writer->payload + HEAD_BYTES);
    if (size == 0 || !add_offset(&writer->offsets, &writer->frame_count, &writer->room, writer->at))
        return error_set(error, RESULT_FAILED, "%s: no memory for a frame", writer->path);
    append(writer, "FRAM", writer->frame_count - 1, writer->payload, HEAD_BYTES + size);
    result = flush(writer, error);
    writer->write_ms += now_ms() - begin_ms;
    return result;
}

Result cache_writer_finish(CacheWriter *writer, Error *error)
{
    uint64_t *index = malloc(writer->frame_count * sizeof *index + 1);
    if (!index) return error_set(error, RESULT_FAILED, "%s: no memory for an index", writer->path);
    for (uint32_t i = 0; i < writer->frame_count; ++i) index[i] = htole64(writer->offsets[i]);
    uint64_t at = htole64(writer->at);
    append(writer, "INDX", writer->frame_count, index, writer->frame_count * sizeof *index);
    free(index);
    fwrite(&at, sizeof at, 1, writer->stream);
    fwrite(TRAILER, 1, sizeof at, writer->stream);
    writer->at += TRAILER_BYTES;
    Result result = flush(writer, error);
    if (result == RESULT_OK && fsync(fileno(writer->stream)) != 0 && errno != EINVAL)
        result = fail_to_write(writer, errno, error);
    return result;
}

void cache_writer_close(CacheWriter *writer)
{
    if (writer->stream) fclose(writer->stream);
    free(writer->path);
    free(writer->offsets);
    free(writer->positions);
    free(writer->payload);
    *writer = (CacheWriter){0};
}

// --- Reading.

// The chunk at `at`, which must have this tag. *end: where the next one begins.
static Result read_part(CacheReader *reader, uint64_t at, const char *tag, Bytes *payload,
                        uint64_t *end, Error *error)
{
    Chunk chunk;
    Result result = chunk_find(&reader->file, at, &chunk, error);
    if (result == RESULT_OK && strcmp(chunk.tag, tag) != 0)
        result = error_set(error, RESULT_BAD_INPUT, "%s: byte %llu: expected %s", reader->file.path,
                           (unsigned long long)at, tag);
    if (result != RESULT_OK) return result;
    *end = chunk_end(&chunk);
    return chunk_read(&reader->file, &chunk, payload, error);
}

// The scene and the hair; *at moves behind them.
static Result check_beginning(CacheReader *reader, uint64_t *at, const Simulation *simulation,
                              const Strands *strands, Error *error)
{
    Bytes part = {0};
    Result result = read_part(reader, *at, "SCEN", &part, at, error);
    if (result == RESULT_OK)
        result = cache_scene_compare(&part, simulation, reader->file.path, error);
    bytes_destroy(&part);
    if (result == RESULT_OK) result = read_part(reader, *at, "HAIR", &part, at, error);
    if (result == RESULT_OK)
        result = cache_hair_compare(&part, simulation, strands, reader->file.path, error);
    bytes_destroy(&part);
    return result;
}

// By the index at the end; false if there is none that is whole.
static bool read_index(CacheReader *reader)
{
    struct {
        uint64_t at;
        char magic[8];
    } trailer;
    _Static_assert(sizeof trailer == TRAILER_BYTES, "a trailer has no holes");
    uint64_t size = reader->file.size, end;
    Bytes index = {0};
    if (size < TRAILER_BYTES ||
        !chunk_file_read_raw(&reader->file, size - TRAILER_BYTES, &trailer, sizeof trailer) ||
        memcmp(trailer.magic, TRAILER, sizeof trailer.magic) != 0 ||
        read_part(reader, le64toh(trailer.at), "INDX", &index, &end, NULL) != RESULT_OK)
        return false;
    bool good = true;
    for (size_t i = 0; i < index.size / sizeof(uint64_t) && good; ++i) {
        uint64_t offset;
        memcpy(&offset, index.data + i * sizeof offset, sizeof offset);
        good = add_offset(&reader->offsets, &reader->frame_count, &reader->room, le64toh(offset));
    }
    bytes_destroy(&index);
    return good;
}

// Chunk by chunk from `at`, as far as they are whole and in order.
static Result scan(CacheReader *reader, uint64_t at, Error *error)
{
    reader->frame_count = 0;
    while (at < reader->file.size) {
        Chunk chunk;
        if (chunk_find(&reader->file, at, &chunk, &reader->end) != RESULT_OK) return RESULT_OK;
        if (strcmp(chunk.tag, "INDX") == 0) return RESULT_OK;
        if (strcmp(chunk.tag, "FRAM") != 0 || chunk.number != reader->frame_count) {
            error_set(&reader->end, RESULT_BAD_INPUT, "%s: byte %llu: not frame %u",
                      reader->file.path, (unsigned long long)at, reader->frame_count);
            return RESULT_OK;
        }
        if (!add_offset(&reader->offsets, &reader->frame_count, &reader->room, at))
            return error_set(error, RESULT_FAILED, "%s: no memory for an index", reader->file.path);
        at = chunk_end(&chunk);
    }
    return RESULT_OK;
}

Result cache_reader_open(CacheReader *reader, const char *path, const Simulation *simulation,
                         const Strands *strands, Error *error)
{
    uint64_t at = CHUNK_FILE_HEADER_BYTES;
    *reader = (CacheReader){.particle_count = count_particles(simulation)};
    Result result = chunk_file_open(&reader->file, path, MAGIC, error);
    if (result != RESULT_OK) return result;
    reader->positions = malloc(reader->particle_count * sizeof *reader->positions + 1);
    if (!reader->positions)
        result = error_set(error, RESULT_FAILED, "%s: no memory for a frame", path);
    if (result == RESULT_OK) result = check_beginning(reader, &at, simulation, strands, error);
    if (result == RESULT_OK && !read_index(reader)) result = scan(reader, at, error);
    if (result != RESULT_OK) cache_reader_close(reader);
    return result;
}

void cache_reader_close(CacheReader *reader)
{
    chunk_file_close(&reader->file);
    free(reader->offsets);
    free(reader->positions);
    *reader = (CacheReader){0};
}

// What follows the file's name in a message about it.
static const char *without_path(const CacheReader *reader, const Error *why)
{
    size_t length = strlen(reader->file.path) + strlen(": ");
    return strlen(why->text) > length ? why->text + length : why->text;
}

Result cache_reader_check(const CacheReader *reader, int last, Error *error)
{
    if (last < (int)reader->frame_count) return RESULT_OK;
    char range[32] = "none";
    if (reader->frame_count) snprintf(range, sizeof range, "0 to %u", reader->frame_count - 1);
    bool ended = reader->end.text[0] == 0;
    return error_set(error, RESULT_BAD_INPUT, "%s: no frame %d, whole ones: %s%s%s",
                     reader->file.path, last, range, ended ? "" : "; ",
                     ended ? "" : without_path(reader, &reader->end));
}

static float take_float(const uint8_t *bytes)
{
    uint32_t bits;
    float value;
    memcpy(&bits, bytes, sizeof bits);
    bits = le32toh(bits);
    memcpy(&value, &bits, sizeof value);
    return value;
}

static Result read_frame(CacheReader *reader, uint32_t frame, HeadPose *head, Error *error)
{
    Bytes payload = {0};
    uint64_t end;
    Error why;
    Result result = read_part(reader, reader->offsets[frame], "FRAM", &payload, &end, &why);
    if (result != RESULT_OK)
        return error_set(error, result, "%s: frame %u, %s", reader->file.path, frame,
                         without_path(reader, &why));
    bool good =
        payload.size >= HEAD_BYTES &&
        float_planes_unpack((float *)reader->positions, (size_t)(3 * reader->particle_count),
                            STRIDE, payload.data + HEAD_BYTES, payload.size - HEAD_BYTES);
    for (int i = 0; i < 4 && good; ++i) head->rotation[i] = take_float(payload.data + 4 * i);
    for (int i = 0; i < 3 && good; ++i)
        head->translation[i] = take_float(payload.data + 16 + 4 * i);
    bytes_destroy(&payload);
    if (good) return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT, "%s: frame %u at byte %llu is no frame of this hair",
                     reader->file.path, frame, (unsigned long long)reader->offsets[frame]);
}

Result cache_reader_show(CacheReader *reader, Simulation *simulation, int frame, Error *error)
{
    HeadPose head = {0};
    Result result = cache_reader_check(reader, frame, error);
    if (result == RESULT_OK) result = read_frame(reader, (uint32_t)frame, &head, error);
    if (result != RESULT_OK) return result;
    return simulation_show(simulation, frame, &head, (const float(*)[3])reader->positions, error);
}
