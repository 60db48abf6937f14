// SPDX-License-Identifier: MIT
#include "base/chunk.h"

#include <endian.h>
#include <errno.h>
#include <fcntl.h>
#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { VERSION = 1, MAGIC_BYTES = 8, TAG_BYTES = 4 };

// All numbers are little-endian, as in the file.
typedef struct Header {
    char tag[TAG_BYTES];
    uint32_t number;
    uint64_t size;
    uint32_t checksum;        // of the payload
    uint32_t header_checksum; // of the first 20 bytes of the header
} Header;
_Static_assert(sizeof(Header) == CHUNK_HEADER_BYTES, "a header has no holes");

void chunk_file_begin(FILE *stream, const char *magic)
{
    const uint32_t rest[2] = {htole32(VERSION), 0};
    fwrite(magic, 1, MAGIC_BYTES, stream);
    fwrite(rest, 1, sizeof rest, stream);
}

void chunk_write(FILE *stream, const char *tag, uint32_t number, const void *payload, size_t size)
{
    Header header = {.number = htole32(number),
                     .size = htole64(size),
                     .checksum = htole32(libdeflate_crc32(0, payload, size))};
    memcpy(header.tag, tag, TAG_BYTES);
    header.header_checksum =
        htole32(libdeflate_crc32(0, &header, offsetof(Header, header_checksum)));
    fwrite(&header, 1, sizeof header, stream);
    fwrite(payload, 1, size, stream);
}

bool chunk_file_read_raw(ChunkFile *file, uint64_t at, void *bytes, size_t size)
{
    uint8_t *to = bytes;
    errno = 0;
    while (size > 0) {
        ssize_t got = pread(file->descriptor, to, size, (off_t)at);
        if (got < 0 && errno == EINTR) {
            errno = 0;
            continue;
        }
        if (got <= 0) return false;
        to += got, at += (uint64_t)got, size -= (size_t)got;
    }
    return true;
}

static Result fail_at(const ChunkFile *file, uint64_t at, const char *what, Error *error)
{
    return error_set(error, RESULT_BAD_INPUT, "%s: byte %llu: %s", file->path,
                     (unsigned long long)at, what);
}

// Reports a failed chunk_file_read_raw: the errno or, if there is none, `ended`.
static Result fail_to_read(const ChunkFile *file, uint64_t at, const char *ended, Error *error)
{
    return fail_at(file, at, errno ? strerror(errno) : ended, error);
}

static Result check_header(ChunkFile *file, const char *magic, Error *error)
{
    char header[CHUNK_FILE_HEADER_BYTES];
    uint32_t version;
    if (!chunk_file_read_raw(file, 0, header, sizeof header) && errno)
        return fail_to_read(file, 0, "", error);
    if (file->size < sizeof header || memcmp(header, magic, MAGIC_BYTES) != 0)
        return error_set(error, RESULT_BAD_INPUT, "%s: byte 0: expected %s", file->path, magic);
    memcpy(&version, header + MAGIC_BYTES, sizeof version);
    if (le32toh(version) == VERSION) return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT, "%s: version %u: expected version %d", file->path,
                     le32toh(version), VERSION);
}

Result chunk_file_open(ChunkFile *file, const char *path, const char *magic, Error *error)
{
    *file = (ChunkFile){.path = strdup(path), .descriptor = -1};
    if (!file->path) return error_set(error, RESULT_FAILED, "no memory for a file's name");
    struct stat status;
    file->descriptor = bytes_open_plain(path, &status);
    Result result = RESULT_OK;
    if (file->descriptor < 0)
        result = error_set(error, RESULT_BAD_INPUT, "%s: %s", path,
                           errno == EINVAL ? BYTES_IS_NOT_PLAIN : strerror(errno));
    else if (!S_ISREG(status.st_mode))
        result = error_set(error, RESULT_BAD_INPUT, "%s: not a plain file", path);
    else
        file->size = (uint64_t)status.st_size;
    THEN(result, check_header(file, magic, error));
    if (result != RESULT_OK) chunk_file_close(file);
    return result;
}

void chunk_file_close(ChunkFile *file)
{
    if (file->path && file->descriptor >= 0) close(file->descriptor);
    free(file->path);
    *file = (ChunkFile){.descriptor = -1};
}

Result chunk_find(ChunkFile *file, uint64_t at, Chunk *chunk, Error *error)
{
    Header header;
    if (!chunk_file_read_raw(file, at, &header, sizeof header))
        return fail_to_read(file, at, "the file ends", error);
    if (le32toh(header.header_checksum) !=
        libdeflate_crc32(0, &header, offsetof(Header, header_checksum)))
        return fail_at(file, at, "damaged: expected the header of a chunk", error);
    *chunk = (Chunk){.number = le32toh(header.number),
                     .at = at,
                     .size = le64toh(header.size),
                     .checksum = le32toh(header.checksum)};
    memcpy(chunk->tag, header.tag, TAG_BYTES);
    if (chunk->size <= file->size && chunk_end(chunk) <= file->size) return RESULT_OK;
    return fail_at(file, at, "the file ends within this chunk", error);
}

Result chunk_read(ChunkFile *file, const Chunk *chunk, Bytes *payload, Error *error)
{
    *payload = (Bytes){.data = malloc((size_t)chunk->size + 1), .size = (size_t)chunk->size};
    if (!payload->data) {
        *payload = (Bytes){0};
        return error_set(error, RESULT_FAILED, "%s: no memory for %llu bytes", file->path,
                         (unsigned long long)chunk->size);
    }
    payload->data[payload->size] = 0;
    Result result = RESULT_OK;
    if (!chunk_file_read_raw(file, chunk->at + CHUNK_HEADER_BYTES, payload->data, payload->size))
        result = fail_to_read(file, chunk->at, "the file ends within this chunk", error);
    else if (libdeflate_crc32(0, payload->data, payload->size) != chunk->checksum)
        result = fail_at(file, chunk->at, "damaged: the checksum does not match", error);
    if (result != RESULT_OK) bytes_destroy(payload);
    return result;
}
