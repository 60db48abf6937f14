// SPDX-License-Identifier: MIT
// The experiments of `tractrix-bench accuracy`: strands whose motion, shape at rest or balance is
// known exactly, in one table. accuracy.c runs them with every solver.
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
    const MotionFolder *folder;
    const Method *method;
    int number;
    char scenario[80];                   // in words, as in the rows
    char settings[128];                  // flags, before the method's
    double points[EXPERIMENT_POINTS][3]; // m, at rest: `strand_count` strands of n particles
    int n;
    uint32_t strand_count, first_id;
    double drag;          // 1/s, whatever the settings say; NaN: as they say
    double velocity[3];   // of the tip, m/s
    double units;         // in a metre: lengths, accelerations and parameters that are such
    const Motion *motion; // the start, head motion and forces in place of the above; NULL: gravity
    bool in_all;          // counts for the row of all cases
    double seconds;       // of long runs
    double exact[EXPERIMENT_POINTS][3]; // where the particles should come to rest, m
    double beam_drop;                   // of a continuous beam's tip, over the length; NaN: none
    const Csv *csv;                     // the tip's motion: columns from `column` on, x, y and,
    size_t column;                      // with 3 axes, z
    int axes;
} Setup;

// One method under a set-up at one rate, and what was measured.
typedef struct Run {
    const Setup *setup;
    const Method *method;
    Trial trial;
    int rate;    // its number among those that are run
    bool finest; // the last of them
    struct {
        const char *what;
        double value;
    } values[EXPERIMENT_VALUES];
    int value_count; // 0: the solver cannot start so, or it is what others are compared with
} Run;

// What becomes of all cases' first values: nothing, their geometric mean, the greatest.
typedef enum Fold { FOLD_NONE, FOLD_MEAN, FOLD_MOST } Fold;

typedef struct Experiment {
    const char *part;     // as --part names it; rows of one part share the name
    double rates[5];      // steps a second, 0 behind the last
    const char *param;    // only for solvers that have this parameter; NULL: for all
    const char *settings; // flags before the method's, unless the set-up has its own
    enum {
        ORDER = 1,        // adds the order of convergence
        FINEST_FIRST = 2, // the finest rate is what the others are compared with
    } flags;
    Fold fold;                    // adds a row of all cases; FOLD_MOST: that alone
    bool (*set_up)(Setup *setup); // for setup->number and method; false: there are no more
    Result (*measure)(Run *run, Error *error);
} Experiment;

extern const Experiment EXPERIMENTS[];
extern const int EXPERIMENT_COUNT;

// Fills case `number` (from 0 on) of an experiment; false: the method has no more.
bool experiments_set_up(const Experiment *experiment, const MotionFolder *folder,
                        const Method *method, double seconds, int number, Setup *setup);

// Steps and measures run->method in run->setup. RESULT_INTERRUPTED if that was asked for.
Result experiments_run(const Experiment *experiment, Run *run, const Gpu *gpu, double rate,
                       Error *error);
