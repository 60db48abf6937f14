// SPDX-License-Identifier: MIT
// The basis of accuracy benchmarks: strands with a method (a solver with its settings) that the
// caller steps, and the exact motions that they are compared with, a folder of NAME.csv and
// NAME.json.
//
// A motion is that of a chain of particles of mass 1 on rigid massless segments, from rest:
// gravity, acceleration drag (wind - v), and a root that stays or moves as x = x0 + amplitude (1 -
// cos(2 pi frequency t)). The CSV file has columns frame, t, x0, y0, z0, x1, ... (s and metres),
// with evenly spaced frames, some of which may be missing. The JSON file has n, strand_length,
// gravity, drag_c, wind, root_motion {amp, freq}; and float32_floor_rms_over_length_per_frame by
// frame number: how far rounding the start to float32 moves the exact strand, RMS relative to its
// length.
#pragma once

#include "base/csv.h"
#include "sim/solver.h"
#include "strands/strands.h"

#include <jansson.h>
#include <stdio.h>

// --- Methods.

typedef struct Method {
    const char *algo;
    const char *variant;  // "": the solver's default
    const char *settings; // flags of tractrix-render and their values, "--rope-iterations 50"; ""
} Method;

// The parameters of a section: defaults, then the flags `before`, then the method's. RESULT_USAGE
// for an unknown solver, variant, flag or value, or settings of more than 4000 bytes. The struct
// may be destroyed in either case.
Result trial_params(SectionParams *params, const Method *method, const char *before, Error *error);

// Applies the method's algo, variant and settings to existing parameters. Errors as above.
Result trial_apply(SectionParams *params, const Method *method, Error *error);

// Whether `settings` may contain the parameter: a section's parameter of the simulation that
// affects guides.
bool trial_takes(const ParamInfo *info);

// Whether the method's solver has this parameter.
bool trial_has(const Method *method, const char *param);

// Whether the method is a solver in its default form, for which bounds are documented.
bool trial_is_default(const Method *method);

// The name of the variant: the method's, or the solver's default ("" if it has no variants).
const char *trial_variant(const Method *method);

// Writes "--algo rope --variant xpbd --rope-iterations 50", always with the variant's name.
void trial_format(const Method *method, char *text, size_t size);

enum { METHODS_MOST = 64 };

// The methods that a user requests: each solver of the comma-separated list `asked->algo`, or, if
// that is NULL, every solver with steps in its default form; all with the same settings. Returns
// their count.
int trial_list(const Method *asked, Method methods[METHODS_MOST]);

// --- Trials.

typedef struct Trial {
    Hair hair;
    Solver solver;
    GpuTimer timer;
    SectionParams params; // strings are borrowed
    SolverStep step; // gravity (0, -9.81, 0), no wind, the head at the origin; callers may change
                     // it
    double rate;     // steps per second
    long steps;      // number of steps so far
    float (*points)[3]; // [hair.particle_count]: the result of trial_read
} Trial;

// Starts the strands at rest, with numbers from `first_id` on, with steps of 1/rate s. The strings
// of `params` must outlive the trial. A zeroed trial, or one whose creation failed, may be
// destroyed.
Result trial_create(Trial *trial, const Gpu *gpu, const Strands *strands, uint32_t first_id,
                    const SectionParams *params, double rate, Error *error);
void trial_destroy(Trial *trial);

// Makes a step that ends with the head at trial->step.head.
void trial_step(Trial *trial);

// Reads the drawn positions, strand by strand from root to tip (hair_read_positions).
Result trial_read(Trial *trial, Error *error);

// The solver's buffer of this kind for a batch of the hair; NULL: none.
const GpuBuffer *trial_buffer(const Trial *trial, uint32_t batch, SolverBufferKind kind);

// The simulated tip of a strand (position and velocity) if the solver simulates one besides the
// drawn strand; otherwise false. Waits for the GPU.
bool trial_read_tip(const Trial *trial, uint32_t batch, uint32_t strand, float tip[2][4]);

// `count` strands of `n` particles each, from `points` [count][n] (m). Free with strands_destroy.
Result trial_make_strands(Strands *strands, const double (*points)[3], uint32_t count, int n,
                          Error *error);

// A helix of `n` particles with a length of `length` metres along its segments: `turns` turns with
// a radius of 2 cm about an axis that leads sideways and down from the root at the origin.
void trial_make_helix(double (*points)[3], int n, double length, double turns);

// A straight strand, held horizontally along x.
void trial_make_beam(double (*points)[3], int n, double length);

// --- Exact motions.

typedef struct MotionFrame {
    double time;         // s
    bool followed;       // rounding the start moves the strand by at most MOTION_FLOOR: float32 can
                         // follow it
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

// If rounding the start moves the strand by more than this, it is chaotic, and float32 can't follow
// it.
#define MOTION_FLOOR 1e-4

// Reads FOLDER/NAME.csv and .json. RESULT_BAD_INPUT with file and position. A zeroed struct may be
// destroyed.
Result trial_read_motion(Motion *motion, const char *folder, const char *name, Error *error);
void trial_destroy_motion(Motion *motion);

// A folder of references: motions in alphabetical order (JSON files with "root_motion" and a CSV
// file of the same name), and other exact results.
typedef struct MotionFolder {
    const char *path;
    Motion *motions;
    size_t count;
    bool whole;        // contains all motions of the documented mean
    json_t *styles;    // static_style.json, styled strands at rest; NULL: missing
    Csv pendulums[2];  // e_pendulum_planar.csv and e_pendulum_3d.csv; empty: missing
    json_t *starts[2]; // their JSON files; NULL: missing
} MotionFolder;

// RESULT_BAD_INPUT if it has no motions or a file is wrong. It may be destroyed in either case.
Result trial_read_folder(MotionFolder *folder, const char *path, Error *error);
void trial_destroy_folder(MotionFolder *folder);

// Whether a motion counts for the mean: if the folder contains all motions of the documented mean,
// only those count, otherwise all.
bool trial_in_mean(const MotionFolder *folder, const Motion *motion);

// Displacement of the root along x, t seconds after the start.
double trial_root(const Motion *motion, double t);

// A strand at rest at the motion's start, with the motion's drag, gravity and constant wind.
Result trial_start(Trial *trial, const Gpu *gpu, const Motion *motion, const SectionParams *params,
                   double rate, Error *error);

// Steps up to `time` (s) with the root's motion. `motion` NULL: the root rests.
void trial_advance(Trial *trial, const Motion *motion, double time);

// RMS of |x - exact| relative to the strand's length, over particles 1 .. n-1 and the frames that
// float32 can follow and that coincide with steps of 1/rate s; NaN if there are none. `params` give
// the solver and its parameters, except drag. Errors as solver_create.
Result trial_error(double *error_over_length, const Gpu *gpu, const Motion *motion,
                   const SectionParams *params, double rate, Error *error);

// The same for a trial started by trial_start.
Result trial_follow(Trial *trial, const Motion *motion, double *error_over_length, Error *error);
