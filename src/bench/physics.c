// SPDX-License-Identifier: MIT
#include "bench/physics.h"

#include <math.h>
#include <string.h>

// Human hair, the defaults of rod: B/(rho A) = E r^2/(4 rho), m^4/s^2.
#define MODULUS 3.5e9
#define RADIUS  35e-6
#define DENSITY 1300.0
#define G       9.81
static const double PI = 3.14159265358979323846;

static double stiffness(void)
{
    return MODULUS * RADIUS * RADIUS / (4 * DENSITY);
}

// --- Cantilever. psi is the angle of the tangent from straight down, sigma the distance from the
// tip over (B/w)^(1/3): the moment of the weight beyond bends, psi'' = sigma sin psi, with psi'(0)
// = 0. The clamp is where psi = pi/2, at sigma = gamma^(1/3). psi(0) is found by bisection of its
// logarithm, since it is tiny for long hair.

typedef struct Tangent {
    double psi, turn, along, down; // psi' = turn; along and down: integrals of sin psi and cos psi
} Tangent;

static Tangent slope(double sigma, const Tangent *at)
{
    return (Tangent){at->turn, sigma * sin(at->psi), sin(at->psi), cos(at->psi)};
}

static Tangent moved(const Tangent *from, double h, const Tangent *by)
{
    return (Tangent){from->psi + h * by->psi, from->turn + h * by->turn,
                     from->along + h * by->along, from->down + h * by->down};
}

// Runge-Kutta of fourth order from the tip to sigma = `length`.
static Tangent integrate(double logarithm, double length)
{
    enum { STEPS = 4000 };
    double h = length / STEPS;
    Tangent at = {exp(logarithm), 0, 0, 0};
    for (int i = 0; i < STEPS; ++i) {
        double sigma = i * h;
        Tangent a = slope(sigma, &at), to = moved(&at, h / 2, &a);
        Tangent b = slope(sigma + h / 2, &to);
        to = moved(&at, h / 2, &b);
        Tangent c = slope(sigma + h / 2, &to);
        to = moved(&at, h, &c);
        Tangent d = slope(sigma + h, &to);
        at = moved(&at, h / 6, &a), at = moved(&at, h / 3, &b);
        at = moved(&at, h / 3, &c), at = moved(&at, h / 6, &d);
        if (at.psi > PI) break; // too far; more would return
    }
    return at;
}

void physics_cantilever(double gamma, double *along, double *drop)
{
    double length = cbrt(gamma), low = -400, high = log(PI / 2);
    for (int i = 0; i < 100; ++i) {
        double middle = (low + high) / 2;
        if (integrate(middle, length).psi < PI / 2)
            low = middle;
        else
            high = middle;
    }
    Tangent root = integrate(low, length);
    *along = root.along / length, *drop = root.down / length;
}

bool physics_cantilever_set_up(Setup *setup)
{
    static const double gammas[] = {1, 10, 100, 1000};
    if (setup->number >= 8) return false;
    double gamma = gammas[setup->number / 2], length = cbrt(gamma * stiffness() / G);
    int n = setup->number % 2 ? 32 : 16;
    setup->n = n + 1;
    setup->length = length;
    trial_make_beam(setup->points, n + 1, length);
    physics_cantilever(gamma, &setup->exact[0][0], &setup->exact[0][1]);
    snprintf(setup->scenario, sizeof setup->scenario, "cantilever %g, %d segments", gamma, n);
    snprintf(setup->settings, sizeof setup->settings, "--drag 10");
    return true;
}

enum { SETTLE_S = 30 };

Result physics_cantilever_measure(Run *run, Error *error)
{
    const Setup *setup = run->setup;
    trial_advance(&run->trial, NULL, SETTLE_S);
    TRY(trial_read(&run->trial, error));
    const float *tip = run->trial.points[setup->n - 1];
    experiment_add(run, "tip error",
                   hypot((double)tip[0] / setup->length - setup->exact[0][0],
                         -(double)tip[1] / setup->length - setup->exact[0][1]));
    experiment_add(run, "drop over reach", -(double)tip[1] / (double)tip[0]);
    return RESULT_OK;
}

// --- Curls that hang at rest. A planar arc stays in its plane up to a natural curvature k = kappa
// (B/w)^(1/3) of 1.659 (32 segments); beyond it twists out. `across`: the extent across the plane;
// `depth`: of the tip below the root. Exact values: the discrete rod, integrated until it rests
// (docs/physics.md).

static const struct {
    const char *name;
    double length, radius, pitch; // m; radius 0: curvature k of an arc of 5 (B/w)^(1/3)
    double k;
    int segments;
    double across, depth; // exact, over the length; NaN: not known
} CURLS[] = {
    {"arc, k 1.60", 0, 0, 0, 1.60, 32, NAN, NAN},
    {"arc, k 1.75", 0, 0, 0, 1.75, 32, NAN, NAN},
    {"arc of 2 cm", 0.32, 0.02, 0, 0, 64, 0.1318, 0.67576},
    {"helix", 0.32, 0.01, 0.04, 0, 32, NAN, 0.69923},
};

// Directions at the middles of segments, from straight down in the plane of x and y, or of a helix
// about -y.
bool physics_curl_set_up(Setup *setup)
{
    if (setup->number >= (int)(sizeof CURLS / sizeof *CURLS)) return false;
    int n = CURLS[setup->number].segments;
    double natural = cbrt(stiffness() / G), radius = CURLS[setup->number].radius,
           pitch = CURLS[setup->number].pitch, length = CURLS[setup->number].length;
    if (!(length > 0)) length = 5 * natural, radius = natural / CURLS[setup->number].k;
    double turn = hypot(2 * PI * radius, pitch);
    setup->n = n + 1;
    setup->length = length;
    for (int j = 1; j <= n; ++j) {
        double s = (j - 0.5) * length / n, angle = pitch > 0 ? 2 * PI * s / turn : s / radius;
        const double arc[3] = {sin(angle), -cos(angle), 0},
                     helix[3] = {-2 * PI * radius / turn * sin(angle), -pitch / turn,
                                 2 * PI * radius / turn * cos(angle)};
        for (int k = 0; k < 3; ++k)
            setup->points[j][k] =
                setup->points[j - 1][k] + length / n * (pitch > 0 ? helix[k] : arc[k]);
    }
    snprintf(setup->scenario, sizeof setup->scenario, "%s", CURLS[setup->number].name);
    snprintf(setup->settings, sizeof setup->settings, "--drag 8");
    return true;
}

// A small velocity across the plane, so that an unstable plane is left.
static void kick(Run *run)
{
    const GpuBuffer *buffer = trial_buffer(&run->trial, 0, SOLVER_VELOCITIES);
    const HairBatch *batch = &run->trial.hair.batches[0];
    for (int j = 1; j < run->setup->n; ++j) {
        const float velocity[3] = {0, 0, 0.05f * (float)j / (float)(run->setup->n - 1)};
        gpu_buffer_write(buffer, (int64_t)(hair_address(batch, 0, (uint32_t)j) * 4 * sizeof(float)),
                         velocity, sizeof velocity);
    }
}

Result physics_curl_measure(Run *run, Error *error)
{
    const Setup *setup = run->setup;
    bool planar = CURLS[setup->number].pitch == 0;
    double low = 0, high = 0;
    if (planar) kick(run);
    trial_advance(&run->trial, NULL, SETTLE_S);
    TRY(trial_read(&run->trial, error));
    for (int j = 1; j < setup->n; ++j) {
        low = fmin(low, (double)run->trial.points[j][2]);
        high = fmax(high, (double)run->trial.points[j][2]);
    }
    double across = (high - low) / setup->length,
           depth = -(double)run->trial.points[setup->n - 1][1] / setup->length,
           known = CURLS[setup->number].across, deep = CURLS[setup->number].depth;
    if (planar) experiment_add(run, "across", across);
    if (!isnan(known)) experiment_add(run, "across, off", fabs(across / known - 1));
    experiment_add(run, isnan(deep) ? "depth" : "depth, off",
                   isnan(deep) ? depth : fabs(depth - deep));
    return RESULT_OK;
}

// --- Exact motions of the discrete rod.

bool physics_motion_set_up(Setup *setup)
{
    const MotionFolder *folder = setup->rods;
    if ((size_t)setup->number >= folder->count) return false;
    setup->motion = &folder->motions[setup->number];
    snprintf(setup->scenario, sizeof setup->scenario, "%s", setup->motion->name);
    snprintf(setup->settings, sizeof setup->settings, "--bend-damping 0");
    return true;
}
