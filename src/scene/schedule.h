// SPDX-License-Identifier: MIT
// Which steps of a simulation lead to which frames of a video.
//
// There are two clocks. The video's clock ticks once per frame, every 1 / --fps; the turntable
// follows it. The scene's clock runs --speed times as fast and is 0 at frame 0; head, gravity, wind
// and camera keys follow it. Steps have equal lengths on the scene's clock and lie at multiples of
// that length, so neither --fps nor --speed changes a simulation with its own --sim-rate.
#pragma once

#include "scene/scene.h"

typedef struct Schedule {
    double steps_per_s;     // on the scene's clock
    double steps_per_frame; // not always a whole number with --sim-rate
    int64_t settling;       // steps of the warm-up, before time 0
} Schedule;

// The state that is drawn as a frame: after step `step`, or `share` of the way from there to the
// next step.
typedef struct ScheduledFrame {
    double time;  // s, on the scene's clock
    int64_t step; // steps since time 0
    float share;  // 0 <= share < 1; rounded to the step if within 1e-6
} ScheduledFrame;

// Time of a frame on the scene's clock, s.
double schedule_frame_time(const RunParams *run, double frame);

// The rate of the periods that --substeps divides into steps (1/s, on the scene's clock):
// --sim-rate, or the frame rate. If the scene stands still (speed 0), the video's rate is used for
// the warm-up.
double schedule_period_rate(const RunParams *run);

// A section's parameters, each with its greatest value over the whole run.
SectionParams schedule_greatest_params(const RunParams *run, const Section *section);

// `substeps`: the value of --substeps, or the value found for auto (simulation.h).
Schedule schedule_create(const RunParams *run, int substeps);

// The step of a frame (from 0).
ScheduledFrame schedule_frame(const Schedule *schedule, const RunParams *run, int frame);
