// SPDX-License-Identifier: MIT
// The commands of tractrix-bench that have no other callers. Each prints its rows and writes the
// requested files. Each returns RESULT_FAILED after all rows if a documented bound is broken. Times
// are wall-clock times; each sample ends with a wait for the GPU.
#pragma once

#include "bench/bench_options.h"

// Measures the errors of solvers where the exact result is known. Runs the requested parts for each
// method: every row of EXPERIMENTS (experiments.h), and "work", run time against error. For each
// point (a method at a rate), "work" measures the mean error over the exact motions, and on each
// set of hair the milliseconds per simulated second. It names the points on the front, which no
// other point beats in both, and for each set the fastest point at some levels of error.
Result accuracy_run(const BenchOptions *options, const Gpu *gpu, Error *error);

// Measures the times of solver steps and drawn frames. Runs all parts, or those of --part; with
// --set or --tfx but without --part only "sets". Hair starts at rest and moves under gravity by
// steps of 1/60 s; options->steps are measured after options->warm_up.
//
// memory    bytes per second of a[i] = b[i] + 3 c[i] over arrays far larger than caches, on all
//           processors; other parts state shares of it
// sets      each hair and method, with the thesis's figure and the documented bound; with --size
//           also drawing
// c         cpu_split.h for hair with one vertex count, on one thread and on two, and its distance
//           from the GPU's strands after a second (RMS relative to the length)
// strands   1,000 to 1,000,000 strands of 16, and the exponent of the shortest time by count
// vertices  the same for 10,000 strands of 4 to 64
// threads   10k32 (or the requested hair) with one and two threads of Mesa's CPU driver, each in
//           a process of its own, and the exponent; not with other drivers
// start     processes that make one step of 1k16 (or the requested hair): with an empty shader
//           cache of Mesa ("cold") and with the cache that the first left ("warm")
Result speed_run(const BenchOptions *options, const Gpu *gpu, Error *error);

// Measures a frame of simulation (a step and the drawn positions, including followers) of scenes
// with different followers, colliders, sleep or sections. Uses options->method ("split" if it names
// none) and options->set ("10k16" if NULL), `steps` times after `warm_up` frames. RESULT_FAILED if
// hair that should fall asleep does not within 60 s.
Result scenes_run(const BenchOptions *options, const Gpu *gpu, Error *error);

// Measures the time of drawing hair, and the difference of the image from the exact one
// (image_reference.h), which uses the exact light at the vertices (shadow_reference.h) for schemes
// with shadows. Draws with options->scheme the hair of --set or --tfx; RESULT_USAGE unless one of
// the two is given.
Result images_run_one(const BenchOptions *options, const Gpu *gpu, Error *error);

// The same for a selection of schemes and presets, for sets that look like hair and the named
// files.
Result images_run(const BenchOptions *options, const Gpu *gpu, Error *error);

// Compares light in hair with the path-traced cases (light_case.h) of options->reference, or of
// tests/data/light, for each way to compute it: mean, rel and coverage relative to the path
// tracer's, times of images, and bounds; with options->picture also images side by side.
Result light_run(const BenchOptions *options, const Gpu *gpu, Error *error);

// Draws the named scenes, NAME.json, by our own path tracer (light_traced.h), and writes the table
// NAME.csv of each beside it (light_case.h), so that the folder can be the reference of light_run.
// RESULT_USAGE without a file.
Result trace_run(const BenchOptions *options, const Gpu *gpu, Error *error);

// Simulates the named hair files on options->mesh with each solver and rate: at rest, and while the
// head shakes (groom_stage.h). Parts: rest, shake, speed. RESULT_USAGE without a file.
Result groom_run(const BenchOptions *options, const Gpu *gpu, Error *error);

// Writes the rows of the named CSV files, of one machine or several, as the page
// options->output.html. RESULT_USAGE without a page or a file, or with csv or json;
// RESULT_BAD_INPUT for a file that is not CSV. `gpu` may be NULL.
Result page_run(const BenchOptions *options, const Gpu *gpu, Error *error);
