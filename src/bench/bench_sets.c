// SPDX-License-Identifier: MIT
#include "bench/bench_sets.h"

#include <string.h>

// Table 4.2 of the thesis: ms a step on a GTX 1080 Ti. Its Mohawk and Short are one scene, which is
// not among these sets.
static const struct {
    const char *set, *algo;
    double ms;
} THESIS[] = {
    {"1k16", "emulation", 3.5},  {"1k16", "split", 0.4},     {"1k32", "emulation", 42.5},
    {"1k32", "split", 0.75},     {"10k16", "emulation", 31}, {"10k16", "split", 1.4},
    {"10k32", "emulation", 410}, {"10k32", "split", 5.9},
};

// What is stated for the solvers' default forms on llvmpipe with two cores, ms a step: of the
// least, since what else runs on the machine only adds.
static const struct {
    const char *set, *algo;
    double ms;
} BOUNDS[] = {
    {"1k16", "emulation", 1.5}, {"10k32", "emulation", 60}, {"10k32", "hybrid", 12},
    {"10k32", "chain", 15},     {"10k32", "tressfx", 15},
};

static void look_up(SpeedRow *row, const Gpu *gpu)
{
    bool plain = row->set && !*row->method.variant && !*row->method.settings;
    bool thesis = row->set && (plain || strcmp(row->method.variant, "thesis") == 0);
    for (size_t i = 0; i < sizeof THESIS / sizeof *THESIS && thesis; ++i)
        if (strcmp(THESIS[i].set, row->set) == 0 && strcmp(THESIS[i].algo, row->method.algo) == 0)
            row->thesis_ms = THESIS[i].ms;
    for (size_t i = 0; i < sizeof BOUNDS / sizeof *BOUNDS && plain; ++i)
        if (strcmp(BOUNDS[i].set, row->set) == 0 && strcmp(BOUNDS[i].algo, row->method.algo) == 0 &&
            strstr(gpu->renderer, "llvmpipe"))
            row->bound_ms = BOUNDS[i].ms;
}

static Result measure_set(Speed *speed, const SpeedSubject *subject, Error *error)
{
    SpeedRow row = speed_row("sets", subject);
    Result result = speed_measure(&row.result, speed->gpu, subject, speed->options, error);
    if (result != RESULT_OK) return result;
    look_up(&row, speed->gpu);
    speed_add(speed, &row);
    return RESULT_OK;
}

Result sets_run(Speed *speed, Error *error)
{
    return speed_for_each(speed, measure_set, error);
}
