// SPDX-License-Identifier: MIT
#include "run/frame_source.h"
#include "base/interrupt.h"
#include "run/snapshot.h"
#include "sim/simulation_state.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

// How much work a crash may cost. Saving the state takes some 50 ms for 10,000 strands of 32
// vertices.
static const double SAVE_EVERY_MS = 5000;

static double now_ms(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return 1e3 * (double)time.tv_sec + 1e-6 * (double)time.tv_nsec;
}

// --- Opening.

static Result begin_cache(FrameSource *source, const char *path, Error *error)
{
    unlink(source->state_path); // of what was there before
    Result result =
        cache_writer_open(&source->writer, path, source->simulation, source->strands, error);
    source->writes = result == RESULT_OK;
    return result;
}

// The state after a frame that the cache holds. If there is none that fits, the simulation begins
// again, with the same result.
static bool find_state(FrameSource *source, FILE *messages, Error *error)
{
    int frame = 0;
    Result result = snapshot_read(&source->state, &frame, source->state_path, source->simulation,
                                  source->strands, error);
    if (result == RESULT_OK && frame < (int)source->reader.cache.frame_count) {
        source->played = frame + 1;
        return true;
    }
    if (result == RESULT_OK)
        error_set(error, result, "%s: is of frame %d, the cache ends before", source->state_path,
                  frame);
    if (messages) fprintf(messages, "%s: simulating again from the start\n", error->text);
    bytes_destroy(&source->state);
    return false;
}

static Result resume_cache(FrameSource *source, const char *path, int last, FILE *messages,
                           Error *error)
{
    CacheReader *reader = &source->reader;
    Result result = cache_reader_open(reader, path, source->simulation, source->strands, error);
    if (result != RESULT_OK) return result;
    source->reads = true;
    if (messages) fprintf(messages, "%s: %u frames are there\n", path, reader->cache.frame_count);
    if ((int)reader->cache.frame_count > last) {
        source->played = (int)reader->cache.frame_count;
        return RESULT_OK;
    }
    if (!find_state(source, messages, error)) return begin_cache(source, path, error);
    result = cache_writer_continue(&source->writer, reader, (uint32_t)source->played,
                                   source->simulation, error);
    source->writes = result == RESULT_OK;
    return result;
}

static Result play_cache(FrameSource *source, const char *path, int last, Error *error)
{
    Result result =
        cache_reader_open(&source->reader, path, source->simulation, source->strands, error);
    if (result != RESULT_OK) return result;
    source->reads = true;
    source->played = last + 1;
    return cache_reader_check(&source->reader, last, error);
}

Result frame_source_look(FrameSource *source, Simulation *simulation, const Strands *strands,
                         int last, Error *error)
{
    const char *from = simulation->scene->run.from_cache;
    *source = (FrameSource){.simulation = simulation, .strands = strands, .written_ms = now_ms()};
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

// --- Going.

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

// The next frame of the simulation; of a resumed one, the first comes after the state that was
// saved.
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
    if (result != RESULT_OK || now_ms() - source->written_ms < SAVE_EVERY_MS) return result;
    result = snapshot_write(source->state_path, source->simulation, source->strands, error);
    simulation_pose(source->simulation); // as drawn: saving shows the last step's positions
    source->written_ms = now_ms();
    return result;
}

Result frame_source_go(FrameSource *source, int frame, bool drawn, Error *error)
{
    if (frame < source->played)
        return drawn ? cache_reader_show(&source->reader, source->simulation, frame, error)
                     : RESULT_OK;
    Result result = simulate(source, frame, error);
    if (result != RESULT_OK) return result;
    if (drawn || source->writes) simulation_pose(source->simulation);
    return source->writes ? record(source, error) : RESULT_OK;
}

// --- Ending.

Result frame_source_finish(FrameSource *source, Error *error)
{
    if (!source->writes) return RESULT_OK;
    source->writes = false;
    Result result = cache_writer_finish(&source->writer, error);
    if (result != RESULT_OK) return result;
    if (source->simulation->frame + 1 < source->simulation->scene->run.frames)
        return snapshot_write(source->state_path, source->simulation, source->strands, error);
    if (unlink(source->state_path) != 0 && errno != ENOENT)
        return error_set(error, RESULT_FAILED, "%s: cannot remove it: %s", source->state_path,
                         strerror(errno));
    return RESULT_OK;
}

void frame_source_close(FrameSource *source)
{
    bool begun = source->writes && source->writer.frame_count > 0 &&
                 source->simulation->frame == (int)source->writer.frame_count - 1;
    if (begun && !source->state.data)
        snapshot_write(source->state_path, source->simulation, source->strands, NULL);
    if (source->writer.path) cache_writer_close(&source->writer);
    if (source->reads) cache_reader_close(&source->reader);
    bytes_destroy(&source->state);
    free(source->state_path);
    *source = (FrameSource){0};
}
