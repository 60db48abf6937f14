// SPDX-License-Identifier: MIT
// The statistics of a run: a JSON file with the times of all passes and frames, counts, what was
// skipped, device, versions, parameters.
#pragma once

#include "draw/renderer.h"
#include "gpu/gpu_timer.h"
#include "run/output.h"
#include "scene/assets.h"
#include "sim/simulation.h"

#include <jansson.h>

// Collected during the run. A zeroed struct is turned off: all functions do nothing.
typedef struct Stats {
    json_t *root; // owned
    json_t *frames;
    double pass_total_ms[TIMER_MAX_LABELS]; // total of each timer label at the end of the last
                                            // frame
} Stats;

// Wall times of one frame, ms.
typedef struct FrameTimes {
    int frame;
    double simulate_ms; // queueing steps and pose (a CPU driver also runs them meanwhile)
    double wait_ms;     // waiting for a free image while the encoder is behind
    double draw_ms;     // drawing and reading back, with simulation that was still queued
} FrameTimes;

// An empty record. RESULT_FAILED when memory is short.
Result stats_create(Stats *stats, Error *error);
void stats_destroy(Stats *stats);

// Adds program, device, parameters and hair files.
void stats_describe(Stats *stats, const Gpu *gpu, const Scene *scene, const Assets *assets,
                    const Simulation *simulation);

// The exposure of all images, EV, given or found.
void stats_add_exposure(Stats *stats, float exposure);

// Appends a frame with the GPU time of every pass since the last one. Waits for the timer's
// results.
void stats_add_frame(Stats *stats, GpuTimer *timer, const FrameTimes *times,
                     const RendererCounts *counts);

// Adds an object of named wall times (ms) at the top level: stats_add_wall(stats, "load_ms", 12.5).
void stats_add_wall(Stats *stats, const char *name, double ms);

// Adds totals at the end. `output` may be NULL.
void stats_finish(Stats *stats, const GpuTimer *timer, const Simulation *simulation,
                  int frames_drawn, int frames_repeated, const OutputCounters *output);

// Writes the file. RESULT_FAILED with path and reason.
Result stats_write(const Stats *stats, const char *path, Error *error);
