// SPDX-License-Identifier: MIT
#include "scene/rigid_track.h"

#include <math.h>

static const double DEGREE = 3.14159265358979323846 / 180;

// The quaternion (x, y, z, w) of a rotation vector: (sin(a/2) axis, cos(a/2)).
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

// R v = v + 2 w (u x v) + 2 u x (u x v), with u the first three numbers of the quaternion, w the
// last.
static void rotate(const double q[4], const float v[3], double rotated[3])
{
    double x = (double)v[0], y = (double)v[1], z = (double)v[2];
    const double cross[3] = {q[1] * z - q[2] * y, q[2] * x - q[0] * z, q[0] * y - q[1] * x};
    rotated[0] = x + 2 * (q[3] * cross[0] + q[1] * cross[2] - q[2] * cross[1]);
    rotated[1] = y + 2 * (q[3] * cross[1] + q[2] * cross[0] - q[0] * cross[2]);
    rotated[2] = z + 2 * (q[3] * cross[2] + q[0] * cross[1] - q[1] * cross[0]);
}

// `formulas`: three.
static void evaluate_formulas(const Formula *formulas, double time, double scale, float value[3])
{
    for (int i = 0; i < 3; i++) {
        double number = formula_evaluate(&formulas[i], time);
        if (isnan(number)) number = 0;
        value[i] = (float)(scale * fmin(fmax(number, -RIGID_TRACK_MAX), RIGID_TRACK_MAX));
    }
}

void rigid_track_evaluate(const RigidTrack *track, double time, float rotation[4],
                          float translation[3])
{
    float moved[3] = {0}, turned[3] = {0};
    if (track->translation.count > 0) keyframes_evaluate(&track->translation, time, moved);
    if (track->rotation.count > 0) keyframes_evaluate(&track->rotation, time, turned);
    if (track->translation_formula[0].text)
        evaluate_formulas(track->translation_formula, time, 1, moved);
    if (track->rotation_formula[0].text)
        evaluate_formulas(track->rotation_formula, time, DEGREE, turned);
    double quaternion[4], pivot[3];
    quaternion_from_vector(turned, quaternion);
    rotate(quaternion, track->pivot, pivot);
    for (int i = 0; i < 4; i++) rotation[i] = (float)quaternion[i];
    for (int i = 0; i < 3; i++)
        translation[i] = (float)((double)track->pivot[i] - pivot[i] + (double)moved[i]);
}

bool rigid_track_is_still(const RigidTrack *track)
{
    return track->translation.count < 2 && track->rotation.count < 2 &&
           !track->translation_formula[0].text && !track->rotation_formula[0].text;
}

// `formulas`: three, or none.
static Result check_formulas(const Formula *formulas, const char *name, double time, Error *error)
{
    for (int i = 0; i < 3 && formulas[i].text; i++) {
        double number = formula_evaluate(&formulas[i], time);
        if (!(fabs(number) <= RIGID_TRACK_MAX))
            return error_set(error, RESULT_BAD_INPUT,
                             "%s[%d]: '%.100s' is %g at t = %.9g, expected -%g to %g", name, i,
                             formulas[i].text, number, time, RIGID_TRACK_MAX, RIGID_TRACK_MAX);
    }
    return RESULT_OK;
}

Result rigid_track_check(const RigidTrack *track, double time, Error *error)
{
    TRY(check_formulas(track->translation_formula, "translate", time, error));
    return check_formulas(track->rotation_formula, "rotate", time, error);
}

void rigid_track_destroy(RigidTrack *track)
{
    keyframes_destroy(&track->translation);
    keyframes_destroy(&track->rotation);
    for (int i = 0; i < 3; i++) {
        formula_destroy(&track->translation_formula[i]);
        formula_destroy(&track->rotation_formula[i]);
    }
    *track = (RigidTrack){0};
}
