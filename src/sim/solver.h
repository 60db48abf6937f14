// SPDX-License-Identifier: MIT
// Solvers move the hair. This is their interface, and the table of all solvers; recipe.h says how
// a solver is built.
#pragma once

#include "sim/recipe.h"

typedef struct SolverType SolverType;

// The content (xyz) of a solver's buffer. w is for the solver's own use.
typedef enum SolverBufferKind {
    SOLVER_POINTS,     // m, in the world
    SOLVER_VELOCITIES, // m/s, of the points in the preceding buffer of the list
    SOLVER_DIRECTIONS, // vectors that only turn with the head
    SOLVER_TIPS,       // alternately a point and its velocity
} SolverBufferKind;

// A buffer of the state that a batch of strands passes on from one step to the next. Hair's
// positions are part of the state only if the solver lists them.
typedef struct SolverBuffer {
    const GpuBuffer *buffer;
    SolverBufferKind kind;
} SolverBuffer;

enum { SOLVER_MAX_BUFFERS = 4 };

enum { SOLVER_MAX_VARIANTS = 4 };

struct SolverType {
    const char *name;    // the word of --algo
    const char *summary; // one line for --algo list
    // Returns a warning for the user, one line. No warning if it is NULL or returns NULL.
    const char *(*caution)(const SectionParams *params);
    const char *lengths; // how well segments keep their lengths, for --algo list; may be NULL
    const char *style;   // how hair returns to its style, for --algo list; NULL: it does not
    // Greatest stability number of a step (simulation_stability) for which the solver is accurate
    // and calm, for --substeps auto; 0: any.
    float most_stability;
    const char *published; // the variant that ignores --rest and profiles; may be NULL
    const char *variants[SOLVER_MAX_VARIANTS]; // words of --variant, the default first; NULL ends
    // One for each variant, or one for all. None: the solver is static, the head carries the style.
    const struct SolverRecipe *recipes[SOLVER_MAX_VARIANTS];
};

// The table, in the order of --algo list.
#define SOLVERS(X)                                                                                 \
    X(SPLIT)                                                                                       \
    X(EMULATION)                                                                                   \
    X(HYBRID)                                                                                      \
    X(ROD)                                                                                         \
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

// Checks that params->algo and params->variant exist; RESULT_USAGE names the nearest valid word.
// Needs no OpenGL context. The functions below expect checked words.
Result solver_check(const SectionParams *params, Error *error);

// The warning for users of this algo and variant, or NULL.
const char *solver_caution(const SectionParams *params);

// SolverType.most_stability of this algo.
float solver_most_stability(const SectionParams *params);

// Whether hair with this style, --rest and variant is at rest in its groom.
bool solver_keeps_groom(const SectionParams *params);

// Creates a solver whose hair is at rest in its style on the head. RESULT_USAGE for strands with
// too many vertices for the solver; errors of solver_check, of the recipe's check, of shaders and
// of buffers.
Result solver_create(Solver *solver, const SolverSetup *setup, Error *error);
void solver_destroy(Solver *solver);

// Lists the buffers with the state of batch `batch` and returns their number, 0 for a static
// solver. Their content is valid after solver_pose.
int solver_buffers(const Solver *solver, uint32_t batch, SolverBuffer buffers[SOLVER_MAX_BUFFERS]);

// solver_step advances the state by one step; solver_pose writes Hair's positions for drawing.
// Both only queue GPU work.
void solver_step(const Solver *solver, const SolverStep *step);
void solver_pose(const Solver *solver, const HeadPose *head);

// Call after the section's parameters have changed (SolverSetup.start). Updates the share of the
// style in the drawn strand.
void solver_refresh(const Solver *solver, uint64_t stamp);

// Adds limited moves, contacts and depths to `report`. Waits for the GPU.
void solver_report(const Solver *solver, SolverReport *report);

// How many equal sub-steps the solver will make of this step, >= 1.
int solver_substeps(const Solver *solver, const SolverStep *step);

// Number of vertices, from the root, that the head carries (SolverRecipe.carried and --clamped).
// Not for static solvers.
uint32_t solver_carried(const Solver *solver);

// True if stepping changes nothing: the pose depends on the head alone.
bool solver_is_static(const SolverType *type);

// Prints the table for --algo list: name, summary, lengths, style, variants, and the solver's own
// flags (the owner column of params.def).
void solver_print_list(FILE *stream);
