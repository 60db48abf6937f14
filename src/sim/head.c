// SPDX-License-Identifier: MIT
#include "sim/head.h"

#include <cglm/cglm.h>

#include <math.h>
#include <string.h>

HeadPose head_at(const RigidTrack *track, double time)
{
    HeadPose pose = {0};
    rigid_track_evaluate(track, time, pose.rotation, pose.translation);
    return pose;
}

bool head_is_same(const HeadPose *a, const HeadPose *b)
{
    return memcmp(a->rotation, b->rotation, sizeof a->rotation) == 0 &&
           memcmp(a->translation, b->translation, sizeof a->translation) == 0;
}

HeadPose head_between(const HeadPose *a, const HeadPose *b, float t)
{
    HeadPose pose = {0};
    if (t >= 1) return *b;
    glm_quat_slerp((float *)a->rotation, (float *)b->rotation, t, pose.rotation);
    glm_vec3_lerp((float *)a->translation, (float *)b->translation, t, pose.translation);
    return pose;
}

void head_put(vec4 rotation, vec4 translation, const HeadPose *pose)
{
    memcpy(rotation, pose->rotation, sizeof pose->rotation);
    memcpy(translation, pose->translation, sizeof pose->translation);
}

HeadMotion head_motion_between(const HeadPose *from, const HeadPose *to)
{
    HeadMotion motion = {0};
    versor back;
    vec3 moved;
    glm_quat_inv((float *)from->rotation, back);
    glm_quat_mul((float *)to->rotation, back, motion.rotation);
    glm_quat_normalize(motion.rotation);
    glm_quat_rotatev(motion.rotation, (float *)from->translation, moved);
    glm_vec3_sub((float *)to->translation, moved, motion.translation);
    return motion;
}

// The rotation from one pose to the other, as a vector: axis times angle (rad).
static void rotation_between(const HeadPose *from, const HeadPose *to, vec3 vector)
{
    versor back, turn;
    glm_quat_inv((float *)from->rotation, back);
    glm_quat_mul((float *)to->rotation, back, turn);
    if (turn[3] < 0) glm_vec4_negate(turn);
    float sine = glm_vec3_norm(turn);
    glm_vec3_scale(turn, sine > 0 ? 2 * atan2f(sine, turn[3]) / sine : 0, vector);
}

// One-sided second-order differences, (4 f(h) - f(2h) - 3 f(0))/(2h), because a track may start
// with a jump of its velocity at time 0.
bool head_starts_moving(const RigidTrack *track, HeadMotion *motion)
{
    const double h = 1e-3;
    HeadPose at[3];
    vec3 near = {0}, far = {0}, moved = {0};
    for (int i = 0; i < 3; ++i) at[i] = head_at(track, i * h);
    rotation_between(&at[0], &at[1], near);
    rotation_between(&at[0], &at[2], far);
    *motion = (HeadMotion){.rotation = {0, 0, 0, 1}};
    for (int k = 0; k < 3; ++k) {
        double step = (double)at[1].translation[k] - (double)at[0].translation[k],
               two_steps = (double)at[2].translation[k] - (double)at[0].translation[k];
        motion->velocity[k] = (float)((4 * step - two_steps) / (2 * h));
        motion->spin[k] = (float)((4 * (double)near[k] - (double)far[k]) / (2 * h));
    }
    // Velocity of the head's point that is at the world's origin.
    glm_vec3_cross(motion->spin, at[0].translation, moved);
    glm_vec3_sub(motion->velocity, moved, motion->velocity);
    return glm_vec3_norm2(motion->velocity) > 0 || glm_vec3_norm2(motion->spin) > 0;
}

static void pivot_at(const float pivot[3], const HeadPose *pose, vec3 place)
{
    glm_quat_rotatev((float *)pose->rotation, (float *)pivot, place);
    glm_vec3_add((float *)pose->translation, place, place);
}

// The pose that has made `share` of the turn and of the pivot's move from one pose to the other.
static HeadPose pose_on_the_way(const float pivot[3], const HeadPose *from, const HeadPose *to,
                                float share)
{
    HeadPose pose = {0};
    vec3 begin = {0}, end = {0}, place = {0}, turned = {0};
    pivot_at(pivot, from, begin);
    pivot_at(pivot, to, end);
    glm_quat_slerp((float *)from->rotation, (float *)to->rotation, share, pose.rotation);
    glm_vec3_lerp(begin, end, share, place);
    glm_quat_rotatev(pose.rotation, (float *)pivot, turned);
    glm_vec3_sub(place, turned, pose.translation);
    return pose;
}

bool head_jumps(const RunParams *run, const float pivot[3], const HeadPose *from,
                const HeadPose *to, HeadPose *carried)
{
    vec3 begin = {0}, end = {0}, turn = {0};
    pivot_at(pivot, from, begin);
    pivot_at(pivot, to, end);
    rotation_between(from, to, turn);
    float felt = 1; // the largest share of the motion that respects both limits
    felt = fminf(felt, run->teleport_distance / fmaxf(glm_vec3_distance(begin, end), 1e-30f));
    felt = fminf(felt, glm_rad(run->teleport_angle) / fmaxf(glm_vec3_norm(turn), 1e-30f));
    if (felt >= 1 || run->teleport == TELEPORT_NONE) return false;
    *carried = run->teleport == TELEPORT_CARRY ? *to : pose_on_the_way(pivot, from, to, 1 - felt);
    return true;
}

void head_middle(float middle[3], const Strands *strands, uint32_t count)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < count; ++i)
        for (uint32_t s = 0; s < strands[i].strand_count; ++s)
            for (int k = 0; k < 3; ++k) {
                float at = strands[i].position[strands[i].first[s]][k];
                low[k] = fminf(low[k], at);
                high[k] = fmaxf(high[k], at);
            }
    for (int k = 0; k < 3; ++k) middle[k] = high[k] >= low[k] ? 0.5f * (low[k] + high[k]) : 0;
}
