// SPDX-License-Identifier: MIT
#include "faults/faults.h"
#include "faults/place.h"

#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { JOBS_MOST = 64, COUNTS = 1 << 15, STREAM_CALLS = 8 };

// The `which`-th call of a site, which is to fail.
typedef struct Fault {
    char name[48];
    uint64_t site;
    unsigned which;
} Fault;

typedef struct Faults {
    const Run *run;
    const TortureOptions *options;
    Folder reference;
    Fault *list;
    int count, next;
    pthread_mutex_t lock;
    FaultTally *tally;
} Faults;

static void *take(void *block)
{
    if (block) return block;
    fprintf(stderr, "torture: no memory\n");
    exit(1);
}

// Number of calls per site, a hash table with open addressing.
typedef struct Counts {
    uint64_t site[COUNTS];
    unsigned calls[COUNTS];
} Counts;

static unsigned count_call(Counts *counts, uint64_t site)
{
    unsigned at = (unsigned)(site % COUNTS);
    while (counts->site[at] && counts->site[at] != site) at = (at + 1) % COUNTS;
    counts->site[at] = site;
    return ++counts->calls[at];
}

static void read_calls(Faults *faults, const char *path)
{
    FILE *log = fopen(path, "r");
    Fault fault;
    unsigned long long site;
    int room = 0;
    Counts *counts = take(calloc(1, sizeof *counts));
    while (log && fscanf(log, "%47s %llx", fault.name, &site) == 2) {
        fault.site = site;
        fault.which = count_call(counts, site);
        if (faults->count == room) {
            room = 2 * room + 1000;
            faults->list = take(realloc(faults->list, (size_t)room * sizeof fault));
        }
        faults->list[faults->count++] = fault;
        faults->tally->sites += fault.which == 1;
    }
    if (log) fclose(log);
    free(counts);
    faults->tally->calls = faults->count;
}

// Text output goes to a buffer, so that all calls of a site fail at the same few places, where the
// buffer is written.
static bool is_stream(const char *name)
{
    static const char *const names[] = {"fwrite", "fputs", "fputc", "putc", "fprintf", "printf"};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i)
        if (strcmp(name, names[i]) == 0) return true;
    return false;
}

// Short form: the first calls of some sites. Long form: all calls, or a few of each site.
static void choose(Faults *faults)
{
    const TortureOptions *options = faults->options;
    int kept = 0, sites = faults->tally->sites, most = faults->run->short_faults, site = 0;
    for (int i = 0; i < faults->count; ++i) {
        const Fault *fault = &faults->list[i];
        bool keep = !options->per_site || fault->which <= (unsigned)options->per_site;
        if (is_stream(fault->name) && fault->which > STREAM_CALLS) keep = false;
        if (!options->whole) {
            keep = fault->which == 1;
            int turn = (site + (int)(options->seed % (unsigned)sites)) % sites;
            if (keep && most < sites) keep = turn * most / sites != (turn + 1) * most / sites;
            site += fault->which == 1;
        }
        if (keep) faults->list[kept++] = *fault;
    }
    faults->count = kept;
}

// Runs the program without faults to list its calls.
static void list_calls(Faults *faults)
{
    const TortureOptions *options = faults->options;
    char bin[4200];
    Place place;
    ChildEnd end;
    snprintf(bin, sizeof bin, "%s/faults", options->bin);
    place_create(&place, options->work, 0);
    Attempt attempt = {.bin = bin,
                       .fault = "none", // fills the driver's shader cache
                       .limit_s = 10 * options->limit_s,
                       .kill_after_s = -1};
    place_run(&place, faults->run, &attempt, &end);
    attempt.fault = NULL;
    place_run(&place, faults->run, &attempt, &end);
    if (end.status != faults->run->status) {
        fprintf(stderr, "torture: %s, %s: undisturbed it ends with status %d: %s\n",
                faults->run->program, faults->run->name, end.status, end.errors);
        exit(1);
    }
    folder_read(&faults->reference, place.run);
    read_calls(faults, place.log);
    choose(faults);
}

// Reads the injector's log: whether the call was made to fail, and with which reason.
static bool read_reason(const Place *place, char reason[100])
{
    char line[200] = "";
    FILE *log = fopen(place->log, "r");
    bool came = log && fgets(line, sizeof line, log);
    if (log) fclose(log);
    line[strcspn(line, "\n")] = 0;
    const char *blank = strchr(line, ' ');
    snprintf(reason, 100, "%s", blank ? blank + 1 : "");
    return came;
}

static const char *complete(const Place *place, const Faults *faults, Attempt *attempt,
                            char words[300])
{
    ChildEnd end;
    attempt->fault = NULL;
    attempt->resumes = true;
    place_run(place, faults->run, attempt, &end);
    if (end.status != 0) {
        snprintf(words, 300, "--resume behind it fails: %.200s", end.errors);
        return words;
    }
    return place_judge_files(place, faults->run, &faults->reference, FILES_WHOLE, words);
}

static void count(Faults *faults, const Fault *fault, const char *wrong, bool whole, bool came,
                  const ChildEnd *end)
{
    FaultTally *tally = faults->tally;
    pthread_mutex_lock(&faults->lock);
    ++tally->injected;
    if (wrong) {
        ++tally->wrong;
        printf("FAULT: tractrix-%s, %s: TRACTRIX_FAULT=%s@%llx:%u: %s\n", faults->run->program,
               faults->run->name, fault->name, (unsigned long long)fault->site, fault->which,
               wrong);
        if (end->errors[0]) printf("    %s\n", end->errors);
        fflush(stdout);
    } else if (!came) {
        ++tally->missed;
    } else {
        ++*(whole ? &tally->managed : &tally->failed);
    }
    pthread_mutex_unlock(&faults->lock);
}

static void try_fault(const Place *place, Faults *faults, const Fault *fault)
{
    const TortureOptions *options = faults->options;
    char bin[4200], text[200], words[300], reason[100];
    ChildEnd end;
    bool whole;
    snprintf(bin, sizeof bin, "%s/faults", options->bin);
    snprintf(text, sizeof text, "%s@%llx:%u", fault->name, (unsigned long long)fault->site,
             fault->which);
    Attempt attempt = {.bin = bin, .fault = text, .limit_s = options->limit_s, .kill_after_s = -1};
    place_run(place, faults->run, &attempt, &end);
    bool came = read_reason(place, reason);
    const char *wrong = place_judge_end(faults->run, &end, reason, &whole, words);
    if (!wrong)
        wrong = place_judge_files(place, faults->run, &faults->reference,
                                  whole ? FILES_WHOLE : FILES_PARTIAL, words);
    if (!wrong && !whole && faults->run->grows) wrong = complete(place, faults, &attempt, words);
    count(faults, fault, wrong, whole, came, &end);
}

typedef struct Job {
    Faults *faults;
    Place place;
    pthread_t thread;
} Job;

static void *work(void *data)
{
    Job *job = data;
    Faults *faults = job->faults;
    for (;;) {
        pthread_mutex_lock(&faults->lock);
        int index = faults->next++;
        pthread_mutex_unlock(&faults->lock);
        if (index >= faults->count) return NULL;
        try_fault(&job->place, faults, &faults->list[index]);
    }
}

void faults_run(const Run *run, const TortureOptions *options, FaultTally *tally)
{
    Faults faults = {
        .run = run, .options = options, .lock = PTHREAD_MUTEX_INITIALIZER, .tally = tally};
    int jobs = options->jobs < JOBS_MOST ? options->jobs : JOBS_MOST;
    Job *list = take(calloc((size_t)jobs, sizeof *list));
    list_calls(&faults);
    for (int i = 0; i < jobs; ++i) {
        list[i].faults = &faults;
        place_create(&list[i].place, options->work, i + 1);
        pthread_create(&list[i].thread, NULL, work, &list[i]);
    }
    for (int i = 0; i < jobs; ++i) pthread_join(list[i].thread, NULL);
    folder_destroy(&faults.reference);
    free(faults.list);
    free(list);
}
