// SPDX-License-Identifier: MIT
#include "support/recorded.h"
#include "scene/scalp_guess.h"
#include "support/hair_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

enum { MOST_ARGUMENTS = 96 };

// The test fails with the name of the case.
#define NEEDED_BY(name, call)                                                                      \
    do {                                                                                           \
        Error error_ = {{0}};                                                                      \
        Error *error = &error_;                                                                    \
        if ((call) != RESULT_OK) fail_msg("%s: %s", name, error_.text);                            \
    } while (0)

void recorded_add(RecordedNumbers *numbers, float value)
{
    if (numbers->count == numbers->room) {
        numbers->room = 2 * numbers->room + 64;
        numbers->value = realloc(numbers->value, numbers->room * sizeof *numbers->value);
        assert_non_null(numbers->value);
    }
    numbers->value[numbers->count++] = value;
}

static FILE *open_set(const char *set, const char *suffix, const char *mode)
{
    char path[300];
    snprintf(path, sizeof path, "tests/data/recorded/%s%s", set, suffix);
    FILE *file = fopen(path, mode);
    if (!file) fail_msg("%s: cannot be opened: expected to run in the root of the project", path);
    return file;
}

// --- One case.

static void open_case(RecordedCase *recorded, char *line)
{
    // A scene needs an output. Nothing is written; a case may name another kind of file.
    char *arguments[MOST_ARGUMENTS + 1] = {"recorded", "-o", "frames_%04d.pfm"}, *rest = NULL;
    int count = 3;
    *recorded = (RecordedCase){.name = strtok_r(line, " \n", &rest), .gpu = fixture_gpu()};
    for (char *word; (word = strtok_r(NULL, " \n", &rest)) && count < MOST_ARGUMENTS;)
        arguments[count++] = word;
    gpu_timer_create(&recorded->timer, false, true);
    Scene *scene = &recorded->scene;
    Assets *assets = &recorded->assets;
    NEEDED_BY(recorded->name, scene_from_arguments(scene, count, arguments, error));
    scene->run.sdf_cache = false;
    NEEDED_BY(recorded->name, assets_load(assets, scene, NULL, false, error));
    NEEDED_BY(recorded->name, scalp_guess(scene, assets, NULL, false, error));
    outline_frame(&recorded->framing, scene, assets->strands, assets->meshes);
    NEEDED_BY(recorded->name,
              simulation_create(&recorded->simulation, recorded->gpu, &recorded->timer, scene,
                                assets->strands, assets->meshes, error));
    while (simulation_settle(&recorded->simulation)) continue;
    simulation_pose(&recorded->simulation);
}

static void close_case(RecordedCase *recorded)
{
    simulation_destroy(&recorded->simulation);
    gpu_timer_destroy(&recorded->timer);
    assets_destroy(&recorded->assets);
    scene_destroy(&recorded->scene);
}

// --- Comparison.

static double root_mean_square(const RecordedNumbers *numbers)
{
    double sum = 0;
    for (size_t i = 0; i < numbers->count; ++i)
        sum += (double)numbers->value[i] * (double)numbers->value[i];
    return numbers->count ? sqrt(sum / (double)numbers->count) : 0;
}

static void read_numbers(char *line, RecordedNumbers *numbers)
{
    char *end = line;
    for (;;) {
        float value = strtof(line, &end);
        if (end == line) break;
        recorded_add(numbers, value);
        line = end;
    }
}

// The largest difference in units of the limit; *at: where.
static double compare(const RecordedNumbers *now, const RecordedNumbers *then, double relative,
                      double absolute, size_t *at)
{
    double most = 0, scale = root_mean_square(then);
    *at = 0;
    if (now->count != then->count) return INFINITY;
    for (size_t i = 0; i < now->count; ++i) {
        double recorded = (double)then->value[i];
        double difference = fabs((double)now->value[i] - recorded);
        double limit = relative * fabs(recorded) + absolute * scale;
        double share = difference == 0 ? 0 : difference / limit;
        if (!(share <= most)) most = share, *at = i;
    }
    return most;
}

static char *find_line(char *text, const char *name)
{
    size_t length = strlen(name);
    for (char *line = text; line && *line; line = strchr(line, '\n'), line += line ? 1 : 0)
        if (strncmp(line, name, length) == 0 && line[length] == ' ') return line + length;
    return NULL;
}

// The driver's name without the width of its vectors and the processor's instructions, with which
// results hardly differ.
static bool is_same_driver(char *text)
{
    const char *platform = fixture_gpu()->platform;
    const char *recorded = find_line(text, "platform");
    size_t length = strcspn(platform, "-");
    const char *rest = strchr(platform + length + (platform[length] ? 1 : 0), '-');
    if (rest) length = (size_t)(rest - platform);
    return recorded && strncmp(recorded + 1, platform, length) == 0;
}

static bool check_case(const char *name, const RecordedNumbers *now, char *line,
                       const RecordedLimits *limits, bool same)
{
    RecordedNumbers then = {0};
    char *end = line ? strchr(line, '\n') : NULL;
    size_t at = 0;
    if (end) *end = 0;
    if (line) read_numbers(line, &then);
    if (end) *end = '\n';
    double share = compare(now, &then, (double)(same ? limits->relative : limits->other_relative),
                           (double)(same ? limits->absolute : limits->other_absolute), &at);
    bool differs = !(share <= 1);
    if (differs || (getenv("RECORD_SHARES") && share > 0)) {
        if (now->count == then.count)
            print_message("%s: %.3g of the limit at number %zu: %.9g, recorded %.9g\n", name, share,
                          at, (double)now->value[at], (double)then.value[at]);
        else
            print_message("%s: %zu numbers, recorded %zu\n", name, now->count, then.count);
    }
    free(then.value);
    return !differs;
}

static void write_case(FILE *file, const char *name, const RecordedNumbers *numbers)
{
    fprintf(file, "%s", name);
    for (size_t i = 0; i < numbers->count; ++i) fprintf(file, " %.7g", (double)numbers->value[i]);
    fprintf(file, "\n");
}

void recorded_check(const char *set, const RecordedLimits *limits,
                    void (*reduce)(RecordedCase *recorded, RecordedNumbers *numbers))
{
    bool records = getenv("RECORD") != NULL;
    const char *only =
        records ? NULL : getenv("RECORD_ONLY"); // a part would replace the whole record
    FILE *cases = open_set(set, ".txt", "r");
    FILE *values = open_set(set, ".values", records ? "w" : "r");
    char *line = NULL, *text = NULL;
    size_t room = 0, text_room = 0;
    int failed = 0, count = 0;
    if (records) fprintf(values, "platform %s\n", fixture_gpu()->platform);
    if (!records && getdelim(&text, &text_room, 0, values) < 0) fail_msg("%s: no values", set);
    const bool same = fixture_rounding() == 1 && (records || is_same_driver(text));
    if (!same) print_message("another driver than the recorded one: wider limits\n");
    while (getline(&line, &room, cases) >= 0) {
        if (*line == '#' || *line == '\n' || (only && !strstr(line, only))) continue;
        RecordedCase recorded;
        RecordedNumbers numbers = {0};
        double began = (double)clock() / CLOCKS_PER_SEC;
        open_case(&recorded, line);
        reduce(&recorded, &numbers);
        if (records)
            write_case(values, recorded.name, &numbers);
        else
            failed +=
                !check_case(recorded.name, &numbers, find_line(text, recorded.name), limits, same);
        ++count;
        if (getenv("RECORD_SHARES"))
            print_message("%s: processor %.2f s\n", recorded.name,
                          (double)clock() / CLOCKS_PER_SEC - began);
        free(numbers.value);
        close_case(&recorded);
    }
    fclose(cases);
    fclose(values);
    free(line);
    free(text);
    if (failed || !count)
        fail_msg("%d of %d cases of tests/data/recorded/%s.txt differ from %s.values", failed,
                 count, set, set);
}
