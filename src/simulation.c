// SPDX-License-Identifier: MIT
#include "simulation.h"
#include "forces.h"

#include <stdlib.h>
#include <string.h>

static bool same_pose(const HeadPose *a, const HeadPose *b)
{
    return memcmp(a->rotation, b->rotation, sizeof a->rotation) == 0 &&
           memcmp(a->translation, b->translation, sizeof a->translation) == 0;
}

static HeadPose head_at(const Scene *scene, double time)
{
    HeadPose pose = {0};
    rigid_track_evaluate(&scene->head, time, pose.rotation, pose.translation);
    return pose;
}

static Result create_section(SimulationSection *section, const Gpu *gpu, GpuTimer *timer,
                             const Section *description, const Strands *strands, uint32_t first_id,
                             uint32_t seed, Error *error)
{
    Result result = hair_create(&section->hair, strands, first_id, &gpu->limits, error);
    if (result == RESULT_OK) {
        const SolverSetup setup = {
            .gpu = gpu, .timer = timer, .hair = &section->hair, .params = &description->params};
        result = solver_create(&section->solver, &setup, error);
    }
    if (result == RESULT_OK)
        result = follow_create(&section->follow, gpu, timer, &section->hair, strands,
                               &description->params, seed, error);
    return result == RESULT_OK ? RESULT_OK : error_prefix(error, result, "%s: ", description->file);
}

Result simulation_create(Simulation *simulation, const Gpu *gpu, GpuTimer *timer,
                         const Scene *scene, const Strands *strands, Error *error)
{
    *simulation = (Simulation){.scene = scene, .timer = timer, .head = head_at(scene, 0)};
    simulation->sections =
        calloc(scene->section_count ? scene->section_count : 1, sizeof *simulation->sections);
    if (!simulation->sections)
        return error_set(error, RESULT_FAILED, "no memory for %u sections", scene->section_count);
    Result result = RESULT_OK;
    uint32_t first_id = 0;
    for (uint32_t i = 0; i < scene->section_count && result == RESULT_OK; ++i) {
        result = create_section(&simulation->sections[i], gpu, timer, &scene->sections[i],
                                &strands[i], first_id, scene->run.seed, error);
        first_id += strands[i].strand_count;
    }
    if (result != RESULT_OK) simulation_destroy(simulation);
    return result;
}

void simulation_destroy(Simulation *simulation)
{
    for (uint32_t i = 0; simulation->sections && i < simulation->scene->section_count; ++i) {
        follow_destroy(&simulation->sections[i].follow);
        solver_destroy(&simulation->sections[i].solver);
        hair_destroy(&simulation->sections[i].hair);
    }
    free(simulation->sections);
    *simulation = (Simulation){0};
}

// Forces act at the step's start; the head's end pose is where the roots go.
static SolverStep next_step(const Simulation *simulation, int substep)
{
    const RunParams *run = &simulation->scene->run;
    double dt = 1 / ((double)run->fps * run->substeps);
    double time = simulation->frame / (double)run->fps + substep * dt;
    Forces forces;
    forces_evaluate(&forces, simulation->scene, time);
    SolverStep step = {
        .dt = dt,
        .first = simulation->frame == 0 && substep == 0,
        .shuffle = run->seed + (uint32_t)(simulation->frame * run->substeps + substep),
        .head_old = simulation->head,
        .head = head_at(simulation->scene, time + dt),
    };
    memcpy(step.gravity, forces.gravity, sizeof step.gravity);
    memcpy(step.wind, forces.wind, sizeof step.wind);
    return step;
}

void simulation_advance(Simulation *simulation)
{
    for (int substep = 0; substep < simulation->scene->run.substeps; ++substep) {
        SolverStep step = next_step(simulation, substep);
        for (uint32_t i = 0; i < simulation->scene->section_count; ++i) {
            const Solver *solver = &simulation->sections[i].solver;
            if (solver_is_static(solver)) continue;
            solver_step(solver, &step);
            ++simulation->steps;
        }
        simulation->head = step.head;
    }
    ++simulation->frame;
}

void simulation_pose(Simulation *simulation)
{
    for (uint32_t i = 0; i < simulation->scene->section_count; ++i) {
        SimulationSection *section = &simulation->sections[i];
        bool same_head = same_pose(&section->posed_at, &simulation->head);
        if (section->posed && same_head && solver_is_static(&section->solver)) {
            ++simulation->poses_skipped;
            continue;
        }
        solver_pose(&section->solver, &simulation->head);
        follow_write(&section->follow, &simulation->head);
        section->posed = true;
        section->posed_at = simulation->head;
        ++simulation->poses;
    }
}

bool simulation_is_still(const Simulation *simulation)
{
    for (uint32_t i = 0; i < simulation->scene->section_count; ++i)
        if (!solver_is_static(&simulation->sections[i].solver)) return false;
    return rigid_track_is_still(&simulation->scene->head);
}

SolverReport simulation_report(const Simulation *simulation)
{
    SolverReport report = {0};
    for (uint32_t i = 0; i < simulation->scene->section_count; ++i)
        solver_report(&simulation->sections[i].solver, &report);
    return report;
}
