// SPDX-License-Identifier: MIT
#include "bench/experiments.h"
#include "base/interrupt.h"
#include "bench/physics.h"

#include <math.h>
#include <string.h>

#define LENGTH 0.25 // m: length of strands that do not come from a motion file
#define G      9.81

// --- Helpers.

static double square_distance(const float a[3], const double b[3])
{
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += pow((double)a[k] - b[k], 2);
    return sum;
}

// RMS distance of particles 1 .. n-1, over the length.
static double rms_distance(float (*const a)[3], const double (*b)[3], int n)
{
    double sum = 0;
    for (int j = 1; j < n; ++j) sum += square_distance(a[j], b[j]);
    return sqrt(sum / (n - 1)) / LENGTH;
}

// --- motions: RMS distance from the exact motions, without style.

static bool motions_set_up(Setup *setup)
{
    if ((size_t)setup->number >= setup->folder->count) return false;
    setup->motion = &setup->folder->motions[setup->number];
    setup->in_all = trial_in_mean(setup->folder, setup->motion);
    snprintf(setup->scenario, sizeof setup->scenario, "%s", setup->motion->name);
    return true;
}

static Result motions_measure(Run *run, Error *error)
{
    double off = NAN;
    TRY(trial_follow(&run->trial, run->setup->motion, &off, error));
    experiment_add(run, "error", off);
    return RESULT_OK;
}

// --- pendulum: RMS distance of a heavy tip from the exact motion, over its length, for each
// pendulum of the CSV files (columns x_NAME, y_NAME, optional z_NAME). The JSON file has the start
// velocity and drag of NAME. For split: the tip of a straight strand of 16 particles; for other
// solvers: a strand of 2 particles.

static double pendulum_at(const Setup *setup, size_t row, int axis)
{
    double value = 0;
    if (axis < setup->axes) csv_number(setup->csv, row, setup->column + (size_t)axis, &value, NULL);
    return value;
}

static bool pendulum_set_up(Setup *setup)
{
    int number = setup->number;
    for (int file = 0; file < 2; ++file) {
        const Csv *csv = &setup->folder->pendulums[file];
        for (size_t i = 2; i < csv->column_count; ++i) {
            if (strncmp(csv->column[i], "x_", 2) != 0 || number-- > 0) continue;
            setup->csv = csv, setup->column = i;
            setup->axes = i + 2 < csv->column_count && csv->column[i + 2][0] == 'z' ? 3 : 2;
            snprintf(setup->scenario, sizeof setup->scenario, "%s", csv->column[i] + 2);
            const json_t *start = json_object_get(setup->folder->starts[file], setup->scenario);
            const json_t *velocity = json_object_get(start, "velocity");
            setup->drag = json_number_value(json_object_get(start, "drag_c"));
            setup->n = strcmp(setup->method->algo, "split") == 0 ? 16 : 2;
            for (int k = 0; k < 3; ++k) {
                setup->velocity[k] = json_number_value(json_array_get(velocity, (size_t)k));
                for (int j = 0; j < setup->n; ++j)
                    setup->points[j][k] = pendulum_at(setup, 0, k) * j / (setup->n - 1);
            }
            return true;
        }
    }
    return false;
}

// False if the solver cannot start with a velocity.
static bool set_velocity(const Run *run)
{
    const double *v = run->setup->velocity;
    const HairBatch *batch = &run->trial.hair.batches[0];
    const float velocity[4] = {(float)v[0], (float)v[1], (float)v[2], 0};
    int64_t offset = sizeof velocity; // the velocity follows the tip's position
    if (v[0] == 0 && v[1] == 0 && v[2] == 0) return true;
    const GpuBuffer *buffer = trial_buffer(&run->trial, 0, SOLVER_TIPS);
    if (!buffer) {
        buffer = trial_buffer(&run->trial, 0, SOLVER_VELOCITIES);
        offset = (int64_t)(hair_address(batch, 0, batch->vertex_count - 1) * sizeof velocity);
    }
    if (!buffer) return false;
    gpu_buffer_write(buffer, offset, velocity, sizeof velocity);
    return true;
}

static Result pendulum_measure(Run *run, Error *error)
{
    Trial *trial = &run->trial;
    double sum = 0;
    long counted = 0;
    if (!set_velocity(run)) return RESULT_OK;
    for (size_t row = 1; row < run->setup->csv->row_count; ++row) {
        double time = 0;
        float tip[2][4];
        const float *end = tip[0];
        csv_number(run->setup->csv, row, 1, &time, NULL);
        trial_advance(trial, NULL, time);
        if (fabs((double)trial->steps - time * trial->rate) > 0.01) continue;
        if (!trial_read_tip(trial, 0, 0, tip)) {
            TRY(trial_read(trial, error));
            end = trial->points[run->setup->n - 1];
        }
        for (int k = 0; k < 3; ++k) sum += pow((double)end[k] - pendulum_at(run->setup, row, k), 2);
        ++counted;
    }
    if (counted) experiment_add(run, "error", sqrt(sum / (double)counted) / LENGTH);
    return RESULT_OK;
}

// --- static: RMS distance after 20 s with drag from the exact minimum of energy of strands with
// the style's position springs (cases of static_style.json).

enum { REST_S = 20, REST_STEPS = 1200 };

static bool static_set_up(Setup *setup)
{
    int number = setup->number;
    const json_t *cases = json_object_get(setup->folder->styles, "cases"), *entry;
    for (size_t i = 0; (entry = json_array_get(cases, i)) != NULL; ++i) {
        setup->n = (int)json_integer_value(json_object_get(entry, "n"));
        if (setup->n < 2 || setup->n > EXPERIMENT_POINTS || number-- > 0) continue;
        double stiffness = json_number_value(json_object_get(entry, "k_style"));
        const json_t *from = json_object_get(entry, "style_positions"),
                     *to = json_object_get(entry, "positions");
        for (size_t j = 0; j < (size_t)setup->n; ++j)
            for (size_t k = 0; k < 3; ++k) {
                setup->points[j][k] = json_number_value(json_array_get(json_array_get(from, j), k));
                setup->exact[j][k] = json_number_value(json_array_get(json_array_get(to, j), k));
            }
        snprintf(setup->scenario, sizeof setup->scenario, "%s, k = %g/s2",
                 json_string_value(json_object_get(entry, "style")), stiffness);
        snprintf(setup->settings, sizeof setup->settings,
                 "--style 0.5 --style-stiffness %g --drag 5", stiffness);
        return true;
    }
    return false;
}

static Result rest_measure(Run *run, Error *error)
{
    const Setup *setup = run->setup;
    trial_advance(&run->trial, NULL, fmax(REST_S, REST_STEPS / run->trial.rate));
    TRY(trial_read(&run->trial, error));
    experiment_add(run, "error", rms_distance(run->trial.points, setup->exact, setup->n));
    return RESULT_OK;
}

// --- drift: a helix with default parameters, settled for 10 s (or half of the time). "drift" is
// the RMS displacement from there at the end; "tremor" is the largest displacement of a particle
// from frame to frame. Both are over the length.

enum { SETTLE_S = 10, FPS = 60 };

static bool drift_set_up(Setup *setup)
{
    setup->n = setup->number ? 48 : 16;
    trial_make_helix(setup->points, setup->n, LENGTH, setup->number ? 4 : 2);
    snprintf(setup->scenario, sizeof setup->scenario, "helix of %d, %g s", setup->n,
             setup->seconds);
    return setup->number < 2;
}

// The largest displacement of a particle since `before`, over the length. Copies `now` to `before`.
static double farthest(float (*const now)[3], double (*before)[3], int n)
{
    double most = 0;
    for (int j = 0; j < n; ++j) {
        most = fmax(most, sqrt(square_distance(now[j], before[j])));
        for (int k = 0; k < 3; ++k) before[j][k] = (double)now[j][k];
    }
    return most / LENGTH;
}

static Result drift_measure(Run *run, Error *error)
{
    Trial *trial = &run->trial;
    double settled[EXPERIMENT_POINTS][3] = {{0}}, before[EXPERIMENT_POINTS][3] = {{0}}, tremor = 0;
    double end = run->setup->seconds, frame = trial->rate > FPS ? round(trial->rate / FPS) : 1;
    int n = run->setup->n;
    trial_advance(trial, NULL, fmin(SETTLE_S, end / 2));
    TRY(trial_read(trial, error));
    farthest(trial->points, settled, n);
    farthest(trial->points, before, n);
    while ((double)trial->steps < end * trial->rate) {
        trial_advance(trial, NULL, ((double)trial->steps + frame) / trial->rate);
        TRY(trial_read(trial, error));
        tremor = fmax(tremor, farthest(trial->points, before, n));
    }
    experiment_add(run, "drift", rms_distance(trial->points, (const double(*)[3])settled, n));
    experiment_add(run, "tremor", tremor);
    return RESULT_OK;
}

// --- beam: strands that bend under their own weight, held horizontally at the root: the RMS
// distance at rest from the exact shape of the same chain, and the drop of the tip.
//
// Angles a_j of the segments j = 1 .. n of length l are below the horizontal; particles have mass
// 1. Each link is pulled towards the horizontal and balances the weight at its end:
//     n b a_j = (n - j + 1) g cos(a_j),
// the balance of forces across link j (glsl/sim/spring.comp). b is at most an eighth of the coil's
// stiffness (the default of --spring-coil, 1e4/s2) times the length. Solved by Newton's method.
static void solve_links(double stiffness, int n, double *angle)
{
    for (int j = 1; j <= n; ++j) {
        double weight = (n - j + 1) * G, b = n * fmin(stiffness, 1e4 * LENGTH / 8), a = 0;
        for (int round = 0; round < 50; ++round)
            a -= (b * a - weight * cos(a)) / (b + weight * sin(a));
        angle[j] = a;
    }
}

static bool beam_set_up(Setup *setup)
{
    static const double stiffnesses[] = {5, 50, 500};
    if (setup->number >= 6) return false;
    double stiffness = stiffnesses[setup->number / 2], angle[EXPERIMENT_POINTS] = {0};
    int n = setup->number % 2 ? 31 : 15;
    setup->n = n + 1;
    trial_make_beam(setup->points, n + 1, LENGTH);
    solve_links(stiffness, n, angle);
    for (int j = 1; j <= n; ++j) {
        setup->exact[j][0] = setup->exact[j - 1][0] + LENGTH / n * cos(angle[j]);
        setup->exact[j][1] = setup->exact[j - 1][1] - LENGTH / n * sin(angle[j]);
    }
    snprintf(setup->scenario, sizeof setup->scenario, "spring-angular %g, %d links", stiffness, n);
    snprintf(setup->settings, sizeof setup->settings, "--style 0.5 --drag 5 --spring-angular %g",
             stiffness);
    return true;
}

static Result beam_measure(Run *run, Error *error)
{
    TRY(rest_measure(run, error));
    experiment_add(run, "drop", -(double)run->trial.points[run->setup->n - 1][1] / LENGTH);
    return RESULT_OK;
}

// --- stretch: the greatest | |x_j - x_(j-1)| / l_j - 1 | over all links and frames of the exact
// motions: as drawn and, for solvers that stretch, as simulated.

static bool stretch_set_up(Setup *setup)
{
    bool found = motions_set_up(setup);
    setup->in_all = true;
    return found;
}

static Result stretch_measure(Run *run, Error *error)
{
    const Motion *motion = run->setup->motion;
    float(*const x)[3] = run->trial.points;
    double most = 0;
    for (size_t f = 1; f < motion->frame_count; ++f) {
        double size = 0;
        trial_advance(&run->trial, motion, motion->frames[f].time);
        TRY(trial_read(&run->trial, error));
        for (int j = 1; j < motion->n; ++j) {
            double now = 0, rest = 0;
            for (int k = 0; k < 3; ++k) {
                const double *from = motion->points[j - 1], *to = motion->points[j];
                now += pow((double)x[j][k] - (double)x[j - 1][k], 2);
                rest += pow((double)(float)to[k] - (double)(float)from[k], 2);
                size = fmax(size, fabs((double)x[j][k]));
            }
            // Subtract what rounding of stored positions can cause: 2^-24 of a coordinate at both
            // ends.
            double off = fabs(sqrt(now) - sqrt(rest)), rounding = 2 * 1.8 * 0x1p-24 * size;
            if (!((off - rounding) / sqrt(rest) <= most)) most = (off - rounding) / sqrt(rest);
        }
    }
    experiment_add(run, run->trial.params.stretch_drawn ? "as simulated" : "as drawn", most);
    return RESULT_OK;
}

// --- energy: a straight strand held horizontally and a helix fall. "rise" is the greatest rise of
// energy above the start, over the energy that a strand can lose by falling. "change", without drag
// and style, is the change over the whole run. Both take kinetic energy from the solver's own
// velocities. "rise as drawn" takes it from the drawn positions of successive steps, and potential
// energy at their middle. For split only the tip has mass, so only the tip's energy counts.

static bool energy_set_up(Setup *setup)
{
    static const int sizes[] = {4, 16, 64};
    int n = sizes[setup->number % 3], drag = setup->number / 3 % 2;
    bool styled = setup->number / 6 == 1;
    setup->n = n, setup->strand_count = 2, setup->first_id = 2 * (uint32_t)(setup->number % 3);
    trial_make_beam(setup->points, n, LENGTH);
    trial_make_helix(setup->points + n, n, LENGTH, 1);
    snprintf(setup->scenario, sizeof setup->scenario, "n = %d, drag %d, %s", n, drag,
             styled ? "styled" : "loose");
    snprintf(setup->settings, sizeof setup->settings, "--style %s --drag %d%s",
             styled ? "0.5" : "0", drag,
             trial_has(setup->method, "stretch_drawn") ? " --stretch-drawn true" : "");
    return setup->number < 12;
}

// Reads the drawn positions. For split the ends are replaced by the tips.
static Result read_masses(Trial *trial, int n, double (*points)[3], Error *error)
{
    TRY(trial_read(trial, error));
    for (int i = 0; i < 2 * n; ++i)
        for (int k = 0; k < 3; ++k) points[i][k] = (double)trial->points[i][k];
    for (uint32_t s = 0; s < 2; ++s) {
        float tip[2][4];
        if (!trial_read_tip(trial, 0, s, tip)) return RESULT_OK;
        for (int k = 0; k < 3; ++k) points[(int)(s + 1) * n - 1][k] = (double)tip[0][k];
    }
    return RESULT_OK;
}

// The energy of the motion from a to b in dt, minus the energy of the start, over the energy that
// falling can release. Particles from index `from` on have the mass 1, the tip `tip`.
static double energy(const double (*start)[3], const double (*a)[3], const double (*b)[3], int from,
                     int n, double dt, double tip)
{
    double sum = 0, budget = 0;
    for (int j = from; j < n; ++j) {
        double square = 0, mass = j == n - 1 ? tip : 1;
        for (int k = 0; k < 3; ++k) square += pow((b[j][k] - a[j][k]) / dt, 2);
        sum += mass * (square / 2 + G * ((a[j][1] + b[j][1]) / 2 - start[j][1]));
        budget += mass * G * (start[j][1] - start[0][1] + LENGTH * j / (n - 1));
    }
    return sum / budget;
}

// The tip of a rod has half a segment's mass.
static double tip_mass(const Run *run)
{
    return trial_has(run->method, "youngs_modulus") ? 0.5 : 1;
}

// The energy with the solver's own velocities: the energy of a motion over h seconds that ends at
// `now` or, if the solver stores velocities at the end of a step, has `now` in its middle. h is the
// duration of the steps that the solver really takes.
static double own_energy(const Run *run, uint32_t s, const double (*start)[3],
                         const double (*now)[3])
{
    const Trial *trial = &run->trial;
    const GpuBuffer *velocities = trial_buffer(trial, 0, SOLVER_VELOCITIES);
    bool at_end = strcmp(run->method->algo, "hybrid") == 0 ||
                  strcmp(run->method->algo, "rod") == 0 ||
                  strcmp(run->method->algo, "emulation") == 0;
    double a[EXPERIMENT_POINTS][3] = {{0}}, b[EXPERIMENT_POINTS][3] = {{0}};
    double h = trial->step.dt / solver_substeps(&trial->solver, &trial->step);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, velocities->buffer);
    for (int j = 0; j < run->setup->n; ++j) {
        float v[4];
        size_t at = hair_address(&trial->hair.batches[0], s, (uint32_t)j);
        glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, (GLintptr)(at * sizeof v), sizeof v, v);
        for (int k = 0; k < 3; ++k) {
            b[j][k] = now[j][k] + (at_end ? h / 2 * (double)v[k] : 0);
            a[j][k] = b[j][k] - h * (double)v[k];
        }
    }
    return energy(start, (const double(*)[3])a, (const double(*)[3])b, 1, run->setup->n, h,
                  tip_mass(run));
}

static void raise_most(double *most, double e)
{
    if (!(e <= *most)) *most = e; // a NaN stays
}

// Checks every step of the first second, in which the hair falls, and then 4 steps a second.
static Result energy_measure(Run *run, Error *error)
{
    Trial *trial = &run->trial;
    const Setup *setup = run->setup;
    double start[EXPERIMENT_POINTS][3], before[EXPERIMENT_POINTS][3], now[EXPERIMENT_POINTS][3];
    double drawn = 0, own = 0, change = 0;
    bool tips = strcmp(run->method->algo, "split") == 0;
    bool has_own = !tips;
    long steps = (long)(setup->seconds * trial->rate + 0.5);
    long sparse = (long)fmax(trial->rate / 4, 1);
    TRY(read_masses(trial, setup->n, start, error));
    memcpy(before, start, sizeof start);
    for (long i = 1; i <= steps; ++i) {
        bool look = i <= (long)trial->rate || i % sparse == 0 || i == steps;
        if (interrupt_requested()) return error_set(error, RESULT_INTERRUPTED, "interrupted");
        if (look && i > 1) TRY(read_masses(trial, setup->n, before, error));
        trial_step(trial);
        if (!look) continue;
        TRY(read_masses(trial, setup->n, now, error));
        for (uint32_t s = 0; s < 2; ++s) {
            int n = setup->n, at = (int)s * n;
            const double(*from)[3] = (const double(*)[3])start + at;
            const double(*to)[3] = (const double(*)[3])now + at;
            double e = energy(from, (const double(*)[3])before + at, to, tips ? n - 1 : 1, n,
                              trial->step.dt, tip_mass(run));
            raise_most(&drawn, e);
            change = s ? fmax(change, e) : e;
            if (has_own) raise_most(&own, own_energy(run, s, from, to));
        }
    }
    if (has_own) experiment_add(run, "rise as drawn", drawn);
    experiment_add(run, "rise", has_own ? own : drawn);
    if (strstr(setup->scenario, "drag 0, loose")) experiment_add(run, "change", change);
    return RESULT_OK;
}

// --- rate: the start and the head's motion of two exact motions, with the solver's default style:
// RMS distance over the length, over 2 s, from the result at the finest rate.

enum { RATE_FPS = 30, RATE_FRAMES = 2 * RATE_FPS, RATE_POINTS = 128 };

static bool rate_set_up(Setup *setup)
{
    int number = setup->number;
    static const char *const names[] = {"c_root2Hz_n16_c1", "bd_curly_wind_n16_c4"};
    for (size_t m = 0; m < setup->folder->count; ++m) {
        const Motion *motion = &setup->folder->motions[m];
        if (strcmp(motion->name, names[0]) != 0 && strcmp(motion->name, names[1]) != 0) continue;
        if (motion->n > RATE_POINTS || number-- > 0) continue;
        setup->motion = motion;
        snprintf(setup->scenario, sizeof setup->scenario, "%s", motion->name);
        return true;
    }
    return false;
}

static Result rate_measure(Run *run, Error *error)
{
    static float finest[RATE_FRAMES][RATE_POINTS][3]; // static, because it is large
    const Motion *motion = run->setup->motion;
    double sum = 0;
    for (int f = 0; f < RATE_FRAMES; ++f) {
        trial_advance(&run->trial, motion, (f + 1.0) / RATE_FPS);
        TRY(trial_read(&run->trial, error));
        if (run->finest) memcpy(finest[f], run->trial.points, (size_t)motion->n * sizeof **finest);
        for (int j = 1; j < motion->n; ++j)
            for (int k = 0; k < 3; ++k)
                sum += pow((double)run->trial.points[j][k] - (double)finest[f][j][k], 2);
    }
    if (!run->finest)
        experiment_add(run, "from finest",
                       sqrt(sum / (RATE_FRAMES * (motion->n - 1))) / motion->length);
    return RESULT_OK;
}

// --- scale: the same hair with centimetres as units: RMS distance over the length after 30 steps.

enum { SCALE_N = 16, SCALE_STEPS = 30 };

static bool scale_set_up(Setup *setup)
{
    setup->n = SCALE_N;
    setup->units = setup->number ? 100 : 1;
    trial_make_helix(setup->points, SCALE_N, LENGTH, 2);
    snprintf(setup->scenario, sizeof setup->scenario, "helix of %d in cm", SCALE_N);
    return setup->number < 2;
}

static Result scale_measure(Run *run, Error *error)
{
    static float metres[EXPERIMENT_RATES][SCALE_N][3];
    double sum = 0;
    trial_advance(&run->trial, NULL, SCALE_STEPS / run->trial.rate);
    TRY(trial_read(&run->trial, error));
    for (int i = 0; i < 3 * SCALE_N; ++i) {
        float x = (float)((double)run->trial.points[i / 3][i % 3] / run->setup->units);
        if (run->setup->units == 1) metres[run->rate][i / 3][i % 3] = x;
        if (i >= 3) sum += pow((double)metres[run->rate][i / 3][i % 3] - (double)x, 2);
    }
    if (run->setup->units != 1)
        experiment_add(run, "from metres", sqrt(sum / (SCALE_N - 1)) / LENGTH);
    return RESULT_OK;
}

// --- The table.

#define LOOSE "--style 0"
#define DRAWN "--style 0 --stretch-drawn true"
const Experiment EXPERIMENTS[] = {
    {"motions", {60, 120, 240}, NULL, LOOSE, ORDER, FOLD_MEAN, motions_set_up, motions_measure},
    {"pendulum", {60, 120, 240}, NULL, LOOSE, ORDER, 0, pendulum_set_up, pendulum_measure},
    {"static", {60}, "style_stiffness", "", 0, 0, static_set_up, rest_measure},
    {"physics",
     {60},
     "youngs_modulus",
     "",
     0,
     0,
     physics_cantilever_set_up,
     physics_cantilever_measure},
    {"physics", {60}, "youngs_modulus", "", 0, 0, physics_curl_set_up, physics_curl_measure},
    {"physics",
     {60, 120, 240, 480},
     "youngs_modulus",
     "",
     ORDER,
     0,
     physics_motion_set_up,
     motions_measure},
    {"drift", {60}, NULL, "", 0, 0, drift_set_up, drift_measure},
    {"beam", {30, 240}, "spring_angular", "", 0, 0, beam_set_up, beam_measure},
    {"stretch", {60, 240}, NULL, LOOSE, 0, FOLD_MOST, stretch_set_up, stretch_measure},
    {"stretch", {60, 240}, "stretch_drawn", DRAWN, 0, FOLD_MOST, stretch_set_up, stretch_measure},
    {"energy", {30, 60, 120, 240}, NULL, "", 0, 0, energy_set_up, energy_measure},
    {"rate", {30, 60, 120, 240}, NULL, "", FINEST_FIRST, 0, rate_set_up, rate_measure},
    {"scale", {60}, NULL, "", 0, 0, scale_set_up, scale_measure},
};
const int EXPERIMENT_COUNT = sizeof EXPERIMENTS / sizeof *EXPERIMENTS;

bool experiments_set_up(const Experiment *experiment, const MotionFolder *folder,
                        const MotionFolder *rods, const Method *method, double seconds, int number,
                        Setup *setup)
{
    if (experiment->param && !trial_has(method, experiment->param)) return false;
    *setup = (Setup){.strand_count = 1, .drag = NAN, .units = 1};
    setup->seconds = seconds;
    setup->folder = folder, setup->rods = rods, setup->method = method, setup->number = number;
    snprintf(setup->settings, sizeof setup->settings, "%s", experiment->settings);
    return experiment->set_up(setup);
}

// Scales all parameters of solvers that are lengths or accelerations.
static void scale_params(SectionParams *params, double units)
{
    for (size_t i = 0; i < PARAM_COUNT; ++i) {
        const ParamInfo *info = &PARAM_TABLE[i];
        bool length = strcmp(info->unit, "m") == 0 || strcmp(info->unit, "cm") == 0 ||
                      strcmp(info->unit, "m/s2") == 0;
        if (!length || !trial_takes(info) || info->kind != PARAM_FLOAT) continue;
        float *value = (float *)(void *)((char *)params + info->offset);
        *value *= (float)units;
    }
    params->hair_radius *= (float)(units * units); // B/(rho A) is in m^4/s^2
}

static Result start(Run *run, const Gpu *gpu, const SectionParams *params, double rate,
                    Error *error)
{
    const Setup *setup = run->setup;
    double points[EXPERIMENT_POINTS][3];
    Strands strands = {0};
    if (setup->motion) return trial_start(&run->trial, gpu, setup->motion, params, rate, error);
    for (int i = 0; i < 3 * EXPERIMENT_POINTS; ++i)
        points[i / 3][i % 3] = setup->units * setup->points[i / 3][i % 3];
    TRY(trial_make_strands(&strands, (const double(*)[3])points, setup->strand_count, setup->n,
                           error));
    Result result = trial_create(&run->trial, gpu, &strands, setup->first_id, params, rate, error);
    run->trial.step.gravity[1] *= (float)setup->units;
    strands_destroy(&strands);
    return result;
}

Result experiments_run(const Experiment *experiment, Run *run, const Gpu *gpu, double rate,
                       Error *error)
{
    SectionParams params;
    run->trial = (Trial){0};
    run->value_count = 0;
    if (interrupt_requested()) return error_set(error, RESULT_INTERRUPTED, "interrupted");
    Result result = trial_params(&params, run->method, run->setup->settings, error);
    if (!isnan(run->setup->drag)) params.drag = (float)run->setup->drag;
    scale_params(&params, run->setup->units);
    THEN(result, start(run, gpu, &params, rate, error));
    THEN(result, experiment->measure(run, error));
    trial_destroy(&run->trial);
    params_destroy_section(&params);
    return result;
}
