// SPDX-License-Identifier: MIT
// Which steps of a simulation lead to which frames of a video.
//
// There are two clocks. The video's ticks once a frame, 1 / --fps; the turntable goes by it. The
// scene's runs --speed times as fast and has 0 at frame 0; head, gravity, wind and camera keys go
// by it. The simulation's steps are of one length on the scene's clock, and lie at whole multiples
// of it, so that neither --fps nor --speed changes a simulation of its own --sim-rate.
#pragma once

#include "scene/scene.h"

typedef struct Schedule {
    double steps_per_s;     // of the scene's clock
    double steps_per_frame; // with --sim-rate not always a whole number
    int64_t settling;       // steps of the warm-up: those before time 0
} Schedule;

// What is drawn as a frame: the state after step `step`, or `share` of the way from it to the next.
typedef struct ScheduledFrame {
    double time;  // s, of the scene's clock
    int64_t step; // steps since time 0
    float share;  // 0 .. below 1; within 1e-6 of a step it is that step
} ScheduledFrame;

// Time of a frame on the scene's clock, s.
double schedule_frame_time(const RunParams *run, double frame);

// The periods that --substeps divides into steps, 1/s of the scene's clock: --sim-rate, or the
// frames'; where the scene stands still (speed 0), the video's, for the warm-up.
double schedule_period_rate(const RunParams *run);

// `substeps`: what --substeps says or, if that is auto, what has been found (simulation.h).
Schedule schedule_create(const RunParams *run, int substeps);

// Where a frame, from 0, falls among the steps.
ScheduledFrame schedule_frame(const Schedule *schedule, const RunParams *run, int frame);
