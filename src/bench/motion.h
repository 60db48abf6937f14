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

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>

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

// Displacement of the root along x, t seconds after the start.
double motion_root(const Motion *motion, double t);

// The names of all motions of a folder in alphabetical order: those JSON files beside which there
// is a CSV file of the same name and that have a "root_motion". RESULT_FAILED if it cannot be read;
// RESULT_BAD_INPUT if there are none. Free by motion_names_destroy.
Result motion_list(char ***names, size_t *count, const char *folder, Error *error);
void motion_names_destroy(char **names, size_t count);
