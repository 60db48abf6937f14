// SPDX-License-Identifier: MIT
// What follow.comp is given, for one batch of followers.
#include "common/shared.h"

// Buffer textures, after that of the guides' positions (BIND_POSITION).
#define BIND_FOLLOW_OFFSETS 1 // vec4 a follower: offset in the head's frame (m), share of guide b
#define BIND_FOLLOW_GUIDES  2 // uvec4 a follower: guides b, c, bits of the share of c, 0

UNIFORM_BLOCK(FollowParams, follow_params, BIND_STEP)
{
    vec4 head_rotation; // quaternion x y z w: the head's frame -> world
    float tip_separation;
    float clump;       // share of the way to the guide at the tip
    uint strand_count; // followers
    uint vertex_count;
    uint first_guide; // strand of the guides' batch
    uint per_guide;
}
END_BLOCK(FollowParams, follow_params);
