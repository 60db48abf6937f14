// SPDX-License-Identifier: MIT
#include "scene/rigid_track.h"

#include <math.h>
#include <string.h>

const TrackRange RIGID_TRACK_METRES = {-RIGID_TRACK_MAX, RIGID_TRACK_MAX, 1.0};
const TrackRange RIGID_TRACK_DEGREES = {-RIGID_TRACK_MAX, RIGID_TRACK_MAX,
                                        3.14159265358979323846 / 180};

// Converts a rotation vector (axis times angle) to a quaternion x, y, z, w.
static void quaternion_from_vector(const float vector[3], double quaternion[4])
{
    double x = (double)vector[0], y = (double)vector[1], z = (double)vector[2];
    double angle = sqrt(x * x + y * y + z * z);
    double scale = angle > 0 ? sin(angle / 2) / angle : 0.0;
    quaternion[0] = scale * x;
    quaternion[1] = scale * y;
    quaternion[2] = scale * z;
    quaternion[3] = cos(angle / 2);
}

// Rotates v: R v = v + 2 w (u x v) + 2 u x (u x v), where u is the vector part of the quaternion
// and w its scalar.
static void rotate(const double q[4], const float v[3], double rotated[3])
{
    double x = (double)v[0], y = (double)v[1], z = (double)v[2];
    const double cross[3] = {q[1] * z - q[2] * y, q[2] * x - q[0] * z, q[0] * y - q[1] * x};
    rotated[0] = x + 2 * (q[3] * cross[0] + q[1] * cross[2] - q[2] * cross[1]);
    rotated[1] = y + 2 * (q[3] * cross[1] + q[2] * cross[0] - q[0] * cross[2]);
    rotated[2] = z + 2 * (q[3] * cross[2] + q[0] * cross[1] - q[1] * cross[0]);
}

// The twist (rotation vector about the origin, rad; velocity of the point at the origin, m) that
// produces a motion in unit time. R = exp [w] and translation = V t, where V is the mean of the
// rotations during the motion (R. Murray, Z. Li and S. Sastry, "A Mathematical Introduction to
// Robotic Manipulation", 1994, chapter 2).
typedef struct Twist {
    Double3 turn, velocity;
} Twist;

// The coefficients of V = 1 + a [w] + b [w]^2 for an angle.
static void mean_factors(double angle, double *a, double *b)
{
    double square = angle * angle;
    bool small = angle < 1e-4;
    *a = small ? 0.5 - square / 24 : (1 - cos(angle)) / square;
    *b = small ? 1.0 / 6 - square / 120 : (angle - sin(angle)) / (square * angle);
}

static void apply_mean(const Double3 turn, double a, double b, const Double3 v, Double3 result)
{
    Double3 once, twice;
    double3_cross(turn, v, once);
    double3_cross(turn, once, twice);
    for (int k = 0; k < 3; ++k) result[k] = v[k] + a * once[k] + b * twice[k];
}

static Twist twist_of(const RigidMotion *motion)
{
    Twist twist;
    const double *q = motion->rotation;
    double sign = q[3] < 0 ? -1 : 1, sine = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]),
           angle = 2 * atan2(sine, sign * q[3]), a, b;
    for (int k = 0; k < 3; ++k) twist.turn[k] = sine > 0 ? sign * q[k] / sine * angle : 0;
    mean_factors(angle, &a, &b);
    // V^-1 = 1 - [w]/2 + c [w]^2.
    double c = angle < 1e-4 ? 1.0 / 12 : (1 - (1 - b * angle * angle) / (2 * a)) / (angle * angle);
    apply_mean(twist.turn, -0.5, c, motion->translation, twist.velocity);
    return twist;
}

static RigidMotion motion_of(const Twist *twist)
{
    RigidMotion motion;
    double angle = double3_length(twist->turn), a, b;
    double scale = angle > 0 ? sin(angle / 2) / angle : 0.5;
    for (int k = 0; k < 3; ++k) motion.rotation[k] = scale * twist->turn[k];
    motion.rotation[3] = cos(angle / 2);
    mean_factors(angle, &a, &b);
    apply_mean(twist->turn, a, b, twist->velocity, motion.translation);
    return motion;
}

RigidMotion rigid_samples_evaluate(const RigidSamples *samples, double time)
{
    SampleSpan span = sample_span(&samples->times, time);
    const RigidMotion *at = &samples->motion[span.near];
    if (span.weight[1] == 1) return samples->motion[span.at[1]];
    RigidMotion back = rigid_motion_inverse(at);
    Twist sum = {{0}, {0}};
    for (int i = 0; i < 4; ++i) {
        if (span.weight[i] == 0 || span.at[i] == span.near) continue;
        RigidMotion way = rigid_motion_product(&samples->motion[span.at[i]], &back);
        Twist twist = twist_of(&way);
        double3_add_scaled(sum.turn, span.weight[i], twist.turn);
        double3_add_scaled(sum.velocity, span.weight[i], twist.velocity);
    }
    RigidMotion way = motion_of(&sum);
    return rigid_motion_product(&way, at);
}

// The track's motion, applied after that of its samples.
static RigidMotion motion_at(const RigidTrack *track, double time)
{
    float moved[3] = {0}, turned[3] = {0};
    if (track_is_given(&track->translation)) track_evaluate(&track->translation, time, moved);
    if (track_is_given(&track->rotation)) track_evaluate(&track->rotation, time, turned);
    RigidMotion motion;
    double pivot[3];
    quaternion_from_vector(turned, motion.rotation);
    rotate(motion.rotation, track->pivot, pivot);
    for (int i = 0; i < 3; i++)
        motion.translation[i] = (double)track->pivot[i] - pivot[i] + (double)moved[i];
    if (!track->samples) return motion;
    RigidMotion sampled = rigid_samples_evaluate(track->samples, time);
    return rigid_motion_product(&motion, &sampled);
}

void rigid_track_evaluate(const RigidTrack *track, double time, float rotation[4],
                          float translation[3])
{
    RigidMotion motion = motion_at(track, time);
    for (int i = 0; i < 4; i++) rotation[i] = (float)motion.rotation[i];
    for (int i = 0; i < 3; i++) translation[i] = (float)motion.translation[i];
}

void rigid_track_place(const RigidTrack *track, double time, const float point[3], double place[3])
{
    RigidMotion motion = motion_at(track, time);
    rotate(motion.rotation, point, place);
    for (int i = 0; i < 3; i++) place[i] += motion.translation[i];
}

bool rigid_track_is_still(const RigidTrack *track)
{
    return track_is_still(&track->translation) && track_is_still(&track->rotation) &&
           !track->samples;
}

Result rigid_track_check(const RigidTrack *track, double time, Error *error)
{
    TRY(track_check(&track->translation, "translate", time, error));
    return track_check(&track->rotation, "rotate", time, error);
}

void rigid_track_destroy(RigidTrack *track)
{
    track_destroy(&track->translation);
    track_destroy(&track->rotation);
    *track = (RigidTrack){0};
}
