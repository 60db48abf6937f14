// SPDX-License-Identifier: MIT
// What benchmarks of accuracy run: strands under a method (a solver with its settings), stepped by
// hand, and the exact motions that they are held against, a folder of NAME.csv and NAME.json.
//
// A chain of particles of mass 1 on rigid segments without mass, from rest: gravity, acceleration
// drag (wind - v), a root that stays or goes by x = x0 + amplitude (1 - cos(2 pi frequency t)).
// The CSV file has columns frame, t, x0, y0, z0, x1, ... (s and metres), frames of equal spacing or
// fewer of them; the JSON file has n, strand_length, gravity, drag_c, wind, root_motion {amp, freq}
// and, by frame number, float32_floor_rms_over_length_per_frame: how far rounding the start to
// float32 moves the exact strand, RMS over its length.
#pragma once

#include "base/csv.h"
#include "sim/solver.h"
#include "strands/strands.h"

#include <jansson.h>
#include <stdio.h>

// --- Methods.

typedef struct Method {
    const char *algo;
    const char *variant;  // "": the solver's first
    const char *settings; // flags of tractrix-render and their values, "--rope-iterations 50"; ""
} Method;

// The parameters of a section: defaults, then the flags `before`, then the method's. RESULT_USAGE
// for a solver, a variant, a flag or a value that does not exist, or settings of more than 4000
// bytes. The struct may be destroyed in either case.
Result trial_params(SectionParams *params, const Method *method, const char *before, Error *error);

// Gives parameters that are there already the method's algo, variant and settings. Errors as above.
Result trial_apply(SectionParams *params, const Method *method, Error *error);

// Whether a parameter is one of those that `settings` may have: a section's, of the simulation,
// that changes how guides move.
bool trial_takes(const ParamInfo *info);

// Whether the method's solver has the parameter of this name.
bool trial_has(const Method *method, const char *param);

// Whether it is a solver in its default form, for which bounds are stated.
bool trial_is_default(const Method *method);

// The variant's word: the method's, or the solver's first ("" if it has none).
const char *trial_variant(const Method *method);

// "--algo rope --variant xpbd --rope-iterations 50", with the variant's word always said.
void trial_format(const Method *method, char *text, size_t size);

enum { METHODS_MOST = 64 };

// The methods that a user asks for: of each solver in `asked->algo`, names with commas between
// them, or, where that is NULL, every solver that steps in its default form; all with the same
// settings. Gives their count.
int trial_list(const Method *asked, Method methods[METHODS_MOST]);

// --- Trials.

typedef struct Trial {
    Hair hair;
    Solver solver;
    GpuTimer timer;
    SectionParams params; // strings are borrowed
    SolverStep step;      // gravity (0, -9.81, 0), no wind, the head at the origin; may be changed
    double rate;          // steps a second
    long steps;           // made so far
    float (*points)[3];   // [hair.particle_count]: what trial_read has read
} Trial;

// The strands at rest, with numbers from `first_id` on; steps of 1/rate s. The strings of `params`
// outlive the trial, which may be destroyed when creation has failed or when it is zeroed.
Result trial_create(Trial *trial, const Gpu *gpu, const Strands *strands, uint32_t first_id,
                    const SectionParams *params, double rate, Error *error);
void trial_destroy(Trial *trial);

// A step, at whose end the head is where trial->step.head says.
void trial_step(Trial *trial);

// The drawn positions, by strands from root to tip (hair_read_positions).
Result trial_read(Trial *trial, Error *error);

// The solver's buffer of that kind for a batch of the hair, NULL: there is none.
const GpuBuffer *trial_buffer(const Trial *trial, uint32_t batch, SolverBufferKind kind);

// The simulated tip of a strand (position and velocity) where a solver has one beside the drawn
// strand; false if it has none. Waits for the GPU.
bool trial_read_tip(const Trial *trial, uint32_t batch, uint32_t strand, float tip[2][4]);

// `count` strands, each of `n` particles on its own of `points` [count][n] (m). Free with
// strands_destroy.
Result trial_make_strands(Strands *strands, const double (*points)[3], uint32_t count, int n,
                          Error *error);

// A helix of `n` particles, `length` metres along its segments, `turns` turns of 2 cm around an
// axis that leads aside and down from the root at the origin.
void trial_make_helix(double (*points)[3], int n, double length, double turns);

// A straight one, held horizontally along x.
void trial_make_beam(double (*points)[3], int n, double length);

// --- Exact motions.

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
Result trial_read_motion(Motion *motion, const char *folder, const char *name, Error *error);
void trial_destroy_motion(Motion *motion);

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
Result trial_read_folder(MotionFolder *folder, const char *path, Error *error);
void trial_destroy_folder(MotionFolder *folder);

// Whether a motion counts for the mean: those that it is stated for where a folder has all of
// them, else all.
bool trial_in_mean(const MotionFolder *folder, const Motion *motion);

// Displacement of the root along x, t seconds after the start.
double trial_root(const Motion *motion, double t);

// A strand at rest in the motion's start, with its drag, gravity and wind, which blows evenly.
Result trial_start(Trial *trial, const Gpu *gpu, const Motion *motion, const SectionParams *params,
                   double rate, Error *error);

// Steps up to `time` (s), the root where the motion has it. `motion` NULL: the root rests.
void trial_advance(Trial *trial, const Motion *motion, double time);

// RMS of |x - exact| over the strand's length, over particles 1 .. n-1 and those frames that
// float32 can follow and that steps of 1/rate s meet; NaN if no frame is met. `params` give the
// solver and its parameters, but for the drag. Errors as solver_create.
Result trial_error(double *error_over_length, const Gpu *gpu, const Motion *motion,
                   const SectionParams *params, double rate, Error *error);

// The same for a trial that trial_start has started.
Result trial_follow(Trial *trial, const Motion *motion, double *error_over_length, Error *error);
