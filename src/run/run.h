// SPDX-License-Identifier: MIT
// A run of tractrix-render: from a scene to pictures, a cache, hair files and statistics.
#pragma once

#include "run/images.h"
#include "run/sequence.h"

// All that a run makes, so that one function can destroy it in whatever state it is. The caller
// fills in `scene` (scene_from_arguments) and `begin_ms`.
typedef struct Run {
    Scene scene;
    Assets assets;
    Gpu gpu;
    bool has_gpu;
    GpuTimer timer;
    Framing framing;
    Simulation simulation;
    Images images; // empty unless the scene has an output
    FrameSource source;
    Exporter exporter;
    bool exports;
    FramesDone done;
    Stats stats;
    double begin_ms, loaded_ms, ready_ms; // clock_ms
} Run;

// Opens everything, goes through the frames and finishes what is written. What goes on is told on
// the standard error, unless the scene says --quiet. Errors of every part; to be called once.
Result run_go(Run *run, Error *error);

// Without a successful run_go, what was begun is dropped: no half-written file remains.
void run_destroy(Run *run);
