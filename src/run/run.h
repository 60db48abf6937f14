// SPDX-License-Identifier: MIT
// The room run: a run of tractrix-render. It takes a scene, simulates and draws its frames one
// after the other, and hands on images or a video, a cache, hair files and statistics: run (set-up
// and order), sequence (the loop over frames), frame_source (simulation or cache), images and
// output (drawing and encoding), survey (a look at all frames for the
// camera), exposure (a look at the first), export, stats, help.
#pragma once

#include "run/images_output.h"
#include "run/resume.h"
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
    float exposure; // EV, of all images
    Simulation simulation;
    Images images;  // empty unless the scene has an output ...
    Output *output; // ... NULL
    FrameSource source;
    Exporter exporter;
    bool exports;
    Fingerprint fingerprint;
    FramesDone done;
    Stats stats;
    double begin_ms, loaded_ms, ready_ms; // clock_ms
} Run;

// Opens everything, goes through the frames and finishes the files. Reports on standard error
// unless --quiet. Errors of every part; to be called once.
Result run_go(Run *run, Error *error);

// Prints the name of the platform that the device is (gpu/platform.h). RESULT_NO_GL.
Result run_print_platform(const RunParams *params, FILE *stream, Error *error);

// Without a successful run_go, unfinished files are removed.
void run_destroy(Run *run);
