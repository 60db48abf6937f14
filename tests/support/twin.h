// SPDX-License-Identifier: MIT
// Shared by the double-precision twins of the particle solvers, and the comparison of a solver with
// its twin: both step the same curls under the same wind and head motion.
#pragma once

#include "support/hair_fixture.h"

typedef double Vec[3];

enum { TWIN_MAX = 256 };

// A strand: particle 0 is the root, length[j] the rest length between j - 1 and j (m).
typedef struct TwinStrand {
    int n;
    Vec x[TWIN_MAX], v[TWIN_MAX]; // m, m/s
    Vec style[TWIN_MAX];          // the rest shape in the head's frame, m
    double length[TWIN_MAX];
    double carried[TWIN_MAX]; // 1/s^2: what chain's corrections add to tensions with bending
    double gained; // m^2/s^2: what chain's and dftl's constraints have given, and it has not paid
    double paid;   // share of its velocities that dftl's next step takes for that
} TwinStrand;

typedef struct TwinStep {
    double dt, drag;
    bool first; // forces act for dt/2
    Vec gravity, wind;
    HeadPose head_old, head; // at the step's start and end
} TwinStep;

// A twin: one step of one strand, by the same parameters as the solver.
typedef void (*TwinFunction)(TwinStrand *strand, const TwinStep *step, const SectionParams *params);

// Products, lengths, copies and sums of vectors.
double vec_dot(const Vec a, const Vec b);
double vec_norm(const Vec a);
void vec_copy(const Vec a, Vec r);                              // r = a
void vec_add_scaled(const Vec a, double s, const Vec b, Vec r); // r = a + s b

// At rest in `positions`, which are also the style (head at the origin); lengths as they are there.
void twin_start(TwinStrand *strand, int n, const Vec *positions);

// Where the head has carried particle j of the style to at the step's end.
void twin_style(const TwinStrand *strand, const HeadPose *head, int j, Vec r);

// Drag and acceleration over h seconds, exact for any h.
void twin_kick(Vec v, const TwinStep *step, double h);

// Draws particles that have flown for h seconds, in which forces acted for `acts`, to the style
// around the root, which x[0] is: x = (x + w style)/(1 + w), w = stiffness style/(1 - style) h f
// acts.
void twin_pull_to_style(TwinStrand *strand, const TwinStep *step, double h, double acts,
                        const SectionParams *params);

// The strand with its directions kept and its lengths restored, from the root outwards.
void twin_rebuild(const TwinStrand *strand, Vec *positions);

// A curly strand of n particles, 0.21 m long, from a root at `x`.
void twin_make_curl(Vec *q, int n, double x, double turns);

// The same, with segments that are long and short in turn, 3 : 1.
void twin_make_uneven_curl(Vec *q, int n, double x, double turns);

// Puts the strands of batch 0, all of one size, where the first `count` twins are, with their
// velocities. Of particle solvers.
void twin_put(HairFixture *fixture, const TwinStrand *twins, int count);

// Strand s of batch 0 as it is drawn.
void twin_read_strand(HairFixture *fixture, int s, Vec *q);

// RMS distance of particles 1 .. n-1 over `length`.
double twin_rms(const Vec *a, const Vec *b, int n, double length);

// Largest | |x_j - x_(j-1)| / length_j - 1 |.
double twin_length_error(const TwinStrand *rest, const Vec *q);

// A solver and its twin.
typedef struct TwinPair {
    const char *algo, *variant; // variant "": the solver's first
    TwinFunction twin;
    bool rebuilt; // particles stretch, but without stretch_drawn exact lengths are drawn
} TwinPair;

// A strand that both step.
typedef struct TwinCase {
    int n;                          // particles
    double per_second, drag, style; // steps a second; drag in 1/s
    int steps;
    // Measured with vectors of 256 and 128 bits, AVX without FMA, and SSE2, as
    // scripts/goldens-by-cpu sets them; three times the largest.
    double tolerance;                    // greatest distance at the end on a CPU driver: RMS over
                                         // the length; on GPUs five times that
    void (*tune)(SectionParams *params); // changes parameters; or NULL
} TwinCase;

// Fails at the first of `count` cases in which a drawn strand ends as far from its twin as the
// tolerance, or farther; prints each distance. Five curls of different turns, wind of 1.6 m/s, a
// head that moves at 2 Hz by 4 cm and turns by 0.2 rad.
void twin_require(const TwinPair *pair, const TwinCase *cases, int count);

// The same of curls whose segments are long and short in turn.
void twin_require_uneven(const TwinPair *pair, const TwinCase *cases, int count);
