// SPDX-License-Identifier: MIT
#include "run/cache_file.h"

#include "base/float_planes.h"
#include "base/outfile.h"
#include "base/quote.h"

#include <endian.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { HEAD_BYTES = 4 * CACHE_HEAD_FLOATS };

bool cache_file_add_offset(uint64_t **offsets, uint32_t *count, uint32_t *room, uint64_t offset)
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

// Reads the chunk at `at`, which must have this tag. *end: offset of the next one.
static Result read_part(CacheFile *cache, uint64_t at, const char *tag, Bytes *payload,
                        uint64_t *end, Error *error)
{
    Chunk chunk;
    TRY(chunk_find(&cache->file, at, &chunk, error));
    if (strcmp(chunk.tag, tag) != 0)
        return error_set(error, RESULT_BAD_INPUT, "%s: byte %llu: expected %s", cache->file.path,
                         (unsigned long long)at, tag);
    *end = chunk_end(&chunk);
    return chunk_read(&cache->file, &chunk, payload, error);
}

// Reads the index at the end: `finished` stays false if there is none or it is damaged.
static Result read_index(CacheFile *cache, Error *error)
{
    struct {
        uint64_t at;
        char magic[8];
    } trailer;
    _Static_assert(sizeof trailer == CACHE_TRAILER_BYTES, "a trailer has no holes");
    uint64_t size = cache->file.size, end;
    Bytes index = {0};
    if (size < CACHE_TRAILER_BYTES) return RESULT_OK;
    if (!chunk_file_read_raw(&cache->file, size - CACHE_TRAILER_BYTES, &trailer, sizeof trailer))
        return error_set(error, RESULT_BAD_INPUT, "%s: cannot read its end: %s", cache->file.path,
                         errno ? strerror(errno) : "the file has become shorter");
    if (memcmp(trailer.magic, CACHE_TRAILER, sizeof trailer.magic) != 0) return RESULT_OK;
    errno = 0;
    Result result = read_part(cache, le64toh(trailer.at), "INDX", &index, &end, error);
    // A damaged index counts as a missing one. If it cannot be read at all (errno), that is an
    // error: the cache itself may be whole.
    if (result != RESULT_OK) return result == RESULT_FAILED || errno ? result : RESULT_OK;
    bool good = true;
    for (size_t i = 0; i < index.size / sizeof(uint64_t) && good; ++i) {
        uint64_t offset;
        memcpy(&offset, index.data + i * sizeof offset, sizeof offset);
        good = cache_file_add_offset(&cache->offsets, &cache->frame_count, &cache->room,
                                     le64toh(offset));
    }
    bytes_destroy(&index);
    cache->finished = good;
    if (good) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "%s: no memory for an index", cache->file.path);
}

// Finds the frames chunk by chunk from `at`, as far as they are complete and in order.
static Result scan(CacheFile *cache, uint64_t at, Error *error)
{
    cache->frame_count = 0;
    while (at < cache->file.size) {
        Chunk chunk;
        errno = 0;
        Result result = chunk_find(&cache->file, at, &chunk, &cache->end);
        if (result != RESULT_OK && errno)
            return error_set(error, result, "%s", cache->end.text); // not the file's fault
        if (result != RESULT_OK) return RESULT_OK;
        if (strcmp(chunk.tag, "INDX") == 0) return RESULT_OK;
        if (strcmp(chunk.tag, "FRAM") != 0 || chunk.number != cache->frame_count) {
            error_set(&cache->end, RESULT_BAD_INPUT, "%s: byte %llu: expected frame %u",
                      cache->file.path, (unsigned long long)at, cache->frame_count);
            return RESULT_OK;
        }
        if (!cache_file_add_offset(&cache->offsets, &cache->frame_count, &cache->room, at))
            return error_set(error, RESULT_FAILED, "%s: no memory for an index", cache->file.path);
        at = chunk_end(&chunk);
    }
    return RESULT_OK;
}

Result cache_file_matches(const char *path, bool *matches, Error *error)
{
    char magic[sizeof CACHE_MAGIC - 1];
    errno = 0;
    size_t size = bytes_peek(path, magic, sizeof magic);
    int reason = size ? 0 : errno;
    *matches = size == sizeof magic && memcmp(magic, CACHE_MAGIC, sizeof magic) == 0;
    // Pipes, folders and missing files are left to whoever opens the path later.
    if (!reason || reason == EISDIR || reason == ENOENT || reason == EINVAL) return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT, "%s: %s", path, strerror(reason));
}

// Whether the file ends before or inside the chunk at *at. Moves *at to the end of the chunk.
static bool ends_within(ChunkFile *file, uint64_t *at)
{
    Chunk chunk = {.size = 0};
    if (file->size < *at + CHUNK_HEADER_BYTES) return true;
    Result result = chunk_find(file, *at, &chunk, NULL);
    *at += CHUNK_HEADER_BYTES + chunk.size;
    return result != RESULT_OK &&
           chunk.size > 0; // without a valid size the chunk is damaged, not cut off
}

bool cache_file_is_stub(const char *path)
{
    char magic[sizeof CACHE_MAGIC - 1];
    struct stat status;
    ChunkFile file = {.descriptor = bytes_open_plain(path, &status)};
    bool stub = file.descriptor >= 0 && S_ISREG(status.st_mode);
    file.size = stub ? (uint64_t)status.st_size : 0;
    size_t begun = file.size < sizeof magic ? (size_t)file.size : sizeof magic;
    uint64_t at = CHUNK_FILE_HEADER_BYTES;
    stub = stub && chunk_file_read_raw(&file, 0, magic, begun) &&
           memcmp(magic, CACHE_MAGIC, begun) == 0 &&
           (file.size < at || ends_within(&file, &at) || ends_within(&file, &at));
    if (file.descriptor >= 0) close(file.descriptor);
    return stub;
}

Result cache_file_open(CacheFile *cache, const char *path, Error *error)
{
    uint64_t at = CHUNK_FILE_HEADER_BYTES;
    *cache = (CacheFile){0};
    TRY(chunk_file_open(&cache->file, path, CACHE_MAGIC, error));
    Result result = read_part(cache, at, "SCEN", &cache->scene, &at, error);
    THEN(result, read_part(cache, at, "HAIR", &cache->hair, &at, error));
    THEN(result, read_index(cache, error));
    if (result == RESULT_OK && !cache->finished) result = scan(cache, at, error);
    if (result != RESULT_OK) cache_file_close(cache);
    return result;
}

void cache_file_close(CacheFile *cache)
{
    if (cache->file.path) chunk_file_close(&cache->file);
    bytes_destroy(&cache->scene);
    bytes_destroy(&cache->hair);
    free(cache->offsets);
    *cache = (CacheFile){0};
}

// The message `why` without the path at its beginning, to be put behind another mention of the
// path.
static const char *without_path(const CacheFile *cache, const Error *why)
{
    char path[sizeof why->text];
    quote_line(path, sizeof path, cache->file.path);
    size_t length = strlen(path);
    bool begins =
        strncmp(why->text, path, length) == 0 && strncmp(why->text + length, ": ", 2) == 0;
    return begins ? why->text + length + 2 : why->text;
}

Result cache_file_check(const CacheFile *cache, int last, Error *error)
{
    if (last < (int)cache->frame_count) return RESULT_OK;
    char range[32] = "none";
    if (cache->frame_count) snprintf(range, sizeof range, "0 to %u", cache->frame_count - 1);
    bool ended = cache->end.text[0] == 0;
    return error_set(error, RESULT_BAD_INPUT, "%s: no frame %d: complete frames: %s%s%s",
                     cache->file.path, last, range, ended ? "" : "; ",
                     ended ? "" : without_path(cache, &cache->end));
}

bool cache_file_verify(CacheFile *cache)
{
    for (uint32_t i = 0; i < cache->frame_count; ++i) {
        Bytes payload = {0};
        uint64_t end;
        Error why;
        Result result = read_part(cache, cache->offsets[i], "FRAM", &payload, &end, &why);
        bytes_destroy(&payload);
        if (result == RESULT_OK) continue;
        error_set(&cache->end, RESULT_BAD_INPUT, "%s: frame %u, %s", cache->file.path, i,
                  without_path(cache, &why));
        cache->frame_count = i;
        return false;
    }
    return true;
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

static bool are_finite(const float *numbers, size_t count)
{
    bool finite = true;
    for (size_t i = 0; i < count; ++i) finite &= isfinite(numbers[i]) != 0;
    return finite;
}

Result cache_file_read(CacheFile *cache, int frame, float head[CACHE_HEAD_FLOATS],
                       float (*positions)[3], uint64_t vertex_count, Error *error)
{
    Bytes payload = {0};
    uint64_t end;
    Error why;
    TRY(cache_file_check(cache, frame, error));
    Result result = read_part(cache, cache->offsets[frame], "FRAM", &payload, &end, &why);
    if (result != RESULT_OK)
        return error_set(error, result, "%s: frame %d, %s", cache->file.path, frame,
                         without_path(cache, &why));
    bool good = payload.size >= HEAD_BYTES &&
                float_planes_unpack((float *)positions, (size_t)(3 * vertex_count), CACHE_STRIDE,
                                    payload.data + HEAD_BYTES, payload.size - HEAD_BYTES);
    bool short_of_memory = !good && payload.size >= HEAD_BYTES && errno == ENOMEM;
    for (int i = 0; i < CACHE_HEAD_FLOATS && good; ++i) head[i] = take_float(payload.data + 4 * i);
    bytes_destroy(&payload);
    good = good && are_finite(head, CACHE_HEAD_FLOATS) &&
           are_finite((const float *)positions, (size_t)(3 * vertex_count));
    if (good) return RESULT_OK;
    if (short_of_memory)
        return error_set(error, RESULT_FAILED, "%s: no memory for frame %d", cache->file.path,
                         frame);
    return error_set(error, RESULT_BAD_INPUT,
                     "%s: frame %d at byte %llu: damaged, or of other hair than the cache",
                     cache->file.path, frame, (unsigned long long)cache->offsets[frame]);
}
