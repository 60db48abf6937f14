// SPDX-License-Identifier: MIT
#include "run/frame_source.h"
#include "base/chunk.h"
#include "base/clock.h"
#include "base/interrupt.h"
#include "base/outfile.h"
#include "base/quote.h"
#include "run/cache_scene.h"
#include "run/played.h"
#include "sim/simulation_state.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

// A crash may cost this much work. Saving the state takes about 50 ms for 10,000 strands of 32
// vertices.
static const double SAVE_EVERY_MS = 5000;

// --- The state of an unfinished simulation, in a file from which another run can continue.

static const char STATE_MAGIC[] = "TRXSTATE";

static Result write_chunks(const char *path, int frame, const Bytes *scene, const Bytes *hair,
                           const Bytes *state, Error *error)
{
    OutFile file;
    TRY(outfile_open(&file, path, error));
    chunk_file_begin(file.stream, STATE_MAGIC);
    chunk_write(file.stream, "SCEN", 0, scene->data, scene->size);
    chunk_write(file.stream, "HAIR", 0, hair->data, hair->size);
    chunk_write(file.stream, "STAT", (uint32_t)frame, state->data, state->size);
    return outfile_commit(&file, error);
}

// Writes the state after the current frame. The file appears complete or not at all.
static Result write_state(const char *path, Simulation *simulation, const Strands *strands,
                          Error *error)
{
    Bytes scene = {0}, hair = {0}, state = {0};
    Result result = cache_scene_describe(&scene, simulation, error);
    THEN(result, cache_scene_describe_hair(&hair, simulation, strands, error));
    THEN(result, simulation_state_save(simulation, &state, error));
    THEN(result, write_chunks(path, simulation->frame, &scene, &hair, &state, error));
    bytes_destroy(&scene);
    bytes_destroy(&hair);
    bytes_destroy(&state);
    return result;
}

// Reads the chunk at *at, which must have this tag, and moves *at behind it.
static Result read_part(ChunkFile *file, uint64_t *at, const char *tag, Chunk *chunk,
                        Bytes *payload, Error *error)
{
    Result result = chunk_find(file, *at, chunk, error);
    if (result == RESULT_OK && strcmp(chunk->tag, tag) != 0)
        result = error_set(error, RESULT_BAD_INPUT, "%s: byte %llu: expected %s", file->path,
                           (unsigned long long)*at, tag);
    THEN(result, chunk_read(file, chunk, payload, error));
    *at = chunk_end(chunk);
    return result;
}

// Reads a state for simulation_state_restore, and the frame after which it was saved.
// RESULT_BAD_INPUT if there is no state or it belongs to another simulation. Free with
// bytes_destroy.
static Result read_state(Bytes *state, int *frame, const char *path, const Simulation *simulation,
                         const Strands *strands, Error *error)
{
    ChunkFile file;
    Chunk chunk = {0};
    Bytes scene = {0}, hair = {0};
    uint64_t at = CHUNK_FILE_HEADER_BYTES;
    *state = (Bytes){0};
    TRY(chunk_file_open(&file, path, STATE_MAGIC, error));
    Result result = read_part(&file, &at, "SCEN", &chunk, &scene, error);
    THEN(result, cache_scene_compare(&scene, simulation, path, error));
    THEN(result, read_part(&file, &at, "HAIR", &chunk, &hair, error));
    THEN(result, cache_scene_compare_hair(&hair, simulation, strands, path, error));
    THEN(result, read_part(&file, &at, "STAT", &chunk, state, error));
    *frame = (int)chunk.number;
    bytes_destroy(&scene);
    bytes_destroy(&hair);
    chunk_file_close(&file);
    return result;
}

// --- Opening.

static Result begin_cache(FrameSource *source, const char *path, Error *error)
{
    Result result = outfile_remove(source->state_path, error); // remove the state of an older cache
    THEN(result,
         cache_writer_open(&source->writer, path, source->simulation, source->strands, error));
    source->writes = result == RESULT_OK;
    return result;
}

// Looks for a state that was saved after one of the cache's frames. Without one the simulation
// starts again from frame 0, with the same result.
static bool find_state(FrameSource *source, FILE *messages, Error *error)
{
    int frame = 0;
    Result result = read_state(&source->state, &frame, source->state_path, source->simulation,
                               source->strands, error);
    if (result == RESULT_OK && frame < (int)source->reader.cache.frame_count) {
        source->played = frame + 1;
        return true;
    }
    if (result == RESULT_OK)
        error_set(error, result,
                  "%s: holds the state after frame %d, but the cache ends before that frame",
                  source->state_path, frame);
    if (messages) fprintf(messages, "%s: simulating again from the start\n", error->text);
    bytes_destroy(&source->state);
    return false;
}

// Writes the index of a cache whose run was stopped after the last frame but before the index.
static Result complete_cache(FrameSource *source, Error *error)
{
    const CacheFile *cache = &source->reader.cache;
    TRY(cache_writer_continue(&source->writer, &source->reader, cache->frame_count,
                              source->simulation, error));
    return cache_writer_finish(&source->writer, error);
}

// Removes the state file once the cache has all frames of the run.
static Result drop_state(const FrameSource *source, Error *error)
{
    return outfile_remove(source->state_path, error);
}

static Result resume_cache(FrameSource *source, const char *path, int last, FILE *messages,
                           Error *error)
{
    CacheReader *reader = &source->reader;
    if (cache_file_is_stub(path)) {
        if (messages) fprintf(messages, "%s: has no frames yet: simulating from the start\n", path);
        return begin_cache(source, path, error);
    }
    TRY(cache_reader_open(reader, path, source->simulation, source->strands, error));
    source->reads = true;
    if (!cache_file_verify(&reader->cache) && messages)
        fprintf(messages, "%s\n", reader->cache.end.text);
    if (messages)
        fprintf(messages, "%s: has %u frames\n", quote(path).text, reader->cache.frame_count);
    if ((int)reader->cache.frame_count > last) {
        source->played = (int)reader->cache.frame_count;
        if (!reader->cache.finished) TRY(complete_cache(source, error));
        bool whole = source->played >= source->simulation->scene->run.frames;
        return whole ? drop_state(source, error) : RESULT_OK;
    }
    if (!find_state(source, messages, error)) return begin_cache(source, path, error);
    Result result = cache_writer_continue(&source->writer, reader, (uint32_t)source->played,
                                          source->simulation, error);
    source->writes = result == RESULT_OK;
    return result;
}

static Result play_cache(FrameSource *source, const char *path, int last, Error *error)
{
    TRY(cache_reader_open(&source->reader, path, source->simulation, source->strands, error));
    source->reads = true;
    source->played = last + 1;
    return cache_reader_check(&source->reader, last, error);
}

Result frame_source_look(FrameSource *source, Simulation *simulation, const Strands *strands,
                         int last, Error *error)
{
    const char *from = simulation->scene->run.from_cache;
    *source = (FrameSource){.simulation = simulation, .strands = strands, .written_ms = clock_ms()};
    return *from ? play_cache(source, from, last, error) : RESULT_OK;
}

Result frame_source_open(FrameSource *source, Simulation *simulation, const Strands *strands,
                         int last, FILE *messages, Error *error)
{
    const RunParams *run = &simulation->scene->run;
    Result result = frame_source_look(source, simulation, strands, last, error);
    if (result != RESULT_OK || source->reads || !*run->cache) return result;
    if (asprintf(&source->state_path, "%s.state", run->cache) < 0) {
        source->state_path = NULL;
        return error_set(error, RESULT_FAILED, "no memory for a file's name");
    }
    if (run->resume && access(run->cache, F_OK) == 0)
        return resume_cache(source, run->cache, last, messages, error);
    return begin_cache(source, run->cache, error);
}

// --- Frames.

bool frame_source_needs(const FrameSource *source, int frame)
{
    return frame >= source->played;
}

static Result settle(Simulation *simulation, Error *error)
{
    while (!interrupt_requested())
        if (!simulation_settle(simulation)) return RESULT_OK;
    return error_set(error, RESULT_INTERRUPTED, "interrupted before the first frame");
}

// Simulates the next frame. After a resume, the next frame is the one after the saved state.
static Result simulate(FrameSource *source, int frame, Error *error)
{
    if (frame == 0) return settle(source->simulation, error);
    if (source->state.data) {
        Result result = simulation_state_restore(source->simulation, &source->state, error);
        bytes_destroy(&source->state);
        if (result != RESULT_OK) return error_prefix(error, result, "%s: ", source->state_path);
    }
    simulation_advance(source->simulation);
    return RESULT_OK;
}

static Result record(FrameSource *source, Error *error)
{
    Result result = cache_writer_add(&source->writer, source->simulation, error);
    if (result != RESULT_OK || clock_ms() - source->written_ms < SAVE_EVERY_MS) return result;
    result = write_state(source->state_path, source->simulation, source->strands, error);
    // Saving shows the last step's positions; go back to the drawn ones.
    simulation_pose(source->simulation);
    THEN(result, played_show(source->simulation, error));
    source->written_ms = clock_ms();
    return result;
}

Result frame_source_go(FrameSource *source, int frame, bool drawn, Error *error)
{
    if (frame < source->played)
        return drawn ? cache_reader_show(&source->reader, source->simulation, frame, error)
                     : RESULT_OK;
    TRY(simulate(source, frame, error));
    if (drawn || source->writes) {
        simulation_pose(source->simulation);
        TRY(played_show(source->simulation, error));
    }
    return source->writes ? record(source, error) : RESULT_OK;
}

// --- The end.

Result frame_source_finish(FrameSource *source, Error *error)
{
    if (!source->writes) return RESULT_OK;
    source->writes = false;
    TRY(cache_writer_finish(&source->writer, error));
    if (source->simulation->frame + 1 < source->simulation->scene->run.frames)
        return write_state(source->state_path, source->simulation, source->strands, error);
    return drop_state(source, error);
}

void frame_source_close(FrameSource *source)
{
    bool begun = source->writes && source->writer.frame_count > 0 &&
                 source->simulation->frame == (int)source->writer.frame_count - 1;
    if (begun && !source->state.data)
        write_state(source->state_path, source->simulation, source->strands, NULL);
    if (source->writer.path) cache_writer_close(&source->writer);
    if (source->reads) cache_reader_close(&source->reader);
    bytes_destroy(&source->state);
    free(source->state_path);
    *source = (FrameSource){0};
}
