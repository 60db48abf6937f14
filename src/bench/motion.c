// SPDX-License-Identifier: MIT
#include "bench/motion.h"
#include "base/csv.h"
#include "base/json.h"

#include <glob.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_PARTICLES = 1024 };

void motion_destroy(Motion *motion)
{
    free(motion->name);
    free(motion->frames);
    free(motion->points);
    *motion = (Motion){0};
}

double motion_root(const Motion *motion, double t)
{
    const double turn = 6.283185307179586;
    return motion->root_amplitude * (1 - cos(turn * motion->root_frequency * t));
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

static Result read_description(Motion *motion, const JsonPlace *place, const json_t *object,
                               Error *error)
{
    const json_t *root = json_object_get(object, "root_motion");
    const JsonPlace root_place = {place, "root_motion", 0};
    double n = 0;
    Result result = read_number(place, object, "n", 2, MOST_PARTICLES, &n, error);
    motion->n = (int)n;
    if (result == RESULT_OK)
        result = read_number(place, object, "strand_length", 1e-6, 1e6, &motion->length, error);
    if (result == RESULT_OK)
        result = read_number(place, object, "drag_c", 0, 1e6, &motion->drag, error);
    if (result == RESULT_OK) result = read_vector(place, object, "gravity", motion->gravity, error);
    if (result == RESULT_OK) result = read_vector(place, object, "wind", motion->wind, error);
    if (result == RESULT_OK)
        result = read_number(&root_place, root, "amp", -1e3, 1e3, &motion->root_amplitude, error);
    if (result == RESULT_OK)
        result = read_number(&root_place, root, "freq", 0, 1e6, &motion->root_frequency, error);
    return result;
}

static Result allocate(Motion *motion, const Csv *csv, Error *error)
{
    if (csv->row_count < 2 || csv->column_count != 2 + 3 * (size_t)motion->n)
        return error_set(
            error, RESULT_BAD_INPUT,
            "%s: expected a start, frames and %d columns, got %zu rows and %zu columns", csv->path,
            2 + 3 * motion->n, csv->row_count, csv->column_count);
    motion->frame_count = csv->row_count;
    motion->frames = calloc(csv->row_count, sizeof *motion->frames);
    motion->points = calloc(csv->row_count * (size_t)motion->n, sizeof *motion->points);
    if (motion->frames && motion->points) return RESULT_OK;
    return error_set(error, RESULT_FAILED, "%s: no memory for its frames", csv->path);
}

static Result read_frame(Motion *motion, size_t row, const Csv *csv, const json_t *floors,
                         Error *error)
{
    MotionFrame *frame = &motion->frames[row];
    double number = 0;
    frame->points = &motion->points[row * (size_t)motion->n];
    Result result = csv_number(csv, row, 0, &number, error);
    if (result == RESULT_OK) result = csv_number(csv, row, 1, &frame->time, error);
    for (size_t i = 0; result == RESULT_OK && i < 3 * (size_t)motion->n; ++i)
        result = csv_number(csv, row, 2 + i, &frame->points[i / 3][i % 3], error);
    if (result != RESULT_OK) return result;
    const json_t *floor = number >= 0 ? json_array_get(floors, (size_t)number) : NULL;
    if (!json_is_number(floor))
        return error_set(error, RESULT_BAD_INPUT,
                         "%s: frame %g has no float32_floor_rms_over_length_per_frame in the JSON "
                         "file beside it",
                         csv->path, number);
    frame->followed = json_number_value(floor) <= MOTION_FLOOR;
    return RESULT_OK;
}

static Result read_frames(Motion *motion, const char *path, const json_t *floors, Error *error)
{
    Csv csv = {0};
    Result result = csv_read(&csv, path, error);
    if (result == RESULT_OK) result = allocate(motion, &csv, error);
    for (size_t row = 0; result == RESULT_OK && row < csv.row_count; ++row)
        result = read_frame(motion, row, &csv, floors, error);
    csv_destroy(&csv);
    return result;
}

Result motion_read(Motion *motion, const char *folder, const char *name, Error *error)
{
    char path[4096];
    json_error_t problem;
    *motion = (Motion){0};
    snprintf(path, sizeof path, "%s/%s.json", folder, name);
    json_t *object = json_load_file(path, 0, &problem);
    if (!object)
        return error_set(error, RESULT_BAD_INPUT, "%s:%d: %s", path, problem.line, problem.text);
    motion->name = strdup(name);
    Result result = motion->name
                        ? read_description(motion, &(JsonPlace){.key = path}, object, error)
                        : error_set(error, RESULT_FAILED, "%s: no memory for its name", path);
    snprintf(path, sizeof path, "%s/%s.csv", folder, name);
    if (result == RESULT_OK)
        result =
            read_frames(motion, path,
                        json_object_get(object, "float32_floor_rms_over_length_per_frame"), error);
    json_decref(object);
    if (result != RESULT_OK) motion_destroy(motion);
    return result;
}

// The file's name without folder and ending if it is a motion's, else NULL; malloc'ed.
static char *motion_name(const char *path)
{
    const char *base = strrchr(path, '/') + 1;
    size_t stem = strlen(path) - strlen(".json");
    char *csv = malloc(strlen(path) + 1), *name = NULL;
    if (!csv) return NULL;
    snprintf(csv, strlen(path) + 1, "%.*s.csv", (int)stem, path);
    json_t *object = access(csv, R_OK) == 0 ? json_load_file(path, 0, NULL) : NULL;
    if (json_object_get(object, "root_motion"))
        name = strndup(base, strlen(base) - strlen(".json"));
    json_decref(object);
    free(csv);
    return name;
}

void motion_names_destroy(char **names, size_t count)
{
    for (size_t i = 0; names && i < count; ++i) free(names[i]);
    free(names);
}

Result motion_list(char ***names, size_t *count, const char *folder, Error *error)
{
    char pattern[4096];
    glob_t found = {0};
    *names = NULL, *count = 0;
    snprintf(pattern, sizeof pattern, "%s/*.json", folder);
    int status = glob(pattern, 0, NULL, &found);
    if (status == 0) *names = calloc(found.gl_pathc, sizeof **names);
    for (size_t i = 0; *names && i < found.gl_pathc; ++i) {
        char *name = motion_name(found.gl_pathv[i]);
        if (name) (*names)[(*count)++] = name;
    }
    globfree(&found);
    if (*count > 0) return RESULT_OK;
    motion_names_destroy(*names, 0);
    *names = NULL;
    return error_set(error, RESULT_BAD_INPUT,
                     "%s: no reference motions there (NAME.csv with NAME.json)", folder);
}
