// SPDX-License-Identifier: MIT
// Followers: strands that are drawn but not stepped. Each takes its shape from one guide, or from
// the three around its root. The plan says from which; glsl/sim/follow.comp does it.
#pragma once

#include "base/params.h"
#include "strands/strands.h"

// One follower. Vertex j of n lies at
//   weight[0] a_j + weight[1] b_j + weight[2] c_j + (1 + separation j / (n - 1)) R offset
// with the vertices of its guides a, b, c and the head's rotation R.
typedef struct Follower {
    uint32_t guide[3]; // places among the plan's guides; the first is the one that it belongs to
    float weight[3];   // >= 0, their sum is 1; the first is the largest
    float offset[3];   // m, in the head's frame, perpendicular to the first guide's first segment
    uint32_t id;       // random number: what varies by strand varies with it
} Follower;

typedef struct FollowOptions {
    uint32_t per_guide;
    bool interpolate; // between guides where there are triangles; else around one guide
    float radius; // m, > 0: of the disc around a guide's root in which its followers have theirs
    uint32_t seed;
} FollowOptions;

// What the parameters say of the followers of these strands, or else what their file says, or else
// (if automatic) follow_plan_fill, interpolated; and follow_plan_auto_radius.
FollowOptions follow_plan_options(const SectionParams *params, const Strands *strands,
                                  uint32_t seed);

// How many followers each of these strands gets where nobody says a number: 0 for fewer than 32
// strands, which are wisps, and for 5,000 or more, which cover; else as many as keep the time of a
// frame within 3 times that of the strands alone. A frame's time is about that of its segments and
// of FRAME_SEGMENTS more; so the followers of n segments may have 2 (n + FRAME_SEGMENTS).
uint32_t follow_plan_fill(const Strands *strands);

// Whether that is the number that these have: neither the user nor the file says one. Where the
// user says how thick fibres are, the strands are all fibres that there are.
bool follow_plan_fills(const SectionParams *params, const Strands *strands);

// How far from its guide a follower may be, m; 0 if there are none. (Between three, it is within
// their hull.)
float follow_plan_reach(const SectionParams *params, const Strands *strands);

// follower[g * per_guide + i] is guide g's follower i.
typedef struct FollowPlan {
    Follower *follower; // [guides * per_guide], owned
    uint32_t per_guide;
} FollowPlan;

// Plans the followers of the strands guides[0 .. count - 1], which have equal vertex counts. They
// depend on the seed, on their guide's vertices and, with `interpolate`, on its neighbours, but not
// on the order of the strands.
//
// Offset: roots lie evenly in a disc of the radius around the guide's, perpendicular to its first
// segment.
//
// Interpolate: files know no triangles between roots, so they are found: a guide and two of its 32
// nearest neighbours, if the circle around the three, in the plane that fits the neighbourhood
// best, holds no other of them (Delaunay). Triangles that might bridge a parting are left out:
// those with a side of more than 6 radii, or whose strands lead to middles or tips in directions
// more than 60 degrees apart. Followers lie evenly in that third of its triangles that is
// nearest to the guide; a guide without triangles has its followers offset.
//
// RESULT_FAILED when memory is short.
Result follow_plan_create(FollowPlan *plan, const Strands *strands, const uint32_t *guides,
                          uint32_t count, const FollowOptions *options, Error *error);
void follow_plan_destroy(FollowPlan *plan);

// A radius (m, > 0) for which discs around the roots about cover the scalp: that of a disc as large
// as a root's share of the scalp, by the distance to its 16th neighbour in another place; the
// median of at most 256 roots. 1/50 of the longest strand where no two roots differ.
float follow_plan_auto_radius(const Strands *strands);
