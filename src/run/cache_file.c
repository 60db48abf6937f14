// SPDX-License-Identifier: MIT
#include "run/cache_file.h"

#include "base/float_planes.h"

#include <endian.h>
#include <stdlib.h>
#include <string.h>

enum { HEAD_BYTES = 4 * CACHE_HEAD_FLOATS };

bool cache_add_offset(uint64_t **offsets, uint32_t *count, uint32_t *room, uint64_t offset)
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

// The chunk at `at`, which must have this tag. *end: where the next one begins.
static Result read_part(CacheFile *cache, uint64_t at, const char *tag, Bytes *payload,
                        uint64_t *end, Error *error)
{
    Chunk chunk;
    Result result = chunk_find(&cache->file, at, &chunk, error);
    if (result == RESULT_OK && strcmp(chunk.tag, tag) != 0)
        result = error_set(error, RESULT_BAD_INPUT, "%s: byte %llu: expected %s", cache->file.path,
                           (unsigned long long)at, tag);
    if (result != RESULT_OK) return result;
    *end = chunk_end(&chunk);
    return chunk_read(&cache->file, &chunk, payload, error);
}

// By the index at the end; false if there is none that is whole.
static bool read_index(CacheFile *cache)
{
    struct {
        uint64_t at;
        char magic[8];
    } trailer;
    _Static_assert(sizeof trailer == CACHE_TRAILER_BYTES, "a trailer has no holes");
    uint64_t size = cache->file.size, end;
    Bytes index = {0};
    if (size < CACHE_TRAILER_BYTES ||
        !chunk_file_read_raw(&cache->file, size - CACHE_TRAILER_BYTES, &trailer, sizeof trailer) ||
        memcmp(trailer.magic, CACHE_TRAILER, sizeof trailer.magic) != 0 ||
        read_part(cache, le64toh(trailer.at), "INDX", &index, &end, NULL) != RESULT_OK)
        return false;
    bool good = true;
    for (size_t i = 0; i < index.size / sizeof(uint64_t) && good; ++i) {
        uint64_t offset;
        memcpy(&offset, index.data + i * sizeof offset, sizeof offset);
        good =
            cache_add_offset(&cache->offsets, &cache->frame_count, &cache->room, le64toh(offset));
    }
    bytes_destroy(&index);
    return good;
}

// Chunk by chunk from `at`, as far as they are whole and in order.
static Result scan(CacheFile *cache, uint64_t at, Error *error)
{
    cache->frame_count = 0;
    while (at < cache->file.size) {
        Chunk chunk;
        if (chunk_find(&cache->file, at, &chunk, &cache->end) != RESULT_OK) return RESULT_OK;
        if (strcmp(chunk.tag, "INDX") == 0) return RESULT_OK;
        if (strcmp(chunk.tag, "FRAM") != 0 || chunk.number != cache->frame_count) {
            error_set(&cache->end, RESULT_BAD_INPUT, "%s: byte %llu: not frame %u",
                      cache->file.path, (unsigned long long)at, cache->frame_count);
            return RESULT_OK;
        }
        if (!cache_add_offset(&cache->offsets, &cache->frame_count, &cache->room, at))
            return error_set(error, RESULT_FAILED, "%s: no memory for an index", cache->file.path);
        at = chunk_end(&chunk);
    }
    return RESULT_OK;
}

bool cache_file_matches(const char *path)
{
    char magic[sizeof CACHE_MAGIC - 1];
    FILE *stream = fopen(path, "rb");
    bool same = stream && fread(magic, sizeof magic, 1, stream) == 1 &&
                memcmp(magic, CACHE_MAGIC, sizeof magic) == 0;
    if (stream) fclose(stream);
    return same;
}

Result cache_file_open(CacheFile *cache, const char *path, Error *error)
{
    uint64_t at = CHUNK_FILE_HEADER_BYTES;
    *cache = (CacheFile){0};
    Result result = chunk_file_open(&cache->file, path, CACHE_MAGIC, error);
    if (result != RESULT_OK) return result;
    result = read_part(cache, at, "SCEN", &cache->scene, &at, error);
    if (result == RESULT_OK) result = read_part(cache, at, "HAIR", &cache->hair, &at, error);
    if (result == RESULT_OK && !read_index(cache)) result = scan(cache, at, error);
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

// What follows the file's name in a message about it.
static const char *without_path(const CacheFile *cache, const Error *why)
{
    size_t length = strlen(cache->file.path) + strlen(": ");
    return strlen(why->text) > length ? why->text + length : why->text;
}

Result cache_file_check(const CacheFile *cache, int last, Error *error)
{
    if (last < (int)cache->frame_count) return RESULT_OK;
    char range[32] = "none";
    if (cache->frame_count) snprintf(range, sizeof range, "0 to %u", cache->frame_count - 1);
    bool ended = cache->end.text[0] == 0;
    return error_set(error, RESULT_BAD_INPUT, "%s: no frame %d, whole ones: %s%s%s",
                     cache->file.path, last, range, ended ? "" : "; ",
                     ended ? "" : without_path(cache, &cache->end));
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

Result cache_file_read(CacheFile *cache, int frame, float head[CACHE_HEAD_FLOATS],
                       float (*positions)[3], uint64_t vertex_count, Error *error)
{
    Bytes payload = {0};
    uint64_t end;
    Error why;
    Result result = cache_file_check(cache, frame, error);
    if (result != RESULT_OK) return result;
    result = read_part(cache, cache->offsets[frame], "FRAM", &payload, &end, &why);
    if (result != RESULT_OK)
        return error_set(error, result, "%s: frame %d, %s", cache->file.path, frame,
                         without_path(cache, &why));
    bool good = payload.size >= HEAD_BYTES &&
                float_planes_unpack((float *)positions, (size_t)(3 * vertex_count), CACHE_STRIDE,
                                    payload.data + HEAD_BYTES, payload.size - HEAD_BYTES);
    for (int i = 0; i < CACHE_HEAD_FLOATS && good; ++i) head[i] = take_float(payload.data + 4 * i);
    bytes_destroy(&payload);
    if (good) return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT, "%s: frame %d at byte %llu is no frame of this hair",
                     cache->file.path, frame, (unsigned long long)cache->offsets[frame]);
}
