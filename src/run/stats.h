// SPDX-License-Identifier: MIT
// The statistics of a run: a JSON file with times of every pass and frame, counts, what was
// skipped, device, versions, parameters.
#pragma once

#include "draw/renderer.h"
#include "gpu/gpu_timer.h"
#include "run/output.h"
#include "scene/assets.h"
#include "sim/simulation.h"

#include <jansson.h>

// Collected while the scene runs. A zeroed struct is off: all functions do nothing.
typedef struct Stats {
    json_t *root; // owned
    json_t *frames;
    double pass_total_ms[TIMER_MAX_LABELS]; // of each timer label when the last frame ended
} Stats;

// Wall times of one frame, ms.
typedef struct FrameTimes {
    int frame;
    double simulate_ms; // queueing steps and pose (a CPU driver also runs them meanwhile)
    double wait_ms;     // for a free image: the encoder is behind
    double draw_ms;     // drawing and reading back, with whatever simulation was still queued
} FrameTimes;

// An empty record. RESULT_FAILED when memory is short.
Result stats_create(Stats *stats, Error *error);
void stats_destroy(Stats *stats);

// Who runs what: program, device, parameters, hair files.
void stats_describe(Stats *stats, const Gpu *gpu, const Scene *scene, const Assets *assets,
                    const Simulation *simulation);

// The exposure of all images, EV: the given one, or the one that was found.
void stats_add_exposure(Stats *stats, float exposure);

// Appends a frame with the GPU time of every pass since the last one. Waits for the timer's
// results.
void stats_add_frame(Stats *stats, GpuTimer *timer, const FrameTimes *times,
                     const RendererCounts *counts);

// An object of named wall times (ms) at the top level: stats_add_wall(stats, "load_ms", 12.5).
void stats_add_wall(Stats *stats, const char *name, double ms);

// Totals at the end. `output` may be NULL.
void stats_finish(Stats *stats, const GpuTimer *timer, const Simulation *simulation,
                  int frames_drawn, int frames_repeated, const OutputCounters *output);

// Writes the file. RESULT_FAILED with path and reason.
Result stats_write(const Stats *stats, const char *path, Error *error);
