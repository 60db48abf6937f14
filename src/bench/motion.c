// SPDX-License-Identifier: MIT
#include "bench/motion.h"
#include "base/json.h"

#include <glob.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_PARTICLES = 1024 };

// --- Reading.

void motion_destroy(Motion *motion)
{
    free(motion->name);
    free(motion->frames);
    free(motion->points);
    *motion = (Motion){0};
}

static Result read_number(const JsonPlace *place, const json_t *object, const char *key,
                          double least, double most, double *value, Error *error)
{
    const JsonPlace member = {place, key, 0};
    return json_read_number(&member, json_object_get(object, key), least, most, "a number", value,
                            error);
}

static Result read_vector(const JsonPlace *place, const json_t *object, const char *key,
                          float *value, Error *error)
{
    const JsonPlace member = {place, key, 0};
    return json_read_vector(&member, json_object_get(object, key), 3, -1e6, 1e6, "a vector", value,
                            error);
}

static Result read_description(Motion *motion, const char *path, const json_t *object, Error *error)
{
    const json_t *root = json_object_get(object, "root_motion");
    const JsonPlace place = {.key = path}, root_place = {&place, "root_motion", 0};
    double n = 0;
    TRY(read_number(&place, object, "n", 2, MOST_PARTICLES, &n, error));
    motion->n = (int)n;
    TRY(read_number(&place, object, "strand_length", 1e-6, 1e6, &motion->length, error));
    TRY(read_number(&place, object, "drag_c", 0, 1e6, &motion->drag, error));
    TRY(read_vector(&place, object, "gravity", motion->gravity, error));
    TRY(read_vector(&place, object, "wind", motion->wind, error));
    TRY(read_number(&root_place, root, "amp", -1e3, 1e3, &motion->root_amplitude, error));
    return read_number(&root_place, root, "freq", 0, 1e6, &motion->root_frequency, error);
}

static Result read_frame(Motion *motion, size_t row, const Csv *csv, const json_t *floors,
                         Error *error)
{
    MotionFrame *frame = &motion->frames[row];
    double number = 0;
    frame->points = &motion->points[row * (size_t)motion->n];
    TRY(csv_number(csv, row, 0, &number, error));
    TRY(csv_number(csv, row, 1, &frame->time, error));
    for (size_t i = 0; i < 3 * (size_t)motion->n; ++i)
        TRY(csv_number(csv, row, 2 + i, &frame->points[i / 3][i % 3], error));
    const json_t *floor = number >= 0 ? json_array_get(floors, (size_t)number) : NULL;
    if (!json_is_number(floor))
        return error_set(error, RESULT_BAD_INPUT,
                         "%s: frame %g has no float32_floor_rms_over_length_per_frame in the JSON "
                         "file beside it",
                         csv->path, number);
    frame->followed = json_number_value(floor) <= MOTION_FLOOR;
    return RESULT_OK;
}

static Result read_frames(Motion *motion, const Csv *csv, const json_t *floors, Error *error)
{
    if (csv->row_count < 2 || csv->column_count != 2 + 3 * (size_t)motion->n)
        return error_set(
            error, RESULT_BAD_INPUT,
            "%s: expected a start, frames and %d columns, got %zu rows and %zu columns", csv->path,
            2 + 3 * motion->n, csv->row_count, csv->column_count);
    motion->frame_count = csv->row_count;
    motion->frames = calloc(csv->row_count, sizeof *motion->frames);
    motion->points = calloc(csv->row_count * (size_t)motion->n, sizeof *motion->points);
    if (!motion->frames || !motion->points)
        return error_set(error, RESULT_FAILED, "%s: no memory for frames", csv->path);
    for (size_t row = 0; row < csv->row_count; ++row)
        TRY(read_frame(motion, row, csv, floors, error));
    return RESULT_OK;
}

Result motion_read(Motion *motion, const char *folder, const char *name, Error *error)
{
    char path[4096];
    json_error_t problem;
    Csv csv = {0};
    *motion = (Motion){0};
    snprintf(path, sizeof path, "%s/%s.json", folder, name);
    json_t *object = json_load_file(path, 0, &problem);
    if (!object)
        return error_set(error, RESULT_BAD_INPUT, "%s:%d: %s", path, problem.line, problem.text);
    motion->name = strdup(name);
    Result result = motion->name
                        ? read_description(motion, path, object, error)
                        : error_set(error, RESULT_FAILED, "%s: no memory for its name", path);
    snprintf(path, sizeof path, "%s/%s.csv", folder, name);
    THEN(result, csv_read(&csv, path, error));
    const char *floors = "float32_floor_rms_over_length_per_frame";
    THEN(result, read_frames(motion, &csv, json_object_get(object, floors), error));
    csv_destroy(&csv);
    json_decref(object);
    if (result != RESULT_OK) motion_destroy(motion);
    return result;
}

// Whether FOLDER/NAME.json is a motion's.
static bool is_motion(const char *folder, const char *name)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s.csv", folder, name);
    if (access(path, R_OK) != 0) return false;
    snprintf(path, sizeof path, "%s/%s.json", folder, name);
    json_t *object = json_load_file(path, 0, NULL);
    bool found = json_object_get(object, "root_motion") != NULL;
    json_decref(object);
    return found;
}

static const char *const MEAN_OF[] = {
    "a_horizontal_n16_c0", "a_horizontal_n16_c1", "a_horizontal_n16_c4", "b_curly_n16_c0",
    "b_curly_n16_c1",      "b_curly_n16_c4",      "c_root2Hz_n16_c0",    "c_root2Hz_n16_c1",
    "c_root2Hz_n16_c4",    "d_wind_n16_c1",       "d_wind_n16_c4",       "a_horizontal_n32_c1",
    "bd_curly_wind_n16_c4"};
enum { MEAN_COUNT = sizeof MEAN_OF / sizeof *MEAN_OF };

static bool is_stated_for(const Motion *motion)
{
    for (int i = 0; i < MEAN_COUNT; ++i)
        if (strcmp(MEAN_OF[i], motion->name) == 0) return true;
    return false;
}

bool motion_in_mean(const MotionFolder *folder, const Motion *motion)
{
    return !folder->whole || is_stated_for(motion);
}

static Result read_motions(MotionFolder *folder, const glob_t *found, Error *error)
{
    int in_mean = 0;
    folder->motions = calloc(found->gl_pathc + 1, sizeof *folder->motions);
    if (!folder->motions) return error_set(error, RESULT_FAILED, "no memory for motions");
    for (size_t i = 0; i < found->gl_pathc; ++i) {
        char *name = strrchr(found->gl_pathv[i], '/') + 1;
        name[strlen(name) - strlen(".json")] = 0;
        if (!is_motion(folder->path, name)) continue;
        TRY(motion_read(&folder->motions[folder->count], folder->path, name, error));
        in_mean += is_stated_for(&folder->motions[folder->count++]);
    }
    folder->whole = in_mean == MEAN_COUNT;
    if (folder->count > 0) return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT,
                     "%s: no reference motions there (NAME.csv with NAME.json)", folder->path);
}

Result motion_read_folder(MotionFolder *folder, const char *path, Error *error)
{
    static const char *const pendulums[] = {"e_pendulum_planar", "e_pendulum_3d"};
    char file[4096];
    glob_t found = {0};
    *folder = (MotionFolder){.path = path};
    snprintf(file, sizeof file, "%s/*.json", path);
    glob(file, 0, NULL, &found);
    Result result = read_motions(folder, &found, error);
    globfree(&found);
    snprintf(file, sizeof file, "%s/static_style.json", path);
    folder->styles = json_load_file(file, 0, NULL);
    for (int i = 0; i < 2; ++i) {
        snprintf(file, sizeof file, "%s/%s.json", path, pendulums[i]);
        folder->starts[i] = json_load_file(file, 0, NULL);
        snprintf(file, sizeof file, "%s/%s.csv", path, pendulums[i]);
        if (access(file, R_OK) == 0) THEN(result, csv_read(&folder->pendulums[i], file, error));
    }
    return result;
}

void motion_destroy_folder(MotionFolder *folder)
{
    for (size_t i = 0; i < folder->count; ++i) motion_destroy(&folder->motions[i]);
    free(folder->motions);
    json_decref(folder->styles);
    for (int i = 0; i < 2; ++i) {
        csv_destroy(&folder->pendulums[i]);
        json_decref(folder->starts[i]);
    }
    *folder = (MotionFolder){0};
}

// --- Following.

double motion_root(const Motion *motion, double t)
{
    const double turn = 6.283185307179586;
    return motion->root_amplitude * (1 - cos(turn * motion->root_frequency * t));
}

Result motion_start(Trial *trial, const Gpu *gpu, const Motion *motion, const SectionParams *params,
                    double rate, Error *error)
{
    SectionParams own = *params; // its strings are borrowed
    Strands strands;
    own.drag = (float)motion->drag;
    *trial = (Trial){0};
    TRY(trial_make_strands(&strands, (const double(*)[3])motion->points, 1, motion->n, error));
    Result result = trial_create(trial, gpu, &strands, 0, &own, rate, error);
    strands_destroy(&strands);
    memcpy(trial->step.gravity, motion->gravity, sizeof motion->gravity);
    for (int i = 0; i < 4; ++i) memcpy(trial->step.wind[i], motion->wind, sizeof motion->wind);
    return result;
}

void motion_advance(Trial *trial, const Motion *motion, double time)
{
    while ((double)trial->steps < time * trial->rate - 0.01) {
        double end = (double)(trial->steps + 1) * trial->step.dt;
        if (motion) trial->step.head.translation[0] = (float)motion_root(motion, end);
        trial_step(trial);
    }
}

Result motion_follow(Trial *trial, const Motion *motion, double *error_over_length, Error *error)
{
    double sum = 0;
    long counted = 0;
    for (size_t f = 1; f < motion->frame_count; ++f) {
        const MotionFrame *frame = &motion->frames[f];
        double mean = 0;
        motion_advance(trial, motion, frame->time);
        if (!frame->followed || fabs((double)trial->steps - frame->time * trial->rate) > 0.01)
            continue;
        TRY(trial_read(trial, error));
        for (int j = 1; j < motion->n; ++j)
            for (int k = 0; k < 3; ++k) {
                double r = (double)trial->points[j][k] - frame->points[j][k];
                mean += r * r / (motion->n - 1);
            }
        sum += mean, ++counted;
    }
    *error_over_length = counted ? sqrt(sum / (double)counted) / motion->length : NAN;
    return RESULT_OK;
}

Result motion_error(double *error_over_length, const Gpu *gpu, const Motion *motion,
                    const SectionParams *params, double rate, Error *error)
{
    Trial trial;
    Result result = motion_start(&trial, gpu, motion, params, rate, error);
    THEN(result, motion_follow(&trial, motion, error_over_length, error));
    trial_destroy(&trial);
    return result;
}
