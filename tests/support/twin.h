// SPDX-License-Identifier: MIT
// Shared by the double-precision twins of particle solvers: compares a solver with its twin. Both
// step the same curls with the same wind and head motion.
#pragma once

#include "support/hair_fixture.h"

typedef double Vec[3];

enum { TWIN_MAX = 256 };

// A strand: particle 0 is the root, length[j] the rest length between particles j - 1 and j (m).
typedef struct TwinStrand {
    int n;
    Vec x[TWIN_MAX], v[TWIN_MAX]; // m, m/s
    Vec style[TWIN_MAX];          // the rest shape in the head's frame, m
    double length[TWIN_MAX];
    double carried[TWIN_MAX]; // of dftl: see reference_dftl.c
    double twist[TWIN_MAX];   // rad, of rod's joints
    double gained;            // energy that chain, dftl and rod have gained and not yet removed
    double paid;              // share of its velocities that dftl's next step removes
} TwinStrand;

typedef struct TwinStep {
    double dt, drag;
    bool first; // forces act for dt/2
    Vec gravity, wind;
    HeadPose head_old, head; // at the step's start and end
} TwinStep;

// A twin: one step of one strand, with the same parameters as the solver.
typedef void (*TwinFunction)(TwinStrand *strand, const TwinStep *step, const SectionParams *params);

// Products, lengths, copies and sums of vectors.
double vec_dot(const Vec a, const Vec b);
double vec_norm(const Vec a);
void vec_copy(const Vec a, Vec r);                              // r = a
void vec_add_scaled(const Vec a, double s, const Vec b, Vec r); // r = a + s b

// Starts at rest in `positions`, which are also the style (head at the origin); rest lengths are
// those of `positions`.
void twin_start(TwinStrand *strand, int n, const Vec *positions);

// The place of particle j of the style at the end of the step, moved by the head.
void twin_style(const TwinStrand *strand, const HeadPose *head, int j, Vec r);

// Drag and acceleration over h seconds, exact for any h.
void twin_kick(Vec v, const TwinStep *step, double h);

// Pulls particles towards the style around the root, which is x[0], after a flight of h seconds in
// which forces acted for `acts`: x = (x + w style)/(1 + w), w = stiffness style/(1 - style) h f
// acts.
void twin_pull_to_style(TwinStrand *strand, const TwinStep *step, double h, double acts,
                        const SectionParams *params);

// The strand with its directions and the rest lengths, built from the root outwards.
void twin_rebuild(const TwinStrand *strand, Vec *positions);

// A curly strand of n particles, 0.21 m long, with its root at `x`.
void twin_make_curl(Vec *q, int n, double x, double turns);

// The same with segments that are alternately long and short, 3 : 1.
void twin_make_uneven_curl(Vec *q, int n, double x, double turns);

// Sets the strands of batch 0, which have equal sizes, to the positions and velocities of the first
// `count` twins. For particle solvers.
void twin_put(HairFixture *fixture, const TwinStrand *twins, int count);

// Reads the drawn positions of strand s of batch 0.
void twin_read_strand(HairFixture *fixture, int s, Vec *q);

// RMS distance of particles 1 .. n-1 over `length`.
double twin_rms(const Vec *a, const Vec *b, int n, double length);

// Largest | |x_j - x_(j-1)| / length_j - 1 |.
double twin_length_error(const TwinStrand *rest, const Vec *q);

// A solver and its twin.
typedef struct TwinPair {
    const char *algo, *variant; // variant "": the solver's default
    TwinFunction twin;
    bool rebuilt; // particles stretch; without stretch_drawn, rest lengths are drawn
} TwinPair;

// A strand that the solver and the twin step.
typedef struct TwinCase {
    int n;                          // particles
    double per_second, drag, style; // steps a second; drag in 1/s
    int steps;
    // Measured with vectors of 256 and 128 bits, AVX without FMA, and SSE2 (settings of
    // scripts/goldens-by-cpu); the tolerance is three times the largest.
    double tolerance; // largest final distance on a CPU driver, RMS over the length; on GPUs five
                      // times as much
    void (*tune)(SectionParams *params); // changes parameters; or NULL
} TwinCase;

// Steps five curls with different turns in wind of 1.6 m/s, on a head that moves at 2 Hz by 4 cm
// and rotates by 0.2 rad. Prints the distance of each case; fails at the first of `count` cases
// whose distance is not below the tolerance.
void twin_require(const TwinPair *pair, const TwinCase *cases, int count);

// The same for curls whose segments are alternately long and short.
void twin_require_uneven(const TwinPair *pair, const TwinCase *cases, int count);
