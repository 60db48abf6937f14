// SPDX-License-Identifier: MIT
// How far solvers are from what is known exactly: the command `tractrix-bench accuracy` and what
// its parts (bench_motions.h and its siblings) share.
#pragma once

#include "bench/bench_options.h"
#include "bench/motion.h"

// A result. Errors are shares of the strand's length unless `what` says otherwise.
typedef struct AccuracyRow {
    const char *part;
    Method method;
    char scenario[80]; // what the hair does
    const char *set;   // the hair that ms were measured on, or ""
    double rate;       // steps a second
    const char *what;  // the quantity
    double value;
    double spread;              // standard error of a fit
    double bound;               // what is stated at most; NaN: nothing is
    double known;               // how far a solver is known to fall short of it; NaN: it is not
    double ms_min, ms_median;   // a simulated second of that set
    double ms_q1, ms_q3;        // quartiles
    const char *front, *remark; // "front" if nothing is both faster and closer; why it falls short
} AccuracyRow;

typedef struct Accuracy {
    const Gpu *gpu;
    const BenchOptions *options;
    BenchTable table;
    Method methods[METHODS_MOST]; // that are asked for
    int method_count;
    const char *folder; // of the references
    Motion *motions;
    size_t motion_count;
    bool whole; // all motions that the mean is stated for are there
} Accuracy;

// The command. RESULT_FAILED if a stated bound is broken, after all rows.
Result accuracy_run(const BenchOptions *options, const Gpu *gpu, Error *error);

// A row of which nothing is known yet but the part, the method and the rate.
AccuracyRow accuracy_row(const char *part, const Method *method, double rate);

// Checks the bound, and adds the row with the command that repeats it. What falls short of the
// bound by no more than is known gets the verdict "short", which is no failure.
void accuracy_add(Accuracy *accuracy, const AccuracyRow *row);

// The rates that are asked for, or `own` (`count` of them); gives their count.
int accuracy_rates(const Accuracy *accuracy, const double *own, int count,
                   double rates[BENCH_MOST_RATES]);

// Calls `run` for each method that is asked for; stops at an error or an interruption.
Result accuracy_for_each(Accuracy *accuracy,
                         Result (*run)(Accuracy *accuracy, const Method *method, Error *error),
                         Error *error);

// method_params without style, unless the method says one: hair that nothing holds.
Result accuracy_loose_params(SectionParams *params, const Method *method, Error *error);

// The slope of log(error) against log(1/rate), least squares, and its standard error (NaN for less
// than three); 0 for less than two of them.
double accuracy_order(const double *rates, const double *errors, int count, double *spread);
