// SPDX-License-Identifier: MIT
#include "base/clock.h"
#include "base/interrupt.h"
#include "bench/bench_commands.h"
#include "bench/experiments.h"
#include "formats/strands_read.h"
#include "gen/strands_make.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A row of results. `set`: the hair on which the ms of a simulated second were measured; `value`: a
// share of the strand's length, unless `what` says otherwise; `spread`: the standard error of a
// fit; `bound`: the largest value that the docs state; `front`: "front" if no other row is both
// faster and more accurate; `remark`: always empty so far.
// clang-format off
#define ROW(X)                                                                                     \
    X(TEXT, part, 9) X(TEXT, algo, 9) X(TEXT, variant, 9) X(TEXT, settings, 22)                    \
    X(CHARS, scenario, 28) X(TEXT, set, 5) X(REAL, rate_hz, 7) X(TEXT, what, 18)                   \
    X(REAL, value, 10) X(REAL, spread, 8) X(REAL, bound, 7) X(TEXT, verdict, 7)                    \
    X(REAL, ms_min, 8) X(REAL, ms_q1, 0) X(REAL, ms_median, 9) X(REAL, ms_q3, 0)                   \
    X(TEXT, front, 5) X(TEXT, remark, 1) X(CHARS, command, 0)
// clang-format on

typedef struct Row {
    ROW(TABLE_FIELD)
    Method method;
} Row;
static const Column COLUMNS[] = {ROW(TABLE_COLUMN)};

_Static_assert((int)EXPERIMENT_RATES >= (int)BENCH_MOST_RATES, "rates of a command line");

typedef struct Accuracy {
    const Gpu *gpu;
    const BenchOptions *options;
    Table table;
    MotionFolder folder, rods;
} Accuracy;

// The stated bounds: errors over the length, shares of energy. The first matching row applies.

static const struct {
    const char *part, *algo; // "": every solver
    const char *scenario;    // the whole scenario or its part before a comma; "": all
    const char *what;
    double rate; // 0: all rates
    bool any;    // for all variants and settings, not only for the default
    double bound, known;
} STATED[] = {
    {"motions", "chain", "mean", "error", 60, false, 0.02, NAN},
    {"motions", "chain", "mean", "error", 240, false, 0.005, NAN},
    {"motions", "hybrid", "a_horizontal_n16_c4", "error", 120, false, 0.03, NAN},
    {"motions", "emulation", "a_horizontal_n16_c4", "error", 120, false, 0.03, NAN},
    {"pendulum", "split", "planar90_c4", "error", 60, false, 0.002, NAN},
    {"beam", "", "", "error", 0, true, 0.01, NAN},
    {"physics", "", "cantilever 1, 16 segments", "tip error", 0, true, 0.0006, NAN},
    {"physics", "", "cantilever 1, 32 segments", "tip error", 0, true, 0.00015, NAN},
    {"physics", "", "cantilever 10, 16 segments", "tip error", 0, true, 0.004, NAN},
    {"physics", "", "cantilever 10, 32 segments", "tip error", 0, true, 0.001, NAN},
    {"physics", "", "cantilever 100, 16 segments", "tip error", 0, true, 0.009, NAN},
    {"physics", "", "cantilever 100, 32 segments", "tip error", 0, true, 0.0025, NAN},
    {"physics", "", "cantilever 1000, 16 segments", "tip error", 0, true, 0.022, NAN},
    {"physics", "", "cantilever 1000, 32 segments", "tip error", 0, true, 0.008, NAN},
    {"physics", "", "arc, k 1.60", "across", 0, true, 0.001, NAN},
    {"physics", "", "arc of 2 cm", "across, off", 0, true, 0.03, NAN},
    {"physics", "", "", "depth, off", 0, true, 0.002, NAN},
    {"physics", "", "t1_straight_horizontal", "error", 60, true, 0.018, NAN},
    {"physics", "", "t1_straight_horizontal", "error", 120, true, 0.0077, NAN},
    {"physics", "", "t1_straight_horizontal", "error", 240, true, 0.003, NAN},
    {"physics", "", "t2_straight_short", "error", 60, true, 0.047, NAN},
    {"physics", "", "t2_straight_short", "error", 120, true, 0.0123, NAN},
    {"physics", "", "t2_straight_short", "error", 240, true, 0.0036, NAN},
    {"physics", "", "t4_helix_r1cm_p4cm", "error", 60, true, 0.01, NAN},
    {"physics", "", "t4_helix_r1cm_p4cm", "error", 120, true, 0.0028, NAN},
    {"physics", "", "t4_helix_r1cm_p4cm", "error", 240, true, 0.00084, NAN},
    {"physics", "", "t5_helix_shaken", "error", 60, true, 0.032, NAN},
    {"physics", "", "t5_helix_shaken", "error", 120, true, 0.008, NAN},
    {"physics", "", "t5_helix_shaken", "error", 240, true, 0.002, NAN},
    {"physics", "", "t7_straight_shaken", "error", 60, true, 0.0019, NAN},
    {"physics", "", "t7_straight_shaken", "error", 120, true, 0.0006, NAN},
    {"physics", "", "t7_straight_shaken", "error", 240, true, 0.0002, NAN},
    {"stretch", "", "", "as drawn", 0, false, 1e-5, NAN},
    {"energy", "", "", "rise", 0, false, 0.01, NAN},
    {"scale", "", "", "from metres", 0, true, 1e-4, NAN},
};

static double stated_bound(const char *part, const Method *method, const char *scenario,
                           const char *what, double rate, double *known)
{
    *known = NAN;
    for (size_t i = 0; i < sizeof STATED / sizeof *STATED; ++i) {
        size_t length = strlen(STATED[i].scenario);
        if (strcmp(STATED[i].part, part) != 0 || strcmp(STATED[i].what, what) != 0) continue;
        if (*STATED[i].algo && strcmp(STATED[i].algo, method->algo) != 0) continue;
        if (length && (strncmp(STATED[i].scenario, scenario, length) != 0 ||
                       (scenario[length] && scenario[length] != ',')))
            continue;
        if (STATED[i].rate > 0 && STATED[i].rate != rate) continue;
        if (!STATED[i].any && !trial_is_default(method)) continue;
        *known = STATED[i].known;
        return STATED[i].bound;
    }
    return NAN;
}

// --- Rows.

static Row row_of(const char *part, const Method *method, double rate, const char *scenario,
                  const char *what, double value)
{
    Row row = {.part = part, .method = *method, .rate_hz = rate, .what = what, .value = value};
    row.algo = method->algo, row.variant = trial_variant(method), row.settings = method->settings;
    row.set = row.front = row.remark = "";
    row.spread = row.ms_min = row.ms_q1 = row.ms_median = row.ms_q3 = NAN;
    snprintf(row.scenario, sizeof row.scenario, "%s", scenario);
    return row;
}

// Checks the bound and adds the row, with the command that repeats it. A value above the bound but
// not above the known error gives the verdict "short", which is not a failure.
static void add_row(Accuracy *accuracy, Row *row)
{
    const BenchOptions *options = accuracy->options;
    char method[256], rate[32] = "", set[256] = "", reference[128] = "";
    double known;
    row->bound =
        stated_bound(row->part, &row->method, row->scenario, row->what, row->rate_hz, &known);
    row->verdict =
        row->value > row->bound && row->value <= known
            ? "short"
            : table_check(&accuracy->table, row->value, row->bound, "%s, %s, %s at %g Hz, %s",
                          row->part, row->algo, row->scenario, row->rate_hz, row->what);
    trial_format(&row->method, method, sizeof method);
    if (!isnan(row->rate_hz)) snprintf(rate, sizeof rate, " --rates %g", row->rate_hz);
    if (*row->set)
        snprintf(set, sizeof set, " --%s %s", strchr(row->set, '.') ? "tfx" : "set", row->set);
    if (options->reference)
        snprintf(reference, sizeof reference, " --reference %s", options->reference);
    snprintf(row->command, sizeof row->command, "tractrix-bench accuracy --part %s %s%s%s%s",
             row->part, method, rate, set, reference);
    table_add(&accuracy->table, row);
}

// --- Experiments.

// Copies the rates of the command line or, without any, `own`, which ends with 0. Returns their
// number.
static int list_rates(const BenchOptions *options, const double *own, double *rates)
{
    int count = 0;
    while (own[count] > 0) ++count;
    if (options->rate_count) own = options->rates, count = options->rate_count;
    memcpy(rates, own, (size_t)count * sizeof *rates);
    return count;
}

// The order of convergence: the slope of log(error) against log(1/rate).
static void add_order(Accuracy *accuracy, const char *part, const Method *method,
                      const char *scenario, const double *rates, const double *errors, int count)
{
    Row row = row_of(part, method, NAN, scenario, "order", NAN);
    row.value = -table_slope(rates, errors, count, &row.spread);
    if (count > 1) add_row(accuracy, &row);
}

// The first value of each case, summed up for each rate.
typedef struct All {
    const char *what;
    double sum[EXPERIMENT_RATES], most[EXPERIMENT_RATES];
    int count;
} All;

static Result run_case(Accuracy *accuracy, const Experiment *experiment, const Method *method,
                       const Setup *setup, All *all, Error *error)
{
    double rates[EXPERIMENT_RATES], first[EXPERIMENT_RATES];
    int count = list_rates(accuracy->options, experiment->rates, rates), values = 0;
    for (int i = 0; i < count; ++i) {
        int r = experiment->flags & FINEST_FIRST ? (i + count - 1) % count : i;
        Run run = {.setup = setup, .method = method, .rate = r, .finest = r == count - 1};
        TRY(experiments_run(experiment, &run, accuracy->gpu, rates[r], error));
        for (int v = 0; v < run.value_count && experiment->fold != FOLD_MOST; ++v) {
            Row row = row_of(experiment->part, method, rates[r], setup->scenario,
                             run.values[v].what, run.values[v].value);
            add_row(accuracy, &row);
        }
        if (run.value_count == 0) continue;
        ++values;
        first[r] = run.values[0].value;
        all->what = run.values[0].what;
        if (!setup->in_all) continue;
        all->sum[r] += log(first[r]);
        if (!(first[r] <= all->most[r])) all->most[r] = first[r]; // a NaN stays
    }
    all->count += setup->in_all;
    if (experiment->flags & ORDER && values == count)
        add_order(accuracy, experiment->part, method, setup->scenario, rates, first, count);
    return RESULT_OK;
}

static Result run_method(Accuracy *accuracy, const Experiment *experiment, const Method *method,
                         Error *error)
{
    double rates[EXPERIMENT_RATES], values[EXPERIMENT_RATES];
    int count = list_rates(accuracy->options, experiment->rates, rates);
    All all = {.what = ""};
    Setup setup;
    for (int number = 0; experiments_set_up(experiment, &accuracy->folder, &accuracy->rods, method,
                                            accuracy->options->seconds, number, &setup);
         ++number)
        TRY(run_case(accuracy, experiment, method, &setup, &all, error));
    if (experiment->fold == FOLD_NONE || all.count == 0) return RESULT_OK;
    const char *scenario = experiment->fold == FOLD_MOST ? "greatest of all motions"
                           : accuracy->folder.whole      ? "mean"
                                                         : "mean of these";
    for (int r = 0; r < count; ++r) {
        values[r] = experiment->fold == FOLD_MOST ? all.most[r] : exp(all.sum[r] / all.count);
        Row row = row_of(experiment->part, method, rates[r], scenario, all.what, values[r]);
        add_row(accuracy, &row);
    }
    if (experiment->flags & ORDER)
        add_order(accuracy, experiment->part, method, scenario, rates, values, count);
    return RESULT_OK;
}

// --- Time against error: the part "work".

// The methods that are compared: every solver, its variants, and settings that trade time for
// accuracy.
static const Method WORTH[] = {
    {"split", "ball", ""},
    {"split", "thesis", ""},
    {"emulation", "projected", ""},
    {"hybrid", "", ""},
    {"chain", "", ""},
    {"tressfx", "steady", ""},
    {"tressfx", "tressfx4", "--tressfx-length-constraints-iterations 2"},
    {"tressfx", "tressfx4", "--tressfx-length-constraints-iterations 10"},
    {"spring", "implicit", "--spring-coil 10000"},
    {"spring", "implicit", "--spring-coil 1000000"},
    {"spring", "explicit", "--spring-coil 10000"},
    {"rope", "bullet", "--rope-iterations 2"},
    {"rope", "bullet", "--rope-iterations 10"},
    {"rope", "bullet", "--rope-iterations 50"},
    {"rope", "xpbd", "--rope-iterations 10"},
    {"rope", "xpbd", "--rope-iterations 50"},
    {"dftl", "", "--ftl-damping 0.9"},
    {"dftl", "", "--ftl-damping 0.98"},
};
static const double LEVELS[] = {0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002};
static const char *const SETS[] = {"1k16", "1k32", "10k16", "10k32"};
enum {
    WORTH_COUNT = sizeof WORTH / sizeof *WORTH,
    LEVEL_COUNT = sizeof LEVELS / sizeof *LEVELS,
    SET_COUNT = sizeof SETS / sizeof *SETS
};

// Times a frame: its steps and the computation of the drawn positions. Each round visits all
// points, so that a disturbance of the machine does not hit only one of them.
enum { FPS = 60, ROUNDS = 2, WARM_UP = 2, MOST_SAMPLES = 20 };
#define ENOUGH_MS 200.0 // time for a point in a round, and for its warm-up

typedef struct Point {
    Method method;
    double rate, error; // 1/s; mean error over the length
    double samples[ROUNDS * MOST_SAMPLES];
    int count;
    Times times; // ms for a simulated second
    bool front;
} Point;

typedef struct Work {
    Accuracy *accuracy;
    Point *points;
    int count;
} Work;

// If a method with a variant or settings was given, lists only this method, otherwise the methods
// of WORTH.
static Result list_points(Work *work, Error *error)
{
    static const double own[] = {60, 120, 240, 480, 0};
    const BenchOptions *options = work->accuracy->options;
    const Method *asked = &options->method;
    bool one = asked->algo && !trial_is_default(asked);
    double rates[EXPERIMENT_RATES];
    int count = list_rates(options, own, rates);
    work->points = calloc((size_t)WORTH_COUNT * (size_t)count, sizeof *work->points);
    if (!work->points) return error_set(error, RESULT_FAILED, "no memory for points");
    for (int m = 0; m < (one ? 1 : WORTH_COUNT); ++m) {
        const Method *method = one ? asked : &WORTH[m];
        if (asked->algo && strcmp(asked->algo, method->algo) != 0) continue;
        for (int r = 0; r < count; ++r)
            work->points[work->count++] = (Point){.method = *method, .rate = rates[r]};
    }
    return RESULT_OK;
}

// Geometric mean of the errors over the motions that are included in the mean.
static Result find_error(const Accuracy *accuracy, Point *point, Error *error)
{
    const MotionFolder *folder = &accuracy->folder;
    SectionParams params;
    double logs = 0;
    int counted = 0;
    Result result = trial_params(&params, &point->method, "--style 0", error);
    for (size_t m = 0; m < folder->count && result == RESULT_OK; ++m) {
        double off = NAN;
        if (!trial_in_mean(folder, &folder->motions[m])) continue;
        if (interrupt_requested()) result = error_set(error, RESULT_INTERRUPTED, "interrupted");
        THEN(result,
             trial_error(&off, accuracy->gpu, &folder->motions[m], &params, point->rate, error));
        logs += log(off), ++counted;
    }
    params_destroy_section(&params);
    point->error = exp(logs / counted);
    return result;
}

static void time_frames(Trial *trial, Point *point)
{
    int steps = point->rate > FPS ? (int)(point->rate / FPS + 0.5) : 1;
    double per_second = point->rate / steps, begun = clock_ms();
    for (int i = -WARM_UP; i < MOST_SAMPLES; ++i) {
        double begin = clock_ms();
        if (i < 0 && begin - begun > ENOUGH_MS) i = 0; // warm enough
        for (int step = 0; step < steps; ++step) trial_step(trial);
        solver_pose(&trial->solver, &trial->step.head);
        glFinish();
        double end = clock_ms();
        if (i == -1) begun = end;
        if (i < 0) continue;
        point->samples[point->count++] = (end - begin) * per_second;
        if (end - begun > ENOUGH_MS) return;
    }
}

static Result time_points(Work *work, const Strands *strands, Error *error)
{
    for (int i = 0; i < work->count; ++i) work->points[i].count = 0;
    for (int round = 0; round < ROUNDS; ++round)
        for (int i = 0; i < work->count; ++i) {
            Point *point = &work->points[i];
            SectionParams params;
            Trial trial = {0};
            if (interrupt_requested()) return error_set(error, RESULT_INTERRUPTED, "interrupted");
            Result result = trial_params(&params, &point->method, "--style 0", error);
            THEN(result, trial_create(&trial, work->accuracy->gpu, strands, 0, &params, point->rate,
                                      error));
            if (result == RESULT_OK) time_frames(&trial, point);
            trial_destroy(&trial);
            params_destroy_section(&params);
            TRY(result);
        }
    for (int i = 0; i < work->count; ++i)
        work->points[i].times = table_times(work->points[i].samples, work->points[i].count);
    return RESULT_OK;
}

// Compares least times, because disturbances only add time.
static bool is_on_front(const Work *work, const Point *p)
{
    for (int k = 0; k < work->count; ++k) {
        const Point *q = &work->points[k];
        if (q->error <= p->error && q->times.minimum <= p->times.minimum &&
            (q->error < p->error || q->times.minimum < p->times.minimum))
            return false;
    }
    return isfinite(p->error);
}

static void add_point(Work *work, const Point *point, const char *set, const char *scenario,
                      const char *what)
{
    Row row = row_of("work", &point->method, point->rate, scenario, what, point->error);
    const Times *times = &point->times;
    row.set = set;
    row.ms_min = times->minimum, row.ms_median = times->median;
    row.ms_q1 = times->lower_quartile, row.ms_q3 = times->upper_quartile;
    row.front = is_on_front(work, point) ? "front" : "";
    add_row(work->accuracy, &row);
}

static void add_points(Work *work, const char *set)
{
    for (int i = 0; i < work->count; ++i) add_point(work, &work->points[i], set, "mean", "error");
    for (int level = 0; level < LEVEL_COUNT; ++level) {
        const Point *best = NULL;
        char scenario[80];
        for (int i = 0; i < work->count; ++i) {
            const Point *p = &work->points[i];
            if (p->error <= LEVELS[level] && (!best || p->times.minimum < best->times.minimum))
                best = p;
        }
        snprintf(scenario, sizeof scenario, "error <= %g", LEVELS[level]);
        if (best) add_point(work, best, set, scenario, "fastest at level");
    }
}

static Result use_set(Work *work, const char *set, const char *file, Error *error)
{
    Strands strands = {0};
    Result result = file ? strands_read(&strands, file, &(StrandsReadOptions){0}, NULL, error)
                         : strands_make_set(&strands, set, 1, error);
    THEN(result, time_points(work, &strands, error));
    if (result == RESULT_OK) add_points(work, file ? file : set);
    strands_destroy(&strands);
    return result;
}

static Result run_work(Accuracy *accuracy, Error *error)
{
    const BenchOptions *options = accuracy->options;
    Work work = {.accuracy = accuracy};
    Result result = list_points(&work, error);
    for (int i = 0; i < work.count; ++i) THEN(result, find_error(accuracy, &work.points[i], error));
    for (int i = 0; i < SET_COUNT && !options->set && !options->tfx; ++i)
        THEN(result, use_set(&work, SETS[i], NULL, error));
    if (options->set) THEN(result, use_set(&work, options->set, NULL, error));
    if (options->tfx) THEN(result, use_set(&work, NULL, options->tfx, error));
    for (int i = 0; i < options->file_count; ++i)
        THEN(result, use_set(&work, NULL, options->files[i], error));
    free(work.points);
    return result;
}

// --- The command.

static Result run_parts(Accuracy *accuracy, Error *error)
{
    const BenchOptions *options = accuracy->options;
    Method methods[METHODS_MOST];
    int method_count = trial_list(&options->method, methods);
    for (int i = 0; i < EXPERIMENT_COUNT; ++i)
        for (int m = 0; m < method_count && bench_options_part(options, EXPERIMENTS[i].part); ++m)
            TRY(run_method(accuracy, &EXPERIMENTS[i], &methods[m], error));
    return bench_options_part(options, "work") ? run_work(accuracy, error) : RESULT_OK;
}

Result accuracy_run(const BenchOptions *options, const Gpu *gpu, Error *error)
{
    Accuracy accuracy = {.gpu = gpu, .options = options};
    const char *names[EXPERIMENTS_MOST + 2] = {NULL};
    int count = 0;
    for (int i = 0; i < EXPERIMENT_COUNT; ++i)
        if (i == 0 || strcmp(EXPERIMENTS[i].part, EXPERIMENTS[i - 1].part) != 0)
            names[count++] = EXPERIMENTS[i].part;
    names[count] = "work";
    TRY(bench_options_check_parts(options, names, error));
    Result result =
        table_open(&accuracy.table, TABLE_COLUMNS, gpu, &options->output, stdout, error);
    THEN(result,
         trial_read_folder(&accuracy.folder,
                           options->reference ? options->reference : "tests/data/motion", error));
    if (bench_options_part(options, "physics"))
        THEN(result, trial_read_folder(&accuracy.rods, "tests/data/physics", error));
    THEN(result, run_parts(&accuracy, error));
    trial_destroy_folder(&accuracy.folder);
    trial_destroy_folder(&accuracy.rods);
    return table_close(&accuracy.table, result, error);
}
