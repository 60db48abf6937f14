// SPDX-License-Identifier: MIT
// Exact motions of strands, to measure solvers against: a folder of NAME.csv and NAME.json.
//
// A chain of particles of mass 1 on rigid segments without mass, from rest: gravity, acceleration
// drag (wind - v), a root that stays or goes by x = x0 + amplitude (1 - cos(2 pi frequency t)).
// The CSV file has columns frame, t, x0, y0, z0, x1, ... (s and metres), frames of equal spacing or
// fewer of them; the JSON file has n, strand_length, gravity, drag_c, wind, root_motion {amp, freq}
// and, by frame number, float32_floor_rms_over_length_per_frame: how far rounding the start to
// float32 moves the exact strand, RMS over its length.
#pragma once

#include "base/csv.h"
#include "bench/trial.h"

#include <jansson.h>

typedef struct MotionFrame {
    double time;         // s
    bool followed;       // rounding the start moves the strand by at most MOTION_FLOOR
    double (*points)[3]; // [n], metres
} MotionFrame;

typedef struct Motion {
    char *name;
    int n;                                 // particles
    double length, drag;                   // m, 1/s
    float gravity[3], wind[3];             // m/s^2, m/s
    double root_amplitude, root_frequency; // m, Hz
    MotionFrame *frames;                   // the first is the start, at rest
    size_t frame_count;
    double (*points)[3]; // of all frames
} Motion;

// Beyond this a strand is chaotic, and float32 cannot follow it.
#define MOTION_FLOOR 1e-4

// Reads FOLDER/NAME.csv and .json. RESULT_BAD_INPUT with file and place. Destroying a zeroed struct
// is legal.
Result motion_read(Motion *motion, const char *folder, const char *name, Error *error);
void motion_destroy(Motion *motion);

// A folder of references: motions in alphabetical order, those JSON files that have a "root_motion"
// and a CSV file of the same name beside them; and what else is known exactly.
typedef struct MotionFolder {
    const char *path;
    Motion *motions;
    size_t count;
    bool whole;        // all motions that the mean is stated for are there
    json_t *styles;    // static_style.json, styled strands at rest; NULL: there is none
    Csv pendulums[2];  // e_pendulum_planar.csv and e_pendulum_3d.csv; empty: there is none
    json_t *starts[2]; // the JSON files beside them; NULL: there is none
} MotionFolder;

// RESULT_BAD_INPUT if it has no motions or a file is wrong. It may be destroyed in either case.
Result motion_read_folder(MotionFolder *folder, const char *path, Error *error);
void motion_destroy_folder(MotionFolder *folder);

// Whether a motion counts for the mean: those that it is stated for where a folder has all of
// them, else all.
bool motion_in_mean(const MotionFolder *folder, const Motion *motion);

// Displacement of the root along x, t seconds after the start.
double motion_root(const Motion *motion, double t);

// A strand at rest in the motion's start, with its drag, gravity and wind, which blows evenly.
Result motion_start(Trial *trial, const Gpu *gpu, const Motion *motion, const SectionParams *params,
                    double rate, Error *error);

// Steps up to `time` (s), the root where the motion has it. `motion` NULL: the root rests.
void motion_advance(Trial *trial, const Motion *motion, double time);

// RMS of |x - exact| over the strand's length, over particles 1 .. n-1 and those frames that
// float32 can follow and that steps of 1/rate s meet; NaN if no frame is met. `params` give the
// solver and its parameters, but for the drag. Errors as solver_create.
Result motion_error(double *error_over_length, const Gpu *gpu, const Motion *motion,
                    const SectionParams *params, double rate, Error *error);

// The same for a trial that motion_start has started.
Result motion_follow(Trial *trial, const Motion *motion, double *error_over_length, Error *error);
