// SPDX-License-Identifier: MIT
#include "sim/solver.h"
#include "base/suggest.h"

#include <string.h>

#define POINT_TO_SOLVER(name) &SOLVER_##name,
const SolverType *const SOLVER_TYPES[] = {SOLVERS(POINT_TO_SOLVER) NULL};

enum { MAX_WORDS = 32 };

static const SolverType *find_type(const char *name)
{
    for (const SolverType *const *type = SOLVER_TYPES; *type; ++type)
        if (strcmp((*type)->name, name) == 0) return *type;
    return NULL;
}

static Result refuse_type(const char *name, Error *error)
{
    const char *names[MAX_WORDS];
    size_t count = 0;
    for (const SolverType *const *type = SOLVER_TYPES; *type && count < MAX_WORDS; ++type)
        names[count++] = (*type)->name;
    return error_set(error, RESULT_USAGE,
                     "algo: no solver '%s'; did you mean '%s'? (--algo list shows all)", name,
                     suggest_nearest(name, names, count));
}

static Result check_variant(const SolverType *type, const char *variant, Error *error)
{
    if (!*variant) return RESULT_OK;
    size_t count = 0;
    for (; type->variants[count]; ++count)
        if (strcmp(type->variants[count], variant) == 0) return RESULT_OK;
    if (count == 0)
        return error_set(error, RESULT_USAGE, "variant: '%s' has none, got '%s'", type->name,
                         variant);
    return error_set(error, RESULT_USAGE, "variant: '%s' has no '%s'; did you mean '%s'?",
                     type->name, variant, suggest_nearest(variant, type->variants, count));
}

Result solver_check(const SectionParams *params, Error *error)
{
    const SolverType *type = find_type(params->algo);
    return type ? check_variant(type, params->variant, error) : refuse_type(params->algo, error);
}

const char *solver_caution(const SectionParams *params)
{
    const SolverType *type = find_type(params->algo);
    return type->caution ? type->caution(params) : NULL;
}

float solver_most_stability(const SectionParams *params)
{
    return find_type(params->algo)->most_stability;
}

Result solver_create(Solver *solver, const SolverSetup *setup, Error *error)
{
    *solver = (Solver){0};
    Result result = solver_check(setup->params, error);
    if (result != RESULT_OK) return result;
    solver->type = find_type(setup->params->algo);
    SolverSetup typed = *setup;
    typed.type = solver->type;
    result = solver->type->calls->create(&solver->state, &typed, error);
    if (result != RESULT_OK) *solver = (Solver){0};
    return result;
}

void solver_destroy(Solver *solver)
{
    if (solver->type) solver->type->calls->destroy(solver->state);
    *solver = (Solver){0};
}

int solver_buffers(const Solver *solver, uint32_t batch, SolverBuffer buffers[SOLVER_MAX_BUFFERS])
{
    const SolverCalls *calls = solver->type->calls;
    return calls->buffers ? calls->buffers(solver->state, batch, buffers) : 0;
}

void solver_step(const Solver *solver, const SolverStep *step)
{
    if (solver->type->calls->step) solver->type->calls->step(solver->state, step);
}

void solver_pose(const Solver *solver, const HeadPose *head)
{
    solver->type->calls->pose(solver->state, head);
}

void solver_report(const Solver *solver, SolverReport *report)
{
    if (solver->type->calls->report) solver->type->calls->report(solver->state, report);
}

bool solver_is_static(const Solver *solver)
{
    return !solver->type->calls->step;
}

int solver_variant(const SolverType *type, const char *variant)
{
    for (int i = 0; i < SOLVER_MAX_VARIANTS && type->variants[i]; ++i)
        if (strcmp(type->variants[i], variant) == 0) return i;
    return 0;
}

static void print_flags(FILE *stream, const char *name)
{
    for (size_t i = 0; i < PARAM_COUNT; ++i) {
        if (!*PARAM_TABLE[i].owner || !params_owned_by(&PARAM_TABLE[i], name)) continue;
        fputs("           --", stream);
        for (const char *c = PARAM_TABLE[i].name; *c; ++c) fputc(*c == '_' ? '-' : *c, stream);
        fprintf(stream, " (%s)\n", PARAM_TABLE[i].default_text);
    }
}

void solver_print_list(FILE *stream)
{
    for (const SolverType *const *type = SOLVER_TYPES; *type; ++type) {
        fprintf(stream, "%-10s %s\n", (*type)->name, (*type)->summary);
        fprintf(stream, "           lengths: %s; style: %s\n",
                (*type)->lengths ? (*type)->lengths : "-",
                (*type)->style ? (*type)->style : "not kept");
        for (int i = 0; (*type)->variants[i]; ++i)
            fprintf(stream, "           --variant %s%s\n", (*type)->variants[i],
                    i ? "" : " (default)");
        print_flags(stream, (*type)->name);
    }
}
