// SPDX-License-Identifier: MIT
// What `tractrix-bench stress` tries: a strand under circumstances, as numbers with names. A case
// differs from the plain one (a straight strand of 16 vertices that falls on a resting head) in
// some of them; these are its text, "dt=0.5 wind=1e4 shape=curl". Behind the circumstances come the
// parameters of the case's solver, with the names, owners, defaults and ranges of params.def.
//
// Gravity at time 0, under which a groom is at rest (--rest groom), is rest_share times what it is
// from then on.
//
// Most are the same for all strands that are stepped together, a set; shape, tilt and shape_seed
// are each strand's own.
#pragma once

#include "base/params.h"
#include "base/random.h"

#include <stdbool.h>
#include <stddef.h>

// STRESS_FIELD(name, plain, low, high, spread, likely)
// spread  how random values lie: EVEN; LOG: evenly in the logarithm; ZERO: as LOG, but 0 in one of
//         four; WHOLE: evenly among whole numbers
// likely  how often a random case differs in it
#define STRESS_FIELDS(STRESS_FIELD)                                                                \
    STRESS_FIELD(n, 16, 2, 64, WHOLE, 0)              /* random: 2, 3, 16 or 64 */                 \
    STRESS_FIELD(dt, 1.0 / 60, 1e-6, 1, LOG, 0.6)     /* s */                                      \
    STRESS_FIELD(length, 0.25, 1e-6, 1e4, LOG, 0.4)   /* m */                                      \
    STRESS_FIELD(gravity, 9.81, 1e-3, 1e5, ZERO, 0.4) /* m/s2 */                                   \
    STRESS_FIELD(rest_share, 1, 0, 2, EVEN, 0.3)      /* of gravity: that at time 0 */             \
    STRESS_FIELD(wind, 0, 1e-2, 1e4, ZERO, 0.4)       /* m/s */                                    \
    STRESS_FIELD(wind_pitch, 90, 0, 180, EVEN, 0.3)   /* degrees from straight down */             \
    STRESS_FIELD(gust, 0, 0, 1, EVEN, 0.3)            /* as --gust */                              \
    STRESS_FIELD(wind_spread, 0, 0, 90, EVEN, 0.3)    /* degrees */                                \
    STRESS_FIELD(jump, 0, 1e-3, 100, ZERO, 0.25)      /* m, to and fro every 64 steps */           \
    STRESS_FIELD(shake, 0, 1e-3, 10, ZERO, 0.15)      /* m, amplitude */                           \
    STRESS_FIELD(shake_rate, 1, 0.1, 100, LOG, 0.15)  /* Hz */                                     \
    STRESS_FIELD(spin, 0, 0.1, 1e3, ZERO, 0.2)        /* rad/s */                                  \
    STRESS_FIELD(away, 0, 1, 1e3, ZERO, 0.2)          /* m from the origin */                      \
    STRESS_FIELD(arm, 0.1, 1e-3, 1, LOG, 0.2)         /* m from the head's pivot to roots */       \
    STRESS_FIELD(shape, 0, 0, 5, WHOLE, 0.7)          /* StressShape */                            \
    STRESS_FIELD(tilt, 90, 0, 180, EVEN, 0.6)         /* degrees from straight down */             \
    STRESS_FIELD(shape_seed, 0, 0, 65535, WHOLE, 1)   /* of random shapes */                       \
    STRESS_FIELD(strand, 0, 0, 65535, WHOLE, 0)       /* its number: winds mix by it */            \
    STRESS_FIELD(warp, 0, 1e-4, 10, ZERO, 0.3) /* m, of waves in a mesh to which it is bound */    \
    STRESS_FIELD(warp_rate, 1, 0.1, 100, LOG, 0.5)   /* Hz */                                      \
    STRESS_FIELD(warp_size, 0.1, 0.01, 10, LOG, 0.5) /* m from crest to crest */                   \
    STRESS_FIELD(warp_seed, 0, 0, 65535, WHOLE, 1)   /* of their directions */

enum StressField {
#define STRESS_NAME(name, ...) STRESS_##name,
    STRESS_FIELDS(STRESS_NAME)
#undef STRESS_NAME
        STRESS_PARAMS, // where the solver's parameters begin
    STRESS_MOST_FIELDS = 64
};

// Shapes, all of the case's length (but for the shortest segments that reading leaves,
// strands_read.h, which none goes below).
enum StressShape {
    STRESS_STRAIGHT,    // collinear
    STRESS_CURL,        // a helix of three turns about the straight one
    STRESS_ZIGZAG,      // each segment opposite to the one before
    STRESS_WALK,        // every segment in a direction of its own
    STRESS_UNEVEN,      // straight, of segments whose lengths differ by up to 1e4
    STRESS_NEARLY_ZERO, // walk, but every other segment is the shortest that reading leaves
};

typedef struct StressCase {
    const char *algo, *variant; // variant: "" for a solver without
    double value[STRESS_MOST_FIELDS];
} StressCase;

// The plain case of a solver.
StressCase stress_case_plain(const char *algo, const char *variant);

// A random set: the circumstances of all its strands; `vertices` of STRESS_VERTICES in turn.
enum {
    STRESS_VERTEX_COUNTS = 4,
    STRESS_MOST_SMALL_STEPS = 40, // that random cases give to the spring
};
extern const int STRESS_VERTICES[STRESS_VERTEX_COUNTS];
StressCase stress_case_random(const char *algo, const char *variant, int vertices, Random *random);

// The set with a strand of its own, of number `strand`.
StressCase stress_case_random_strand(const StressCase *set, int strand, Random *random);

// Reads the output of stress_case_write, words in any order, into a plain case. RESULT_USAGE
// naming the word.
Result stress_case_read(StressCase *stress, const char *text, Error *error);

// How it differs from the plain case; "plain" if it does not. Cut at `size`. Numbers are rounded to
// five digits beforehand, by whoever makes them.
void stress_case_write(const StressCase *stress, char *text, size_t size);

// The next simpler case to try: number `move` of them, from 0 on; false when there are no more.
// `simpler` may equal the case. Moves go from the boldest to the most timid of each field: back to
// the plain value, half the way there (in the logarithm where it has one); fewer vertices.
bool stress_case_simplify(const StressCase *stress, int move, StressCase *simpler);

// The solver's parameters; free with params_destroy_section.
Result stress_case_params(const StressCase *stress, SectionParams *params, Error *error);

// Where a point of the mesh to which the strand is bound is after `time` seconds of warping: `rest`
// and `place`, metres in the head's frame. Three waves, which are 0 at time 0.
void stress_case_warp(const StressCase *stress, double time, const double rest[3], double place[3]);

// The strand: `points` [n], metres in the head's frame.
void stress_case_make_strand(const StressCase *stress, float (*points)[3]);
