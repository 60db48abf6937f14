// SPDX-License-Identifier: MIT
#include "sim/field_cache.h"
#include "base/chunk.h"
#include "base/outfile.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char MAGIC[] = "TRXFIELD";

// Counts up when a field of the same mesh comes out otherwise.
enum { METHOD = 1 };

// The grid, as it stands in the file.
typedef struct GridRecord {
    uint32_t size[3];
    float low[3], spacing;
} GridRecord;

// FNV-1a over 64 bits, 4 bytes at a time.
static uint64_t hash_words(uint64_t hash, const void *words, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        uint32_t word;
        memcpy(&word, (const char *)words + 4 * i, 4);
        hash = (hash ^ word) * 0x100000001b3ull;
    }
    return hash;
}

char *field_cache_name(const Mesh *mesh, uint32_t resolution)
{
    const char *folder = getenv("XDG_CACHE_HOME"), *home = getenv("HOME"), *between = "";
    if (!folder || folder[0] != '/') folder = home, between = "/.cache";
    if (!folder || folder[0] != '/') return NULL;
    const uint32_t header[] = {METHOD, resolution, mesh->vertex_count, mesh->triangle_count};
    uint64_t hash = hash_words(0xcbf29ce484222325ull, header, 4);
    hash = hash_words(hash, mesh->position, 3 * (size_t)mesh->vertex_count);
    hash = hash_words(hash, mesh->triangle, 3 * (size_t)mesh->triangle_count);
    char *name = NULL;
    if (asprintf(&name, "%s%s/tractrix/%016llx.field", folder, between, (unsigned long long)hash) <
        0)
        return NULL;
    return name;
}

static Result read_chunk(ChunkFile *file, uint64_t at, const char *tag, size_t size, Bytes *bytes,
                         uint64_t *end, Error *error)
{
    Chunk chunk;
    Result result = chunk_find(file, at, &chunk, error);
    if (result != RESULT_OK) return result;
    if (strcmp(chunk.tag, tag) != 0 || chunk.size != size)
        return error_set(error, RESULT_BAD_INPUT, "%s: another kind of field", file->path);
    *end = chunk_end(&chunk);
    return chunk_read(file, &chunk, bytes, error);
}

static Result read_field(DistanceField *field, ChunkFile *file, const Gpu *gpu, Error *error)
{
    Bytes grid = {0}, values = {0};
    uint64_t at = CHUNK_FILE_HEADER_BYTES;
    Result result = read_chunk(file, at, "GRID", sizeof(GridRecord), &grid, &at, error);
    if (result == RESULT_OK) {
        GridRecord record;
        memcpy(&record, grid.data, sizeof record);
        memcpy(field->size, record.size, sizeof field->size);
        memcpy(field->low, record.low, sizeof field->low);
        field->spacing = record.spacing;
        result = read_chunk(file, at, "DIST", distance_field_count(field) * sizeof(float), &values,
                            &at, error);
    }
    if (result == RESULT_OK)
        result = gpu_buffer_create(&field->values, &gpu->limits, "a distance field",
                                   (int64_t)values.size, values.data, GL_R32F, error);
    bytes_destroy(&grid);
    bytes_destroy(&values);
    return result;
}

static Result read_file(DistanceField *field, const char *name, const Gpu *gpu, Error *error)
{
    ChunkFile file;
    *field = (DistanceField){0};
    Result result = chunk_file_open(&file, name, MAGIC, error);
    if (result == RESULT_OK) {
        result = read_field(field, &file, gpu, error);
        chunk_file_close(&file);
    }
    if (result != RESULT_OK) distance_field_destroy(field);
    return result;
}

// The cache's folder and the one before it, which may be missing.
static void make_folders(char *name)
{
    char *last = strrchr(name, '/');
    *last = 0;
    char *before = strrchr(name, '/');
    *before = 0;
    mkdir(name, 0700);
    *before = '/';
    mkdir(name, 0700);
    *last = '/';
}

static Result write_file(const DistanceField *field, char *name, Error *error)
{
    size_t size = distance_field_count(field) * sizeof(float);
    void *values = malloc(size);
    if (!values) return error_set(error, RESULT_FAILED, "no memory for a distance field");
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, field->values.buffer);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)size, values);
    GridRecord record = {.spacing = field->spacing};
    memcpy(record.size, field->size, sizeof record.size);
    memcpy(record.low, field->low, sizeof record.low);
    make_folders(name);
    OutFile file;
    Result result = outfile_open(&file, name, error);
    if (result == RESULT_OK) {
        chunk_file_begin(file.stream, MAGIC);
        chunk_write(file.stream, "GRID", 0, &record, sizeof record);
        chunk_write(file.stream, "DIST", 0, values, size);
        result = outfile_commit(&file, error);
    }
    free(values);
    return result;
}

Result field_cache_create(DistanceField *field, const Gpu *gpu, const Mesh *mesh,
                          uint32_t resolution, bool *read, Error *error)
{
    Error why = {{0}};
    char *name = field_cache_name(mesh, resolution);
    bool found = name && read_file(field, name, gpu, &why) == RESULT_OK;
    Result result = found ? RESULT_OK : distance_field_create(field, gpu, mesh, resolution, error);
    if (result == RESULT_OK && name && !found) write_file(field, name, &why);
    if (read) *read = found;
    free(name);
    return result;
}
