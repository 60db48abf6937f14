// SPDX-License-Identifier: MIT
#include "faults/kills.h"

#include "base/random.h"
#include "faults/place.h"

#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const int SIGNALS[] = {SIGKILL, SIGTERM, SIGINT};
static const double LOADING_S = 0.05;

typedef struct Kills {
    const Run *run;
    const TortureOptions *options;
    Place place;
    Folder reference;
    double seconds; // of an uninterrupted run
} Kills;

static void run_undisturbed(Kills *kills)
{
    ChildEnd end;
    place_create(&kills->place, kills->options->work, 0);
    for (int i = 0; i < 3; ++i) {
        place_run(&kills->place, kills->run,
                  &(Attempt){.bin = kills->options->bin,
                             .limit_s = 10 * kills->options->limit_s,
                             .kill_after_s = -1},
                  &end);
        if (i == 0 || end.seconds < kills->seconds) kills->seconds = end.seconds;
    }
    if (end.status != 0) {
        fprintf(stderr, "torture: tractrix-%s, %s: undisturbed it fails: %s\n", kills->run->program,
                kills->run->name, end.errors);
        exit(1);
    }
    folder_read(&kills->reference, kills->place.run);
}

// Judges the end by a signal that can be caught: the program must report it, unless it had
// finished. In the first milliseconds, while libraries are loaded, no handler is installed.
static const char *judge_interrupted(const Kills *kills, int signal, const ChildEnd *end,
                                     bool *late, char words[300])
{
    *late = end->status == 0;
    if (end->hung) return "hangs";
    if (end->status < 0 && end->signal == signal && end->seconds < LOADING_S)
        return place_judge_files(&kills->place, kills->run, &kills->reference, FILES_PARTIAL,
                                 words);
    if (end->status != 0 && end->status != 130) {
        snprintf(words, 300, "status %d, signal %d", end->status, end->signal);
        return words;
    }
    if (!*late && !strstr(end->errors, "interrupted")) return "does not say 'interrupted'";
    return place_judge_files(&kills->place, kills->run, &kills->reference,
                             *late ? FILES_WHOLE : FILES_PARTIAL, words);
}

static const char *judge_killed(const Kills *kills, const ChildEnd *end, bool *late,
                                char words[300])
{
    *late = end->status == 0;
    if (end->hung) return "hangs";
    if (!*late && end->signal != SIGKILL) return "has failed of itself";
    return place_judge_files(&kills->place, kills->run, &kills->reference,
                             *late ? FILES_WHOLE : FILES_KILLED, words);
}

// Runs the same command again without interruption.
static const char *judge_resumed(const Kills *kills, char words[300])
{
    ChildEnd end;
    place_run(&kills->place, kills->run,
              &(Attempt){.bin = kills->options->bin,
                         .resumes = true,
                         .limit_s = 10 * kills->options->limit_s,
                         .kill_after_s = -1},
              &end);
    if (end.status != 0) {
        snprintf(words, 300, "--resume fails: %.200s", end.errors);
        return words;
    }
    const char *wrong =
        place_judge_files(&kills->place, kills->run, &kills->reference, FILES_WHOLE, words);
    if (wrong && wrong == words) memmove(words + 9, words, 290), memcpy(words, "resumed: ", 9);
    return wrong;
}

static void kill_once(Kills *kills, int which, double after_s, KillTally *tally)
{
    ChildEnd end;
    char words[300] = "";
    bool late;
    place_run(&kills->place, kills->run,
              &(Attempt){.bin = kills->options->bin,
                         .limit_s = kills->options->limit_s,
                         .kill_after_s = after_s,
                         .kill_signal = SIGNALS[which]},
              &end);
    const char *wrong = which == 0 ? judge_killed(kills, &end, &late, words)
                                   : judge_interrupted(kills, SIGNALS[which], &end, &late, words);
    place_wait_left(&kills->place); // ffmpeg ends shortly after the killed run
    if (!wrong) wrong = judge_resumed(kills, words);
    ++tally->kills;
    ++tally->by[which];
    tally->late += late;
    if (!wrong) return;
    ++tally->wrong;
    printf("KILL: tractrix-%s, %s: %s after %.6f of %.6f s: %s\n", kills->run->program,
           kills->run->name, strsignal(SIGNALS[which]), after_s, kills->seconds, wrong);
    if (end.errors[0]) printf("    %s\n", end.errors);
}

void kills_run(const Run *run, const TortureOptions *options, KillTally *tally)
{
    static const int turns[] = {0, 1, 0, 2};
    Kills kills = {.run = run, .options = options};
    Random random = random_create(options->seed, (uint64_t)(run - RUN_KILLED));
    run_undisturbed(&kills);
    for (int i = 0; i < options->kills; ++i)
        kill_once(&kills, turns[i % 4], kills.seconds * random_real(&random), tally);
    folder_destroy(&kills.reference);
}
