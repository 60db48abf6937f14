// SPDX-License-Identifier: MIT
// The bounds that strands of stress_case.h must keep: bounds that hold for any solver, and bounds
// that each solver promises.
//
// Energy. Let E be the mean of v^2/2 - g.(x - s) over a strand's particles of mass 1, in
// coordinates that move with the root but do not rotate; s is the particle's start, at rest in the
// style. The springs of style and links store non-negative energy, and none at the start. So
//     dE/dt <= V |a| + c V (W - V) + P
// with the root's acceleration a, the air's speed W relative to the root, drag c, the root mean
// square speed V, and the power P by which a rotating style stretches its springs. As g.(x - s) <=
// B = mean(|g| l - g.s) at the distance l along the strand, V^2/2 <= E + B =: S^2/2.
//   - A groom at rest (--rest groom) balances the gravity of time 0 and turns that with the head:
//     g is the difference. Where g changes, E + B grows by at most 2 |dg| l, and S^2 by 4 |dg| l.
//     Strands of segments (split) feel all gravity and hang straight down at the start.
//   - Gravity alone: S^2 stays 2B. Nothing can be faster than its fall.
//   - The root's motion: dS/dt <= |a|. S grows by at most the sum of all changes of the root's
//     velocity.
//   - Wind: S^2 grows by at most c W^2/2 per second, and not at all while V > W. The energy other
//     than V^2/2 varies by at most 4 |g| L/2, so that S^2 <= W^2 + 4 |g| L.
//   - Rotating a style of stiffness k does the work (2 l)(l) k per radian: S^2 grows by 4 k L^2 per
//     radian; angular springs b (m/s^2) give 2 pi b L.
//   - Parts other than the root that the head carries or takes along rigidly have the speed of its
//     rotation.
//   - Vertex 1, if the head carries it: the head may lift it with any force, which adds at most
//     |g| l_1 + g.s_1 for it, and as much for all that hangs from it. In coordinates that move with
//     vertex 1, the bound above holds with the changes of its velocity instead of the root's: its
//     velocity about the root, w l_1, where a rotation at the rate w starts or ends, and w l_1 per
//     radian.
// In any order, S <= sqrt(2B + wind + style) + kicks together, since sqrt((S + d)^2 + w) <=
// sqrt(S^2 + w) + d. All terms scale alike, so the bound does not depend on units. It needs no
// quantities of the solver: v is the distance that the drawn positions move in a step, divided by
// the step.
//
// Rounding. Positions are float32 and err by 2^-24 of their size X, so that v errs by 2^-23 X/dt. A
// solver that computes velocities from positions accumulates that: over N steps, including
// sub-steps, like a random walk. Directions err by the rounding relative to the shortest segment,
// and stiff bends store the energy of that error from the start.
//
// Rest. With the head at rest and steady forces, drag takes all energy. Oscillations decay like
// e^{-c t/2}, and overdamped motion like e^{-t g/(c L)}. After 30 times both time constants, the
// strand must be still.
//
// Flutter. In tressfx, a segment follows the previous one without acting back on it. Under a weight
// that compresses such a strand, it flutters like a column under a load that follows its end (Beck
// 1952), if load over stiffness is large enough. With n particles of weight g, links l and a
// joint's W^2 (solver_tressfx.c), that ratio is F = n g/(l W^2), times the share of the weight that
// compresses, u = -mean(g.s)/ mean(|g| l). If F u > 0.5, neither energy nor rest is checked, and
// the tool counts such strands. The smallest value at which a strand fluttered is 0.52.
#pragma once

#include "bench/stress_case.h"

#include "glsl/bench/stress_params.h"

typedef struct StressBound {
    double small_steps, steps; // largest number of sub-steps per step; number of steps so far
    double step_s;             // duration of a sub-step
    double drag, wind, length;
    double g;           // m/s^2: the strongest gravity felt
    double share, held; // shares of gravity: that the strand feels, and that the groom balances
    bool hangs;         // the strand is simulated as hanging straight down
    double felt[3], felt_first[3]; // m/s^2: gravity felt in the last step and the first
    double changes, strongest; // m/s^2: sum of changes of the gravity felt so far, and its maximum
    double stiffness;          // added to S^2 per radian of the head's rotation, m^2/s^2
    double kicks, blown, cap;  // m/s; m^2/s^2
    double turning;            // m/s: speed of a strand that moves rigidly with the head
    double turned;             // m^2/s^2
    bool carries;              // the head carries vertex 1
    double rate, spun; // 1/s: the head's rate of rotation; changes of that rate and of its axis
    double warp;       // 1/s: the strand's rotation with the deforming mesh
    double root_velocity[3];
    double rise;    // share by which the solver may let energy grow; < 0: no bound
    double jerk;    // factor of the root's changes of velocity in the last step
    double changed; // m/s: the last change
    double bends;   // m^2/s^2: 16 times what bends by one radian would store: twice the energy, and
                    // directions of both segments that err by twice as much
    double resolved;      // energy is checked only for segments longer than this many roundings
    double length_error;  // bound of segments; 0: the solver does not keep lengths
    double rest_move;     // m per step, at the end; 0: need not rest
    double rest_shortest; // m: need not rest if a segment is as short as this
    double flutter;       // F; 0: the solver has no such strands
    double rest_resolved; // roundings: need not rest if a segment is shorter than this
} StressBound;

// `params` are the case's. `steps`: total number of steps; the head rests in the second half.
StressBound stress_bound_create(const StressCase *stress, const SectionParams *params, int steps);

// A step: the root's displacement `moved` (m), the head's rotation `angle` (rad) in this step and
// `turned` about z since time 0, and `gravity` (m/s^2).
typedef struct StressMove {
    double moved[3], angle, turned, gravity[3];
    double warped[4]; // the strand's rotation since time 0 in the head's frame, a quaternion x y z
                      // w; all 0: none
    double warp;      // rad, change of that rotation in the step
} StressMove;

// Takes a step into account.
void stress_bound_step(StressBound *bound, const StressMove *move);

// Fills in the bounds that stress.comp compares with, except steps and counts. `last`: the run's
// last step.
void stress_bound_fill(const StressBound *bound, bool last, StressParams *params);
