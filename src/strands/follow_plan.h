// SPDX-License-Identifier: MIT
// Followers: strands that are drawn but not simulated. Each takes its shape from one guide or from
// the three guides around its root. The plan assigns the guides; glsl/sim/follow.comp computes the
// positions.
#pragma once

#include "base/params.h"
#include "strands/strands.h"

#include <stdio.h>

// One follower. Its vertex j of n is at
//   weight[0] a_j + weight[1] b_j + weight[2] c_j + (1 + separation j / (n - 1)) R offset
// where a, b, c are the vertices of its guides and R is the head's rotation.
typedef struct Follower {
    uint32_t guide[3]; // indices into the plan's guides; the follower belongs to the first one
    float weight[3];   // >= 0 with sum 1; the first is the largest
    float offset[3];   // m, in the head's frame, perpendicular to the first guide's first segment
    uint32_t id;       // random number, for everything that varies from strand to strand
} Follower;

typedef struct FollowOptions {
    uint32_t per_guide;
    bool interpolate; // between guides if there is a triangle of guides, otherwise around one guide
    // m, > 0: radius of the disc around a guide's root in which the followers' roots lie.
    float radius;
    uint32_t seed;
} FollowOptions;

// The options for the followers of these strands: what the user set, otherwise what the file says,
// otherwise (if automatic) follow_plan_fill with interpolation, and follow_plan_auto_radius.
FollowOptions follow_plan_options(const SectionParams *params, const Strands *strands,
                                  uint32_t seed);

// The default number of followers per strand. It is 0 for fewer than 32 strands, which are single
// wisps, and for 5,000 or more, which cover the scalp by themselves. Otherwise it is as many as
// keep the time of a frame within 3 times that of the strands alone. A frame takes about as long as
// drawing its segments and FRAME_SEGMENTS more, so the followers of n segments may have 2 (n +
// FRAME_SEGMENTS) segments.
uint32_t follow_plan_fill(const Strands *strands);

// Whether follow_plan_fill applies: neither the user nor the file gives a number. If the user gives
// the fibre radius, the strands are taken to be all the fibres that there are, and no followers are
// added.
bool follow_plan_fills(const SectionParams *params, const Strands *strands);

// If follow_plan_fill does not apply for the only reason that the user gives the fibre radius,
// prints a line with the options that fill the space. `name`: of the hair file, quoted.
void follow_plan_tell_gaps(const SectionParams *params, const Strands *strands, const char *name,
                           FILE *stream);

// The largest distance of a follower from its guide, m; 0 if there are none. (A follower between
// three guides is within their hull.)
float follow_plan_reach(const SectionParams *params, const Strands *strands);

// follower[g * per_guide + i] is follower i of guide g.
typedef struct FollowPlan {
    Follower *follower; // [guides * per_guide], owned
    uint32_t per_guide;
} FollowPlan;

// Plans the followers of the strands guides[0 .. count - 1], which must have equal vertex counts.
// Random numbers depend on the seed and on the guide's number in `strands`, not on its vertices:
// the same hair moved, scaled or rounded gets the same followers.
//
// Offset: roots are distributed uniformly in a disc of the given radius around the guide's root,
// perpendicular to its first segment.
//
// Interpolate: files contain no triangles between roots, so they are computed. A guide and two of
// its 32 nearest neighbours form a triangle if the circle through their roots, in the plane that
// fits the neighbourhood best, contains no other of the neighbours (Delaunay). Triangles that might
// bridge a parting are left out: those with a side of more than 6 radii, and those whose strands
// differ in direction by more than 60 degrees, at half their length or at the tip. Followers are
// distributed uniformly in the third of each triangle that is nearest to the guide. The followers
// of a guide without triangles are offset.
//
// RESULT_FAILED when memory is short.
Result follow_plan_create(FollowPlan *plan, const Strands *strands, const uint32_t *guides,
                          uint32_t count, const FollowOptions *options, Error *error);
void follow_plan_destroy(FollowPlan *plan);

// The radius (m, > 0) for which discs around the roots cover about the whole scalp. For one root it
// is the radius of a disc with the root's share of the scalp, estimated from the distance to its
// 16th neighbour at another position; the result is the median over at most 256 roots. If all roots
// coincide, it is 1/50 of the longest strand.
float follow_plan_auto_radius(const Strands *strands);
