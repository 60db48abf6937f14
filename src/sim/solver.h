// SPDX-License-Identifier: MIT
// Solvers: what moves the hair. One interface, one table; adding a solver is one C file, one GLSL
// file and one line of SOLVERS.
#pragma once

#include "base/params.h"
#include "gpu/gpu_timer.h"
#include "scene/colliders.h"
#include "sim/distance_field.h"
#include "sim/hair.h"

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
    float shelter[4];        // m: the middle of the head; share of the wind kept off behind it
    float head_velocity[3];  // m/s, of that middle
} SolverStep;

typedef struct SolverType SolverType;

// What a solver works on. All of it outlives the solver.
typedef struct SolverSetup {
    const Gpu *gpu;
    GpuTimer *timer; // spans "sim_<name>" and "pose"
    const Hair *hair;
    const SectionParams *params;
    const HeadPose *head;       // at the start; NULL: where the style is
    const Colliders *colliders; // shapes that hair must not cross; NULL: none
    const DistanceField *field; // a mesh that it must not cross; NULL: none
    bool sheltered;             // SolverStep.shelter counts
    const SolverType *type;     // solver_create sets it
} SolverSetup;

// What the vec4s of a buffer are; w is the solver's own.
typedef enum SolverBufferKind {
    SOLVER_POINTS,     // m, in the world
    SOLVER_VELOCITIES, // m/s, of the points in the buffer before
    SOLVER_DIRECTIONS, // unit vectors
    SOLVER_TIPS,       // a point and its velocity in turn
} SolverBufferKind;

// All that a batch of strands hands on from one step to the next, together with Hair's positions
// where it lists them.
typedef struct SolverBuffer {
    const GpuBuffer *buffer;
    SolverBufferKind kind;
} SolverBuffer;

enum { SOLVER_MAX_BUFFERS = 4 };

// What happened so far, for the statistics.
typedef struct SolverReport {
    uint64_t moves_limited; // moves cut because a particle was flung beyond what float32 can follow
    uint64_t contacts;      // particles that touched a collider in the last step
    float deepest_found, deepest_left; // m: deepest that a particle was in a collider, with its
                                       // margin, before it was pushed out, and after
} SolverReport;

// How a solver's state comes, moves and goes. Every function is called with the context current;
// all but create and report only queue GPU work.
typedef struct SolverCalls {
    Result (*create)(void **state, const SolverSetup *setup,
                     Error *error); // hair at rest in its style
    int (*buffers)(const void *state, uint32_t batch,
                   SolverBuffer buffers[SOLVER_MAX_BUFFERS]); // lists the state, gives its count;
                                                              // NULL: there is none
    void (*step)(void *state, const SolverStep *step); // advances the physical state; may be NULL
    void (*pose)(void *state, const HeadPose *head);   // writes Hair's positions for drawing
    void (*report)(void *state, SolverReport *report); // waits for the GPU; may be NULL
    void (*destroy)(void *state);                      // NULL state is legal
} SolverCalls;

enum { SOLVER_MAX_VARIANTS = 4 };

struct SolverType {
    const char *name;                                    // the word of --algo
    const char *summary;                                 // one line for --algo list
    const char *(*caution)(const SectionParams *params); // what its user should know, one line;
                                                         // NULL or giving NULL: nothing
    const char *lengths;  // how well segments keep theirs, for --algo list; may be NULL
    const char *style;    // what brings the style back, for --algo list; NULL: nothing does
    float most_stability; // greatest stability number of a step (stability.h) at which it is calm,
                          // for
                          // --substeps auto; 0: any
    const char *variants[SOLVER_MAX_VARIANTS]; // words of --variant, the default first; NULL ends
    const SolverCalls *calls;                  // &PARTICLE_SOLVER, or its own
    const struct ParticleRecipe
        *recipes[SOLVER_MAX_VARIANTS]; // with PARTICLE_SOLVER: a variant's, or one for all
};

// The table, in the order of --algo list.
#define SOLVERS(X)                                                                                 \
    X(SPLIT)                                                                                       \
    X(EMULATION)                                                                                   \
    X(HYBRID)                                                                                      \
    X(CHAIN)                                                                                       \
    X(TRESSFX)                                                                                     \
    X(SPRING)                                                                                      \
    X(ROPE)                                                                                        \
    X(DFTL)                                                                                        \
    X(NONE)

#define DECLARE_SOLVER(name) extern const SolverType SOLVER_##name;
SOLVERS(DECLARE_SOLVER)
#undef DECLARE_SOLVER

// The same as pointers; ends with NULL.
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

// Its type's most_stability. The words have been checked.
float solver_most_stability(const SectionParams *params);

// Checks as above and creates.
Result solver_create(Solver *solver, const SolverSetup *setup, Error *error);
void solver_destroy(Solver *solver);

// The calls of its type, on its state. The buffers' content is there once the solver has posed.
int solver_buffers(const Solver *solver, uint32_t batch, SolverBuffer buffers[SOLVER_MAX_BUFFERS]);
void solver_step(const Solver *solver, const SolverStep *step);
void solver_pose(const Solver *solver, const HeadPose *head);
void solver_report(const Solver *solver, SolverReport *report);

// True if stepping changes nothing: the pose depends on the head alone.
bool solver_is_static(const Solver *solver);

// Which of the type's variants the parameters name: 0, the default, for "".
int solver_variant(const SolverType *type, const char *variant);

// Prints the table: name, summary, what it keeps, variants, and the flags that it owns (the owner
// column of params.def).
void solver_print_list(FILE *stream);
