// SPDX-License-Identifier: MIT
// The room sim moves hair on the GPU. It takes strands and a scene (head, forces, colliders,
// parameters), and hands on the positions in Hair's buffers (hair.h) that the renderer draws.
//
// A simulation is a scene in motion: each section's hair with its solver (solver.h), followers,
// collisions and sleep, advanced frame by frame. A section moves as it would alone, to the bit:
// strands have their numbers within it, so that what varies by strand does not depend on other
// sections. (Only --substeps auto looks at all of them.)
#pragma once

#include "scene/scene.h"
#include "scene/schedule.h"
#include "sim/bound.h"
#include "sim/carry.h"
#include "sim/collision.h"
#include "sim/distance_field.h"
#include "sim/follow.h"
#include "sim/inbetween.h"
#include "sim/moving_field.h"
#include "sim/sleep.h"
#include "sim/solver.h"
#include "sim/volume.h"
#include "strands/strands.h"

typedef struct SimulationSection {
    const SectionParams *params; // the scene's, or, if they change over time, `now`
    SectionParams now;           // as at the step or the drawn frame; its texts are the scene's
    uint64_t posed_stamp;        // of `now`, when followers were last written
    Hair hair;
    Bound bound; // empty unless the mesh deforms
    Solver solver;
    Follow follow;
    Collision follow_collision; // of the followers, which take no part in the motion
    Inbetween inbetween; // empty where no frame falls between two steps, or the solver is static
    Sleep sleep;
    Volume volume;
    bool posed;         // positions are written ...
    bool stepped;       // ... and the hair has moved since ...
    HeadPose posed_at;  // ... or not, and they hold while the head is here ...
    double posed_shape; // ... and the mesh like this
} SimulationSection;

typedef struct Simulation {
    const Scene *scene;
    GpuTimer *timer;
    Schedule schedule;
    Carry carry;                 // made if the head moves or the mesh deforms
    BoundBody body;              // empty unless the mesh deforms
    int substeps;                // steps a period, found if --substeps is auto
    DistanceField field;         // of the mesh that hair collides with, or empty ...
    MovingField moving;          // ... since the mesh deforms
    uint32_t mesh_checksum;      // CRC-32 of that mesh's vertices and triangles
    SimulationSection *sections; // [scene->section_count]
    int frame;                   // to be drawn now; frame 0 is the start
    HeadPose head;               // as drawn ...
    double time;                 // ... at this time, s
    float share;     // drawn so far on the way from the last step but one to the last; 0: the last
    float middle[3]; // of the roots, in the head's frame: who is in the lee (--wind-shelter)
    int64_t step;    // steps since time 0; below 0 while the hair settles
    HeadPose step_head, step_head_before;       // after the last step and before it
    HeadPose posed_at;                          // the head at the last pose ...
    double posed_shape;                         // ... and the mesh (bound_body_shape)
    uint64_t changes;                           // poses that moved what is drawn, or the head
    uint64_t steps, poses, poses_skipped;       // of sections
    uint64_t strand_steps, strand_steps_asleep; // made, and left out
    uint64_t jumps;                             // of the head, by the rule of --teleport
} Simulation;

// The stability number of a step: sigma = dt (n - 1) sqrt(g / L), the greatest among the strands of
// n vertices and length L (m). It counts how much a link can turn within a step of dt s under an
// acceleration of g m/s2 along the strand. 0 without strands or acceleration.
double simulation_stability(const Strands *strands, double g, double dt);

// The greatest acceleration by gravity and wind that the scene will have, m/s2: keyed values, and
// wind at the height of a gust through the section's drag. The head's own motion isn't in it.
double simulation_acceleration(const Scene *scene, const SectionParams *params);

// The fewest steps a period (schedule_period_rate) with which the stability number of each section
// stays within what its solver takes (SolverType.most_stability). `strands`: one for each section.
// RESULT_USAGE with the section's file if that is more than --substeps may be.
Result simulation_choose_substeps(int *substeps, const Scene *scene, const Strands *strands,
                                  Error *error);

// Uploads strands[section] and makes the solvers, unless scene->run.from_cache is set: then there
// is nothing but simulation_show. `mesh`, which hair collides with unless the scene says otherwise,
// may be NULL and is not needed afterwards. `gpu`, `timer`, `scene` outlive the simulation. Errors
// of hair_create and solver_create, prefixed with the section's file, and of
// simulation_choose_substeps.
Result simulation_create(Simulation *simulation, const Gpu *gpu, GpuTimer *timer,
                         const Scene *scene, const Strands *strands, const Mesh *mesh,
                         Error *error);
void simulation_destroy(Simulation *simulation);

// A step of the warm-up (--preroll), in which the head stands as at time 0. Returns whether more
// are left; to be called until it says no, before the first simulation_advance.
bool simulation_settle(Simulation *simulation);

// To the next frame, by as many steps of each section as it takes. Only queues GPU work.
void simulation_advance(Simulation *simulation);

// Makes what a head that moves needs, where the scene did not say that it does. Before it moves.
// Errors of carry_create.
Result simulation_expect_motion(Simulation *simulation, const Gpu *gpu, Error *error);

// Writes the positions that are drawn. Skips what has not changed. As long as `changes` stays the
// same, so does what is drawn, but for the camera.
void simulation_pose(Simulation *simulation);

// Shows a frame that was simulated elsewhere: writes the drawn positions of all sections' guides,
// one behind the other (hair_write_positions), and what follows from them. The simulation's own
// state is lost. RESULT_FAILED when memory is short.
Result simulation_show(Simulation *simulation, int frame, const HeadPose *head,
                       const float (*positions)[3], Error *error);

// The scene's time (s) after so many steps; the warm-up (below 0) happens at time 0.
double simulation_step_time(const Simulation *simulation, int64_t step);

// The stamp of a section's parameters in the step that begins after so many steps; the section has
// them then.
uint64_t simulation_params_stamp(Simulation *simulation, uint32_t section, int64_t step);

// Makes the field of a mesh that deforms that of a step between two times (s); others stay.
void simulation_update_field(Simulation *simulation, double before, double after);

// Adds up the solvers' reports. Waits for the GPU.
SolverReport simulation_report(const Simulation *simulation);
