// SPDX-License-Identifier: MIT
#include "bench/bench_beam.h"
#include "base/interrupt.h"
#include "bench/bench_trial.h"

#include <math.h>
#include <string.h>

// Seconds and steps until a strand rests: stiff ones swing slower at long steps.
enum { MOST = 64, REST_S = 20, REST_STEPS = 1200 };
#define LENGTH 0.25
#define G      9.81
#define COIL   1e4 // the default of --spring-coil, 1/s2

// Angles a_j below the horizontal of segments j = 1 .. n, of length l; particles of mass 1.
//
// chain: joint j turns by d_j = a_j - a_(j-1) (a_0 = 0) against the weight of all that hangs
// beyond:
//     K n^2 l sin(d_j) = sum over i >= j of g (x_i - x_(j-1)),
// the exact minimum of the discrete rod's energy (glsl/sim/bend.glsl). Relaxed, because x depends
// on a.
static void solve_joints(double stiffness, int n, double *angle)
{
    for (int j = 1; j <= n; ++j) angle[j] = 0;
    for (int round = 0; round < 2000; ++round) {
        double moment = 0, hanging = 0, turn[MOST + 1] = {0};
        for (int j = n; j >= 1; --j) {
            hanging += 1;
            moment += G * hanging * cos(angle[j]);
            turn[j] = asin(fmin(1, moment / (stiffness * n * n)));
        }
        for (int j = 1; j <= n; ++j) {
            double a = turn[j] + (j > 1 ? angle[j - 1] : 0);
            angle[j] += 0.2 * (a - angle[j]);
        }
    }
}

// spring: each link is drawn to its own horizontal, against the weight that hangs at its end:
//     n b a_j = (n - j + 1) g cos(a_j),
// the balance of forces across link j (glsl/sim/spring.comp), with b at most an eighth of the
// coil's stiffness times the length. By Newton's method.
static void solve_links(double stiffness, int n, double *angle)
{
    for (int j = 1; j <= n; ++j) {
        double weight = (n - j + 1) * G, b = n * fmin(stiffness, COIL * LENGTH / 8), a = 0;
        for (int round = 0; round < 50; ++round)
            a -= (b * a - weight * cos(a)) / (b + weight * sin(a));
        angle[j] = a;
    }
}

typedef struct Beam {
    const char *algo, *flag;
    double stiffness;
    void (*solve)(double stiffness, int n, double *angle);
    // Small drop of a continuous beam's tip over its length: q L^4/(8 E I) of a cantilever under
    // its own weight q (Gere and Timoshenko, Mechanics of Materials), with E I = K L^2 and
    // q = n g/L: n g/(8 K). 0: no such formula.
    bool continuous;
} Beam;

static const Beam BEAMS[] = {
    {"chain", "--chain-bend", 5, solve_joints, false},
    {"chain", "--chain-bend", 50, solve_joints, false},
    {"chain", "--chain-bend", 500, solve_joints, true},
    {"spring", "--spring-angular", 5, solve_links, false},
    {"spring", "--spring-angular", 50, solve_links, false},
    {"spring", "--spring-angular", 500, solve_links, false},
};

static void draw_exact(const Beam *beam, int n, double (*points)[3])
{
    double angle[MOST + 1], l = LENGTH / n;
    beam->solve(beam->stiffness, n, angle);
    memset(points[0], 0, sizeof points[0]);
    for (int j = 1; j <= n; ++j) {
        points[j][0] = points[j - 1][0] + l * cos(angle[j]);
        points[j][1] = points[j - 1][1] - l * sin(angle[j]);
        points[j][2] = 0;
    }
}

static Result settle(Trial *trial, const Accuracy *accuracy, const Method *method, int n,
                     double rate, SectionParams *params, Error *error)
{
    double points[MOST + 1][3];
    Strands strands = {0};
    trial_make_beam(points, n + 1, LENGTH);
    Result result = method_params(params, method, error);
    if (result == RESULT_OK)
        result = trial_make_strand(&strands, (const double(*)[3])points, n + 1, error);
    if (result == RESULT_OK)
        result = trial_create(trial, accuracy->gpu, &strands, params, rate, error);
    while (result == RESULT_OK && (double)trial->steps < fmax(REST_S * rate, REST_STEPS))
        trial_step(trial);
    if (result == RESULT_OK) result = trial_read(trial, error);
    strands_destroy(&strands);
    return result;
}

static Result use_beam(Accuracy *accuracy, const Method *method, const Beam *beam, int n,
                       double rate, Error *error)
{
    char settings[256];
    double exact[MOST + 1][3], sum = 0;
    SectionParams params = {0};
    Trial trial = {0};
    snprintf(settings, sizeof settings, "--style 0.5 --style-stiffness 0 --drag 5 %s %g",
             beam->flag, beam->stiffness);
    const Method own = {method->algo, method->variant, settings};
    AccuracyRow row = accuracy_row("beam", &own, rate);
    snprintf(row.scenario, sizeof row.scenario, "%s %g, %d links", beam->flag + 2, beam->stiffness,
             n);
    Result result = settle(&trial, accuracy, &own, n, rate, &params, error);
    draw_exact(beam, n, exact);
    for (int j = 1; j <= n && result == RESULT_OK; ++j)
        for (int k = 0; k < 3; ++k) sum += pow((double)trial.points[j][k] - exact[j][k], 2);
    if (result == RESULT_OK) {
        row.what = "error", row.value = sqrt(sum / n) / LENGTH, row.bound = 0.01;
        accuracy_add(accuracy, &row);
        row.bound = NAN;
        row.what = "drop", row.value = -(double)trial.points[n][1] / LENGTH;
        accuracy_add(accuracy, &row);
    }
    if (result == RESULT_OK && beam->continuous) {
        row.what = "drop over beam's";
        row.value = row.value / (n * G / (8 * beam->stiffness));
        accuracy_add(accuracy, &row);
    }
    trial_destroy(&trial);
    params_destroy_section(&params);
    return result;
}

static Result use_method(Accuracy *accuracy, const Method *method, Error *error)
{
    static const double own[] = {30, 240};
    double rates[BENCH_MOST_RATES];
    int count = accuracy_rates(accuracy, own, 2, rates);
    Result result = RESULT_OK;
    for (size_t b = 0; b < sizeof BEAMS / sizeof *BEAMS; ++b)
        for (int r = 0; r < count && strcmp(BEAMS[b].algo, method->algo) == 0; ++r)
            for (int n = 15; n <= 31 && result == RESULT_OK; n += 16)
                result = interrupt_requested()
                             ? error_set(error, RESULT_INTERRUPTED, "interrupted")
                             : use_beam(accuracy, method, &BEAMS[b], n, rates[r], error);
    return result;
}

Result beam_run(Accuracy *accuracy, Error *error)
{
    return accuracy_for_each(accuracy, use_method, error);
}
