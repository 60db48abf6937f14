// SPDX-License-Identifier: MIT
// Solvers: what moves the hair. One interface, one table; what each is made of stands in recipe.h.
#pragma once

#include "sim/recipe.h"

typedef struct SolverType SolverType;

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

enum { SOLVER_MAX_VARIANTS = 4 };

struct SolverType {
    const char *name;    // the word of --algo
    const char *summary; // one line for --algo list
    // A warning for its user, one line; NULL or giving NULL: none.
    const char *(*caution)(const SectionParams *params);
    const char *lengths; // how well segments keep theirs, for --algo list; may be NULL
    const char *style;   // what brings the style back, for --algo list; NULL: nothing does
    // Greatest stability number of a step (simulation_stability) at which it is calm, for
    // --substeps auto; 0: any.
    float most_stability;
    const char *published; // the variant that stays as published, without --rest; may be NULL
    const char *variants[SOLVER_MAX_VARIANTS]; // words of --variant, the default first; NULL ends
    // A variant's, or one for all; none: it steps nothing, hair is carried stiff in its style.
    const struct SolverRecipe *recipes[SOLVER_MAX_VARIANTS];
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
    struct SolverState *state;
} Solver;

// Whether params->algo and params->variant exist; RESULT_USAGE naming the nearest valid word. Needs
// no context.
Result solver_check(const SectionParams *params, Error *error);

// The warning for users of this algo and variant, or NULL. The words have been checked.
const char *solver_caution(const SectionParams *params);

// Its type's most_stability. The words have been checked.
float solver_most_stability(const SectionParams *params);

// Whether hair of this style, --rest and variant is at rest in its groom. The words have been
// checked.
bool solver_keeps_groom(const SectionParams *params);

// Hair at rest in its style where the head is. Errors of solver_check and of the recipe's check;
// RESULT_USAGE for strands of more vertices than it takes; of shaders and buffers.
Result solver_create(Solver *solver, const SolverSetup *setup, Error *error);
void solver_destroy(Solver *solver);

// Lists the state of batch `batch` and gives its count, 0 for a static solver. The buffers' content
// is there once the solver has posed.
int solver_buffers(const Solver *solver, uint32_t batch, SolverBuffer buffers[SOLVER_MAX_BUFFERS]);

// Advances the physical state; writes Hair's positions for drawing. Both only queue GPU work.
void solver_step(const Solver *solver, const SolverStep *step);
void solver_pose(const Solver *solver, const HeadPose *head);

// The section's parameters have changed (SolverSetup.start): what is drawn of a style follows.
void solver_refresh(const Solver *solver, uint64_t stamp);

// Adds limited moves, contacts and depths to `report`. Waits for the GPU.
void solver_report(const Solver *solver, SolverReport *report);

// How many equal sub-steps the solver will make of this step, >= 1.
int solver_substeps(const Solver *solver, const SolverStep *step);

// Vertices, from the root, that the head carries (SolverRecipe.carried and --clamped); not of a
// static solver.
uint32_t solver_carried(const Solver *solver);

// True if stepping changes nothing: the pose depends on the head alone.
bool solver_is_static(const SolverType *type);

// Prints the table: name, summary, what it keeps, variants, and the flags that it owns (the owner
// column of params.def).
void solver_print_list(FILE *stream);
