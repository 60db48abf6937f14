// SPDX-License-Identifier: MIT
#include "sim/solver.h"

#include "glsl/sim/spring_params.h"

#include <cglm/cglm.h>

#include <math.h>
#include <string.h>

static void fill(void *block, StepParams *uniforms, const SolverStep *step,
                 const SectionParams *params)
{
    (void)uniforms;
    (void)step;
    *(SpringParams *)block = (SpringParams){
        .coil = params->spring_coil,
        .angular = params->spring_angular * step_style_odds(params),
        .stretch_drawn = params->stretch_drawn,
    };
}

static void along(float texel[4], const void *block, const void *mean, const SectionParams *there)
{
    const SpringParams *spring = block, *all = mean;
    (void)there;
    texel[0] = all->angular > 0 ? spring->angular / all->angular : 0;
}

static void define(ShaderDefine *defines, const SectionParams *params)
{
    defines[0] = (ShaderDefine){"IMPLICIT", strcmp(params->variant, "explicit") != 0};
}

static int two_phases(const SectionParams *params, const Hair *hair)
{
    (void)hair;
    (void)params;
    return 2; // there and back
}

static uint32_t most_links(const Hair *hair)
{
    uint32_t most = 1;
    for (uint32_t i = 0; i < hair->batch_count; ++i)
        if (hair->batches[i].vertex_count - 1 > most) most = hair->batches[i].vertex_count - 1;
    return most;
}

// A step of backward Euler takes the directions of forces from its start. Measured, loose strands
// gain energy when more than 10 of the time sqrt(L/g)/(n - 1), in which a link falls by itself,
// pass in it.
static int calm_substeps(const SolverStep *step, const SectionParams *params, const Hair *hair)
{
    (void)params;
    const double limit = 10;
    double g = sqrt((double)glm_vec3_norm2((float *)step->gravity));
    double fall = sqrt(g / (double)hair->longest) * most_links(hair);
    return (int)fmax(1, fmin(ceil(step->dt * fall / limit), 1e3));
}

static const SolverRecipe IMPLICIT = {
    .label = "sim_spring",
    .shader = "sim/spring.comp",
    .scratch = 3,
    .params_size = sizeof(SpringParams),
    .fill = fill,
    .define = define,
    .along = along,
    .substeps = calm_substeps,
    .phases = two_phases,
};

// Symplectic Euler needs h omega < 2. By Gershgorin, omega^2 <= 4 (k/2 + b/l): a particle's row of
// the stiffness matrix has its two links' once and its neighbours' one each; coils have k/2 at
// most, angular springs k/8 a length. 1.6 leaves room for even hair.
//
// A link shorter than a quarter of the average (SHORT of spring.comp) may turn over in a sub-step,
// so that the matrix is another in each. Where it alternates between two, (2 - (h omega_1)^2) (2 -
// (h omega_2)^2) < 0 lets energy rise without end, which h omega <= sqrt(2) rules out; cycles of
// three and more need less. Measured, 16 particles, links that differ by 1e4, no drag, 5000 steps
// of 1/60 s: of 18 strands two gain at 1.6, none at 1 (nor in 10000 steps).
static int stable_substeps(const SolverStep *step, const SectionParams *params, const Hair *hair)
{
    const double limit = hair->evenness < 0.25f ? 1 : 1.6;
    double omega = most_links(hair) * sqrt(2.5 * (double)params->spring_coil);
    return (int)fmin(ceil(step->dt * omega / limit), 1e9);
}

static const SolverRecipe EXPLICIT = {
    .label = "sim_spring",
    .shader = "sim/spring.comp",
    .params_size = sizeof(SpringParams),
    .fill = fill,
    .define = define,
    .along = along,
    .substeps = stable_substeps,
};

const SolverType SOLVER_SPRING = {
    .name = "spring",
    .summary = "mass-spring: coil springs along the links, angular springs towards the style",
    .lengths = "within what its stiffness allows; drawn exactly",
    .style = "angular springs, --style, --spring-angular",
    .variants = {"implicit", "explicit"},
    .recipes = {&IMPLICIT, &EXPLICIT},
};
