// SPDX-License-Identifier: MIT
#include "bench/bench_accuracy.h"
#include "base/interrupt.h"
#include "bench/bench_beam.h"
#include "bench/bench_energy.h"
#include "bench/bench_fit.h"
#include "bench/bench_invariance.h"
#include "bench/bench_motions.h"
#include "bench/bench_pendulum.h"
#include "bench/bench_still.h"
#include "bench/bench_work.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// What a row is in the files: its method in words, the verdict on its bound, its command.
typedef struct Line {
    AccuracyRow row;
    const char *variant, *verdict;
    char command[1024];
} Line;

#define AT(member) offsetof(Line, member)
static const Column COLUMNS[] = {
    {"part", COLUMN_TEXT, AT(row.part), 9},
    {"algo", COLUMN_TEXT, AT(row.method.algo), 9},
    {"variant", COLUMN_TEXT, AT(variant), 9},
    {"settings", COLUMN_TEXT, AT(row.method.settings), 22},
    {"scenario", COLUMN_CHARS, AT(row.scenario), 28},
    {"set", COLUMN_TEXT, AT(row.set), 5},
    {"rate_hz", COLUMN_REAL, AT(row.rate), 7},
    {"what", COLUMN_TEXT, AT(row.what), 18},
    {"value", COLUMN_REAL, AT(row.value), 10},
    {"spread", COLUMN_REAL, AT(row.spread), 8},
    {"bound", COLUMN_REAL, AT(row.bound), 7},
    {"verdict", COLUMN_TEXT, AT(verdict), 7},
    {"ms_min", COLUMN_REAL, AT(row.ms_min), 8},
    {"ms_q1", COLUMN_REAL, AT(row.ms_q1), 0},
    {"ms_median", COLUMN_REAL, AT(row.ms_median), 9},
    {"ms_q3", COLUMN_REAL, AT(row.ms_q3), 0},
    {"front", COLUMN_TEXT, AT(row.front), 5},
    {"remark", COLUMN_TEXT, AT(row.remark), 1},
    {"command", COLUMN_CHARS, AT(command), 0},
};
enum { COLUMN_COUNT = sizeof COLUMNS / sizeof *COLUMNS };

static const struct {
    const char *name;
    Result (*run)(Accuracy *accuracy, Error *error);
} PARTS[] = {
    {"motions", motions_run},        {"work", work_run},         {"pendulum", pendulum_run},
    {"static", still_run_static},    {"drift", still_run_drift}, {"beam", beam_run},
    {"stretch", energy_run_stretch}, {"energy", energy_run},     {"rate", invariance_run_rate},
    {"scale", invariance_run_scale},
};
enum { PART_COUNT = sizeof PARTS / sizeof *PARTS };

AccuracyRow accuracy_row(const char *part, const Method *method, double rate)
{
    return (AccuracyRow){.part = part,
                         .method = *method,
                         .set = "",
                         .rate = rate,
                         .what = "",
                         .value = NAN,
                         .spread = NAN,
                         .bound = NAN,
                         .known = NAN,
                         .ms_min = NAN,
                         .ms_median = NAN,
                         .ms_q1 = NAN,
                         .ms_q3 = NAN,
                         .front = "",
                         .remark = ""};
}

static void write_command(const Accuracy *accuracy, Line *line)
{
    const BenchOptions *options = accuracy->options;
    const AccuracyRow *row = &line->row;
    char method[256], rate[32] = "", set[256] = "", reference[128] = "";
    method_format(&row->method, method, sizeof method);
    if (!isnan(row->rate)) snprintf(rate, sizeof rate, " --rates %g", row->rate);
    if (*row->set)
        snprintf(set, sizeof set, " --%s %s", strchr(row->set, '.') ? "tfx" : "set", row->set);
    if (options->reference)
        snprintf(reference, sizeof reference, " --reference %s", options->reference);
    snprintf(line->command, sizeof line->command, "tractrix-bench accuracy --part %s %s%s%s%s",
             row->part, method, rate, set, reference);
}

void accuracy_add(Accuracy *accuracy, const AccuracyRow *row)
{
    Line line = {.row = *row, .variant = method_variant(&row->method)};
    bool falls_short = row->value > row->bound && row->value <= row->known;
    line.verdict =
        falls_short
            ? "short"
            : bench_table_check(&accuracy->table, row->value, row->bound, "%s, %s, %s at %g Hz, %s",
                                row->part, row->method.algo, row->scenario, row->rate, row->what);
    write_command(accuracy, &line);
    bench_table_add(&accuracy->table, &line);
}

int accuracy_rates(const Accuracy *accuracy, const double *own, int count,
                   double rates[BENCH_MOST_RATES])
{
    const BenchOptions *options = accuracy->options;
    if (options->rate_count) own = options->rates, count = options->rate_count;
    memcpy(rates, own, (size_t)count * sizeof *rates);
    return count;
}

Result accuracy_for_each(Accuracy *accuracy,
                         Result (*run)(Accuracy *accuracy, const Method *method, Error *error),
                         Error *error)
{
    Result result = RESULT_OK;
    for (int i = 0; i < accuracy->method_count && result == RESULT_OK; ++i)
        result = interrupt_requested() ? error_set(error, RESULT_INTERRUPTED, "interrupted")
                                       : run(accuracy, &accuracy->methods[i], error);
    return result;
}

Result accuracy_loose_params(SectionParams *params, const Method *method, Error *error)
{
    char settings[512];
    snprintf(settings, sizeof settings, "--style 0 %s", method->settings);
    const Method loose = {method->algo, method->variant, settings};
    return method_params(params, &loose, error);
}

double accuracy_order(const double *rates, const double *errors, int count, double *spread)
{
    return -fit_exponent(rates, errors, count, spread);
}

static Result run_parts(Accuracy *accuracy, Error *error)
{
    Result result = motions_read(accuracy, error);
    for (int i = 0; i < PART_COUNT && result == RESULT_OK; ++i)
        if (bench_options_part(accuracy->options, PARTS[i].name))
            result = PARTS[i].run(accuracy, error);
    return result;
}

Result accuracy_run(const BenchOptions *options, const Gpu *gpu, Error *error)
{
    Accuracy accuracy = {.gpu = gpu,
                         .options = options,
                         .folder = options->reference ? options->reference : "tests/data/motion"};
    const char *names[PART_COUNT + 1] = {NULL};
    for (int i = 0; i < PART_COUNT; ++i) names[i] = PARTS[i].name;
    Result result = bench_options_check_parts(options, names, error);
    if (result != RESULT_OK) return result;
    accuracy.method_count = method_list(&options->method, accuracy.methods);
    result = bench_table_open(&accuracy.table, COLUMNS, COLUMN_COUNT, gpu, &options->output, stdout,
                              error);
    if (result == RESULT_OK) result = run_parts(&accuracy, error);
    for (size_t i = 0; i < accuracy.motion_count; ++i) motion_destroy(&accuracy.motions[i]);
    free(accuracy.motions);
    return bench_table_close(&accuracy.table, result, error);
}
