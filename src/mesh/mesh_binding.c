// SPDX-License-Identifier: MIT
#include "mesh/mesh_binding.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int compare_floats(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

// Rotates v by a unit quaternion with vector part u and scalar w: v + 2 w (u x v) + 2 u x (u x v).
static inline void turn_vector(const double q[4], const double v[3], double turned[3])
{
    Double3 once, twice;
    double3_cross(q, v, once);
    double3_cross(q, once, twice);
    for (int k = 0; k < 3; ++k) turned[k] = v[k] + 2 * (q[3] * once[k] + twice[k]);
}

static void bind(BoundPoint *point, const Surface *surface, SurfacePoint *nearest,
                 const float from[3], float *distance)
{
    Double3 p;
    double3_from_float(from, p);
    *distance = (float)fabs(surface_nearest(surface, p, nearest));
    for (int i = 0; i < 3; ++i) {
        point->corner[i] = surface->mesh->triangle[nearest->triangle][i];
        point->weight[i] = nearest->weight[i];
    }
    double3_copy(nearest->place, point->place);
}

Result mesh_binding_create(MeshBinding *binding, const Mesh *rest, const char *name,
                           const float (*points)[3], uint32_t count, Error *error)
{
    Surface surface;
    *binding = (MeshBinding){.count = count};
    TRY(surface_create(&surface, rest, name, error));
    binding->points = calloc((size_t)count + 1, sizeof *binding->points);
    float *distance = calloc((size_t)count + 1, sizeof *distance);
    Result result = binding->points && distance
                        ? RESULT_OK
                        : error_set(error, RESULT_FAILED, "no memory for %u bound roots", count);
    SurfacePoint nearest = {.triangle = surface.triangle[0]};
    for (uint32_t i = 0; i < count && result == RESULT_OK; ++i)
        bind(&binding->points[i], &surface, &nearest, points[i], &distance[i]);
    if (result == RESULT_OK && count) {
        qsort(distance, count, sizeof *distance, compare_floats);
        binding->median = distance[count / 2];
    }
    free(distance);
    surface_destroy(&surface);
    if (result != RESULT_OK) mesh_binding_destroy(binding);
    return result;
}

void mesh_binding_destroy(MeshBinding *binding)
{
    free(binding->points);
    *binding = (MeshBinding){0};
}

RigidMotion mesh_binding_motion(const MeshBinding *binding, uint32_t i, const float (*position)[3],
                                const double (*turn)[4])
{
    const BoundPoint *point = &binding->points[i];
    RigidMotion motion = {.rotation = {0, 0, 0, 0}};
    double place[3] = {0}, turned[3], norm = 0;
    const double *first = turn[point->corner[0]];
    for (int c = 0; c < 3; ++c) {
        const double *q = turn[point->corner[c]];
        double dot = q[0] * first[0] + q[1] * first[1] + q[2] * first[2] + q[3] * first[3];
        double weight = dot < 0 ? -point->weight[c] : point->weight[c];
        for (int k = 0; k < 4; ++k) motion.rotation[k] += weight * q[k];
        for (int k = 0; k < 3; ++k)
            place[k] += point->weight[c] * (double)position[point->corner[c]][k];
    }
    for (int k = 0; k < 4; ++k) norm += motion.rotation[k] * motion.rotation[k];
    if (norm > 1e-6) {
        double scale = 1 / sqrt(norm);
        for (int k = 0; k < 4; ++k) motion.rotation[k] *= scale;
    } else { // the corners' rotations cancel
        memcpy(motion.rotation, first, sizeof motion.rotation);
    }
    turn_vector(motion.rotation, point->place, turned);
    double3_subtract(place, turned, motion.translation);
    return motion;
}

void rigid_motion_apply(const RigidMotion *motion, const double point[3], double moved[3])
{
    Double3 turned;
    turn_vector(motion->rotation, point, turned);
    for (int k = 0; k < 3; ++k) moved[k] = turned[k] + motion->translation[k];
}

RigidMotion rigid_motion_product(const RigidMotion *a, const RigidMotion *b)
{
    RigidMotion product;
    const double *p = a->rotation, *q = b->rotation;
    Double3 cross;
    double norm = 0;
    double3_cross(p, q, cross);
    for (int k = 0; k < 3; ++k) product.rotation[k] = p[3] * q[k] + q[3] * p[k] + cross[k];
    product.rotation[3] = p[3] * q[3] - double3_dot(p, q);
    for (int k = 0; k < 4; ++k) norm += product.rotation[k] * product.rotation[k];
    for (int k = 0; k < 4; ++k) product.rotation[k] /= sqrt(norm);
    rigid_motion_apply(a, b->translation, product.translation);
    return product;
}

RigidMotion rigid_motion_inverse(const RigidMotion *motion)
{
    RigidMotion inverse = *motion;
    Double3 back;
    for (int k = 0; k < 3; ++k) inverse.rotation[k] = -motion->rotation[k];
    turn_vector(inverse.rotation, motion->translation, back);
    for (int k = 0; k < 3; ++k) inverse.translation[k] = -back[k];
    return inverse;
}

// --- The best rigid motion between two sets of points.

// The eigenvector of the largest eigenvalue of a symmetric matrix, by Jacobi rotations.
static void largest_eigenvector(double m[4][4], double vector[4])
{
    double v[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    for (int sweep = 0; sweep < 30; ++sweep) {
        double off = 0;
        for (int p = 0; p < 3; ++p)
            for (int q = p + 1; q < 4; ++q) {
                off += fabs(m[p][q]);
                if (m[p][q] == 0) continue;
                double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
                double t = (theta >= 0 ? 1 : -1) / (fabs(theta) + sqrt(theta * theta + 1));
                double c = 1 / sqrt(t * t + 1), s = t * c;
                for (int k = 0; k < 4; ++k) {
                    double a = m[k][p], b = m[k][q];
                    m[k][p] = c * a - s * b, m[k][q] = s * a + c * b;
                }
                for (int k = 0; k < 4; ++k) {
                    double a = m[p][k], b = m[q][k];
                    m[p][k] = c * a - s * b, m[q][k] = s * a + c * b;
                }
                for (int k = 0; k < 4; ++k) {
                    double a = v[k][p], b = v[k][q];
                    v[k][p] = c * a - s * b, v[k][q] = s * a + c * b;
                }
            }
        if (off == 0) break;
    }
    int largest = 0;
    for (int k = 1; k < 4; ++k)
        if (m[k][k] > m[largest][largest]) largest = k;
    for (int k = 0; k < 4; ++k) vector[k] = v[k][largest];
}

static void find_middle(const double (*points)[3], uint32_t count, Double3 middle)
{
    memset(middle, 0, sizeof(Double3));
    for (uint32_t i = 0; i < count; ++i) double3_add_scaled(middle, 1.0 / count, points[i]);
}

RigidMotion rigid_motion_fit(const double (*from)[3], const double (*to)[3], uint32_t count,
                             const RigidMotion *near)
{
    Double3 middle, moved, turned;
    double s[3][3] = {{0}}, scale = 0;
    if (count == 0) return *near;
    find_middle(from, count, middle);
    find_middle(to, count, moved);
    for (uint32_t i = 0; i < count; ++i) {
        Double3 a, b;
        double3_subtract(from[i], middle, a);
        double3_subtract(to[i], moved, b);
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k) s[j][k] += a[j] * b[k];
        scale += double3_length(a) * double3_length(b);
    }
    // Horn's matrix for quaternions in the order x y z w.
    double m[4][4], trace = s[0][0] + s[1][1] + s[2][2];
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) m[i][j] = s[i][j] + s[j][i] - (i == j ? trace : 0);
        m[i][3] = m[3][i] = s[(i + 1) % 3][(i + 2) % 3] - s[(i + 2) % 3][(i + 1) % 3];
    }
    m[3][3] = trace;
    // A weight of 1e-12 for the previous rotation decides only what the points leave undetermined.
    double little = scale > 0 ? 1e-12 * scale : 1;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) m[i][j] += little * near->rotation[i] * near->rotation[j];
    RigidMotion motion = {{0}, {0}};
    largest_eigenvector(m, motion.rotation);
    double dot = 0;
    for (int k = 0; k < 4; ++k) dot += motion.rotation[k] * near->rotation[k];
    for (int k = 0; k < 4 && dot < 0; ++k) motion.rotation[k] = -motion.rotation[k];
    turn_vector(motion.rotation, middle, turned);
    double3_subtract(moved, turned, motion.translation);
    return motion;
}
