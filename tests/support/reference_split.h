// SPDX-License-Identifier: MIT
// The split solver in double precision, for one strand on the CPU, written from the definitions and
// not from the shaders.
#pragma once

#include <stdbool.h>

enum { REFERENCE_MAX = 128 };

// A strand: q[0] is the root, length[j] the rest length between particles j - 1 and j.
typedef struct ReferenceStrand {
    int n;
    double q[REFERENCE_MAX][3];
    double length[REFERENCE_MAX];
    double tip[3], velocity[3]; // the tip particle (ball only); the tip's velocity
} ReferenceStrand;

typedef struct ReferenceForces {
    double dt, drag, gravity[3], wind[3];
    bool first; // forces act for dt/2
} ReferenceForces;

// Starts at rest in `positions`; rest lengths are those of `positions`.
void reference_start(ReferenceStrand *strand, int n, const double (*positions)[3]);

// The tail's new position: the exact pursuit curve by its classical solution with asech, tanh and
// sech in the plane of the motion.
void reference_tractrix(const double h[3], const double t[3], const double p[3], double L,
                        double result[3]);

// One step. `root`: the root's new place. For `ball`, the strand is first carried along with the
// root; for `dragged` it is not.
typedef void (*ReferenceStep)(ReferenceStrand *strand, const double root[3],
                              const ReferenceForces *forces);
void reference_ball_step(ReferenceStrand *strand, const double root[3],
                         const ReferenceForces *forces);
void reference_dragged_step(ReferenceStrand *strand, const double root[3],
                            const ReferenceForces *forces);
void reference_thesis_step(ReferenceStrand *strand, const double root[3],
                           const ReferenceForces *forces);

// The drawn strand: directions rotated by the share `style` towards style[j] (unit vectors, j > 0).
void reference_pose(const ReferenceStrand *strand, const double (*style)[3], double share,
                    double (*positions)[3]);
