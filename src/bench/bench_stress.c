// SPDX-License-Identifier: MIT
#include "bench/bench_stress.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "bench/stress_run.h"
#include "sim/solver.h"

#include <math.h>
#include <string.h>
#include <time.h>

enum { TEXT_SIZE = 1024 };

// A form's sum, a case that failed, or the smallest that such a one was made to.
typedef struct Line {
    const char *what, *algo, *variant;
    long cases, sets, failures;
    double seconds;
    const char *rule; // that was broken
    long set, strand; // -1: it is no strand of a set
    long steps, at;   // of the case; the first that broke it
    double of_allowed, worst_length, worst_energy, worst_rest;
    char text[TEXT_SIZE], command[TEXT_SIZE + 128];
} Line;

#define AT(member) offsetof(Line, member)
static const Column COLUMNS[] = {
    {"what", COLUMN_TEXT, AT(what), 0},
    {"algo", COLUMN_TEXT, AT(algo), 0},
    {"variant", COLUMN_TEXT, AT(variant), 0},
    {"cases", COLUMN_WHOLE, AT(cases), 0},
    {"sets", COLUMN_WHOLE, AT(sets), 0},
    {"failures", COLUMN_WHOLE, AT(failures), 0},
    {"seconds", COLUMN_REAL, AT(seconds), 0},
    {"rule", COLUMN_TEXT, AT(rule), 0},
    {"set", COLUMN_WHOLE, AT(set), 0},
    {"strand", COLUMN_WHOLE, AT(strand), 0},
    {"steps", COLUMN_WHOLE, AT(steps), 0},
    {"at", COLUMN_WHOLE, AT(at), 0},
    {"of_allowed", COLUMN_REAL, AT(of_allowed), 0},
    {"worst_length", COLUMN_REAL, AT(worst_length), 0},
    {"worst_energy", COLUMN_REAL, AT(worst_energy), 0},
    {"worst_rest", COLUMN_REAL, AT(worst_rest), 0},
    {"case", COLUMN_CHARS, AT(text), 0},
    {"command", COLUMN_CHARS, AT(command), 0},
};
enum { COLUMN_COUNT = sizeof COLUMNS / sizeof *COLUMNS };

// Of the failures of a set only the worst of each rule is made smaller, and so many of a form; all
// are named.
enum { MOST_SHRUNK = 8 };

StressOptions stress_options_default(void)
{
    return (StressOptions){.cases = 5000, .steps = 10000, .seed = 1, .allowed = 1, .shrinks = true};
}

// What happened to a solver's form.
typedef struct Tally {
    const char *algo, *variant;
    int cases, sets, failures, shrunk;
    int broken[STRESS_RULES];
    double worst[STRESS_RULES];
    double seconds;
} Tally;

typedef struct Bench {
    const Gpu *gpu;
    const StressOptions *options;
    FILE *stream;
    Table table; // of the files
    Progress progress;
    int sets_done, cases_done;
} Bench;

static double now_s(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static int first_step(const StressVerdict *verdict, StressRule *rule)
{
    int first = 0;
    for (int i = 0; i < STRESS_RULES; ++i)
        if (verdict->first[i] && (!first || verdict->first[i] < first))
            first = verdict->first[i], *rule = (StressRule)i;
    return first;
}

// Whether the case alone breaks the rule; *steps: when.
static bool breaks(Bench *bench, const StressCase *stress, StressRule rule, int *steps)
{
    StressVerdict verdict;
    Error unused;
    if (interrupt_requested() || stress_run(&verdict, bench->gpu, stress, 1, *steps,
                                            bench->options->allowed, &unused) != RESULT_OK)
        return false;
    if (!verdict.first[rule]) return false;
    // The head rests in the second half, and strands must lie still at the end.
    if (rule != STRESS_REST && stress->value[STRESS_jump] == 0 &&
        stress->value[STRESS_shake] == 0 && stress->value[STRESS_spin] == 0)
        *steps = verdict.first[rule];
    return true;
}

enum { MOST_PASSES = 3 };

// Tries all simpler cases, over again where one breaks the rule, too.
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

// The command that repeats a case, of the line's form and steps.
static void write_command(const Bench *bench, Line *line)
{
    char allow[32] = "";
    if (bench->options->allowed < 1)
        snprintf(allow, sizeof allow, " --allow %.9g", bench->options->allowed);
    snprintf(line->command, sizeof line->command,
             "tractrix-bench stress --algo %s%s%s --steps %ld%s --case '%s'", line->algo,
             *line->variant ? " --variant " : "", line->variant, line->steps, allow, line->text);
}

static Line line_of_case(const Bench *bench, const char *what, const StressCase *stress,
                         const StressVerdict *verdict, StressRule rule, int steps)
{
    Line line = {.what = what,
                 .algo = stress->algo,
                 .variant = stress->variant,
                 .cases = 1,
                 .sets = 1,
                 .failures = 1,
                 .seconds = NAN,
                 .rule = STRESS_RULE_NAMES[rule],
                 .set = -1,
                 .strand = -1,
                 .steps = steps,
                 .at = verdict->first[rule],
                 .of_allowed = verdict->worst[rule],
                 .worst_length = verdict->worst[STRESS_LENGTHS],
                 .worst_energy = verdict->worst[STRESS_ENERGY],
                 .worst_rest = verdict->worst[STRESS_REST]};
    stress_case_write(stress, line.text, sizeof line.text);
    write_command(bench, &line);
    return line;
}

static void print_case(Bench *bench, const StressCase *stress, const StressVerdict *verdict,
                       StressRule rule, int steps)
{
    const Line line = line_of_case(bench, "smallest", stress, verdict, rule, steps);
    fprintf(bench->stream, "  %s broken at step %ld (%.3g of what is allowed):\n    %s\n",
            line.rule, line.at, line.of_allowed, line.command);
    fflush(bench->stream);
    table_add(&bench->table, &line);
}

static void tell_failure(Bench *bench, const StressCase *stress, const StressVerdict *found)
{
    StressRule rule = STRESS_FINITE;
    StressCase smallest = *stress;
    StressVerdict verdict = *found;
    Error unused;
    int steps = bench->options->steps, at = first_step(found, &rule);
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
    (void)at;
    print_case(bench, &smallest, &verdict, rule, steps);
}

// Names a case as it was found.
static void name_failure(Bench *bench, const Tally *tally, const StressCase *stress, int strand,
                         const StressVerdict *verdict, StressRule rule)
{
    Line line = line_of_case(bench, "failed", stress, verdict, rule, bench->options->steps);
    line.set = tally->sets, line.strand = strand;
    progress_clear(&bench->progress);
    fprintf(bench->stream, "  set %d, strand %d: %s at step %ld (%.3g): '%s'\n", tally->sets,
            strand, line.rule, line.at, line.of_allowed, line.text);
    table_add(&bench->table, &line);
}

// Whether a breaks the rule worse than b: by more, or else sooner.
static bool is_worse(const StressVerdict *a, const StressVerdict *b, StressRule rule)
{
    if (a->worst[rule] > b->worst[rule]) return true;
    return a->worst[rule] == b->worst[rule] && a->first[rule] < b->first[rule];
}

// Counts a set's strands, names all that failed, and tells the worst by each rule.
static void count(Bench *bench, Tally *tally, const StressCase *strands,
                  const StressVerdict *verdicts, int strand_count)
{
    int worst[STRESS_RULES] = {-1, -1, -1, -1};
    for (int s = 0; s < strand_count; ++s) {
        for (int i = 0; i < STRESS_RULES; ++i) {
            tally->broken[i] += verdicts[s].first[i] > 0;
            if (!(verdicts[s].worst[i] <= tally->worst[i])) tally->worst[i] = verdicts[s].worst[i];
        }
        StressRule rule = STRESS_FINITE;
        if (!first_step(&verdicts[s], &rule)) continue;
        ++tally->failures;
        if (!bench->options->text) name_failure(bench, tally, &strands[s], s, &verdicts[s], rule);
        if (worst[rule] < 0 || is_worse(&verdicts[s], &verdicts[worst[rule]], rule))
            worst[rule] = s;
    }
    for (int i = 0; i < STRESS_RULES; ++i)
        if (worst[i] >= 0 && !interrupt_requested() && tally->shrunk++ < MOST_SHRUNK)
            tell_failure(bench, &strands[worst[i]], &verdicts[worst[i]]);
    ++tally->sets;
    tally->cases += strand_count;
}

// One set, its circumstances from the seed and its number.
static Result run_set(Bench *bench, Tally *tally, int set, int strand_count, Error *error)
{
    StressCase strands[STRESS_STRANDS];
    StressVerdict verdicts[STRESS_STRANDS];
    Random random = random_create((uint64_t)bench->options->seed, (uint64_t)set);
    StressCase plain = stress_case_random(tally->algo, tally->variant,
                                          STRESS_VERTICES[set % STRESS_VERTEX_COUNTS], &random);
    for (int s = 0; s < strand_count; ++s)
        strands[s] = stress_case_random_strand(&plain, s, &random);
    Result result = stress_run(verdicts, bench->gpu, strands, strand_count, bench->options->steps,
                               bench->options->allowed, error);
    if (result == RESULT_OK) count(bench, tally, strands, verdicts, strand_count);
    return result;
}

static Result run_text(Bench *bench, Tally *tally, Error *error)
{
    StressCase stress = {.algo = tally->algo, .variant = tally->variant};
    StressVerdict verdict;
    Result result = stress_case_read(&stress, bench->options->text, error);
    if (result == RESULT_OK)
        result = stress_run(&verdict, bench->gpu, &stress, 1, bench->options->steps,
                            bench->options->allowed, error);
    if (result == RESULT_OK) count(bench, tally, &stress, &verdict, 1);
    return result;
}

static Result run_sets(Bench *bench, Tally *tally, Error *error)
{
    Result result = RESULT_OK;
    for (int set = 0, left = bench->options->cases; left > 0 && result == RESULT_OK;
         ++set, left -= STRESS_STRANDS) {
        result = run_set(bench, tally, set, left < STRESS_STRANDS ? left : STRESS_STRANDS, error);
        progress_update(&bench->progress, ++bench->sets_done);
    }
    return result;
}

static void print_head(FILE *stream)
{
    fprintf(stream, "%-10s %-10s %8s %6s %8s %8s  %-28s %s\n", "solver", "form", "cases", "sets",
            "failures", "seconds", "failures by rule (f/l/e/r)", "worst of allowed (l/e/r)");
    fflush(stream);
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
    fflush(bench->stream);
    const Line line = {.what = "form",
                       .algo = tally->algo,
                       .variant = tally->variant,
                       .cases = tally->cases,
                       .sets = tally->sets,
                       .failures = tally->failures,
                       .seconds = tally->seconds,
                       .rule = "",
                       .set = -1,
                       .strand = -1,
                       .steps = bench->options->steps,
                       .of_allowed = NAN,
                       .worst_length = worst[STRESS_LENGTHS],
                       .worst_energy = worst[STRESS_ENERGY],
                       .worst_rest = worst[STRESS_REST]};
    table_add(&bench->table, &line);
}

static Result run_form(Bench *bench, const char *algo, const char *variant, int *failures,
                       Error *error)
{
    Tally tally = {.algo = algo, .variant = variant};
    double begun = now_s();
    Result result =
        bench->options->text ? run_text(bench, &tally, error) : run_sets(bench, &tally, error);
    tally.seconds = now_s() - begun;
    if (tally.cases) print_tally(bench, &tally);
    *failures += tally.failures;
    bench->cases_done += tally.cases;
    return result;
}

// Whether the options ask for it.
static bool is_asked(const StressOptions *options, const SolverType *type, const char *variant)
{
    bool named = !options->algo || strcmp(options->algo, type->name) == 0;
    return !solver_is_static(type) && named &&
           (!options->variant || strcmp(options->variant, variant) == 0);
}

// Calls `each` for the forms that are asked for, or counts them if there is no bench.
static Result for_forms(Bench *bench, const StressOptions *options, int *failures, int *forms,
                        Error *error)
{
    Result result = RESULT_OK;
    for (const SolverType *const *type = SOLVER_TYPES; *type; ++type)
        for (int v = 0; v == 0 || (*type)->variants[v]; ++v) {
            const char *variant = (*type)->variants[v] ? (*type)->variants[v] : "";
            if (!is_asked(options, *type, variant)) continue;
            ++*forms;
            if (bench && result == RESULT_OK)
                result = run_form(bench, (*type)->name, variant, failures, error);
        }
    return result;
}

static Result check_words(const StressOptions *options, Error *error)
{
    const SectionParams params = {.algo = (char *)(options->algo ? options->algo : "split"),
                                  .variant = (char *)(options->variant ? options->variant : "")};
    if (options->text && !options->algo)
        return error_set(error, RESULT_USAGE, "stress: --case needs --algo");
    return solver_check(&params, error);
}

// The files have what was done until an interruption, too.
static Result close_table(Table *table, Result result, Error *error)
{
    Error unwritten;
    Result closed = table_close(table, RESULT_OK, &unwritten);
    return closed == RESULT_OK ? result : error_set(error, closed, "%s", unwritten.text);
}

Result bench_stress(const Gpu *gpu, const StressOptions *options, const TableOutput *output,
                    FILE *stream, Error *error)
{
    Bench bench = {.gpu = gpu, .options = options, .stream = stream};
    int forms = 0, failures = 0, unused = 0;
    Result result = check_words(options, error);
    if (result == RESULT_OK)
        result = table_open(&bench.table, COLUMNS, COLUMN_COUNT, gpu, output, NULL, error);
    if (result != RESULT_OK) return result;
    for_forms(NULL, options, &failures, &forms, error);
    int sets = options->text ? 1 : (options->cases + STRESS_STRANDS - 1) / STRESS_STRANDS;
    progress_start(&bench.progress, stderr, forms ? forms * sets : 1, false);
    print_head(stream);
    double begun = now_s();
    result = for_forms(&bench, options, &failures, &unused, error);
    progress_clear(&bench.progress);
    fprintf(stream, "%d cases, %d steps each, of %d forms of solvers in %.0f s: %d failed\n",
            bench.cases_done, options->steps, forms, now_s() - begun, failures);
    if (result == RESULT_OK && failures)
        result = error_set(error, RESULT_FAILED, "%d cases failed", failures);
    return close_table(&bench.table, result, error);
}
