// SPDX-License-Identifier: MIT
// The commands of tractrix-bench that have no other callers. Each prints its rows, writes the files
// that are asked for, and gives RESULT_FAILED if a stated bound is broken, after all rows. Times
// are of the wall clock, waiting for the GPU at the end of each sample.
#pragma once

#include "bench/bench_options.h"

// How far solvers are from what is known exactly. Runs the parts that are asked for with each
// method: every row of EXPERIMENTS (experiments.h), and "work", run time against error: for each
// point (a method and a rate) its mean error over the exact motions, and on each set of hair the
// milliseconds that a simulated second takes. Points on the front, those that no other beats in
// both, are named, and for each set the fastest point at some levels of error.
Result accuracy_run(const BenchOptions *options, const Gpu *gpu, Error *error);

// How long a solver's step and a drawn frame take. All parts, or those that --part lists; with
// --set or --tfx and no --part only "sets". Steps are of 1/60 s from rest under gravity,
// options->steps after options->warm_up.
//
// memory    bytes a second of a[i] = b[i] + 3 c[i] over arrays far larger than caches, on all
//           processors; the others have shares of it
// sets      each hair and method, with the thesis's figure and the stated bound; with --size also
//           drawing
// c         cpu_split.h on hair whose strands have one vertex count, on one thread and on two, with
//           its distance from the GPU's strands after a second (RMS over the length)
// strands   1,000 to 1,000,000 strands of 16, and the exponent of least time by count
// vertices  the same for 10,000 strands of 4 to 64
// threads   10k32 (or the hair that is asked for) with one and two threads of Mesa's CPU driver,
//           each in a process of its own, and the exponent; not on other drivers
// start     processes that make one step of 1k16 (or the hair that is asked for): with an empty
//           shader cache of Mesa ("cold") and with the one that is left ("warm")
Result speed_run(const BenchOptions *options, const Gpu *gpu, Error *error);

// A frame of simulation (a step and the positions that are drawn, followers too) of scenes that
// differ in followers, colliders, sleep or sections, with options->method ("split" if it names
// none) and options->set ("10k16" if NULL), `steps` times after `warm_up` frames. RESULT_FAILED if
// hair that should sleep does not within 60 s.
Result scenes_run(const BenchOptions *options, const Gpu *gpu, Error *error);

// How long drawing hair takes, and how far the image is from the exact one (image_reference.h),
// with the exact light at the vertices (shadow_reference.h) for schemes with shadows:
// options->scheme on --set or --tfx. RESULT_USAGE unless there is one of both.
Result images_run_one(const BenchOptions *options, const Gpu *gpu, Error *error);

// The schemes and presets that are worth comparing, for sets that look like hair and the files
// that are named.
Result images_run(const BenchOptions *options, const Gpu *gpu, Error *error);

// Light in hair against path-traced cases (light_case.h) of options->reference, or of
// tests/data/light, by each way to compute it: mean, rel and coverage over the tracer's, times of
// images, and bounds; with options->picture images side by side.
Result light_run(const BenchOptions *options, const Gpu *gpu, Error *error);

// What becomes of the hair files that are named, on options->mesh, with each solver and rate: at
// rest, and while the head shakes (groom_stage.h). Parts: rest, shake, speed. RESULT_USAGE without
// a file.
Result groom_run(const BenchOptions *options, const Gpu *gpu, Error *error);

// The rows of the CSV files that are named, of one machine or several, as a page: options->output's
// html. RESULT_USAGE without that or a file, or with csv or json; RESULT_BAD_INPUT for a file that
// is no CSV. `gpu` may be NULL.
Result page_run(const BenchOptions *options, const Gpu *gpu, Error *error);
