// SPDX-License-Identifier: MIT
// Cases of `tractrix-bench stress`: a strand and its circumstances as named numbers. The plain case
// is a straight strand of 16 vertices that falls on a resting head. A case's text lists its
// differences from that: "dt=0.5 wind=1e4 shape=curl". After the circumstances come the parameters
// of the case's solver, with names, owners, defaults and ranges as in params.def.
//
// Gravity at time 0, with which a groom is in balance (--rest groom), is rest_share times the later
// gravity.
//
// Strands that are stepped together, a set, share most fields; shape, tilt and shape_seed are
// individual.
#pragma once

#include "base/params.h"
#include "base/random.h"

#include <stdbool.h>
#include <stddef.h>

// STRESS_FIELD(name, plain, low, high, spread, likely)
// spread  distribution of random values: EVEN; LOG: even in the logarithm; ZERO: as LOG, but 0 in
//         one of four; WHOLE: even among integers
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

// Shapes of the case's length, in which no segment is shorter than the shortest that reading keeps
// (strands_read.h).
enum StressShape {
    STRESS_STRAIGHT,    // collinear
    STRESS_CURL,        // a helix of three turns around the straight shape
    STRESS_ZIGZAG,      // each segment in the opposite direction of the previous one
    STRESS_WALK,        // every segment in a random direction
    STRESS_UNEVEN,      // straight, with segments whose lengths differ by up to 1e4
    STRESS_NEARLY_ZERO, // walk, but every second segment is the shortest that reading keeps
};

typedef struct StressCase {
    const char *algo, *variant; // variant: "" for a solver without variants
    double value[STRESS_MOST_FIELDS];
} StressCase;

// The plain case of a solver.
StressCase stress_case_plain(const char *algo, const char *variant);

// A random set: the circumstances shared by its strands; vertex counts take turns.
enum {
    STRESS_VERTEX_COUNTS = 4,
    STRESS_MOST_SMALL_STEPS = 40, // sub-steps per step in random cases of spring
};
extern const int STRESS_VERTICES[STRESS_VERTEX_COUNTS];
StressCase stress_case_random(const char *algo, const char *variant, int vertices, Random *random);

// A case of the set with individual fields for strand `strand`.
StressCase stress_case_random_strand(const StressCase *set, int strand, Random *random);

// Reads the output of stress_case_write, with words in any order, into a plain case. RESULT_USAGE
// names an invalid word.
Result stress_case_read(StressCase *stress, const char *text, Error *error);

// Writes the differences from the plain case; "plain" if there are none. Truncated to `size`.
// Callers must have rounded numbers to five digits.
void stress_case_write(const StressCase *stress, char *text, size_t size);

// A simpler case to try, number `move` from 0 on; false if there are no more. `simpler` may equal
// the case. For each field, the largest simplification comes first: the plain value, then half-way
// to it (in the logarithm if possible); fewer vertices.
bool stress_case_simplify(const StressCase *stress, int move, StressCase *simpler);

// The solver's parameters; free with params_destroy_section.
Result stress_case_params(const StressCase *stress, SectionParams *params, Error *error);

// The position, after `time` seconds of deformation, of a point of the mesh to which the strand is
// bound; `rest` and `place` in m in the head's frame. The sum of three waves, which are 0 at time
// 0.
void stress_case_warp(const StressCase *stress, double time, const double rest[3], double place[3]);

// The strand: `points` [n], metres in the head's frame.
void stress_case_make_strand(const StressCase *stress, float (*points)[3]);
