// SPDX-License-Identifier: MIT
// What an experiment of `tractrix-bench accuracy` is: strands whose motion, rest shape or balance
// is known exactly.
#pragma once

#include "bench/trial.h"

enum {
    EXPERIMENT_POINTS = 256,
    EXPERIMENT_RATES = 8,
    EXPERIMENT_VALUES = 3,
    EXPERIMENTS_MOST = 16
};

// A case of an experiment: how strands start, and what moves them.
typedef struct Setup {
    const MotionFolder *folder, *rods; // motions of strings, and of elastic rods
    const Method *method;
    int number;
    char scenario[80];                   // description, as in the rows
    char settings[128];                  // flags that come before the method's
    double points[EXPERIMENT_POINTS][3]; // m, at rest: strand_count strands of n particles
    int n;
    uint32_t strand_count, first_id;
    double drag;        // 1/s, overrides the settings; NaN: does not
    double velocity[3]; // of the tip, m/s
    double units; // units per metre: scales lengths, accelerations and parameters with such units
    const Motion *motion; // replaces start, head motion and forces above; NULL: gravity only
    bool in_all;          // counts in the row of all cases
    double seconds;       // of long runs
    double length;        // m, of strands whose length is not that of the others
    double exact[EXPERIMENT_POINTS][3]; // the exact rest positions of the particles, m
    const Csv *csv;                     // the tip's motion: columns from `column` on, x, y and,
    size_t column;                      // with 3 axes, z
    int axes;
} Setup;

// One method with one set-up at one rate, and the measured values.
typedef struct Run {
    const Setup *setup;
    const Method *method;
    Trial trial;
    int rate;    // its index among the rates
    bool finest; // the last rate
    struct {
        const char *what;
        double value;
    } values[EXPERIMENT_VALUES];
    int value_count; // 0: the solver can't start like this, or the run is the reference of the
                     // others
} Run;

// How the first values of all cases are combined.
typedef enum Fold { FOLD_NONE, FOLD_MEAN, FOLD_MOST } Fold;

typedef struct Experiment {
    const char *part;     // name for --part; several experiments may share it
    double rates[5];      // steps per second, 0 after the last
    const char *param;    // only for solvers that have this parameter; NULL: for all
    const char *settings; // flags that come before the method's, unless the set-up has its own
    enum {
        ORDER = 1,        // adds the order of convergence
        FINEST_FIRST = 2, // the finest rate is the reference of the others
    } flags;
    Fold fold;                    // adds a row of all cases; FOLD_MOST: only that row
    bool (*set_up)(Setup *setup); // for setup->number and method; false: no more cases
    Result (*measure)(Run *run, Error *error);
} Experiment;

// Adds a value to the run.
static inline void experiment_add(Run *run, const char *what, double value)
{
    run->values[run->value_count].what = what;
    run->values[run->value_count++].value = value;
}
