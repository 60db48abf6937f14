// SPDX-License-Identifier: MIT
#include "run/snapshot.h"
#include "base/chunk.h"
#include "base/outfile.h"
#include "run/cache_scene.h"
#include "sim/simulation_state.h"

#include <string.h>

static const char MAGIC[] = "TRXSTATE";

static Result write_chunks(const char *path, int frame, const Bytes *scene, const Bytes *hair,
                           const Bytes *state, Error *error)
{
    OutFile file;
    Result result = outfile_open(&file, path, error);
    if (result != RESULT_OK) return result;
    chunk_file_begin(file.stream, MAGIC);
    chunk_write(file.stream, "SCEN", 0, scene->data, scene->size);
    chunk_write(file.stream, "HAIR", 0, hair->data, hair->size);
    chunk_write(file.stream, "STAT", (uint32_t)frame, state->data, state->size);
    return outfile_commit(&file, error);
}

Result snapshot_write(const char *path, Simulation *simulation, const Strands *strands,
                      Error *error)
{
    Bytes scene = {0}, hair = {0}, state = {0};
    Result result = cache_scene_describe(&scene, simulation, error);
    if (result == RESULT_OK) result = cache_hair_describe(&hair, simulation, strands, error);
    if (result == RESULT_OK) result = simulation_state_save(simulation, &state, error);
    if (result == RESULT_OK)
        result = write_chunks(path, simulation->frame, &scene, &hair, &state, error);
    bytes_destroy(&scene);
    bytes_destroy(&hair);
    bytes_destroy(&state);
    return result;
}

// The chunk at *at, which must have this tag; *at moves behind it.
static Result read_part(ChunkFile *file, uint64_t *at, const char *tag, Chunk *chunk,
                        Bytes *payload, Error *error)
{
    Result result = chunk_find(file, *at, chunk, error);
    if (result == RESULT_OK && strcmp(chunk->tag, tag) != 0)
        result = error_set(error, RESULT_BAD_INPUT, "%s: byte %llu: expected %s", file->path,
                           (unsigned long long)*at, tag);
    if (result == RESULT_OK) result = chunk_read(file, chunk, payload, error);
    *at = chunk_end(chunk);
    return result;
}

Result snapshot_read(Bytes *state, int *frame, const char *path, const Simulation *simulation,
                     const Strands *strands, Error *error)
{
    ChunkFile file;
    Chunk chunk = {0};
    Bytes scene = {0}, hair = {0};
    uint64_t at = CHUNK_FILE_HEADER_BYTES;
    *state = (Bytes){0};
    Result result = chunk_file_open(&file, path, MAGIC, error);
    if (result != RESULT_OK) return result;
    result = read_part(&file, &at, "SCEN", &chunk, &scene, error);
    if (result == RESULT_OK) result = cache_scene_compare(&scene, simulation, path, error);
    if (result == RESULT_OK) result = read_part(&file, &at, "HAIR", &chunk, &hair, error);
    if (result == RESULT_OK) result = cache_hair_compare(&hair, simulation, strands, path, error);
    if (result == RESULT_OK) result = read_part(&file, &at, "STAT", &chunk, state, error);
    *frame = (int)chunk.number;
    bytes_destroy(&scene);
    bytes_destroy(&hair);
    chunk_file_close(&file);
    return result;
}
