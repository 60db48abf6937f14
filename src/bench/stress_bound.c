// SPDX-License-Identifier: MIT
#include "bench/stress_bound.h"
#include "sim/solver.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

enum { LENGTHS = 1, ENERGY = 2, REST = 4 };

// What a solver does not promise, and why; by how much of S^2 its energy may rise otherwise.
static const struct {
    const char *algo, *variant; // variant NULL: all
    unsigned lacks;
    double rise;
    const char *why;
} EXCEPTIONS[] = {
    {"split", NULL, 0, 0.3, "its tip goes by chords of the ball that it is in"},
    {"split", "thesis", ENERGY, 0, "its tip's velocity is what the pulls of the root leave"},
    {"emulation", "thesis", ENERGY | REST, 0, "gains energy, as published"},
    {"tressfx", "tressfx4", LENGTHS | ENERGY | REST, 0, "its passes leave it stretched"},
    {"chain", "", 0, 0.03, "its account leaves out what stiff springs of the style give"},
    {"hybrid", "", 0, 0.03, "its balance takes a gain out of velocities, after the step's move"},
    {"emulation", "projected", 0, 0.06, "so does its balance"},
    {"dftl", "", 0, 0.15, "its corrections go into velocities, not into what is drawn"},
};
static const double USUAL_RISE = 0.02;

static const double LENGTH_ERROR = 1e-5;
static const double REST_MOVE =
    3e-3; // of the length in a step: the tremor that docs/solvers.md has

static const double PATIENCE = 30; // of each time constant, until a strand must lie still
static const double CALM = 2; // stability number (simulation.h) up to which solvers come to rest

static const double NOISE_STEPS = 8; // steps whose rounding may add up, beside a random walk's

bool stress_bound_tip_only(const StressCase *stress)
{
    return strcmp(stress->algo, "split") == 0;
}

static double value(const StressCase *stress, enum StressField field)
{
    return stress->value[field];
}

// What a jerk of the root gives to a strand, over its change of velocity: where it is by tens of
// links, chain's corrections of the lengths overshoot, for that step only; those of dftl are
// velocities, which it takes a dozen steps to lose.
static double jerk_of(const StressCase *stress)
{
    bool overshoots = strcmp(stress->algo, "chain") == 0 || strcmp(stress->algo, "dftl") == 0;
    return overshoots ? 1.5 : 1;
}

static bool head_carries(const StressCase *stress)
{
    return strcmp(stress->algo, "tressfx") == 0 ||
           (value(stress, STRESS_clamped) > 1 && value(stress, STRESS_n) > 2);
}

static double odds_of(const SectionParams *params)
{
    return (double)params->style / fmax(1 - (double)params->style, 1e-6);
}

// Springs towards the style: 4 k L^2 and 2 pi b L for each radian.
static double turned_springs(const StressCase *stress, const SectionParams *params)
{
    double odds = odds_of(params), length = value(stress, STRESS_length),
           square = 4 * length * length;
    double bend = 2 * PI * length * odds;
    if (strcmp(stress->algo, "split") == 0) return 0; // its style is drawn only
    if (strcmp(stress->algo, "spring") == 0) return bend * (double)params->spring_angular;
    if (strcmp(stress->algo, "tressfx") == 0) {
        double passes = (double)params->tressfx_local_constraints_iterations / 2;
        return square * fmax(passes, 1) * 4e4 * odds;
    }
    double springs = square * (double)params->style_stiffness * odds;
    return springs + (strcmp(stress->algo, "chain") == 0 ? bend * (double)params->chain_bend : 0);
}

// All that makes hair go with the air, 1/s.
static double all_drag(const StressCase *stress, const SectionParams *params)
{
    if (strcmp(stress->algo, "tressfx") == 0)
        return (double)params->drag +
               (double)params->tressfx_damping * (double)params->tressfx_damping_rate;
    return (double)params->drag;
}

// The range that docs/solvers.md states for its energy, with what is fixed in TressFX as it is.
static bool is_stable_tressfx(const StressCase *stress, const SectionParams *params)
{
    double dt = value(stress, STRESS_dt);
    return dt > 1.0 / 241 && dt < 1.0 / 29 && params->tressfx_damping_rate == 60 &&
           params->tressfx_local_constraints_iterations <= 8 &&
           params->tressfx_local_share <= 0.5f && params->tressfx_local_max <= 0.95f;
}

static void apply_promises(StressBound *bound, const StressCase *stress,
                           const SectionParams *params, bool rests)
{
    unsigned lacks = 0;
    bound->rise = USUAL_RISE;
    // Shorter segments have no certain direction; TressFX's levers make much of that.
    bound->resolved = strcmp(stress->algo, "tressfx") == 0 ? 4096 : 64;
    for (size_t i = 0; i < sizeof EXCEPTIONS / sizeof *EXCEPTIONS; ++i)
        if (strcmp(EXCEPTIONS[i].algo, stress->algo) == 0 &&
            (!EXCEPTIONS[i].variant || strcmp(EXCEPTIONS[i].variant, stress->variant) == 0)) {
            lacks |= EXCEPTIONS[i].lacks;
            if (EXCEPTIONS[i].rise > 0) bound->rise = EXCEPTIONS[i].rise;
        }
    bool elastic = strcmp(stress->algo, "spring") == 0 || strcmp(stress->algo, "rope") == 0;
    if (elastic) lacks |= params->stretch_drawn ? LENGTHS : ENERGY; // which it draws
    // The lower, the more it whips, and the more the shorter the steps (docs/solvers.md).
    if (strcmp(stress->algo, "dftl") == 0 && params->ftl_damping < 0.98f) lacks |= ENERGY;
    if (strcmp(stress->algo, "tressfx") == 0 && !is_stable_tressfx(stress, params))
        lacks |= ENERGY | REST;
    if (lacks & ENERGY) bound->rise = -1;
    bound->length_error = lacks & LENGTHS ? 0 : LENGTH_ERROR;
    bound->rest_move = rests && !(lacks & REST) ? REST_MOVE * bound->length : 0;
}

// Whether what drag takes must have ended in the half of the steps in which the head rests.
static bool must_rest(const StressCase *stress, const StressBound *bound, double g, int steps)
{
    double time = bound->step_s * steps / 2;
    if (value(stress, STRESS_gust) > 0 && bound->wind > 0) return false;
    if (!(bound->drag > 0 && g > 0)) return false;
    return time > PATIENCE * fmax(2 / bound->drag, bound->drag * bound->length / g);
}

StressBound stress_bound_create(const StressCase *stress, const SectionParams *params, int steps)
{
    double spread = fmin(value(stress, STRESS_wind_spread), 89) * PI / 180;
    StressBound bound = {
        .step_s = value(stress, STRESS_dt) * value(stress, STRESS_rope_time_scale),
        .drag = all_drag(stress, params),
        .wind = value(stress, STRESS_wind) * (1 + value(stress, STRESS_gust)) / cos(spread),
        .g = value(stress, STRESS_gravity),
        .length = value(stress, STRESS_length),
        .stiffness = turned_springs(stress, params),
        .jerk = jerk_of(stress),
        .jerk_stays = strcmp(stress->algo, "dftl") == 0,
        .carries = head_carries(stress),
        .bends = 16 * value(stress, STRESS_chain_bend) * odds_of(params) *
                 (value(stress, STRESS_n) - 1) * value(stress, STRESS_length),
        .small_steps = strcmp(stress->variant, "xpbd") == 0       ? params->rope_iterations
                       : strcmp(stress->variant, "explicit") == 0 ? STRESS_MOST_SMALL_STEPS
                                                                  : 1,
    };
    double g = bound.g + bound.drag * bound.wind, links = value(stress, STRESS_n) - 1;
    bound.rest_shortest = bound.step_s * bound.step_s * g * links / (CALM * CALM);
    apply_promises(&bound, stress, params, must_rest(stress, &bound, g, steps));
    // Damping by a share in each step is drag of some strength.
    if (strcmp(stress->algo, "rope") == 0 && params->rope_damping > 0) bound.drag = INFINITY;
    return bound;
}

void stress_bound_step(StressBound *bound, const double moved[3], double angle)
{
    double change = 0, speed = 0, rate = fabs(angle) / bound->step_s;
    for (int k = 0; k < 3; ++k) {
        double u = moved[k] / bound->step_s;
        change += (u - bound->root_velocity[k]) * (u - bound->root_velocity[k]);
        speed += u * u;
        bound->root_velocity[k] = u;
    }
    double air = bound->wind + sqrt(speed);
    bound->kicks += bound->changed = sqrt(change);
    bound->steps += 1;
    bound->turned += bound->stiffness * fabs(angle);
    bound->turning = fmax(bound->turning, rate * bound->length);
    bound->spun += fabs(rate - bound->rate) + rate * fmin(fabs(angle), 2);
    bound->rate = rate;
    if (!(bound->drag > 0)) return;
    bound->cap = fmax(bound->cap, air * air + 4 * bound->g * bound->length);
    if (air > 0)
        bound->blown = fmin(bound->blown + bound->drag * air * air / 2 * bound->step_s, bound->cap);
}

void stress_bound_fill(const StressBound *bound, bool last, StressParams *params)
{
    const double most = 1e18; // float32 squares it
    double overshoot = (bound->jerk - 1) * (bound->jerk_stays ? bound->kicks : bound->changed);
    params->per_dt = (float)(1 / bound->step_s);
    params->kicks = (float)fmin(bound->kicks + overshoot + bound->turning, most);
    params->spun = bound->carries ? (float)fmin(bound->spun, most) : 0;
    params->carried = bound->carries;
    params->added = (float)fmin(bound->blown + bound->turned, most * most);
    params->rise = (float)bound->rise;
    params->energy = bound->rise >= 0;
    params->resolved = (float)bound->resolved;
    params->rounding = 12 * 0x1p-24f;
    params->bends = (float)fmin(bound->bends, most * most);
    params->noise_steps = (float)(bound->small_steps * (NOISE_STEPS + sqrt(bound->steps)));
    params->length_error = (float)bound->length_error;
    params->rest_shortest = (float)bound->rest_shortest;
    params->rest_move = last ? (float)bound->rest_move : 0;
}
