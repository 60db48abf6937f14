// SPDX-License-Identifier: MIT
// Makes calls of small runs of all programs fail in turn, and kills runs at random moments.
//   torture BIN [--long] [--seed N] [--jobs N] [--per-site N] [--kills N] [--only WORD]
// BIN: folder of the programs. --only: runs with this in their program or name, "faults" or
// "kills". Prints what is wrong, a table, and `N passed, N failed`; status 1 if anything failed.
#include "faults/faults.h"
#include "faults/folder.h"
#include "faults/kills.h"
#include "faults/place.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static double seconds(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static int usage(const char *word)
{
    fprintf(stderr,
            "torture: %s: expected BIN [--long] [--seed N] [--jobs N] [--per-site N] "
            "[--kills N] [--only WORD]\n",
            word);
    return 2;
}

// Links work/root to the project, the harness's working directory.
static void link_root(const char *work)
{
    char from[PATH_MAX], to[PATH_MAX + 8];
    snprintf(to, sizeof to, "%s/root", work);
    if (getcwd(from, sizeof from) && symlink(from, to) == 0) return;
    perror("torture: root");
    exit(1);
}

static void prepare(const TortureOptions *options)
{
    char folder[4200];
    snprintf(folder, sizeof folder, "%s/in", options->work);
    folder_clear(folder);
    for (const Run *run = RUN_PREPARED; run->program; ++run) {
        char text[1000], program[4200];
        char *words[RUN_WORDS];
        ChildEnd end;
        run_words(run, text, words);
        snprintf(program, sizeof program, "%s/tractrix-%s", options->bin, run->program);
        child_run(&(Child){.folder = folder,
                           .program = program,
                           .arguments = words,
                           .environment = (const char *const[]){NULL},
                           .limit_s = 10 * options->limit_s,
                           .kill_after_s = -1},
                  &end);
        if (end.status == 0) continue;
        fprintf(stderr, "torture: tractrix-%s %s: %s\n", run->program, run->arguments, end.errors);
        exit(1);
    }
}

static bool has_ffmpeg(void)
{
    char folders[4096], path[4200];
    const char *list = getenv("PATH");
    snprintf(folders, sizeof folders, "%s", list ? list : "");
    for (char *rest = folders, *folder; (folder = strsep(&rest, ":"));) {
        snprintf(path, sizeof path, "%s/ffmpeg", folder);
        if (access(path, X_OK) == 0) return true;
    }
    return false;
}

static bool is_wanted(const Run *run, const char *only, const char *part)
{
    if (strcmp(run->name, "video") == 0 && !has_ffmpeg()) {
        printf("skipped: video: no ffmpeg here\n");
        return false;
    }
    return !*only || strcmp(only, part) == 0 || strstr(run->program, only) ||
           strstr(run->name, only);
}

static void add(FaultTally *sum, const FaultTally *tally)
{
    sum->calls += tally->calls;
    sum->sites += tally->sites;
    sum->injected += tally->injected;
    sum->failed += tally->failed;
    sum->managed += tally->managed;
    sum->missed += tally->missed;
    sum->wrong += tally->wrong;
}

static void print_row(const char *program, const char *name, const FaultTally *tally, double s)
{
    printf("%-8s %-26s %6d %6d %7d %7d %7d %7d %6d %6.1f\n", program, name, tally->calls,
           tally->sites, tally->injected, tally->failed, tally->managed, tally->missed,
           tally->wrong, s);
    fflush(stdout);
}

static void run_faults(const TortureOptions *options, const char *only, FaultTally *sum)
{
    double begin = seconds();
    printf("%-8s %-26s %6s %6s %7s %7s %7s %7s %6s %6s\n", "program", "run", "calls", "sites",
           "faults", "failed", "managed", "missed", "wrong", "s");
    for (const Run *run = RUNS; run->program; ++run) {
        if (!is_wanted(run, only, "faults")) continue;
        double start = seconds();
        FaultTally tally = {0};
        faults_run(run, options, &tally);
        add(sum, &tally);
        print_row(run->program, run->name, &tally, seconds() - start);
    }
    print_row("all", "", sum, seconds() - begin);
}

static void run_kills(const TortureOptions *options, const char *only, KillTally *sum)
{
    printf("%-8s %-26s %6s %6s %7s %7s %6s %6s\n", "kills", "run", "KILL", "TERM", "INT", "after",
           "wrong", "s");
    for (const Run *run = RUN_KILLED; run->program; ++run) {
        if (!is_wanted(run, only, "kills")) continue;
        double start = seconds();
        KillTally tally = {0};
        kills_run(run, options, &tally);
        printf("%-8s %-26s %6d %6d %7d %7d %6d %6.1f\n", run->program, run->name, tally.by[0],
               tally.by[1], tally.by[2], tally.late, tally.wrong, seconds() - start);
        fflush(stdout);
        sum->kills += tally.kills;
        sum->wrong += tally.wrong;
    }
}

static bool read_options(char **arguments, TortureOptions *options, const char **only)
{
    for (; *arguments; ++arguments) {
        if (strcmp(*arguments, "--long") == 0) {
            options->whole = true;
            options->kills = 50;
            continue;
        }
        if (!arguments[1]) return false;
        const char *name = *arguments++;
        int value = atoi(*arguments);
        if (strcmp(name, "--seed") == 0)
            options->seed = (unsigned)value;
        else if (strcmp(name, "--jobs") == 0)
            options->jobs = value > 0 ? value : 1;
        else if (strcmp(name, "--per-site") == 0)
            options->per_site = value;
        else if (strcmp(name, "--kills") == 0)
            options->kills = value;
        else if (strcmp(name, "--only") == 0)
            *only = *arguments;
        else
            return false;
    }
    return true;
}

int main(int count, char **arguments)
{
    TortureOptions options = {.seed = 1, .jobs = 1, .kills = 2, .limit_s = 60};
    const char *only = "", *base = getenv("TMPDIR");
    char work[PATH_MAX], bin[PATH_MAX];
    if (count < 2 || !realpath(arguments[1], bin)) return usage("no folder of programs");
    if (!read_options(arguments + 2, &options, &only)) return usage("wrong option");
    snprintf(work, sizeof work, "%s/torture-XXXXXX", base && *base ? base : "/tmp");
    if (!mkdtemp(work)) return usage(work);
    options.bin = bin;
    options.work = work;
    link_root(work);
    printf("seed %u\n", options.seed);
    prepare(&options);
    FaultTally faults = {0};
    KillTally kills = {0};
    if (strcmp(only, "kills") != 0) run_faults(&options, only, &faults);
    if (strcmp(only, "faults") != 0) run_kills(&options, only, &kills);
    folder_remove(work);
    int wrong = faults.wrong + kills.wrong, all = faults.injected + kills.kills;
    printf("%d passed, %d failed\n", all - wrong, wrong);
    return wrong || !all;
}
