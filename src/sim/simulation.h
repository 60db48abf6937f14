// SPDX-License-Identifier: MIT
// The room `sim` moves hair on the GPU. Its input is strands and a scene (head, forces, colliders,
// parameters). Its output is the positions in Hair's buffers (hair.h), which the renderer draws.
//
// A simulation is a scene in motion: its bodies (moving_body.h), and the hair of each section with
// its solver (solver.h), followers, collisions and sleep, advanced frame by frame. A section moves
// as it would alone on its body, bit for bit: strands are numbered within their section, so nothing
// that varies from strand to strand depends on other sections. (Only --substeps auto looks at all
// of them.)
#pragma once

#include "scene/forces.h"
#include "scene/scene.h"
#include "scene/schedule.h"
#include "sim/bound.h"
#include "sim/collision.h"
#include "sim/follow.h"
#include "sim/inbetween.h"
#include "sim/moving_body.h"
#include "sim/sleep.h"
#include "sim/solver.h"
#include "sim/volume.h"
#include "strands/strands.h"

typedef struct SimulationSection {
    MovingBody *body;            // that it is on
    const SectionParams *params; // the scene's; `now` if they change over time
    SectionParams now;           // at the current step or drawn frame; its texts are the scene's
    uint64_t posed_stamp;        // the stamp of `now` when followers were last written
    Hair hair;
    Bound bound; // empty unless the mesh deforms
    Solver solver;
    Follow follow;
    Collision follow_collision; // pushes the followers, which the solver does not move
    Inbetween inbetween; // empty where no frame falls between two steps, or the solver is static
    Sleep sleep;
    Volume volume;
    bool posed;         // positions have been written. They are valid while `stepped` is false,
    bool stepped;       // which means that the hair has moved since,
    HeadPose posed_at;  // the head is here,
    double posed_shape; // and the mesh has this shape (bound_body_shape)
} SimulationSection;

typedef struct Simulation {
    const Scene *scene;
    GpuTimer *timer;
    Schedule schedule;
    int substeps;                // steps a period; chosen here if --substeps is auto
    MovingBody *bodies;          // [scene->body_count]
    SimulationSection *sections; // [scene->section_count]
    int frame;                   // the frame to be drawn now; frame 0 is the start
    double time;                 // s, of the drawn frame
    float share;      // drawn fraction of the way between the last two steps; 0: the last step
    int64_t step;     // steps since time 0; negative while the hair settles
    uint64_t changes; // number of poses that moved hair or a head
    uint64_t steps, poses, poses_skipped;       // counted for each section
    uint64_t strand_steps, strand_steps_asleep; // made, and left out because of sleep
    uint64_t jumps;                             // of the head, by the rule of --teleport
} Simulation;

// The stability number of a step: the maximum of dt (n - 1) sqrt(g / L) over the strands of n
// vertices and length L (m). It measures how far a link can turn in a step of dt s under an
// acceleration of g m/s2 along the strand. 0 without strands or acceleration.
double simulation_stability(const Strands *strands, double g, double dt);

// The greatest acceleration of a section by the scene's forces, m/s2: wind counts multiplied by the
// section's drag. The head's motion is not included.
double simulation_acceleration(const ForcesMost *forces, const SectionParams *params);

// The smallest number of steps a period (schedule_period_rate) for which the stability number of
// each section stays within its solver's limit (SolverType.most_stability). `strands`: one element
// for each section. RESULT_USAGE with the section's file if the number exceeds the maximum of
// --substeps.
Result simulation_choose_substeps(int *substeps, const Scene *scene, const Strands *strands,
                                  Error *error);

// Uploads strands[section] and creates the solvers. If scene->run.from_cache is set, no solver is
// created, and only simulation_show may be called. `meshes` has the mesh of each body, with which
// its hair collides unless the scene says otherwise; it may be NULL and is not needed afterwards.
// `gpu`, `timer` and `scene` must outlive the simulation. Errors of hair_create and solver_create,
// prefixed with the section's file, and of simulation_choose_substeps.
Result simulation_create(Simulation *simulation, const Gpu *gpu, GpuTimer *timer,
                         const Scene *scene, const Strands *strands, const Mesh *meshes,
                         Error *error);
void simulation_destroy(Simulation *simulation);

// Makes one step of the warm-up (--preroll), during which the head stays as at time 0. Returns
// true if more steps are left. Call it until it returns false, before the first
// simulation_advance.
bool simulation_settle(Simulation *simulation);

// Advances to the next frame, by as many steps of each section as needed. Only queues GPU work.
void simulation_advance(Simulation *simulation);

// Writes the drawn positions; skips sections that have not changed. While `changes` stays the
// same, the drawn hair and head stay the same.
void simulation_pose(Simulation *simulation);

// Shows a frame that was simulated elsewhere. `head`: the first body's; the others are where the
// scene has them. `positions`: the drawn positions of the guides of
// all sections, section after section, each as in hair_write_positions. Followers are computed
// from them. The simulation's own state is lost. RESULT_FAILED when memory is short.
Result simulation_show(Simulation *simulation, int frame, const HeadPose *head,
                       const float (*positions)[3], Error *error);

// Replaces the drawn positions of a section after simulation_pose; followers are computed from
// them. `positions`: as in hair_write_positions. RESULT_FAILED when memory is short.
Result simulation_show_section(Simulation *simulation, uint32_t section,
                               const float (*positions)[3], Error *error);

// The scene's time (s) after `step` steps, for head and mesh. 0 during the warm-up (step < 0).
double simulation_step_time(const Simulation *simulation, int64_t step);

// Sets a section's parameters to those of the step that begins after `step` steps, and returns
// their stamp.
uint64_t simulation_params_stamp(Simulation *simulation, uint32_t section, int64_t step);

// Adds up the solvers' reports. Waits for the GPU.
SolverReport simulation_report(const Simulation *simulation);
