// SPDX-License-Identifier: MIT
#include "sim/solver.h"

#include "base/parallel.h"
#include "scene/scene.h"
#include "sim/along.h"
#include "sim/rest_shape.h"
#include "strands/fibre.h"

#include "glsl/sim/rod_params.h"

#include <math.h>
#include <stdlib.h>

static double rod_stiffness(const SectionParams *params)
{
    const Fibre fibre = fibre_of(params);
    return fibre_stiffness(&fibre);
}

// Kelvin-Voigt damping of time eta takes bending eta later than the middle of the step: at most
// half a step later, or MOST_LATER in shorter steps. Beyond that, strands that turn fast would be
// bent by an extrapolation that has no meaning.
static float bending_share(const SectionParams *params, double dt)
{
    const double MOST_LATER = 2e-3; // s
    double later = fmin((double)params->bend_damping * 1e-3, fmax(dt / 2, MOST_LATER));
    return (float)(0.5 + later / dt);
}

static void fill(void *block, StepParams *uniforms, const SolverStep *step,
                 const SectionParams *params)
{
    double radius = (double)params->hair_radius;
    // The first step is like any other: velocities belong to the ends of steps.
    step_drag_factors((double)params->drag, step->dt, &uniforms->decay, &uniforms->gain);
    *(RodParams *)block = (RodParams){
        .spring = step_style_spring(uniforms, step->dt, params),
        .bend = (float)rod_stiffness(params),
        .twist = 1 / (1 + params->poisson),
        .share = bending_share(params, step->dt),
        .area = (float)(radius * radius),
    };
}

static float contact_bend(const SectionParams *params, double dt)
{
    return (float)((double)bending_share(params, dt) * rod_stiffness(params) * dt * dt / 2);
}

// Stiffness and mass are relative to the cross section of the mean radius.
static void along(float texel[4], const void *block, const void *mean, const SectionParams *there)
{
    const RodParams *rod = block, *all = mean;
    (void)there;
    float area = all->area > 0 ? rod->area / all->area : 1;
    texel[0] = rod->spring.stiffness, texel[1] = area, texel[2] = rod->bend * area;
}

static void define(ShaderDefine *defines, const SectionParams *params)
{
    bool fibre = section_is_elastic(params);
    defines[0] = (ShaderDefine){"JOINTS", fibre && params->youngs_modulus > 0};
    defines[1] = (ShaderDefine){"BALANCED", fibre && solver_keeps_groom(params)};
    defines[2] = (ShaderDefine){"EQUAL", !fibre};
}

// --- The groom at rest.

typedef struct Balance {
    RestBatch *batch;
    RestJoint *joints;     // [parts][vertices]
    double (*bend)[2];     // [vertices]: B/(rho A0), area over that of the mean radius
    double *gravity_share; // [vertices]
    double (*sums)[2];     // [parts]: weight, held
    int parts;
} Balance;

enum { MOST_PARTS = 64 };

static void fill_joint(const Balance *balance, const float (*rest)[4], uint32_t slot, uint32_t j,
                       RestJoint *joint)
{
    const RestBatch *batch = balance->batch;
    const HairBatch *hair = batch->hair;
    const float *here = rest[hair_address(hair, slot, j)];
    bool clamp = j == batch->lead + 1;
    double l = (double)here[3], before = 0, beyond = 0;
    if (!clamp || batch->lead) before = (double)rest[hair_address(hair, slot, j - 1)][3];
    if (j + 1 < hair->vertex_count) beyond = (double)rest[hair_address(hair, slot, j + 1)][3];
    *joint = (RestJoint){.length = l,
                         .bend = balance->bend[j - 1][0],
                         .beta = 2 * balance->bend[j - 1][0] / (before + l)};
    for (int k = 0; k < 3; ++k) {
        joint->t[k] = (double)here[k];
        joint->weight[k] = 0.5 * (l + beyond) * balance->bend[j][1] * balance->gravity_share[j] *
                           (double)batch->gravity[k];
    }
    double size =
        sqrt(joint->t[0] * joint->t[0] + joint->t[1] * joint->t[1] + joint->t[2] * joint->t[2]);
    for (int k = 0; k < 3; ++k) joint->t[k] /= size;
}

static void balance_strand(const Balance *balance, int part, uint32_t slot)
{
    const RestBatch *batch = balance->batch;
    const HairBatch *hair = batch->hair;
    int n = (int)(hair->vertex_count - 1 - batch->lead);
    RestJoint *joints = balance->joints + (size_t)part * hair->vertex_count;
    for (int j = 1; j <= n; ++j)
        fill_joint(balance, batch->rest, slot, (uint32_t)j + batch->lead, &joints[j]);
    rest_shape_solve(joints, n, 1 / (1 + (double)batch->params->poisson));
    for (int j = 1; j <= n; ++j) {
        size_t at = hair_address(hair, slot, (uint32_t)j + batch->lead);
        double weight = 0, held = 0;
        for (int k = 0; k < 3; ++k) {
            batch->natural[at][k] = (float)joints[j].natural[k];
            batch->held[at][k] = (float)joints[j].held[k];
            weight += pow(joints[j].weight[k], 2), held += pow(joints[j].held[k], 2);
        }
        batch->natural[at][3] = (float)joints[j].twist;
        if (slot >= hair->strand_count) continue;
        balance->sums[part][0] += sqrt(weight), balance->sums[part][1] += sqrt(held);
    }
}

static void balance_part(void *data, int part)
{
    const Balance *balance = data;
    uint32_t slots = hair_slots(balance->batch->hair);
    uint32_t first = (uint32_t)((uint64_t)slots * (uint64_t)part / (uint64_t)balance->parts),
             end = (uint32_t)((uint64_t)slots * (uint64_t)(part + 1) / (uint64_t)balance->parts);
    for (uint32_t slot = first; slot < end; ++slot) balance_strand(balance, part, slot);
}

// B/(rho A) times the cross section's share of the mean radius's, m^4/s^2, and that share.
static void find_material(const SectionParams *params, double share, double material[2])
{
    const SectionParams there = along_params_at(params, share);
    double radius = (double)there.hair_radius, mean = (double)params->hair_radius;
    material[1] = radius * radius / (mean * mean);
    material[0] = rod_stiffness(&there) * material[1];
}

static Result balance_groom(RestBatch *batch, Error *error)
{
    uint32_t n = batch->hair->vertex_count;
    Balance balance = {.batch = batch, .parts = MOST_PARTS};
    balance.joints = malloc((size_t)MOST_PARTS * n * sizeof *balance.joints);
    balance.bend = malloc(n * sizeof *balance.bend);
    balance.gravity_share = malloc(n * sizeof *balance.gravity_share);
    balance.sums = calloc(MOST_PARTS, sizeof *balance.sums);
    Result result = RESULT_OK;
    if (!balance.joints || !balance.bend || !balance.gravity_share || !balance.sums)
        result = error_set(error, RESULT_FAILED, "no memory for the groom's balance");
    for (uint32_t j = 0; j < n && result == RESULT_OK; ++j) {
        double share = (double)j / (n - 1);
        find_material(batch->params, share, balance.bend[j]);
        balance.gravity_share[j] = (double)along_params_at(batch->params, share).gravity_share;
    }
    if (result == RESULT_OK) parallel_run(balance.parts, balance_part, &balance);
    for (int part = 0; part < MOST_PARTS && result == RESULT_OK; ++part)
        batch->weight += balance.sums[part][0], batch->supports += balance.sums[part][1];
    free(balance.joints);
    free(balance.bend);
    free(balance.gravity_share);
    free(balance.sums);
    return result;
}

static const SolverRecipe FIBRE = {
    .label = "sim_rod",
    .shader = "sim/rod.comp",
    .shape = STEP_ROD,
    .scratch = 7,
    .most_vertices = 5000, // 13 sweeps fit the 65535 iterations of CPU drivers
    .params_size = sizeof(RodParams),
    .fill = fill,
    .define = define,
    .along = along,
    .bend = contact_bend,
    .midpoint = true,
    .counts = true,
    .balance = balance_groom,
};

static const SolverRecipe PARTICLES = {
    .label = "sim_rod",
    .shader = "sim/rod.comp",
    .shape = STEP_ROD,
    .scratch = 7,
    .most_vertices = 5000,
    .params_size = sizeof(RodParams),
    .fill = fill,
    .define = define,
    .along = along,
    .midpoint = true,
    .counts = true,
};

const SolverType SOLVER_ROD = {
    .name = "rod",
    .summary = "every particle is simulated, as an elastic rod with material parameters: bends, "
               "twists, keeps its curls; second order in the step",
    .lengths = "exact",
    .style = "natural shape of the fibre; position springs: --style, --style-stiffness",
    .most_stability = 3,
    .variants = {"fibre", "particles"},
    .recipes = {&FIBRE, &PARTICLES},
};
