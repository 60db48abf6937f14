// SPDX-License-Identifier: MIT
#include "faults/place.h"

#include <ctype.h>
#include <glob.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

void place_create(Place *place, const char *work, int number)
{
    memset(place, 0, sizeof *place);
    snprintf(place->root, sizeof place->root, "%.4000s/%d", work, number);
    snprintf(place->run, sizeof place->run, "%s/run", place->root);
    snprintf(place->tmp, sizeof place->tmp, "%s/tmp", place->root);
    snprintf(place->log, sizeof place->log, "%s/log", place->root);
    folder_clear(place->root);
}

void place_run(const Place *place, const Run *run, const Attempt *attempt, ChildEnd *end)
{
    char text[1000], program[4200], fault[200], log[4300], tmp[4300];
    char *words[RUN_WORDS];
    run_words(run, text, words);
    for (int i = 0; attempt->resumes && !run->one_piece; ++i) {
        if (words[i] && strcmp(words[i], "--resume") == 0) break; // already in the run's arguments
        if (!words[i]) {
            words[i] = "--resume";
            words[i + 1] = NULL;
            break;
        }
    }
    if (!attempt->resumes) {
        folder_clear(place->run);
        folder_clear(place->tmp);
        remove(place->log);
    }
    snprintf(program, sizeof program, "%s/tractrix-%s", attempt->bin, run->program);
    snprintf(fault, sizeof fault, "TRACTRIX_FAULT=%s", attempt->fault ? attempt->fault : "");
    snprintf(log, sizeof log, "TRACTRIX_FAULT_LOG=%s", place->log);
    snprintf(tmp, sizeof tmp, "TMPDIR=%s", place->tmp);
    const char *names[] = {fault, log, tmp, NULL};
    child_run(&(Child){.folder = place->run,
                       .program = program,
                       .arguments = words,
                       .environment = names,
                       .limit_s = attempt->limit_s,
                       .kill_after_s = attempt->kill_after_s,
                       .kill_signal = attempt->kill_signal},
              end);
}

static bool is_worked_in(const char *folder)
{
    glob_t found = {0};
    char there[4300];
    bool any = false;
    glob("/proc/[0-9]*/cwd", 0, NULL, &found);
    for (size_t i = 0; i < found.gl_pathc && !any; ++i) {
        ssize_t size = readlink(found.gl_pathv[i], there, sizeof there - 1);
        there[size > 0 ? size : 0] = 0;
        any = strcmp(there, folder) == 0;
    }
    globfree(&found);
    return any;
}

void place_wait_left(const Place *place)
{
    char folder[PATH_MAX];
    if (!realpath(place->run, folder)) return;
    for (int i = 0; i < 1000 && is_worked_in(folder); ++i)
        nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL);
}

static bool is_listed(const char *list, const char *name)
{
    size_t length = strlen(name);
    for (const char *at = list; at && (at = strstr(at, name)); at += length)
        if ((at == list || at[-1] == ' ') && (!at[length] || at[length] == ' ')) return true;
    return false;
}

static bool has_end(const char *name, const char *end)
{
    size_t length = strlen(name), end_length = strlen(end);
    return length >= end_length && strcmp(name + length - end_length, end) == 0;
}

static bool may_be_partial(const Run *run, const char *name)
{
    return run->grows && (has_end(name, ".cache") || has_end(name, ".cache.state"));
}

// Whether files are equal from the pixels on: the texts before them name the processor, which a run
// may fail to find out.
static bool are_same_pixels(const FolderFile *a, const FolderFile *b)
{
    const char *from = memmem(a->bytes, a->size, "IDAT", 4);
    const char *at = memmem(b->bytes, b->size, "IDAT", 4);
    size_t size = from ? a->size - (size_t)(from - (const char *)a->bytes) : 0;
    size_t other = at ? b->size - (size_t)(at - (const char *)b->bytes) : 0;
    return size && size == other && memcmp(from, at, size) == 0;
}

// Whether files that contain times have the same first byte and the file does not end within a
// line.
static bool is_alike(const FolderFile *a, const FolderFile *b)
{
    if (has_end(a->name, ".png")) return are_same_pixels(a, b);
    return a->size > 0 && b->size > 0 && a->bytes[0] == b->bytes[0] &&
           a->bytes[a->size - 1] == b->bytes[b->size - 1];
}

// Whether the file is the beginning of a frame record (run/record.h), which has a line per finished
// frame: each line is one of the uninterrupted run's, and a truncated last line is ignored.
static bool is_record_begun(const FolderFile *wanted, const FolderFile *file)
{
    const unsigned char *line = file->bytes, *end = line + file->size;
    if (!has_end(file->name, ".scenes")) return false;
    for (const unsigned char *next; (next = memchr(line, '\n', (size_t)(end - line)));
         line = next + 1)
        if (!memmem(wanted->bytes, wanted->size, line, (size_t)(next + 1 - line))) return false;
    return true;
}

static const char *judge_file(const Run *run, const Folder *reference, const FolderFile *file,
                              FilesState state, char words[300])
{
    const FolderFile *wanted = folder_find(reference, file->name);
    if (state != FILES_WHOLE && may_be_partial(run, file->name)) return NULL;
    if (state == FILES_KILLED && strncmp(file->name, ".tractrix-", 10) == 0) return NULL;
    if (wanted && folder_same(wanted, file)) return NULL;
    if (wanted && state != FILES_WHOLE && is_record_begun(wanted, file)) return NULL;
    bool loose = is_listed(run->measured, file->name) || has_end(file->name, ".png");
    if (wanted && loose && is_alike(wanted, file)) return NULL;
    snprintf(words, 300, "%s: %s", file->name, wanted ? "not whole" : "left behind");
    return words;
}

const char *place_judge_files(const Place *place, const Run *run, const Folder *reference,
                              FilesState state, char words[300])
{
    Folder found, scratch;
    const char *wrong = NULL;
    folder_read(&found, place->run);
    folder_read(&scratch, place->tmp);
    for (int i = 0; i < found.count && !wrong; ++i)
        wrong = judge_file(run, reference, &found.files[i], state, words);
    for (int i = 0; i < reference->count && !wrong && state == FILES_WHOLE; ++i)
        if (!folder_find(&found, reference->files[i].name)) {
            snprintf(words, 300, "%s: missing", reference->files[i].name);
            wrong = words;
        }
    if (!wrong && state != FILES_KILLED && scratch.count) {
        snprintf(words, 300, "left behind in TMPDIR: %s", scratch.files[0].name);
        wrong = words;
    }
    folder_destroy(&found);
    folder_destroy(&scratch);
    return wrong;
}

// --- How a run ended.

static int count_lines(const char *text)
{
    int lines = 0;
    for (; *text; ++text) lines += *text == '\n';
    return lines;
}

// Checks an error line: the program's name first, a reason last.
static const char *judge_line(const Run *run, const char *line, const char *reason)
{
    char name[40];
    int length = snprintf(name, sizeof name, "tractrix-%s: ", run->program);
    size_t size = strlen(line);
    if (!size || line[size - 1] != '\n') return "no line of error";
    if (count_lines(line) != 1) return "more than one line of error";
    if (strncmp(line, name, (size_t)length) != 0) return "the line does not begin with the name";
    while (size && isspace((unsigned char)line[size - 1])) --size;
    if (line[size - 1] == ':' || line[size - 1] == '(') return "an empty reason";
    if (strstr(line, "(null)")) return "(null)";
    if (strstr(line, "Success")) return "a reason of success";
    for (size_t i = 0; i < size; ++i)
        if (iscntrl((unsigned char)line[i])) return "a control character";
    if (strcasestr(line, reason)) return NULL;
    // There are several messages for lack of memory.
    bool memory = strcasestr(reason, "memory");
    return memory && strcasestr(line, "memory") ? NULL : "the line does not give the reason";
}

// Skips the first line of tractrix-bench, which names the device.
static const char *skip_device(const Run *run, const char *errors)
{
    const char *end = strchr(errors, '\n');
    bool named = strcmp(run->program, "bench") == 0 && strncmp(errors, "tractrix-", 9) != 0;
    return named && end ? end + 1 : errors;
}

const char *place_judge_end(const Run *run, const ChildEnd *end, const char *reason, bool *whole,
                            char words[300])
{
    *whole = false;
    if (end->hung) return "hangs";
    if (end->status < 0) {
        snprintf(words, 300, "crashes: %s", strsignal(end->signal));
        return words;
    }
    *whole = end->status == run->status && (run->status == 0 || !end->errors[0]);
    if (end->status > 4 || (end->status == 0 && run->status != 0)) {
        snprintf(words, 300, "exit status %d", end->status);
        return words;
    }
    const char *errors = skip_device(run, end->errors);
    if (!*whole) return judge_line(run, errors, reason);
    return count_lines(errors) > 1 ? "says more than a line, but is done" : NULL;
}
