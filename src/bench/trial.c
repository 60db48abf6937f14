// SPDX-License-Identifier: MIT
#include "bench/trial.h"
#include "base/json.h"

#include <glob.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// --- Methods.

bool trial_takes(const ParamInfo *info)
{
    static const char *const other[] = {"algo",   "variant",         "followers",
                                        "follow", "follower_radius", "tip_separation",
                                        "clump",  "sleep",           "volume"};
    for (size_t i = 0; i < sizeof other / sizeof *other; ++i)
        if (strcmp(info->name, other[i]) == 0) return false;
    return info->scope == SCOPE_SECTION && info->group == GROUP_SIMULATION;
}

bool trial_has(const Method *method, const char *param)
{
    return params_owned_by(params_find(param), method->algo);
}

bool trial_is_default(const Method *method)
{
    return !*method->variant && !*method->settings;
}

static Result set_param(SectionParams *params, const char *name, const char *text, Error *error)
{
    const ParamInfo *info = params_find(name);
    if (!info) return error_set(error, RESULT_USAGE, "--%s: no such parameter", name);
    Result result = params_parse(info, params, text, error);
    return result == RESULT_OK ? result : error_prefix(error, result, "--%s: ", name);
}

// Applies a text of flags, each followed by its value.
static Result apply(SectionParams *params, char *words, Error *error)
{
    char *rest = NULL;
    for (char *flag = strtok_r(words, " ", &rest); flag; flag = strtok_r(NULL, " ", &rest)) {
        const char *value = strtok_r(NULL, " ", &rest);
        if (strncmp(flag, "--", 2) != 0 || !value)
            return error_set(error, RESULT_USAGE, "settings: got '%s', expected --OPTION VALUE",
                             flag);
        TRY(set_param(params, flag + 2, value, error));
    }
    return RESULT_OK;
}

static Result apply_text(SectionParams *params, const char *text, Error *error)
{
    char words[4096];
    if (snprintf(words, sizeof words, "%s", text) >= (int)sizeof words)
        return error_set(error, RESULT_USAGE, "settings: too long: expected at most %zu bytes",
                         sizeof words);
    return apply(params, words, error);
}

Result trial_apply(SectionParams *params, const Method *method, Error *error)
{
    TRY(set_param(params, "algo", method->algo, error));
    TRY(set_param(params, "variant", method->variant, error));
    TRY(apply_text(params, method->settings, error));
    return solver_check(params, error);
}

Result trial_params(SectionParams *params, const Method *method, const char *before, Error *error)
{
    *params = (SectionParams){0};
    TRY(params_create_section(params, error));
    TRY(scene_apply_presets(&(Presets){.look = "plain"}, SCOPE_SECTION, params, error));
    if (strcmp(method->algo, "rod") == 0) TRY(set_param(params, "style", "0", error));
    TRY(apply_text(params, before, error));
    return trial_apply(params, method, error);
}

const char *trial_variant(const Method *method)
{
    if (*method->variant) return method->variant;
    for (const SolverType *const *type = SOLVER_TYPES; *type; ++type)
        if (strcmp((*type)->name, method->algo) == 0 && (*type)->variants[0])
            return (*type)->variants[0];
    return "";
}

void trial_format(const Method *method, char *text, size_t size)
{
    const char *variant = trial_variant(method);
    snprintf(text, size, "--algo %s%s%s%s%s", method->algo, *variant ? " --variant " : "", variant,
             *method->settings ? " " : "", method->settings);
}

// Finds the solver whose name begins the text and ends at a comma or at the end of the text.
static const SolverType *find_type(const char *word)
{
    size_t length = strcspn(word, ",");
    for (const SolverType *const *type = SOLVER_TYPES; *type; ++type)
        if (strlen((*type)->name) == length && strncmp((*type)->name, word, length) == 0)
            return *type;
    return NULL;
}

int trial_list(const Method *asked, Method methods[METHODS_MOST])
{
    int count = 0;
    for (const char *at = asked->algo; at && count < METHODS_MOST; at = strchr(at, ',')) {
        at += *at == ',';
        const SolverType *type = find_type(at);
        if (type) methods[count++] = (Method){type->name, asked->variant, asked->settings};
    }
    if (asked->algo) return count;
    for (const SolverType *const *type = SOLVER_TYPES; *type && count < METHODS_MOST; ++type)
        if (!solver_is_static(*type))
            methods[count++] = (Method){(*type)->name, "", asked->settings};
    return count;
}

// --- Trials.

Result trial_create(Trial *trial, const Gpu *gpu, const Strands *strands, uint32_t first_id,
                    const SectionParams *params, double rate, Error *error)
{
    *trial = (Trial){.params = *params,
                     .rate = rate,
                     .step = {.dt = 1 / rate, .first = true, .gravity = {0, -9.81f, 0}}};
    trial->step.head.rotation[3] = trial->step.head_old.rotation[3] = 1;
    gpu_timer_create(&trial->timer, false, true);
    TRY(hair_create(&trial->hair, strands, first_id, &gpu->limits, error));
    trial->points = calloc(trial->hair.particle_count, sizeof *trial->points);
    if (!trial->points) return error_set(error, RESULT_FAILED, "no memory for positions");
    const SolverSetup setup = {
        .gpu = gpu, .timer = &trial->timer, .hair = &trial->hair, .params = &trial->params};
    return solver_create(&trial->solver, &setup, error);
}

void trial_destroy(Trial *trial)
{
    solver_destroy(&trial->solver);
    hair_destroy(&trial->hair);
    gpu_timer_destroy(&trial->timer);
    free(trial->points);
    *trial = (Trial){0};
}

void trial_step(Trial *trial)
{
    solver_step(&trial->solver, &trial->step);
    trial->step.head_old = trial->step.head;
    trial->step.first = false;
    ++trial->step.number;
    ++trial->steps;
}

Result trial_read(Trial *trial, Error *error)
{
    solver_pose(&trial->solver, &trial->step.head);
    return hair_read_positions(&trial->hair, trial->points, error);
}

const GpuBuffer *trial_buffer(const Trial *trial, uint32_t batch, SolverBufferKind kind)
{
    SolverBuffer buffers[SOLVER_MAX_BUFFERS];
    int count = solver_buffers(&trial->solver, batch, buffers);
    for (int i = 0; i < count; ++i)
        if (buffers[i].kind == kind) return buffers[i].buffer;
    return NULL;
}

bool trial_read_tip(const Trial *trial, uint32_t batch, uint32_t strand, float tip[2][4])
{
    const GpuBuffer *tips = trial_buffer(trial, batch, SOLVER_TIPS);
    if (!tips) return false;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, tips->buffer);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, (GLintptr)(strand * sizeof(float[2][4])),
                       sizeof(float[2][4]), tip);
    return true;
}

Result trial_make_strands(Strands *strands, const double (*points)[3], uint32_t count, int n,
                          Error *error)
{
    uint32_t total = count * (uint32_t)n;
    TRY(strands_create(strands, count, total, error));
    for (uint32_t s = 0; s <= count; ++s) strands->first[s] = s * (uint32_t)n;
    for (uint32_t i = 0; i < 3 * total; ++i)
        strands->position[i / 3][i % 3] = (float)points[i / 3][i % 3];
    return RESULT_OK;
}

void trial_make_beam(double (*points)[3], int n, double length)
{
    for (int j = 0; j < n; ++j)
        points[j][0] = length * j / (n - 1), points[j][1] = points[j][2] = 0;
}

// A helix with segments of equal length: `turns` turns of a circle across the axis; the remaining
// length goes along the axis.
void trial_make_helix(double (*points)[3], int n, double length, double turns)
{
    const double radius = 0.02, along[3] = {0.6, -0.8, 0}, up[3] = {0.8, 0.6, 0};
    double angle = 6.283185307179586 * turns / (n - 1), l = length / (n - 1);
    double chord = 2 * radius * sin(angle / 2), rise = sqrt(fmax(l * l - chord * chord, 0));
    for (int j = 0; j < n; ++j) {
        double x = rise * j, y = radius * (cos(angle * j) - 1), z = radius * sin(angle * j);
        for (int k = 0; k < 3; ++k) points[j][k] = x * along[k] + y * up[k] + (k == 2 ? z : 0);
    }
}

// --- Exact motions.

enum { MOST_PARTICLES = 1024 };

void trial_destroy_motion(Motion *motion)
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

Result trial_read_motion(Motion *motion, const char *folder, const char *name, Error *error)
{
    char path[4096];
    Csv csv = {0};
    json_t *object;
    *motion = (Motion){0};
    snprintf(path, sizeof path, "%s/%s.json", folder, name);
    TRY(json_load(&object, path, error));
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
    if (result != RESULT_OK) trial_destroy_motion(motion);
    return result;
}

// Whether FOLDER/NAME.json describes a motion.
static Result is_motion(bool *found, const char *folder, const char *name, Error *error)
{
    char path[4096];
    json_t *object;
    *found = false;
    snprintf(path, sizeof path, "%s/%s.csv", folder, name);
    if (access(path, R_OK) != 0) return RESULT_OK;
    snprintf(path, sizeof path, "%s/%s.json", folder, name);
    TRY(json_load(&object, path, error));
    *found = json_object_get(object, "root_motion") != NULL;
    json_decref(object);
    return RESULT_OK;
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

bool trial_in_mean(const MotionFolder *folder, const Motion *motion)
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
        bool is_one;
        TRY(is_motion(&is_one, folder->path, name, error));
        if (!is_one) continue;
        TRY(trial_read_motion(&folder->motions[folder->count], folder->path, name, error));
        in_mean += is_stated_for(&folder->motions[folder->count++]);
    }
    folder->whole = in_mean == MEAN_COUNT;
    if (folder->count > 0) return RESULT_OK;
    return error_set(error, RESULT_BAD_INPUT,
                     "%s: no reference motions: expected NAME.csv with NAME.json in this folder; "
                     "the project's are in its sources, others are named with --reference DIR",
                     folder->path);
}

Result trial_read_folder(MotionFolder *folder, const char *path, Error *error)
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
    if (access(file, R_OK) == 0) THEN(result, json_load(&folder->styles, file, error));
    for (int i = 0; i < 2; ++i) {
        snprintf(file, sizeof file, "%s/%s.json", path, pendulums[i]);
        if (access(file, R_OK) == 0) THEN(result, json_load(&folder->starts[i], file, error));
        snprintf(file, sizeof file, "%s/%s.csv", path, pendulums[i]);
        if (access(file, R_OK) == 0) THEN(result, csv_read(&folder->pendulums[i], file, error));
    }
    return result;
}

void trial_destroy_folder(MotionFolder *folder)
{
    for (size_t i = 0; i < folder->count; ++i) trial_destroy_motion(&folder->motions[i]);
    free(folder->motions);
    json_decref(folder->styles);
    for (int i = 0; i < 2; ++i) {
        csv_destroy(&folder->pendulums[i]);
        json_decref(folder->starts[i]);
    }
    *folder = (MotionFolder){0};
}

double trial_root(const Motion *motion, double t)
{
    const double turn = 6.283185307179586;
    return motion->root_amplitude * (1 - cos(turn * motion->root_frequency * t));
}

Result trial_start(Trial *trial, const Gpu *gpu, const Motion *motion, const SectionParams *params,
                   double rate, Error *error)
{
    SectionParams own = *params; // a copy that borrows the strings
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

void trial_advance(Trial *trial, const Motion *motion, double time)
{
    while ((double)trial->steps < time * trial->rate - 0.01) {
        double end = (double)(trial->steps + 1) * trial->step.dt;
        if (motion) trial->step.head.translation[0] = (float)trial_root(motion, end);
        trial_step(trial);
    }
}

Result trial_follow(Trial *trial, const Motion *motion, double *error_over_length, Error *error)
{
    double sum = 0;
    long counted = 0;
    for (size_t f = 1; f < motion->frame_count; ++f) {
        const MotionFrame *frame = &motion->frames[f];
        double mean = 0;
        trial_advance(trial, motion, frame->time);
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

Result trial_error(double *error_over_length, const Gpu *gpu, const Motion *motion,
                   const SectionParams *params, double rate, Error *error)
{
    Trial trial;
    Result result = trial_start(&trial, gpu, motion, params, rate, error);
    THEN(result, trial_follow(&trial, motion, error_over_length, error));
    trial_destroy(&trial);
    return result;
}
