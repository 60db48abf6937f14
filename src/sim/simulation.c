// SPDX-License-Identifier: MIT
#include "sim/simulation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Applies the parameters of a time if the section has tracks. Returns their stamp.
static uint64_t set_params(Simulation *simulation, SimulationSection *section, double time)
{
    const SectionTracks *tracks =
        &simulation->scene->sections[section - simulation->sections].tracks;
    if (!tracks->count) return 0;
    section_tracks_apply(tracks, time, &section->now);
    section->volume.strength = section->now.volume;
    section->follow.tip_separation = section->now.tip_separation;
    section->follow.clump = section->now.clump;
    uint64_t stamp = section_tracks_stamp(tracks, &section->now);
    solver_refresh(&section->solver, stamp);
    return stamp;
}

uint64_t simulation_params_stamp(Simulation *simulation, uint32_t section, int64_t step)
{
    return set_params(simulation, &simulation->sections[section],
                      simulation_step_time(simulation, step));
}

// Frames lie between steps if a frame is not a whole number of steps. Static hair needs no
// inbetweens: it can be posed at any time.
static bool needs_inbetween(const Simulation *simulation, const Solver *solver)
{
    double steps = simulation->schedule.steps_per_frame;
    return steps != floor(steps) && !solver_is_static(solver->type);
}

// Makes the followers of moving hair collide with the same colliders as their guides.
static Result create_follow_collision(SimulationSection *section, const SolverSetup *setup,
                                      Error *error)
{
    SolverSetup drawn = *setup;
    static const HeadPose origin = {.rotation = {0, 0, 0, 1}};
    drawn.hair = &section->follow.hair;
    drawn.bounds = &section->hair;
    if (!drawn.hair->batch_count || strcmp(setup->params->algo, "none") == 0) return RESULT_OK;
    follow_write(&section->follow, &origin); // positions in the groom, for the clearances
    return collision_create(&section->follow_collision, &drawn, COLLISION_DRAWN, NULL, error);
}

static void write_followers(const Simulation *simulation, SimulationSection *section)
{
    const HeadPose *head = &section->body->head;
    follow_move(&section->follow, &section->body->mesh, simulation->time);
    follow_write(&section->follow, head);
    collision_push_drawn(&section->follow_collision, head);
}

// Gravity at time 0, in which the groom is at rest.
static void find_rest_gravity(float gravity[3], const Scene *scene)
{
    Forces forces;
    forces_evaluate(&forces, scene, 0);
    memcpy(gravity, forces.gravity, sizeof forces.gravity);
}

// The section's parameters. Programs and buffers are created for the greatest values that animated
// parameters will have.
static const SectionParams *take_params(Simulation *simulation, uint32_t i)
{
    const Section *from = &simulation->scene->sections[i];
    SimulationSection *section = &simulation->sections[i];
    section->params = &from->params;
    if (!from->tracks.count) return section->params;
    section->now = schedule_greatest_params(&simulation->scene->run, from);
    return section->params = &section->now;
}

static Result create_section(Simulation *simulation, uint32_t i, const Gpu *gpu,
                             const Strands *strands, Error *error)
{
    SimulationSection *section = &simulation->sections[i];
    const SceneBody *on = scene_body_of(simulation->scene, i);
    MovingBody *body = section->body = &simulation->bodies[on - simulation->scene->bodies];
    const SectionParams *start = &simulation->scene->sections[i].params,
                        *params = take_params(simulation, i);
    const SectionTracks *tracks = &simulation->scene->sections[i].tracks;
    const RunParams *run = &simulation->scene->run;
    SolverSetup setup = {.gpu = gpu,
                         .timer = simulation->timer,
                         .hair = &section->hair,
                         .params = params,
                         .start = tracks->count ? start : NULL,
                         .style_changes = section_tracks_has(tracks, params_find("style")),
                         .colliders = &on->colliders,
                         .field = moving_body_field(body),
                         .sheltered = run->wind_shelter > 0,
                         .keeps_groom = solver_keeps_groom(params),
                         .head = &body->head};
    if (params->rest == REST_GROOM) find_rest_gravity(setup.rest_gravity, simulation->scene);
    TRY(hair_create(&section->hair, strands, 0, &gpu->limits, error));
    TRY(bound_create(&section->bound, &body->mesh, i - on->first, &section->hair, &gpu->limits,
                     error));
    setup.frames = section->bound.frames;
    TRY(follow_create(&section->follow, gpu, simulation->timer, &section->hair, strands, params,
                      run->seed, error));
    if (body->mesh.body)
        TRY(follow_bind(&section->follow, &body->mesh, section->bound.roots, strands, error));
    TRY(create_follow_collision(section, &setup, error));
    if (*run->from_cache) return RESULT_OK;
    TRY(solver_create(&section->solver, &setup, error));
    TRY(sleep_create(&section->sleep, gpu, simulation->timer, &section->hair, &section->solver,
                     params, error));
    TRY(volume_create(&section->volume, gpu, simulation->timer, &section->hair, &section->solver,
                      params, error));
    if (needs_inbetween(simulation, &section->solver))
        TRY(inbetween_create(&section->inbetween, gpu, &section->hair, section->bound.frames,
                             error));
    return RESULT_OK;
}

static Result create_sections(Simulation *simulation, const Gpu *gpu, const Strands *strands,
                              Error *error)
{
    const Scene *scene = simulation->scene;
    simulation->sections = calloc((size_t)scene->section_count + 1, sizeof *simulation->sections);
    if (!simulation->sections)
        return error_set(error, RESULT_FAILED, "no memory for %u sections", scene->section_count);
    for (uint32_t i = 0; i < scene->section_count; ++i) {
        Result result = create_section(simulation, i, gpu, &strands[i], error);
        if (result != RESULT_OK)
            return error_prefix(error, result, "%s: ", scene->sections[i].file);
        set_params(simulation, &simulation->sections[i], 0);
    }
    return RESULT_OK;
}

double simulation_stability(const Strands *strands, double g, double dt)
{
    double most = 0; // the largest (n - 1)^2 / L
    for (uint32_t s = 0; s < strands->strand_count; ++s) {
        double links = strands_size(strands, s) - 1.0, length = strands_length(strands, s);
        if (length > 0) most = fmax(most, links * links / length);
    }
    return dt * sqrt(g * most);
}

double simulation_acceleration(const ForcesMost *forces, const SectionParams *params)
{
    return forces->gravity + (double)params->drag * forces->wind;
}

Result simulation_choose_substeps(int *substeps, const Scene *scene, const Strands *strands,
                                  Error *error)
{
    const double most_steps = params_find("substeps")->maximum;
    const ForcesMost forces = forces_most(scene);
    *substeps = 1;
    for (uint32_t i = 0; i < scene->section_count; ++i) {
        const Section *section = &scene->sections[i];
        const SectionParams params = schedule_greatest_params(&scene->run, section);
        double limit = solver_most_stability(&params);
        if (!(limit > 0)) continue;
        double sigma = simulation_stability(&strands[i], simulation_acceleration(&forces, &params),
                                            1 / schedule_period_rate(&scene->run));
        double steps = ceil(sigma / limit);
        if (steps > most_steps)
            return error_set(error, RESULT_USAGE,
                             "%s: --substeps auto comes to %.6g: expected at most %.0f (raise "
                             "--sim-rate or --fps, or give a number)",
                             section->file, steps, most_steps);
        if ((int)steps > *substeps) *substeps = (int)steps;
    }
    return RESULT_OK;
}

static Result create_bodies(Simulation *simulation, const Gpu *gpu, const Strands *strands,
                            const Mesh *meshes, Error *error)
{
    const Scene *scene = simulation->scene;
    simulation->bodies = calloc((size_t)scene->body_count + 1, sizeof *simulation->bodies);
    if (!simulation->bodies)
        return error_set(error, RESULT_FAILED, "no memory for %u bodies", scene->body_count);
    for (uint32_t b = 0; b < scene->body_count; ++b)
        TRY(moving_body_create(&simulation->bodies[b], gpu, scene, b, strands,
                               meshes ? &meshes[b] : NULL, error));
    return RESULT_OK;
}

Result simulation_create(Simulation *simulation, const Gpu *gpu, GpuTimer *timer,
                         const Scene *scene, const Strands *strands, const Mesh *meshes,
                         Error *error)
{
    const RunParams *run = &scene->run;
    *simulation = (Simulation){.scene = scene, .timer = timer, .substeps = run->substeps.value};
    Result result = RESULT_OK;
    for (uint32_t i = 0; i < scene->section_count && result == RESULT_OK; ++i)
        result = solver_check(&scene->sections[i].params, error);
    if (run->substeps.automatic)
        THEN(result, simulation_choose_substeps(&simulation->substeps, scene, strands, error));
    simulation->schedule = schedule_create(run, simulation->substeps);
    simulation->step = -simulation->schedule.settling;
    THEN(result, create_bodies(simulation, gpu, strands, meshes, error));
    THEN(result, create_sections(simulation, gpu, strands, error));
    if (result != RESULT_OK) simulation_destroy(simulation);
    return result;
}

void simulation_destroy(Simulation *simulation)
{
    for (uint32_t i = 0; simulation->sections && i < simulation->scene->section_count; ++i) {
        sleep_destroy(&simulation->sections[i].sleep);
        volume_destroy(&simulation->sections[i].volume);
        collision_destroy(&simulation->sections[i].follow_collision);
        follow_destroy(&simulation->sections[i].follow);
        inbetween_destroy(&simulation->sections[i].inbetween);
        solver_destroy(&simulation->sections[i].solver);
        bound_destroy(&simulation->sections[i].bound);
        hair_destroy(&simulation->sections[i].hair);
    }
    free(simulation->sections);
    for (uint32_t b = 0; simulation->bodies && b < simulation->scene->body_count; ++b)
        moving_body_destroy(&simulation->bodies[b]);
    free(simulation->bodies);
    *simulation = (Simulation){0};
}

double simulation_step_time(const Simulation *simulation, int64_t step)
{
    return fmax(0, (double)step / simulation->schedule.steps_per_s);
}

// Forces are those at the step's start; roots move to the head's pose at the step's end.
static SolverStep next_step(const Simulation *simulation, const MovingBody *body)
{
    const Scene *scene = simulation->scene;
    double rate = simulation->schedule.steps_per_s,
           before = simulation_step_time(simulation, simulation->step),
           after = simulation_step_time(simulation, simulation->step + 1);
    Forces forces;
    forces_evaluate(&forces, scene, (double)simulation->step / rate);
    SolverStep step = {
        .dt = 1 / rate,
        .first = simulation->step == -simulation->schedule.settling,
        .number = scene->run.seed + (uint32_t)simulation->step,
        .head_old = body->step_head,
        .head = head_at(&body->of->head, after),
        .shape_old = bound_body_shape(&body->mesh, before),
        .shape = bound_body_shape(&body->mesh, after),
    };
    double from[3], to[3];
    rigid_track_place(&body->of->head, before, body->middle, from);
    rigid_track_place(&body->of->head, after, body->middle, to);
    step_set_move(&step, body->middle,
                  (double[]){to[0] - from[0], to[1] - from[1], to[2] - from[2]});
    memcpy(step.gravity, forces.gravity, sizeof step.gravity);
    memcpy(step.wind, forces.wind, sizeof step.wind);
    return step;
}

// Sets the frames of bound strands for a step. If the head jumped, they were already carried to the
// step's end.
static void set_frames(const Simulation *simulation, Bound *bound, const SolverStep *step)
{
    double after = simulation_step_time(simulation, simulation->step + 1);
    bool jumped = step->shape_old == step->shape;
    bound_set(bound, jumped ? after : simulation_step_time(simulation, simulation->step), after);
}

static void step_section(Simulation *simulation, SimulationSection *section,
                         const SolverStep *whole)
{
    SolverStep own = *whole, *step = &own;
    own.params_stamp =
        set_params(simulation, section, simulation_step_time(simulation, simulation->step));
    uint64_t strands = section->hair.strand_count;
    if (solver_is_static(section->solver.type)) return;
    if (sleep_skips(&section->sleep, step)) {
        simulation->strand_steps_asleep += strands;
        return;
    }
    inbetween_restore(&section->inbetween);
    if (section->bound.body) set_frames(simulation, &section->bound, step);
    solver_step(&section->solver, step);
    volume_step(&section->volume, step);
    sleep_check(&section->sleep, &section->solver);
    section->stepped = true;
    simulation->strand_steps += strands;
    ++simulation->steps;
}

// Sets the motion that carries bound strands: to the head pose `to` at the step's end, or, if NULL,
// the velocities at the start.
static void set_motions(const Simulation *simulation, const MovingBody *body, Bound *bound,
                        const HeadPose *to)
{
    if (!bound->body) return;
    if (to)
        bound_set_way(bound, simulation_step_time(simulation, simulation->step), &body->step_head,
                      simulation_step_time(simulation, simulation->step + 1), to);
    else
        bound_set_start(bound, &body->of->head);
}

static void carry_sections(Simulation *simulation, MovingBody *body, const HeadMotion *motion,
                           const HeadPose *to)
{
    for (uint32_t i = 0; i < body->of->section_count; ++i) {
        SimulationSection *section = &simulation->sections[body->of->first + i];
        if (solver_is_static(section->solver.type)) continue;
        inbetween_restore(&section->inbetween);
        bound_set_after(&section->bound, simulation_step_time(simulation, simulation->step));
        solver_pose(&section->solver, &body->step_head);
        set_motions(simulation, body, &section->bound, to);
        carry_apply(&body->carry, &section->solver, &section->hair, motion, section->bound.frames);
    }
}

// Handles a head that starts to move or jumps at the step's start: the hair is carried along.
static void carry_along(Simulation *simulation, MovingBody *body, SolverStep *step)
{
    const RigidTrack *head = &body->of->head;
    HeadMotion motion;
    HeadPose carried;
    bool starts = simulation->step == 0 && head_starts_moving(head, &motion);
    if (starts || (simulation->step == 0 && body->mesh.body))
        carry_sections(simulation, body, &motion, NULL);
    if (!head_jumps(&simulation->scene->run, head->pivot, &step->head_old, &step->head, &carried))
        return;
    motion = head_motion_between(&step->head_old, &carried);
    carry_sections(simulation, body, &motion, &carried);
    step->head_old = carried;
    memset(step->move_lost, 0, sizeof step->move_lost);
    step->shape_old = step->shape;
    ++simulation->jumps;
}

static void step_body(Simulation *simulation, MovingBody *body)
{
    SolverStep step = next_step(simulation, body);
    if (body->carry.program) carry_along(simulation, body, &step);
    double before = simulation_step_time(simulation, simulation->step),
           after = simulation_step_time(simulation, simulation->step + 1);
    moving_body_update_field(body, step.shape_old == step.shape ? after : before, after);
    step_shelter(&step, body->middle, simulation->scene->run.wind_shelter);
    for (uint32_t i = 0; i < body->of->section_count; ++i)
        step_section(simulation, &simulation->sections[body->of->first + i], &step);
    body->step_head_before = body->step_head;
    body->step_head = step.head;
}

static void take_step(Simulation *simulation)
{
    for (uint32_t b = 0; b < simulation->scene->body_count; ++b)
        step_body(simulation, &simulation->bodies[b]);
    ++simulation->step;
}

bool simulation_settle(Simulation *simulation)
{
    if (simulation->step < 0) take_step(simulation);
    return simulation->step < 0;
}

// Whether the drawn positions may differ from the last pose, assuming that the head does not move.
static bool moves(const SimulationSection *section)
{
    return section->stepped ||
           (section->inbetween.hair && (!section->sleep.asleep || section->inbetween.mixed));
}

static void pose_section(Simulation *simulation, SimulationSection *section, const HeadPose *head,
                         double time)
{
    inbetween_restore(&section->inbetween);
    bound_set_after(&section->bound, time);
    solver_pose(&section->solver, head);
    section->posed = true;
    section->posed_at = *head;
    section->posed_shape = bound_body_shape(&section->body->mesh, time);
    ++simulation->poses;
}

// Poses every section that moves in its state after the last step, and keeps the positions for
// inbetweens.
static void keep(Simulation *simulation, bool later)
{
    for (uint32_t i = 0; i < simulation->scene->section_count; ++i) {
        SimulationSection *section = &simulation->sections[i];
        if (!section->inbetween.hair || !moves(section)) continue;
        pose_section(simulation, section, &section->body->step_head,
                     simulation_step_time(simulation, simulation->step));
        inbetween_keep(&section->inbetween, later);
    }
}

// Moves each head to its pose in a frame that lies at `share` between two steps.
static void place_heads(Simulation *simulation, float share)
{
    for (uint32_t b = 0; b < simulation->scene->body_count; ++b) {
        MovingBody *body = &simulation->bodies[b];
        body->head = share > 0 ? head_at(&body->of->head, simulation->time) : body->step_head;
    }
}

void simulation_advance(Simulation *simulation)
{
    const RunParams *run = &simulation->scene->run;
    ScheduledFrame next = schedule_frame(&simulation->schedule, run, ++simulation->frame);
    while (simulation->step < next.step) take_step(simulation);
    if (next.share > 0 && simulation->step == next.step) {
        keep(simulation, false);
        take_step(simulation);
        keep(simulation, true);
    }
    simulation->share = next.share;
    simulation->time =
        next.share > 0 ? next.time : simulation_step_time(simulation, simulation->step);
    place_heads(simulation, next.share);
}

static void pose_between(Simulation *simulation, SimulationSection *section)
{
    gpu_timer_begin(simulation->timer, "inbetween");
    if (section->bound.body)
        bound_set_between(&section->bound, simulation_step_time(simulation, simulation->step - 1),
                          simulation_step_time(simulation, simulation->step), simulation->time);
    inbetween_mix(&section->inbetween, simulation->share, &section->body->step_head_before,
                  &section->body->step_head, &section->body->head);
    gpu_timer_end(simulation->timer);
    ++simulation->poses;
}

// Poses the hair of one body. Returns whether hair or head have moved since the last pose.
static bool pose_on_body(Simulation *simulation, MovingBody *body)
{
    double shape = bound_body_shape(&body->mesh, simulation->time);
    bool moved = !head_is_same(&body->posed_at, &body->head) || body->posed_shape != shape;
    for (uint32_t i = 0; i < body->of->section_count; ++i) {
        SimulationSection *section = &simulation->sections[body->of->first + i];
        uint64_t stamp = set_params(simulation, section, simulation->time);
        bool same_head = head_is_same(&section->posed_at, &body->head) &&
                         section->posed_shape == shape && section->posed_stamp == stamp;
        if (section->posed && same_head && !moves(section)) {
            ++simulation->poses_skipped;
            continue;
        }
        if (simulation->share > 0 && section->inbetween.hair && !section->sleep.asleep)
            pose_between(simulation, section);
        else
            pose_section(simulation, section, &body->head, simulation->time);
        write_followers(simulation, section);
        section->posed_stamp = stamp;
        section->stepped = false;
        moved = true;
    }
    body->posed_at = body->head;
    body->posed_shape = shape;
    return moved;
}

void simulation_pose(Simulation *simulation)
{
    bool moved = false;
    for (uint32_t b = 0; b < simulation->scene->body_count; ++b)
        if (pose_on_body(simulation, &simulation->bodies[b])) moved = true;
    simulation->changes += moved;
}

// Brings a body to the state in which simulation_advance leaves it in a frame. `head`: its pose; if
// NULL, the pose that the scene gives.
static void place_body(const Simulation *simulation, MovingBody *body, const ScheduledFrame *frame,
                       const HeadPose *head)
{
    double step = simulation_step_time(simulation, frame->step),
           later = simulation_step_time(simulation, frame->step + 1);
    bool between = frame->share > 0;
    body->head = head ? *head : head_at(&body->of->head, between ? frame->time : step);
    body->posed_at = body->head;
    body->posed_shape = bound_body_shape(&body->mesh, simulation->time);
    moving_body_update_field(body, step, between ? later : step);
}

Result simulation_show(Simulation *simulation, int frame, const HeadPose *head,
                       const float (*positions)[3], Error *error)
{
    simulation->frame = frame;
    simulation->time = schedule_frame_time(&simulation->scene->run, frame);
    ScheduledFrame at = schedule_frame(&simulation->schedule, &simulation->scene->run, frame);
    for (uint32_t b = 0; b < simulation->scene->body_count; ++b)
        place_body(simulation, &simulation->bodies[b], &at, b ? NULL : head);
    ++simulation->changes;
    Result result = RESULT_OK;
    for (uint32_t i = 0; i < simulation->scene->section_count && result == RESULT_OK; ++i) {
        SimulationSection *section = &simulation->sections[i];
        result = hair_write_positions(&section->hair, positions, error);
        set_params(simulation, section, simulation->time);
        if (result == RESULT_OK) write_followers(simulation, section);
        positions += section->hair.particle_count;
        section->posed = false;
    }
    return result;
}

Result simulation_show_section(Simulation *simulation, uint32_t i, const float (*positions)[3],
                               Error *error)
{
    SimulationSection *section = &simulation->sections[i];
    TRY(hair_write_positions(&section->hair, positions, error));
    write_followers(simulation, section);
    section->posed = false;
    ++simulation->changes;
    return RESULT_OK;
}

SolverReport simulation_report(const Simulation *simulation)
{
    SolverReport report = {0};
    for (uint32_t i = 0; i < simulation->scene->section_count; ++i)
        if (simulation->sections[i].solver.type)
            solver_report(&simulation->sections[i].solver, &report);
    return report;
}
