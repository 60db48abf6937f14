// SPDX-License-Identifier: MIT
// The bounds that strands of stress_case.h keep: what a strand may do, whatever its solver, and
// what each solver says of itself.
//
// Energy. Let E be the mean over a strand's particles, mass 1, of v^2/2 - g.(x - s), seen from the
// root without turning with it; s is where a particle was at the start, at rest in the style. The
// springs of the style and of links store what is never negative, and nothing at the start. So
//     dE/dt <= V |a| + c V (W - V) + P
// with the root's acceleration a, the speed W of the air as seen from the root, drag c, the root
// mean square speed V, and the power P by which a turning style stretches its springs. As
// g.(x - s) <= B = mean(|g| l - g.s) at the distance l along the strand, V^2/2 <= E + B =: S^2/2.
//   - A groom at rest (--rest groom) holds the gravity of time 0 and turns it with the head: g is
//   what
//     is felt beyond that. Where it changes, E + B grows by at most 2 |dg| l, S^2 by 4 |dg| l.
//     Strands of segments (split) feel all gravity, and hang straight down at the start.
//   - Nothing but gravity: S^2 stays at 2B. What falls cannot be faster than its fall.
//   - The root's motion: dS/dt <= |a|. S grows by no more than all changes of the root's velocity.
//   - Wind: S^2 grows by c W^2/2 per second at most, and not at all where V > W; the energy beside
//     V^2/2 varies by 4 |g| L/2 at most, so not above S^2 = W^2 + 4 |g| L.
//   - A style of stiffness k that is turned by an angle does (2 l)(l) k per radian: S^2 grows by
//     4 k L^2 per radian; angular springs b (m/s^2) give 2 pi b L.
//   - What the head carries beside the root, or takes along rigidly, has the speed of its turning.
//   - Vertex 1, where the head carries it: nothing bounds what the head does to lift it, by at most
//     |g| l_1 + g.s_1, and all that hangs from it as much. Seen from there, the bound above holds
//     with the changes of its velocity for those of the root's: those about the root, w l_1 by
//     which a turn at the rate w begins or ends, and w l_1 per radian, are added.
// Taken together in any order, S <= sqrt(2B + wind + style) + kicks, for sqrt((S + d)^2 + w) <=
// sqrt(S^2 + w) + d. All terms scale alike, so the bound does not depend on units. It needs no
// solver's own quantities: v is how far what is drawn goes in a step, by the step.
//
// Rounding. Positions are float32, off by 2^-24 of their size X: v is off by 2^-23 X/dt, and a
// solver that takes velocities from positions hands that on: in N steps, small ones counted, as far
// as a random walk. Directions are off by the rounding over the shortest segment: what stiff bends
// store by that is there from the start.
//
// Rest. With the head at rest and steady forces, drag takes all energy. A swing dies like e^{-c
// t/2}, what is overdamped creeps like e^{-t g/(c L)}; where both have passed for 30 times, the
// strand must lie still.
//
// Flutter. Segments of tressfx follow the one before, which takes no reaction. Under a weight that
// presses such a strand together it flutters as a column does under a load that follows its end
// (Beck 1952), above some load over stiffness: with n particles of weight g, links l and a joint's
// W^2 (solver_tressfx.c), F = n g/(l W^2), times the share of its weight that presses, u =
// -mean(g.s)/ mean(|g| l). Beyond F u = 0.5 neither energy nor rest are looked at, and the tool
// counts such strands. Smallest number at which one was found to flutter: 0.52.
#pragma once

#include "bench/stress_case.h"

#include "glsl/bench/stress_params.h"

typedef struct StressBound {
    double small_steps, steps; // that the solver makes of one, at most; so far
    double step_s;             // of the solver's own time
    double drag, wind, length;
    double g;                      // m/s^2: most that is felt of gravity
    double share, held;            // of gravity: that is felt, and that the groom holds of it
    bool hangs;                    // the strand is simulated hanging straight down
    double felt[3], felt_first[3]; // m/s^2: gravity, in the last step and the first
    double changes, strongest;     // m/s^2: of what is felt so far, all changes and the most
    double stiffness;              // added to S^2 for each radian that the head turns, m^2/s^2
    double kicks, blown, cap;      // m/s; m^2/s^2
    double turning;                // m/s: of a strand that goes rigidly with the head
    double turned;                 // m^2/s^2
    bool carries;                  // vertex 1 is the head's
    double rate, spun;             // 1/s: the head's turning; its changes, and its own direction's
    double warp;                   // 1/s: the strand's own turning
    double root_velocity[3];
    double rise;     // share by which the solver lets energy rise; < 0: no bound
    double jerk;     // times the root's changes of velocity in the last step
    double changed;  // m/s: the last of them
    double bends;    // m^2/s^2: what bends by a radian would store, 16 times: twice the energy, and
                     // both segments' directions off by as much again
    double resolved; // roundings that segments must be long for energy to be looked at
    double length_error;  // of segments; 0: it does not keep them
    double rest_move;     // m a step, at the end; 0: it need not rest
    double rest_shortest; // m: nor with a segment as short as this
    double flutter;       // F; 0: no such strands
    double rest_resolved; // roundings: nor as this
} StressBound;

// `params` are the case's. `steps` that there will be, the head at rest in the second half of them.
StressBound stress_bound_create(const StressCase *stress, const SectionParams *params, int steps);

// A step: the root has gone by `moved` (m), the head has turned by `angle` (rad), in all from time
// 0 on by `turned` about z; gravity is `gravity` (m/s^2).
typedef struct StressMove {
    double moved[3], angle, turned, gravity[3];
    double warped[4]; // the strand's own rotation from time 0 on in the head's frame, a quaternion
                      // x y z w; all 0: none
    double warp;      // rad, by which that has changed in the step
} StressMove;

// Takes a step into account.
void stress_bound_step(StressBound *bound, const StressMove *move);

// Fills in what stress.comp compares with, but for steps and counts. `last`: the run's last step.
void stress_bound_fill(const StressBound *bound, bool last, StressParams *params);
