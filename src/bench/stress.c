// SPDX-License-Identifier: MIT
#include "bench/stress.h"
#include "base/clock.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "bench/stress_run.h"
#include "sim/solver.h"

#include <math.h>
#include <string.h>

// A row is the sum of a form (a solver's variant), a case that failed, or the smallest failing case
// that it was shrunk to. `rule`: the broken rule; `set`, `strand`: -1 if the case is not a strand
// of a set; `steps`: steps of the case; `at`: the first step that broke the rule.
// clang-format off
#define ROW(X)                                                                                     \
    X(TEXT, what, 0) X(TEXT, algo, 0) X(TEXT, variant, 0) X(WHOLE, cases, 0) X(WHOLE, sets, 0)     \
    X(WHOLE, failures, 0) X(REAL, seconds, 0) X(TEXT, rule, 0) X(WHOLE, set, 0)                    \
    X(WHOLE, strand, 0) X(WHOLE, steps, 0) X(WHOLE, at, 0) X(REAL, of_allowed, 0)                  \
    X(REAL, worst_length, 0) X(REAL, worst_energy, 0) X(REAL, worst_rest, 0)
// clang-format on

typedef struct Row {
    ROW(TABLE_FIELD)
    char text[TABLE_CHARS - 128], command[TABLE_CHARS];
} Row;
static const Column COLUMNS[] = {ROW(TABLE_COLUMN){"case", COLUMN_CHARS, offsetof(Row, text), 0},
                                 TABLE_COLUMN(CHARS, command, 0)};

// In each set only the worst failure of each rule is shrunk, at most MOST_SHRUNK for a form. All
// failures are printed.
enum { MOST_SHRUNK = 8, MOST_FORMS = 64 };

StressOptions stress_options_default(void)
{
    return (StressOptions){.cases = 5000, .steps = 10000, .seed = 1, .allowed = 1, .shrinks = true};
}

// Results of a form.
typedef struct Tally {
    const char *algo, *variant;
    int cases, sets, failures, shrunk;
    int fluttering; // strands that may flutter (stress_bound.h)
    int broken[STRESS_RULES];
    double worst[STRESS_RULES];
    double seconds;
} Tally;

typedef struct Bench {
    const Gpu *gpu;
    const StressOptions *options;
    FILE *stream;
    Table table; // for --csv, --json and --html
    Progress progress;
    int sets; // number of sets for each form
    int sets_done, cases_done, failures;
} Bench;

static int first_step(const StressVerdict *verdict, StressRule *rule)
{
    int first = 0;
    for (int i = 0; i < STRESS_RULES; ++i)
        if (verdict->first[i] && (!first || verdict->first[i] < first))
            first = verdict->first[i], *rule = (StressRule)i;
    return first;
}

// Whether the case breaks the rule when it runs alone. *steps: number of steps to run; set to the
// step of the failure if later steps are not needed.
static bool breaks(Bench *bench, const StressCase *stress, StressRule rule, int *steps)
{
    StressVerdict verdict;
    Error unused;
    if (interrupt_requested() || stress_run(&verdict, bench->gpu, stress, 1, *steps,
                                            bench->options->allowed, &unused) != RESULT_OK)
        return false;
    if (!verdict.first[rule]) return false;
    // These rules need all steps: the head rests in the second half, and STRESS_REST is checked at
    // the end.
    if (rule != STRESS_REST && stress->value[STRESS_jump] == 0 &&
        stress->value[STRESS_shake] == 0 && stress->value[STRESS_spin] == 0)
        *steps = verdict.first[rule];
    return true;
}

enum { MOST_PASSES = 3 };

// Tries all simpler cases, and repeats this as long as one of them still breaks the rule.
static void shrink(Bench *bench, StressCase *stress, StressRule rule, int *steps)
{
    bool smaller = true;
    StressCase simpler;
    for (int pass = 0; pass < MOST_PASSES && smaller; ++pass) {
        smaller = false;
        for (int fewer = *steps / 2; fewer > 0 && breaks(bench, stress, rule, &fewer);
             fewer = *steps / 2)
            *steps = fewer, smaller = true;
        for (int move = 0; stress_case_simplify(stress, move, &simpler); ++move) {
            if (memcmp(&simpler, stress, sizeof simpler) == 0) continue;
            if (!breaks(bench, &simpler, rule, steps)) continue;
            *stress = simpler;
            smaller = true;
        }
    }
}

static void set_worst(Row *row, const double worst[STRESS_RULES])
{
    row->worst_length = worst[STRESS_LENGTHS];
    row->worst_energy = worst[STRESS_ENERGY];
    row->worst_rest = worst[STRESS_REST];
}

// Makes the row of a case, with the command that repeats it.
static Row line_of_case(const Bench *bench, const char *what, const StressCase *stress,
                        const StressVerdict *verdict, StressRule rule, int steps)
{
    Row line = {.what = what, .algo = stress->algo, .variant = stress->variant};
    char allow[32] = "";
    line.cases = line.sets = line.failures = 1;
    line.set = line.strand = -1;
    line.steps = steps, line.at = verdict->first[rule];
    line.seconds = NAN;
    line.rule = STRESS_RULE_NAMES[rule];
    line.of_allowed = verdict->worst[rule];
    set_worst(&line, verdict->worst);
    stress_case_write(stress, line.text, sizeof line.text);
    if (bench->options->allowed < 1)
        snprintf(allow, sizeof allow, " --allow %.9g", bench->options->allowed);
    snprintf(line.command, sizeof line.command,
             "tractrix-bench stress --algo %s%s%s --steps %ld%s --case '%s'", line.algo,
             *line.variant ? " --variant " : "", line.variant, line.steps, allow, line.text);
    return line;
}

static void print_case(Bench *bench, const StressCase *stress, const StressVerdict *verdict,
                       StressRule rule, int steps)
{
    const Row line = line_of_case(bench, "smallest", stress, verdict, rule, steps);
    fprintf(bench->stream, "  %s broken at step %ld (%.3g of what is allowed):\n    %s\n",
            line.rule, line.at, line.of_allowed, line.command);
    fflush(bench->stream);
    table_add(&bench->table, &line);
}

// Shrinks a failing case, run alone, as long as it breaks the first rule that it broke.
static void report_smallest(Bench *bench, const StressCase *stress, const StressVerdict *found)
{
    StressRule rule = STRESS_FINITE;
    StressCase smallest = *stress;
    StressVerdict verdict = *found;
    Error unused;
    int steps = bench->options->steps;
    first_step(found, &rule);
    progress_clear(&bench->progress);
    if (!breaks(bench, &smallest, rule, &steps)) {
        fprintf(bench->stream, "  not when it is alone:\n");
        print_case(bench, stress, found, rule, bench->options->steps);
        return;
    }
    if (!bench->options->text && bench->options->shrinks) shrink(bench, &smallest, rule, &steps);
    if (stress_run(&verdict, bench->gpu, &smallest, 1, steps, bench->options->allowed, &unused) !=
        RESULT_OK)
        verdict = *found;
    print_case(bench, &smallest, &verdict, rule, steps);
}

// Counts a set's strands, prints all failures, and reports the worst failure of each rule.
static void count(Bench *bench, Tally *tally, const StressCase *strands,
                  const StressVerdict *verdicts, int strand_count)
{
    int worst[STRESS_RULES] = {-1, -1, -1, -1};
    for (int s = 0; s < strand_count; ++s) {
        tally->fluttering += verdicts[s].flutters;
        for (int i = 0; i < STRESS_RULES; ++i) {
            tally->broken[i] += verdicts[s].first[i] > 0;
            if (!(verdicts[s].worst[i] <= tally->worst[i])) tally->worst[i] = verdicts[s].worst[i];
        }
        StressRule rule = STRESS_FINITE;
        if (!first_step(&verdicts[s], &rule)) continue;
        ++tally->failures;
        const StressVerdict *found = &verdicts[s],
                            *most = &verdicts[worst[rule] < 0 ? s : worst[rule]];
        if (!bench->options->text) {
            Row line =
                line_of_case(bench, "failed", &strands[s], found, rule, bench->options->steps);
            line.set = tally->sets, line.strand = s;
            progress_clear(&bench->progress);
            fprintf(bench->stream, "  set %d, strand %d: %s at step %ld (%.3g): '%s'\n",
                    tally->sets, s, line.rule, line.at, line.of_allowed, line.text);
            table_add(&bench->table, &line);
        }
        // The worst failure exceeds its bound most; among equal ones it is the earliest.
        if (worst[rule] < 0 || found->worst[rule] > most->worst[rule] ||
            (found->worst[rule] == most->worst[rule] && found->first[rule] < most->first[rule]))
            worst[rule] = s;
    }
    for (int i = 0; i < STRESS_RULES; ++i)
        if (worst[i] >= 0 && !interrupt_requested() && tally->shrunk++ < MOST_SHRUNK)
            report_smallest(bench, &strands[worst[i]], &verdicts[worst[i]]);
    ++tally->sets;
    tally->cases += strand_count;
}

// Runs one set, with circumstances from the seed and the set's number, or the single case of the
// command line.
static Result run_set(Bench *bench, Tally *tally, int set, Error *error)
{
    const StressOptions *options = bench->options;
    StressCase strands[STRESS_STRANDS] = {{.algo = tally->algo, .variant = tally->variant}};
    StressVerdict verdicts[STRESS_STRANDS];
    int left = options->cases - set * STRESS_STRANDS;
    int strand_count = left < STRESS_STRANDS ? left : STRESS_STRANDS;
    if (options->text) {
        strand_count = 1;
        TRY(stress_case_read(strands, options->text, error));
    } else {
        Random random = random_create((uint64_t)options->seed, (uint64_t)set);
        StressCase plain = stress_case_random(tally->algo, tally->variant,
                                              STRESS_VERTICES[set % STRESS_VERTEX_COUNTS], &random);
        for (int s = 0; s < strand_count; ++s)
            strands[s] = stress_case_random_strand(&plain, s, &random);
    }
    TRY(stress_run(verdicts, bench->gpu, strands, strand_count, options->steps, options->allowed,
                   error));
    count(bench, tally, strands, verdicts, strand_count);
    return RESULT_OK;
}

static void print_tally(Bench *bench, const Tally *tally)
{
    const int *broken = tally->broken;
    const double *worst = tally->worst;
    progress_clear(&bench->progress);
    fprintf(bench->stream, "%-10s %-10s %8d %6d %8d %8.1f  %6d %6d %6d %6d   %.2g %.2g %.2g\n",
            tally->algo, *tally->variant ? tally->variant : "-", tally->cases, tally->sets,
            tally->failures, tally->seconds, broken[0], broken[1], broken[2], broken[3], worst[1],
            worst[2], worst[3]);
    if (tally->fluttering)
        fprintf(
            bench->stream,
            "  energy and rest not checked for %d strands that may flutter: their weight presses "
            "on their style (docs/reliability.md)\n",
            tally->fluttering);
    fflush(bench->stream);
    Row line = {.what = "form", .algo = tally->algo, .variant = tally->variant, .rule = ""};
    line.cases = tally->cases, line.sets = tally->sets, line.failures = tally->failures;
    line.set = line.strand = -1;
    line.steps = bench->options->steps;
    line.seconds = tally->seconds;
    line.of_allowed = NAN;
    set_worst(&line, worst);
    table_add(&bench->table, &line);
}

static Result run_form(Bench *bench, const char *algo, const char *variant, Error *error)
{
    Tally tally = {.algo = algo, .variant = variant};
    double begun = clock_ms();
    Result result = RESULT_OK;
    for (int set = 0; set < bench->sets; ++set) {
        THEN(result, run_set(bench, &tally, set, error));
        if (result == RESULT_OK) progress_update(&bench->progress, ++bench->sets_done);
    }
    tally.seconds = (clock_ms() - begun) / 1000;
    if (tally.cases) print_tally(bench, &tally);
    bench->failures += tally.failures;
    bench->cases_done += tally.cases;
    return result;
}

// Lists the forms to test: [count] of algo and variant.
static int list_forms(const StressOptions *options, const char *forms[MOST_FORMS][2])
{
    int count = 0;
    for (const SolverType *const *type = SOLVER_TYPES; *type; ++type)
        for (int v = 0; (v == 0 || (*type)->variants[v]) && count < MOST_FORMS; ++v) {
            const char *variant = (*type)->variants[v] ? (*type)->variants[v] : "";
            if (solver_is_static(*type)) continue;
            if (options->algo && strcmp(options->algo, (*type)->name) != 0) continue;
            if (options->variant && strcmp(options->variant, variant) != 0) continue;
            forms[count][0] = (*type)->name, forms[count++][1] = variant;
        }
    return count;
}

Result stress_search(const Gpu *gpu, const StressOptions *options, const TableOutput *output,
                     FILE *stream, Error *error)
{
    Bench bench = {.gpu = gpu, .options = options, .stream = stream, .sets = 1};
    if (!options->text) bench.sets = (options->cases + STRESS_STRANDS - 1) / STRESS_STRANDS;
    const SectionParams words = {.algo = (char *)(options->algo ? options->algo : "split"),
                                 .variant = (char *)(options->variant ? options->variant : "")};
    const char *forms[MOST_FORMS][2];
    int count = list_forms(options, forms);
    if (options->text && !options->algo)
        return error_set(error, RESULT_USAGE, "stress: --case needs --algo");
    TRY(solver_check(&words, error));
    TRY(table_open(&bench.table, TABLE_COLUMNS, gpu, output, NULL, error));
    progress_start(&bench.progress, stderr, count ? count * bench.sets : 1, false);
    fprintf(stream, "%-10s %-10s %8s %6s %8s %8s  %-28s %s\n", "solver", "form", "cases", "sets",
            "failures", "seconds", "failures by rule (f/l/e/r)", "worst of allowed (l/e/r)");
    fflush(stream);
    double begun = clock_ms();
    Result result = RESULT_OK;
    for (int i = 0; i < count; ++i) THEN(result, run_form(&bench, forms[i][0], forms[i][1], error));
    progress_clear(&bench.progress);
    fprintf(stream, "%d cases, %d steps each, of %d forms of solvers in %.0f s: %d failed\n",
            bench.cases_done, options->steps, count, (clock_ms() - begun) / 1000, bench.failures);
    if (bench.failures)
        THEN(result, error_set(error, RESULT_FAILED, "%d cases failed", bench.failures));
    // After an interruption the files have the results so far.
    Error unwritten;
    Result closed = table_close(&bench.table, RESULT_OK, &unwritten);
    return closed == RESULT_OK ? result : error_set(error, closed, "%s", unwritten.text);
}
