// SPDX-License-Identifier: MIT
// The natural shape of an elastic strand that is at rest in its groom, under its weight: found in
// one sweep from tip to root. The energy is that of glsl/sim/rod_joint.glsl. Everything is per
// rho A of the root's cross section; SI units otherwise.
//
// If everything beyond a joint is turned rigidly, no other joint changes. So a joint alone balances
// the torque T of what lies beyond:
//     beta a x t + gamma (tau - tau0) (a + t)/(1 + a.t) = T,
// which gives the unloaded direction a and the unloaded twist tau0 (at rest tau = 0).
//
// A joint cannot balance any torque (|a x t| <= 1), and hair that stands up buckles. Real hair
// rests on the head and on other hair. So each particle may be held by a force: as little as keeps
// the torque of each joint below MOST_TORQUE beta, and the compression of each segment below half
// of the load under which a strand buckles. What hangs freely keeps its weight and its tension.
// Finally the shape must be a minimum of energy. If it is not, these bounds are halved until it is.
#pragma once

#include <stdbool.h>

// Joint j = 1 .. n lies at the root's end of segment j, whose other end is particle j.
typedef struct RestJoint {
    double t[3];      // unit direction of the segment in the groom
    double length;    // m
    double beta;      // m^3/s^2
    double bend;      // B/(rho A), m^4/s^2: the bending stiffness of the segment
    double weight[3]; // of the particle, m^2/s^2
    // Results.
    double a[3];       // unloaded direction, unit
    double natural[3]; // unloaded direction in the frame of the unloaded strand: s_j
    double twist;      // tau0, rad
    double held[3];    // m^2/s^2: the force that holds the particle
} RestJoint;

// Fills the results of joints[1 .. n]. `ratio`: gamma/beta = 1/(1 + nu).
void rest_shape_solve(RestJoint *joints, int n, double ratio);
