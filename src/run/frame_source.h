// SPDX-License-Identifier: MIT
// The source of a run's frames: a simulation, animated hair files (played.h), a cache
// (--from-cache), or both if an unfinished --cache is resumed, first the cache. Also writes the
// cache.
#pragma once

#include "run/cache.h"

typedef struct FrameSource {
    Simulation *simulation;
    const Strands *strands;
    CacheReader reader;
    CacheWriter writer;
    bool reads, writes;
    int played;        // frames before this one come from the reader
    Bytes state;       // of the simulation after frame played - 1; empty after use
    char *state_path;  // next to a cache that is written
    double written_ms; // when the state was last written
} FrameSource;

// Follows the run's parameters cache, from_cache and resume. `last`: the last frame that will be
// requested. Reports on `messages` (NULL: nowhere) which part of an unfinished cache is used. All
// arguments must outlive the source. RESULT_BAD_INPUT with one line about a cache that is damaged,
// too short or of another scene; RESULT_FAILED if it can't be written.
Result frame_source_open(FrameSource *source, Simulation *simulation, const Strands *strands,
                         int last, FILE *messages, Error *error);

// The same without run.cache: frames come from run.from_cache or the simulation, and nothing is
// written.
Result frame_source_look(FrameSource *source, Simulation *simulation, const Strands *strands,
                         int last, Error *error);

// Makes `frame` the current one; frames must be requested in ascending order. Positions of `drawn`
// frames are written to the cache. Frames in between are simulated if needed. RESULT_INTERRUPTED if
// the warm-up before frame 0 was interrupted; errors as above.
Result frame_source_go(FrameSource *source, int frame, bool drawn, Error *error);

// Whether `frame` must be requested even if it is not drawn, because it has to be simulated.
bool frame_source_needs(const FrameSource *source, int frame);

// After the last frame: finishes the cache, and removes the saved state if the sequence is
// complete.
Result frame_source_finish(FrameSource *source, Error *error);

// Without frame_source_finish, this saves the state of an unfinished cache, so that the run can be
// resumed. A zeroed struct may be closed.
void frame_source_close(FrameSource *source);
