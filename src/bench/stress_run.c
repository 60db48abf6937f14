// SPDX-License-Identifier: MIT
#include "bench/stress_run.h"
#include "base/double3.h"
#include "base/interrupt.h"
#include "bench/bench_glsl.h"
#include "gpu/gpu_dispatch.h"
#include "gpu/gpu_uniforms.h"
#include "scene/forces.h"
#include "sim/bound.h"
#include "sim/solver.h"
#include "sim/step.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

// --- Bounds.

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
    {"dftl", "mueller", ENERGY | REST, 0, "its corrections give energy, as published"},
};
static const double USUAL_RISE = 0.02;

static const double LENGTH_ERROR = 1e-5;
static const double REST_MOVE =
    3e-3; // of the length in a step: the tremor that docs/solvers.md has

static const double PATIENCE = 30; // of each time constant, until a strand must lie still
static const double CALM = 2; // stability number (simulation.h) up to which solvers come to rest

static const double TRESSFX_RESOLVED = 4096; // roundings
static const double MOST_FLUTTER = 0.5;      // the smallest at which a strand was found to: 0.52

static const double NOISE_STEPS = 8; // steps whose rounding may add up, beside a random walk's

static bool is(const StressCase *stress, const char *algo)
{
    return strcmp(stress->algo, algo) == 0;
}

static double odds_of(const SectionParams *params)
{
    return (double)params->style / fmax(1 - (double)params->style, 1e-6);
}

// Springs towards the style: 4 k L^2 and 2 pi b L for each radian.
static double turned_springs(const StressCase *stress, const SectionParams *params)
{
    double odds = odds_of(params), length = stress->value[STRESS_length],
           square = 4 * length * length;
    double bend = 2 * PI * length * odds;
    if (is(stress, "split")) return 0; // its style is drawn only
    if (is(stress, "spring")) return bend * (double)params->spring_angular;
    if (is(stress, "tressfx")) {
        double passes = (double)params->tressfx_local_constraints_iterations / 2;
        return square * fmax(passes, 1) * 4e4 * odds;
    }
    double springs = square * (double)params->style_stiffness * odds;
    return springs + (is(stress, "chain") ? bend * (double)params->chain_bend : 0);
}

// Whether the parameters lie in the range in which docs/solver_derivations.md says that `tressfx
// steady` gains no energy, with TressFX's fixed constants unchanged.
static bool is_stable_tressfx(const StressCase *stress, const SectionParams *params)
{
    double dt = stress->value[STRESS_dt];
    return dt > 1.0 / 241 && dt < 1.0 / 29 && params->tressfx_damping_rate == 60 &&
           params->tressfx_local_constraints_iterations <= 8 &&
           params->tressfx_local_share <= 0.5f && params->tressfx_local_max <= 0.95f;
}

// F: a strand's weight over the stiffness of its joints (stress_run.h), in TressFX's two passes a
// frame, which `steady` keeps to.
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

static void apply_promises(StressBound *bound, const StressCase *stress,
                           const SectionParams *params, bool rests)
{
    unsigned lacks = 0;
    bound->rise = USUAL_RISE;
    // Shorter segments have no certain direction; TressFX's levers make much of that.
    bound->resolved = is(stress, "tressfx") ? TRESSFX_RESOLVED : 64;
    // What rounding turns a short segment by, by that it turns all behind it.
    bound->rest_resolved = is(stress, "tressfx") ? TRESSFX_RESOLVED : 0;
    for (size_t i = 0; i < sizeof EXCEPTIONS / sizeof *EXCEPTIONS; ++i)
        if (strcmp(EXCEPTIONS[i].algo, stress->algo) == 0 &&
            (!EXCEPTIONS[i].variant || strcmp(EXCEPTIONS[i].variant, stress->variant) == 0)) {
            lacks |= EXCEPTIONS[i].lacks;
            if (EXCEPTIONS[i].rise > 0) bound->rise = EXCEPTIONS[i].rise;
        }
    bool elastic = is(stress, "spring") || is(stress, "rope");
    if (elastic) lacks |= params->stretch_drawn ? LENGTHS : ENERGY; // which it draws
    if (is(stress, "tressfx") && !is_stable_tressfx(stress, params)) lacks |= ENERGY | REST;
    if (lacks & ENERGY) bound->rise = -1;
    bound->length_error = lacks & LENGTHS ? 0 : LENGTH_ERROR;
    bound->rest_move = rests && !(lacks & REST) ? REST_MOVE * bound->length : 0;
}

// What is felt of gravity, m/s^2, at `turned` rad of the head: a groom holds its own part.
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

// What the groom holds, and how strong what is left can be.
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

// Whether what drag takes must have ended in the half of the steps in which the head rests.
static bool must_rest(const StressCase *stress, const StressBound *bound, int steps)
{
    double time = bound->step_s * steps / 2, gravity = stress->value[STRESS_gravity];
    double g = bound->share * gravity * fabs(1 - bound->held) + bound->drag * bound->wind;
    if (stress->value[STRESS_gust] > 0 && bound->wind > 0) return false;
    if (!(bound->drag > 0) || !(time > PATIENCE * 2 / bound->drag)) return false;
    if (g > 0) return time > PATIENCE * bound->drag * bound->length / g;
    // Only springs pull: 2L e^{-y N} is left after N steps of a share y, 2 L/(e N) a step at most.
    return bound->held > 0 && steps / 2 > 2 / (exp(1) * REST_MOVE);
}

StressBound stress_run_bound(const StressCase *stress, const SectionParams *params, int steps)
{
    double spread = fmin(stress->value[STRESS_wind_spread], 89) * PI / 180;
    StressBound bound = {
        .step_s =
            stress->value[STRESS_dt] * (is(stress, "rope") ? (double)params->rope_time_scale : 1),
        .drag = (double)params->drag,
        .wind = stress->value[STRESS_wind] * (1 + stress->value[STRESS_gust]) / cos(spread),
        .length = stress->value[STRESS_length],
        .stiffness = turned_springs(stress, params),
        // What a jerk of the root gives to a strand, over its change of velocity, in that step
        // only. Where it is by tens of links, chain's corrections of the lengths overshoot. In dftl
        // no particle moves by more than its leader, and the root by the jerk; a slowed one that is
        // thrown about its leader comes out there all the same.
        .jerk = is(stress, "chain")  ? 1.5
                : is(stress, "dftl") ? 2
                                     : 1,
        .carries = is(stress, "tressfx") || (params->clamped > 1 && stress->value[STRESS_n] > 2),
        .bends = 16 * (is(stress, "chain") ? (double)params->chain_bend : 0) * odds_of(params) *
                 (stress->value[STRESS_n] - 1) * stress->value[STRESS_length],
        .small_steps = strcmp(stress->variant, "xpbd") == 0       ? params->rope_iterations
                       : strcmp(stress->variant, "explicit") == 0 ? STRESS_MOST_SMALL_STEPS
                                                                  : 1,
    };
    find_held(&bound, stress, params);
    if (is(stress, "tressfx")) // which has more that makes hair go with the air
        bound.drag += (double)params->tressfx_damping * (double)params->tressfx_damping_rate;
    double g = bound.g + bound.drag * bound.wind, links = stress->value[STRESS_n] - 1;
    bound.rest_shortest = bound.step_s * bound.step_s * g * links / (CALM * CALM);
    apply_promises(&bound, stress, params, must_rest(stress, &bound, steps));
    if (bound.rise >= 0 || bound.rest_move > 0)
        bound.flutter = flutter_number(stress, params, bound.g);
    // Damping by a share in each step is drag of some strength.
    if (is(stress, "rope") && params->rope_damping > 0) bound.drag = INFINITY;
    return bound;
}

// Takes into account how what is felt of gravity has changed.
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

void stress_run_bound_step(StressBound *bound, const StressMove *move)
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
    // The axis of a warp's turn may be another one in each step.
    bound->spun += fabs(head - bound->rate) + warp + bound->warp + rate * fmin(angle, 2);
    bound->rate = head;
    bound->warp = warp;
    if (!(bound->drag > 0)) return;
    bound->cap = fmax(bound->cap, air * air + 4 * bound->g * bound->length);
    if (air > 0)
        bound->blown = fmin(bound->blown + bound->drag * air * air / 2 * bound->step_s, bound->cap);
}

void stress_run_bound_fill(const StressBound *bound, bool last, StressParams *params)
{
    const double most = 1e18; // float32 squares it
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

// --- Running.

enum { JUMP_PERIOD = 64 };

const char *const STRESS_RULE_NAMES[STRESS_RULES] = {"finite", "lengths", "energy", "rest"};

typedef struct Run {
    const StressCase *set;
    int steps;
    double allowed;
    Hair hair;
    SectionParams params;
    Scene scene; // its wind
    GpuTimer timer;
    Solver solver;
    SolverStep step;
    StressBound bound;
    GLuint program;
    const GpuLimits *limits;
    GpuBuffer before, worst, first;
    Mesh sheet; // to which strands are bound; empty: to none
    Body body;  // its samples are before and after a step, whose number is their time
    BoundBody bound_body;
    Bound strands;
    RigidMotion motion; // of the strands' frames, at the step's start
} Run;

static void run_destroy(Run *run)
{
    bound_destroy(&run->strands);
    bound_body_destroy(&run->bound_body);
    body_destroy(&run->body);
    mesh_destroy(&run->sheet);
    solver_destroy(&run->solver);
    hair_destroy(&run->hair);
    params_destroy_section(&run->params);
    gpu_timer_destroy(&run->timer);
    if (run->program) glDeleteProgram(run->program);
    gpu_buffer_destroy(&run->before);
    gpu_buffer_destroy(&run->worst);
    gpu_buffer_destroy(&run->first);
}

static Result upload(Run *run, const Gpu *gpu, const StressCase *strands, int count, Error *error)
{
    uint32_t n = (uint32_t)run->set->value[STRESS_n];
    Strands made;
    TRY(strands_create(&made, (uint32_t)count, (uint32_t)count * n, error));
    for (uint32_t s = 0; s < (uint32_t)count; ++s) {
        made.first[s + 1] = (s + 1) * n;
        stress_case_make_strand(&strands[s], &made.position[s * n]);
    }
    Result result = hair_create(&run->hair, &made, (uint32_t)run->set->value[STRESS_strand],
                                &gpu->limits, error);
    strands_destroy(&made);
    return result;
}

// --- The mesh: a sheet about the roots, which all are in one place.

enum { SHEET_CELLS = 6, SHEET_VERTICES = (SHEET_CELLS + 1) * (SHEET_CELLS + 1) };

static Result make_sheet(Run *run, Error *error)
{
    const double *value = run->set->value, cell = value[STRESS_warp_size] / 10;
    Mesh *sheet = &run->sheet;
    TRY(mesh_create(sheet, SHEET_VERTICES, 2 * SHEET_CELLS * SHEET_CELLS, error));
    for (int v = 0; v < SHEET_VERTICES; ++v) {
        int i = v % (SHEET_CELLS + 1), j = v / (SHEET_CELLS + 1);
        sheet->position[v][0] = (float)(cell * (i - SHEET_CELLS / 2));
        sheet->position[v][1] = (float)value[STRESS_arm];
        sheet->position[v][2] = (float)(cell * (j - SHEET_CELLS / 2));
    }
    for (uint32_t c = 0; c < SHEET_CELLS * SHEET_CELLS; ++c) {
        uint32_t a = c / SHEET_CELLS * (SHEET_CELLS + 1) + c % SHEET_CELLS, b = a + SHEET_CELLS + 1;
        const uint32_t two[2][3] = {{a, b, a + 1}, {a + 1, b, b + 1}};
        memcpy(sheet->triangle[2 * c], two, sizeof two);
    }
    mesh_compute_normals(sheet);
    return RESULT_OK;
}

static Result bind(Run *run, const Gpu *gpu, int count, Error *error)
{
    MeshSequence *sequence = &run->body.sequence;
    float(*roots)[3] = calloc((size_t)count, sizeof *roots);
    size_t size = sizeof *sequence->position * SHEET_VERTICES;
    TRY(make_sheet(run, error));
    *sequence = (MeshSequence){.times = {.count = 2, .rate = 1, .start = -1, .linear = true},
                               .vertex_count = SHEET_VERTICES,
                               .position = malloc(2 * size)};
    run->body.mesh = &run->sheet;
    run->body.name = "sheet";
    run->body.section_count = 1;
    run->body.roots = calloc(1, sizeof *run->body.roots);
    Result result = RESULT_OK;
    if (!roots || !sequence->position || !run->body.roots)
        result = error_set(error, RESULT_FAILED, "no memory for a mesh");
    for (int i = 0; i < 2 && result == RESULT_OK; ++i)
        memcpy(mesh_sequence_at(sequence, (uint32_t)i), run->sheet.position, size);
    for (int s = 0; s < count && result == RESULT_OK; ++s)
        roots[s][1] = (float)run->set->value[STRESS_arm];
    THEN(result, mesh_binding_create(run->body.roots, &run->sheet, "sheet",
                                     (const float(*)[3])roots, (uint32_t)count, error));
    THEN(result, bound_body_create(&run->bound_body, &run->body, error));
    THEN(result, bound_create(&run->strands, &run->bound_body, 0, &run->hair, &gpu->limits, error));
    if (result == RESULT_OK) bound_set(&run->strands, 0, 0);
    run->motion = (RigidMotion){.rotation = {0, 0, 0, 1}};
    free(roots);
    return result;
}

// The mesh after step i; it stands still in the second half. Returns the strands' frames there.
static RigidMotion warp(Run *run, int i)
{
    int moving = i < run->steps / 2 ? i : run->steps / 2;
    float position[SHEET_VERTICES][3];
    for (int v = 0; v < SHEET_VERTICES; ++v) {
        double rest[3], place[3];
        for (int k = 0; k < 3; ++k) rest[k] = (double)run->sheet.position[v][k];
        stress_case_warp(run->set, moving * run->set->value[STRESS_dt], rest, place);
        for (int k = 0; k < 3; ++k) position[v][k] = (float)place[k];
    }
    mesh_sequence_push(&run->body.sequence, (const float(*)[3])position, i - 1, i);
    const BodyPose *pose = bound_body_pose(&run->bound_body, i);
    return mesh_binding_motion(run->body.roots, 0, (const float(*)[3])pose->position,
                               (const double(*)[4])pose->turn);
}

static Result create_check(Run *run, const Gpu *gpu, Error *error)
{
    const HairBatch *batch = &run->hair.batches[0];
    run->limits = &gpu->limits;
    const ShaderDefine defines[] = {
        {"GROUP_SIZE", gpu->limits.sizes.strands}, {"TIP", is(run->set, "split")}, {0}};
    int64_t size = (int64_t)hair_slots(batch) * 16;
    void *zero = calloc((size_t)size, 1);
    if (!zero) return error_set(error, RESULT_FAILED, "no memory for verdicts");
    shader_add_sources(BENCH_GLSL_SOURCES);
    Result result = shader_build_compute(&run->program, "bench/stress.comp", defines, error);
    THEN(result, gpu_buffer_create(&run->before, &gpu->limits, "positions before a step",
                                   batch->position.size, NULL, GL_RGBA32F, error));
    THEN(result, gpu_buffer_create(&run->worst, &gpu->limits, "verdicts", size, zero, 0, error));
    THEN(result, gpu_buffer_create(&run->first, &gpu->limits, "verdicts", size, zero, 0, error));
    free(zero);
    return result;
}

// rad, below two turns: the head's angle about z after step i.
static double angle_at(const Run *run, int i)
{
    double moving = i < run->steps / 2 ? i : run->steps / 2;
    return fmod(run->set->value[STRESS_spin] * moving * run->set->value[STRESS_dt], 4 * PI);
}

// The head after step i: off the origin, to and fro along x, shaken along z, turning about z; it
// stands still in the second half.
static HeadPose pose_at(const Run *run, int i)
{
    const double *value = run->set->value;
    int moving = i < run->steps / 2 ? i : run->steps / 2;
    double time = moving * value[STRESS_dt], half = angle_at(run, i) / 2;
    double jumped = moving / JUMP_PERIOD % 2 ? value[STRESS_jump] : 0;
    double shaken = value[STRESS_shake] * sin(2 * PI * value[STRESS_shake_rate] * time);
    return (HeadPose){{0, 0, (float)sin(half), (float)cos(half)},
                      {(float)(value[STRESS_away] + jumped), 0, (float)shaken}};
}

static bool is_looked_at(const Run *run, int i)
{
    bool jumps = run->set->value[STRESS_jump] > 0 && i <= run->steps / 2 + 8;
    return i <= 64 || i % 16 == 0 || i == run->steps || (jumps && i % JUMP_PERIOD < 8);
}

// The root, which lies at (0, arm, 0) in the head's frame, as float32 has it in the world; `own` is
// the motion of a mesh that it is bound to.
static void root_at(const Run *run, const HeadPose *pose, const RigidMotion *own, double root[3])
{
    if (run->sheet.vertex_count) {
        const double rest[3] = {0, run->set->value[STRESS_arm], 0};
        RigidMotion head = {
            .rotation = {0, 0, (double)pose->rotation[2], (double)pose->rotation[3]}};
        double place[3];
        for (int k = 0; k < 3; ++k) head.translation[k] = (double)pose->translation[k];
        rigid_motion_apply(own, rest, place);
        rigid_motion_apply(&head, place, root);
        for (int k = 0; k < 3; ++k) root[k] = (double)(float)root[k];
        return;
    }
    double s = (double)pose->rotation[2], c = (double)pose->rotation[3],
           arm = run->set->value[STRESS_arm];
    root[0] = (double)(float)((double)pose->translation[0] - 2 * s * c * arm);
    root[1] = (double)(float)((double)pose->translation[1] + (c * c - s * s) * arm);
    root[2] = (double)pose->translation[2];
}

static Result run_create(Run *run, const Gpu *gpu, const StressCase *strands, int count, int steps,
                         double allowed, Error *error)
{
    *run = (Run){.set = strands, .steps = steps, .allowed = allowed};
    const double *value = strands->value;
    double pitch = value[STRESS_wind_pitch] * PI / 180;
    RunParams *forces = &run->scene.run;
    forces->gravity[1] = (float)-value[STRESS_gravity];
    forces->wind[0] = (float)(value[STRESS_wind] * sin(pitch));
    forces->wind[1] = (float)(value[STRESS_wind] * -cos(pitch));
    forces->gust = (float)value[STRESS_gust];
    forces->gust_period = 2;
    forces->wind_spread = (float)value[STRESS_wind_spread];
    gpu_timer_create(&run->timer, false, true);
    TRY(stress_case_params(strands, &run->params, error));
    run->bound = stress_run_bound(strands, &run->params, steps);
    run->step = (SolverStep){.dt = value[STRESS_dt], .first = true, .number = 1};
    run->step.head = run->step.head_old = pose_at(run, 0);
    TRY(upload(run, gpu, strands, count, error));
    if (value[STRESS_warp] > 0) TRY(bind(run, gpu, count, error));
    float rest_gravity = 0;
    if (run->params.rest == REST_GROOM)
        rest_gravity = (float)(-value[STRESS_gravity] * value[STRESS_rest_share]);
    const SolverSetup setup = {.gpu = gpu,
                               .timer = &run->timer,
                               .hair = &run->hair,
                               .params = &run->params,
                               .head = &run->step.head,
                               .frames = run->strands.frames,
                               .rest_gravity = {0, rest_gravity, 0}};
    TRY(solver_create(&run->solver, &setup, error));
    return create_check(run, gpu, error);
}

static void keep_positions(Run *run)
{
    const GpuBuffer *positions = &run->hair.batches[0].position;
    solver_pose(&run->solver, &run->step.head_old);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_COPY_READ_BUFFER, positions->buffer);
    glBindBuffer(GL_COPY_WRITE_BUFFER, run->before.buffer);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0,
                        (GLsizeiptr)positions->size);
}

static void look(Run *run, int i)
{
    const HairBatch *batch = &run->hair.batches[0];
    StressParams params = {.step = (uint32_t)i,
                           .used_most = (float)run->allowed,
                           .strand_count = batch->strand_count,
                           .vertex_count = batch->vertex_count};
    stress_run_bound_fill(&run->bound, i == run->steps, &params);
    solver_pose(&run->solver, &run->step.head);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    gpu_uniforms_set(BIND_STEP, &params, sizeof params);
    gpu_buffer_bind_texture(&batch->position, BIND_POSITION);
    gpu_buffer_bind_texture(&run->before, BIND_STRESS_BEFORE);
    gpu_buffer_bind_texture(&batch->rest, BIND_REST);
    gpu_buffer_bind_storage(&run->worst, BIND_STRESS_WORST);
    gpu_buffer_bind_storage(&run->first, BIND_STRESS_FIRST);
    if (is(run->set, "split")) {
        SolverBuffer buffers[SOLVER_MAX_BUFFERS];
        solver_buffers(&run->solver, 0, buffers);
        gpu_buffer_bind_storage(buffers[1].buffer, BIND_TIPS);
    }
    glUseProgram(run->program);
    gpu_dispatch(run->limits, batch->strand_count, (uint64_t)run->limits->sizes.strands, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

static void take_step(Run *run, int i)
{
    SolverStep *step = &run->step;
    Forces forces;
    double before[3], now[3];
    StressMove move = {.turned = angle_at(run, i)};
    forces_evaluate(&forces, &run->scene, (i - 1) * step->dt);
    memcpy(step->gravity, forces.gravity, sizeof step->gravity);
    memcpy(step->wind, forces.wind, sizeof step->wind);
    step->head = pose_at(run, i);
    RigidMotion own = run->motion;
    if (run->sheet.vertex_count) {
        own = warp(run, i);
        const double *a = run->motion.rotation, *b = own.rotation;
        double along = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
        move.warp = 2 * acos(fmin(fabs(along), 1));
        memcpy(move.warped, own.rotation, sizeof move.warped);
        step->shape_old = bound_body_shape(&run->bound_body, i - 1);
        step->shape = bound_body_shape(&run->bound_body, i);
    }
    root_at(run, &step->head_old, &run->motion, before);
    root_at(run, &step->head, &own, now);
    run->motion = own;
    for (int k = 0; k < 3; ++k) {
        move.moved[k] = now[k] - before[k];
        move.gravity[k] = (double)step->gravity[k];
    }
    bool turns = i <= run->steps / 2;
    move.angle = turns ? fmin(run->set->value[STRESS_spin] * step->dt, PI) : 0;
    stress_run_bound_step(&run->bound, &move);
    bool looked_at = is_looked_at(run, i);
    bound_set_after(&run->strands, i - 1);
    if (looked_at) keep_positions(run);
    if (run->sheet.vertex_count) bound_set(&run->strands, i - 1, i);
    solver_step(&run->solver, step);
    if (looked_at) look(run, i);
    step->head_old = step->head;
    step->first = false;
    ++step->number;
}

Result stress_run(StressVerdict *verdicts, const Gpu *gpu, const StressCase *strands, int count,
                  int steps, double allowed, Error *error)
{
    enum { STEPS_IN_FLIGHT = 256 }; // on a GPU, so that it can be interrupted
    Run run;
    Result result = run_create(&run, gpu, strands, count, steps, allowed, error);
    for (int i = 1; i <= steps && result == RESULT_OK; ++i) {
        take_step(&run, i);
        if (i % STEPS_IN_FLIGHT == 0) glFinish();
        if (interrupt_requested()) result = error_set(error, RESULT_INTERRUPTED, "interrupted");
    }
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    for (int s = 0; s < count && result == RESULT_OK; ++s) {
        float worst[4];
        uint32_t first[4];
        GLintptr at = s * (GLintptr)sizeof worst;
        glBindBuffer(GL_COPY_READ_BUFFER, run.worst.buffer);
        glGetBufferSubData(GL_COPY_READ_BUFFER, at, sizeof worst, worst);
        glBindBuffer(GL_COPY_READ_BUFFER, run.first.buffer);
        glGetBufferSubData(GL_COPY_READ_BUFFER, at, sizeof first, first);
        verdicts[s].flutters = worst[3] > 0;
        for (int i = 0; i < STRESS_RULES; ++i) {
            verdicts[s].first[i] = (int)first[i];
            verdicts[s].worst[i] = i == 0 ? 0 : (double)worst[i - 1];
        }
    }
    run_destroy(&run);
    return result;
}
