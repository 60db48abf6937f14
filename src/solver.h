// SPDX-License-Identifier: MIT
// Solvers: what moves the hair. One interface, one table; adding a solver is one C file, one GLSL
// file and one line of the table.
#pragma once

#include "gpu_timer.h"
#include "hair.h"
#include "params.h"

#include <cglm/types.h>

// The head's rigid frame: x_world = rotation x_head + translation.
typedef struct HeadPose {
    versor rotation;  // unit quaternion x y z w
    vec3 translation; // metres
} HeadPose;

// One step of time, the same for all sections.
typedef struct SolverStep {
    double dt;  // s
    bool first; // the first step from rest: forces act for dt/2 (leapfrog start, which second order
                // needs)
    uint32_t shuffle;        // random number of this step, the same for all strands
    HeadPose head_old, head; // at the step's start and end
    float gravity[3];        // m/s^2
    float wind[4][3];        // m/s: mixed by strand
} SolverStep;

// What a solver works on. All of it outlives the solver.
typedef struct SolverSetup {
    const Gpu *gpu;
    GpuTimer *timer; // spans "sim_<name>" and "pose"
    const Hair *hair;
    const SectionParams *params;
} SolverSetup;

// What happened so far, for the statistics.
typedef struct SolverReport {
    uint64_t moves_limited; // moves cut because a particle was flung beyond what float32 can follow
} SolverReport;

// Every function is called with the context current; all but create and report only queue GPU work.
typedef struct SolverType {
    const char *name;                                    // the word of --algo
    const char *summary;                                 // one line for --algo list
    const char *(*caution)(const SectionParams *params); // what its user should know, one line;
                                                         // NULL or giving NULL: nothing
    const char *lengths;     // how well segments keep theirs, for --algo list; may be NULL
    const char *style;       // what brings the style back, for --algo list; NULL: nothing does
    const char *variants[4]; // words of --variant, the default first; NULL ends
    Result (*create)(void **state, const SolverSetup *setup,
                     Error *error);                    // hair at rest in its style
    void (*step)(void *state, const SolverStep *step); // advances the physical state; may be NULL
    void (*pose)(void *state, const HeadPose *head);   // writes Hair's positions for drawing
    void (*report)(void *state, SolverReport *report); // waits for the GPU; may be NULL
    void (*destroy)(void *state);                      // NULL state is legal
} SolverType;

// Ends with a NULL name.
extern const SolverType *const SOLVER_TYPES[];

typedef struct Solver {
    const SolverType *type;
    void *state;
} Solver;

// Whether params->algo and params->variant exist; RESULT_USAGE naming the nearest valid word. Needs
// no context.
Result solver_check(const SectionParams *params, Error *error);

// What the user of this algo and variant should know, or NULL. The words have been checked.
const char *solver_caution(const SectionParams *params);

// Checks as above and creates.
Result solver_create(Solver *solver, const SolverSetup *setup, Error *error);
void solver_destroy(Solver *solver);

// True if stepping changes nothing: the pose depends on the head alone.
bool solver_is_static(const Solver *solver);

// Prints the table: name, summary, what it keeps, variants, and the flags whose help begins with
// the name ("chain, hybrid: ...").
void solver_print_list(FILE *stream);
