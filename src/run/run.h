// SPDX-License-Identifier: MIT
// The room run: a run of tractrix-render. From a scene, it simulates and draws one frame after the
// other, and outputs images or a video, a cache, hair files and statistics. Its parts: run (set-up
// and order), sequence (the loop over frames), frame_source (simulation or cache), images and
// output (drawing and encoding), survey (simulates all frames for the camera), exposure (meters the
// first), export, stats, help.
#pragma once

#include "run/images_output.h"
#include "run/resume.h"
#include "run/sequence.h"

// Everything a run creates, so that one function can destroy it in any state. The caller sets
// `scene` (scene_from_arguments) and `begin_ms`.
typedef struct Run {
    Scene scene;
    Assets assets;
    Gpu gpu;
    bool has_gpu;
    GpuTimer timer;
    Framing framing;
    float exposure; // EV, of all images
    Simulation simulation;
    Images images;  // empty unless the scene has an output
    Output *output; // NULL unless the scene has an output
    FrameSource source;
    Exporter exporter;
    bool exports;
    Fingerprint fingerprint;
    FramesDone done;
    Stats stats;
    double begin_ms, loaded_ms, ready_ms; // clock_ms
} Run;

// Checks all that can be checked before a file is opened: names, paths (run_paths.h), and whether
// the outputs can hold the frames. RESULT_USAGE or RESULT_BAD_INPUT.
Result run_check(const Scene *scene, Error *error);

// Opens everything, draws all frames and finishes the files. Reports on standard error unless
// --quiet. Errors of every part; must be called once only.
Result run_go(Run *run, Error *error);

// Prints the name of the device's platform (gpu/platform.h). RESULT_NO_GL.
Result run_print_platform(const RunParams *params, FILE *stream, Error *error);

// Without a successful run_go, this removes unfinished files.
void run_destroy(Run *run);
