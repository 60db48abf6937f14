// SPDX-License-Identifier: MIT
// Vectors of three doubles. They use only sums, products and square roots, so results are the same
// on every machine.
#pragma once

#include <math.h>
#include <string.h>

typedef double Double3[3];

// As fmax and fmin, but without a call. If one number is NaN they return b.
static inline double double_max(double a, double b)
{
    return a > b ? a : b;
}

static inline double double_min(double a, double b)
{
    return a < b ? a : b;
}

static inline void double3_copy(const Double3 from, Double3 to)
{
    memmove(to, from, sizeof(Double3));
}

static inline void double3_from_float(const float from[3], Double3 to)
{
    for (int i = 0; i < 3; i++) to[i] = (double)from[i];
}

static inline double double3_dot(const Double3 a, const Double3 b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// c must be neither a nor b.
static inline void double3_cross(const Double3 a, const Double3 b, Double3 c)
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

static inline void double3_subtract(const Double3 a, const Double3 b, Double3 c)
{
    for (int i = 0; i < 3; i++) c[i] = a[i] - b[i];
}

static inline void double3_add_scaled(Double3 to, double factor, const Double3 v)
{
    for (int i = 0; i < 3; i++) to[i] += factor * v[i];
}

// a + share (b - a)
static inline void double3_mix(const Double3 a, const Double3 b, double share, Double3 c)
{
    for (int i = 0; i < 3; i++) c[i] = a[i] + share * (b[i] - a[i]);
}

static inline double double3_length(const Double3 v)
{
    return sqrt(double3_dot(v, v));
}

static inline double double3_distance(const Double3 a, const Double3 b)
{
    Double3 difference;
    double3_subtract(a, b, difference);
    return double3_length(difference);
}

// Returns the previous length; a vector of length 0 stays.
static inline double double3_normalize(Double3 v)
{
    double length = double3_length(v);
    for (int i = 0; i < 3 && length > 0.0; i++) v[i] /= length;
    return length;
}

// The matrix (for column vectors) of a unit quaternion x y z w.
static inline void double3_rotation(const double q[4], double rows[3][3])
{
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    rows[0][0] = 1 - 2 * (y * y + z * z), rows[0][1] = 2 * (x * y - w * z);
    rows[0][2] = 2 * (x * z + w * y), rows[1][0] = 2 * (x * y + w * z);
    rows[1][1] = 1 - 2 * (x * x + z * z), rows[1][2] = 2 * (y * z - w * x);
    rows[2][0] = 2 * (x * z - w * y), rows[2][1] = 2 * (y * z + w * x);
    rows[2][2] = 1 - 2 * (x * x + y * y);
}

// Removes the component along `normal`, a unit vector.
static inline void double3_flatten(Double3 v, const Double3 normal)
{
    double3_add_scaled(v, -double3_dot(v, normal), normal);
}
