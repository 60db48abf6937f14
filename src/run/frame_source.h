// SPDX-License-Identifier: MIT
// Where the frames of a run come from: a simulation, a cache (--from-cache), or, when an unfinished
// --cache is resumed, first the one and then the other. Writes the cache as it goes.
#pragma once

#include "run/cache.h"

typedef struct FrameSource {
    Simulation *simulation;
    const Strands *strands;
    CacheReader reader;
    CacheWriter writer;
    bool reads, writes;
    int played;        // frames before this one come from the reader
    Bytes state;       // of the simulation after frame played - 1; empty once it has been used
    char *state_path;  // beside a cache that is written
    double written_ms; // when the state was last written
} FrameSource;

// As the run's parameters cache, from_cache and resume say. `last`: the last frame that will be
// asked for. Reports on `messages` (NULL: none) which part of an unfinished cache
// is used.
// All arguments outlive the source. RESULT_BAD_INPUT with one line about a cache that is damaged,
// too short or of another scene; RESULT_FAILED if it cannot be written.
Result frame_source_open(FrameSource *source, Simulation *simulation, const Strands *strands,
                         int last, FILE *messages, Error *error);

// The same without run.cache: frames come from run.from_cache or the simulation, and nothing is
// written.
Result frame_source_look(FrameSource *source, Simulation *simulation, const Strands *strands,
                         int last, Error *error);

// Makes `frame` the current one; frames must be requested in ascending order. Those that are
// `drawn` have their positions written. Frames between them are simulated if needed.
// RESULT_INTERRUPTED if the warm-up before frame 0 was; errors as above.
Result frame_source_go(FrameSource *source, int frame, bool drawn, Error *error);

// Whether `frame` must be requested, drawn or not, because it has to be simulated.
bool frame_source_needs(const FrameSource *source, int frame);

// After the last frame: ends the cache, and removes the saved state if the sequence is complete.
Result frame_source_finish(FrameSource *source, Error *error);

// Without frame_source_finish, the state of a cache that is not complete is saved, so that the run
// can be resumed. A zeroed struct may be closed.
void frame_source_close(FrameSource *source);
