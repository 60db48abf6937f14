// SPDX-License-Identifier: MIT
#include "bench/stress_bound.h"

#include "base/double3.h"
#include "scene/rigid_track.h"
#include "sim/solver.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

enum { LENGTHS = 1, ENERGY = 2, REST = 4 };

// The promises that a solver does not make and why. `rise`: the share of S^2 by which its energy
// may rise, if USUAL_RISE is too small.
static const struct {
    const char *algo, *variant; // variant NULL: all variants
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
    {"rod", NULL, 0, 0.15, "so does its limiter; two vertices swing up"},
    {"dftl", "mueller", ENERGY | REST, 0, "its corrections give energy, as published"},
};
static const double USUAL_RISE = 0.02;

static const double LENGTH_ERROR = 1e-5;
// Movement in a step over the length: the tremor that docs/solvers.md states.
static const double REST_MOVE = 3e-3;

static const double PATIENCE = 30; // a strand must lie still after this many time constants
static const double CALM = 2; // solvers come to rest up to this stability number (simulation.h)

static const double TRESSFX_RESOLVED = 4096; // segment length in rounding errors
static const double MOST_FLUTTER = 0.5;      // the smallest number seen with flutter is 0.52

// The rounding errors of this many steps may add up; the others grow like a random walk.
static const double NOISE_STEPS = 8;

static bool is(const StressCase *stress, const char *algo)
{
    return strcmp(stress->algo, algo) == 0;
}

static double odds_of(const SectionParams *params)
{
    return (double)params->style / fmax(1 - (double)params->style, 1e-6);
}

// The energy that springs towards the style can add to S^2 for each radian that the style turns:
// 4 k L^2, for angular springs 2 pi b L (stress_bound.h).
static double turned_springs(const StressCase *stress, const SectionParams *params)
{
    double odds = odds_of(params), length = stress->value[STRESS_length],
           square = 4 * length * length;
    double bend = 2 * PI * length * odds;
    if (is(stress, "split")) return 0; // its style acts on drawn strands only
    if (is(stress, "spring")) return bend * (double)params->spring_angular;
    if (is(stress, "tressfx")) {
        double passes = (double)params->tressfx_local_constraints_iterations / 2;
        return square * fmax(passes, 1) * 4e4 * odds;
    }
    return square * (double)params->style_stiffness * odds;
}

// beta over the mass of a particle, m^2/s^2 (glsl/sim/rod_joint.glsl).
static double joint_stiffness(const StressCase *stress, const SectionParams *params)
{
    double radius = (double)params->hair_radius * 1e-6, modulus = (double)params->youngs_modulus,
           l = stress->value[STRESS_length] / (stress->value[STRESS_n] - 1);
    if (!is(stress, "rod")) return 0;
    return modulus * 1e9 * radius * radius / (4 * (double)params->hair_density * l * l);
}

// Whether the parameters are in the range in which `tressfx steady` gains no energy according to
// docs/solver_derivations.md, with TressFX's other constants unchanged.
static bool is_stable_tressfx(const StressCase *stress, const SectionParams *params)
{
    double dt = stress->value[STRESS_dt];
    return dt > 1.0 / 241 && dt < 1.0 / 29 && params->tressfx_damping_rate == 60 &&
           params->tressfx_local_constraints_iterations <= 8 &&
           params->tressfx_local_share <= 0.5f && params->tressfx_local_max <= 0.95f;
}

// F: a strand's weight over the stiffness of its joints (stress_bound.h). TressFX makes two passes
// a frame; `steady` has the stiffness of two passes, too.
static double flutter_number(const StressCase *stress, const SectionParams *params, double g)
{
    double k = fmin((double)params->tressfx_local_constraint_stiffness,
                    (double)params->tressfx_local_max),
           firm = k / (1 - 0.75 * k) * odds_of(params),
           share = fmin(firm / (1 + 0.75 * firm), (double)params->tressfx_local_max) *
                   (double)params->tressfx_local_share;
    double rate = (double)params->tressfx_damping_rate, square = 4 * share * rate * rate;
    double n = stress->value[STRESS_n], link = stress->value[STRESS_length] / (n - 1);
    if (!is(stress, "tressfx") || params->tressfx_local_constraints_iterations == 0) return 0;
    return square > 0 ? fmin(n * g / (link * square), 1e18) : 0;
}

// Whether steps are as short as docs/solver_derivations.md asks of `rod`. In longer steps inertia
// no longer keeps the system of a stiff strand regular: float32 cannot solve it.
static bool is_stable_rod(const StressCase *stress, double g)
{
    double dt = stress->value[STRESS_dt], links = stress->value[STRESS_n] - 1,
           stability = dt * links * sqrt(g / stress->value[STRESS_length]);
    return dt < 1.0 / 29 && stability <= 3;
}

static void apply_promises(StressBound *bound, const StressCase *stress,
                           const SectionParams *params, bool rests)
{
    unsigned lacks = 0;
    bound->rise = USUAL_RISE;
    // Shorter segments have no certain direction because of rounding. TressFX amplifies such errors
    // along the strand.
    bound->resolved = is(stress, "tressfx") ? TRESSFX_RESOLVED : 64;
    // In tressfx, a rounding error that turns a short segment turns all segments behind it.
    bound->rest_resolved = is(stress, "tressfx") ? TRESSFX_RESOLVED : 0;
    for (size_t i = 0; i < sizeof EXCEPTIONS / sizeof *EXCEPTIONS; ++i)
        if (strcmp(EXCEPTIONS[i].algo, stress->algo) == 0 &&
            (!EXCEPTIONS[i].variant || strcmp(EXCEPTIONS[i].variant, stress->variant) == 0)) {
            lacks |= EXCEPTIONS[i].lacks;
            if (EXCEPTIONS[i].rise > 0) bound->rise = EXCEPTIONS[i].rise;
        }
    bool elastic = is(stress, "spring") || is(stress, "rope");
    // With stretch_drawn the drawn lengths change. Without it the drawn motion is not the simulated
    // motion, whose energy is bounded.
    if (elastic) lacks |= params->stretch_drawn ? LENGTHS : ENERGY;
    if (is(stress, "tressfx") && !is_stable_tressfx(stress, params)) lacks |= ENERGY | REST;
    if (is(stress, "rod") && !is_stable_rod(stress, bound->g + bound->drag * bound->wind))
        lacks |= ENERGY | REST;
    if (lacks & ENERGY) bound->rise = -1;
    bound->length_error = lacks & LENGTHS ? 0 : LENGTH_ERROR;
    bound->rest_move = rests && !(lacks & REST) ? REST_MOVE * bound->length : 0;
}

// The gravity that acts on the strand in m/s^2, with the head turned by move->turned: gravity minus
// the part that the groom holds.
static void find_felt(const StressBound *bound, const StressMove *move, double felt[3])
{
    const double *gravity = move->gravity;
    RigidMotion own = {.rotation = {0}};
    bool warped = false;
    double held[3];
    for (int k = 0; k < 4; ++k) warped |= (own.rotation[k] = move->warped[k]) != 0;
    if (!warped) own.rotation[3] = 1;
    rigid_motion_apply(&own, gravity, held);
    double cosine = bound->held * cos(move->turned), sine = bound->held * sin(move->turned);
    felt[0] = bound->share * (gravity[0] - cosine * held[0] + sine * held[1]);
    felt[1] = bound->share * (gravity[1] - cosine * held[1] - sine * held[0]);
    felt[2] = bound->share * (gravity[2] - bound->held * held[2]);
}

// The share of gravity that the groom holds, and the upper limit g of the gravity that acts on the
// strand.
static void find_held(StressBound *bound, const StressCase *stress, const SectionParams *params)
{
    const double *value = stress->value;
    double holds = solver_keeps_groom(params) ? value[STRESS_rest_share] : 0;
    bool segments = is(stress, "split");
    bound->hangs = segments && holds > 0;
    bound->held = segments ? 0 : holds;
    bound->share = (double)params->gravity_share;
    double most =
        value[STRESS_spin] > 0 || value[STRESS_warp] > 0 ? 1 + bound->held : fabs(1 - bound->held);
    bound->g = bound->share * value[STRESS_gravity] * most;
}

// Whether drag must have stopped the strand within the second half of the steps, in which the head
// rests.
static bool must_rest(const StressCase *stress, const StressBound *bound, int steps)
{
    double time = bound->step_s * steps / 2, gravity = stress->value[STRESS_gravity];
    double g = bound->share * gravity * fabs(1 - bound->held) + bound->drag * bound->wind;
    if (stress->value[STRESS_gust] > 0 && bound->wind > 0) return false;
    if (!(bound->drag > 0) || !(time > PATIENCE * 2 / bound->drag)) return false;
    if (g > 0) return time > PATIENCE * bound->drag * bound->length / g;
    // Without gravity and wind only springs pull. After N steps, each of which removes a share y,
    // 2 L e^{-y N} is left, so a step moves by at most 2 L/(e N).
    return bound->held > 0 && steps / 2 > 2 / (exp(1) * REST_MOVE);
}

StressBound stress_bound_create(const StressCase *stress, const SectionParams *params, int steps)
{
    double spread = fmin(stress->value[STRESS_wind_spread], 89) * PI / 180;
    StressBound bound = {
        .step_s =
            stress->value[STRESS_dt] * (is(stress, "rope") ? (double)params->rope_time_scale : 1),
        .drag = (double)params->drag,
        .wind = stress->value[STRESS_wind] * (1 + stress->value[STRESS_gust]) / cos(spread),
        .length = stress->value[STRESS_length],
        .stiffness = turned_springs(stress, params),
        // The velocity that a strand gains in the step of a jerk, over the root's change of
        // velocity. With jerks of tens of segments, chain's length corrections overshoot. In dftl
        // no particle moves farther than the particle before it, and the root moves by the jerk;
        // but a slow particle that is thrown about the one before it can gain as much again.
        .jerk = is(stress, "chain")  ? 1.5
                : is(stress, "dftl") ? 2
                                     : 1,
        .carries = is(stress, "tressfx") || (params->clamped > 1 && stress->value[STRESS_n] > 2),
        .bends = 16 * joint_stiffness(stress, params),
        .small_steps = strcmp(stress->variant, "xpbd") == 0       ? params->rope_iterations
                       : strcmp(stress->variant, "explicit") == 0 ? STRESS_MOST_SMALL_STEPS
                                                                  : 1,
    };
    find_held(&bound, stress, params);
    if (is(stress, "tressfx")) // its damping acts like additional drag
        bound.drag += (double)params->tressfx_damping * (double)params->tressfx_damping_rate;
    double g = bound.g + bound.drag * bound.wind, links = stress->value[STRESS_n] - 1;
    bound.rest_shortest = bound.step_s * bound.step_s * g * links / (CALM * CALM);
    apply_promises(&bound, stress, params, must_rest(stress, &bound, steps));
    if (bound.rise >= 0 || bound.rest_move > 0)
        bound.flutter = flutter_number(stress, params, bound.g);
    // Damping by a share in each step acts like drag of unknown strength.
    if (is(stress, "rope") && params->rope_damping > 0) bound.drag = INFINITY;
    return bound;
}

// Adds up the changes of the gravity that acts on the strand.
static void step_gravity(StressBound *bound, const StressMove *move)
{
    Double3 felt, change;
    find_felt(bound, move, felt);
    if (bound->steps == 0) {
        memcpy(bound->felt_first, felt, sizeof felt);
        memcpy(bound->felt, felt, sizeof felt);
    }
    for (int k = 0; k < 3; ++k) change[k] = felt[k] - bound->felt[k];
    bound->changes += double3_length(change);
    bound->strongest = fmax(bound->strongest, double3_length(felt));
    memcpy(bound->felt, felt, sizeof felt);
}

void stress_bound_step(StressBound *bound, const StressMove *move)
{
    double change = 0, speed = 0, head = fabs(move->angle) / bound->step_s,
           warp = move->warp / bound->step_s, rate = head + warp,
           angle = fabs(move->angle) + move->warp;
    step_gravity(bound, move);
    for (int k = 0; k < 3; ++k) {
        double u = move->moved[k] / bound->step_s;
        change += (u - bound->root_velocity[k]) * (u - bound->root_velocity[k]);
        speed += u * u;
        bound->root_velocity[k] = u;
    }
    double air = bound->wind + sqrt(speed);
    bound->kicks += bound->changed = sqrt(change);
    bound->steps += 1;
    bound->turned += bound->stiffness * angle;
    bound->turning = fmax(bound->turning, rate * bound->length);
    // The axis of a warp's rotation may change in each step, so two steps' rates are added instead
    // of subtracted.
    bound->spun += fabs(head - bound->rate) + warp + bound->warp + rate * fmin(angle, 2);
    bound->rate = head;
    bound->warp = warp;
    if (!(bound->drag > 0)) return;
    bound->cap = fmax(bound->cap, air * air + 4 * bound->g * bound->length);
    if (air > 0)
        bound->blown = fmin(bound->blown + bound->drag * air * air / 2 * bound->step_s, bound->cap);
}

void stress_bound_fill(const StressBound *bound, bool last, StressParams *params)
{
    const double most = 1e18; // its square must be finite in float32
    double overshoot = (bound->jerk - 1) * bound->changed;
    params->per_dt = (float)(1 / bound->step_s);
    params->kicks = (float)fmin(bound->kicks + overshoot + bound->turning, most);
    params->spun = bound->carries ? (float)fmin(bound->spun, most) : 0;
    params->carried = bound->carries;
    params->hangs = bound->hangs;
    params->changes = (float)fmin(bound->changes, most);
    params->strongest = (float)bound->strongest;
    for (int k = 0; k < 3; ++k) {
        params->gravity[k] = (float)bound->felt[k];
        params->gravity_first[k] = (float)bound->felt_first[k];
    }
    params->added = (float)fmin(bound->blown + bound->turned, most * most);
    params->rise = (float)bound->rise;
    params->energy = bound->rise >= 0;
    params->resolved = (float)bound->resolved;
    params->rounding = 12 * 0x1p-24f;
    params->bends = (float)fmin(bound->bends, most * most);
    params->noise_steps = (float)(bound->small_steps * (NOISE_STEPS + sqrt(bound->steps)));
    params->length_error = (float)bound->length_error;
    params->rest_shortest = (float)bound->rest_shortest;
    params->flutter = (float)bound->flutter;
    params->most_flutter = (float)MOST_FLUTTER;
    params->rest_resolved = (float)bound->rest_resolved;
    params->rest_move = last ? (float)bound->rest_move : 0;
}
