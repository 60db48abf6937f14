// SPDX-License-Identifier: MIT
#include "run/cache.h"
#include "base/clock.h"
#include "base/float_planes.h"
#include "base/outfile.h"
#include "base/quote.h"
#include "run/cache_scene.h"

#include <endian.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { HEAD_BYTES = 4 * CACHE_HEAD_FLOATS, KEPT_BYTES = 32 << 20 };

// --- Writing.

static uint64_t count_particles(const Simulation *simulation)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < simulation->scene->section_count; ++i)
        count += simulation->sections[i].hair.particle_count;
    return count;
}

static Result fail_to_write(const CacheWriter *writer, int reason, Error *error)
{
    return error_set(error, RESULT_FAILED, "%s: cannot write: %s", writer->path, strerror(reason));
}

// Flushes the stream. The error names the first failure's reason.
static Result flush(CacheWriter *writer, Error *error)
{
    errno = 0;
    if (fflush(writer->stream) == 0 && !ferror(writer->stream)) return RESULT_OK;
    return fail_to_write(writer, writer->reason ? writer->reason : errno ? errno : EIO, error);
}

// Overwrites only empty files and caches, so that a wrong path does not destroy another file.
static Result check_kind(const CacheWriter *writer, int descriptor, Error *error)
{
    char magic[sizeof CACHE_MAGIC - 1];
    ssize_t got = pread(descriptor, magic, sizeof magic, 0);
    if (got == 0 || (got == sizeof magic && memcmp(magic, CACHE_MAGIC, sizeof magic) == 0))
        return RESULT_OK;
    if (got < 0) return fail_to_write(writer, errno, error);
    return error_set(error, RESULT_FAILED,
                     "%s: is not a cache, so it is not overwritten: expected a cache or a new name",
                     writer->path);
}

static Result make_frame_room(CacheWriter *writer, uint64_t count, Error *error)
{
    if (!writer->positions) writer->positions = malloc(count * sizeof *writer->positions + 1);
    if (!writer->payload) writer->payload = malloc(HEAD_BYTES + float_planes_bound(3 * count));
    if (writer->positions && writer->payload) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "no memory for frames of %llu particles",
                     (unsigned long long)count);
}

// Frees the buffers of large frames after each frame, because the renderer needs the memory before
// the next one.
static void release_frame_room(CacheWriter *writer, uint64_t count)
{
    if (count * sizeof *writer->positions <= KEPT_BYTES) return;
    free(writer->positions);
    free(writer->payload);
    writer->positions = NULL;
    writer->payload = NULL;
}

static Result open_stream(CacheWriter *writer, const char *path, const Simulation *simulation,
                          Error *error)
{
    *writer = (CacheWriter){.path = strdup(path)};
    if (!writer->path) return error_set(error, RESULT_FAILED, "no memory for a file's name");
    TRY(make_frame_room(writer, count_particles(simulation), error));
    int descriptor;
    TRY(outfile_open_kept(&descriptor, path, error));
    writer->stream = fdopen(descriptor, "r+b");
    if (!writer->stream) {
        close(descriptor);
        return fail_to_write(writer, ENOMEM, error);
    }
    if (flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        return error_set(error, RESULT_FAILED, "%s: another process is writing this file", path);
    return check_kind(writer, descriptor, error);
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
    errno = 0;
    chunk_write(writer->stream, tag, number, payload, size);
    // The stream remembers that a write has failed, but not why.
    if (ferror(writer->stream) && !writer->reason) writer->reason = errno;
    writer->at += CHUNK_HEADER_BYTES + size;
}

static Result write_beginning(CacheWriter *writer, const Simulation *simulation,
                              const Strands *strands, Error *error)
{
    Bytes scene = {0}, hair = {0};
    Result result = cache_scene_describe(&scene, simulation, error);
    THEN(result, cache_scene_describe_hair(&hair, simulation, strands, error));
    if (result == RESULT_OK) {
        chunk_file_begin(writer->stream, CACHE_MAGIC);
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
    THEN(result, cut(writer, 0, error));
    THEN(result, write_beginning(writer, simulation, strands, error));
    if (result != RESULT_OK) cache_writer_close(writer);
    return result;
}

Result cache_writer_continue(CacheWriter *writer, const CacheReader *reader, uint32_t frame_count,
                             const Simulation *simulation, Error *error)
{
    Chunk last;
    TRY(chunk_find((ChunkFile *)&reader->cache.file, reader->cache.offsets[frame_count - 1], &last,
                   error));
    Result result = open_stream(writer, reader->cache.file.path, simulation, error);
    for (uint32_t i = 0; i < frame_count && result == RESULT_OK; ++i)
        if (!cache_file_add_offset(&writer->offsets, &writer->frame_count, &writer->room,
                                   reader->cache.offsets[i]))
            result = error_set(error, RESULT_FAILED, "no memory for an index");
    THEN(result, cut(writer, chunk_end(&last), error));
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
    TRY(make_frame_room(writer, count / 3, error));
    TRY(read_positions(writer, simulation, error));
    double begin_ms = clock_ms();
    put_head(writer->payload, &simulation->bodies[0].head);
    size_t size = float_planes_pack((const float *)writer->positions, count, CACHE_STRIDE,
                                    writer->payload + HEAD_BYTES);
    if (size == 0 ||
        !cache_file_add_offset(&writer->offsets, &writer->frame_count, &writer->room, writer->at))
        return error_set(error, RESULT_FAILED, "%s: no memory for a frame", writer->path);
    append(writer, "FRAM", writer->frame_count - 1, writer->payload, HEAD_BYTES + size);
    Result result = flush(writer, error);
    release_frame_room(writer, count / 3);
    writer->write_ms += clock_ms() - begin_ms;
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
    fwrite(CACHE_TRAILER, 1, sizeof at, writer->stream);
    writer->at += CACHE_TRAILER_BYTES;
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

Result cache_reader_open(CacheReader *reader, const char *path, const Simulation *simulation,
                         const Strands *strands, Error *error)
{
    *reader = (CacheReader){.particle_count = count_particles(simulation)};
    TRY(cache_file_open(&reader->cache, path, error));
    Result result = RESULT_OK;
    reader->positions = malloc(reader->particle_count * sizeof *reader->positions + 1);
    if (!reader->positions)
        result = error_set(error, RESULT_FAILED, "%s: no memory for a frame", path);
    THEN(result, cache_scene_compare(&reader->cache.scene, simulation, path, error));
    THEN(result, cache_scene_compare_hair(&reader->cache.hair, simulation, strands, path, error));
    if (result != RESULT_OK) cache_reader_close(reader);
    return result;
}

void cache_reader_close(CacheReader *reader)
{
    cache_file_close(&reader->cache);
    free(reader->positions);
    *reader = (CacheReader){0};
}

Result cache_reader_check(const CacheReader *reader, int last, Error *error)
{
    return cache_file_check(&reader->cache, last, error);
}

Result cache_reader_show(CacheReader *reader, Simulation *simulation, int frame, Error *error)
{
    float pose[CACHE_HEAD_FLOATS];
    HeadPose head = {0};
    TRY(cache_file_read(&reader->cache, frame, pose, reader->positions, reader->particle_count,
                        error));
    memcpy(head.rotation, pose, sizeof head.rotation);
    memcpy(head.translation, pose + 4, sizeof head.translation);
    return simulation_show(simulation, frame, &head, (const float(*)[3])reader->positions, error);
}
