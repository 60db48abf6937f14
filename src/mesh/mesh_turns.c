// SPDX-License-Identifier: MIT
#include "mesh/mesh_turns.h"
#include "base/double3.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void mesh_turns_destroy(MeshTurns *turns)
{
    free(turns->first);
    free(turns->neighbour);
    free(turns->share);
    free(turns->frame);
    free(turns->twin);
    *turns = (MeshTurns){0};
}

// --- Vertices at the same position, which files have along seams of texture coordinates.

static uint32_t hash_position(const float p[3])
{
    uint32_t hash = 2166136261u;
    for (int k = 0; k < 3; ++k) {
        float number = p[k] + 0.0f; // turns -0 into 0
        uint32_t bits;
        memcpy(&bits, &number, sizeof bits);
        hash = (hash ^ bits) * 16777619u;
        hash ^= hash >> 15;
    }
    return hash;
}

static bool find_twins(uint32_t *twin, const Mesh *mesh)
{
    uint32_t size = 1;
    while (size < 2 * mesh->vertex_count + 2 && size < UINT32_C(1) << 31) size *= 2;
    uint32_t *table = malloc(size * sizeof *table);
    if (!table) return false;
    memset(table, 0xff, size * sizeof *table);
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        const float *p = mesh->position[v];
        uint32_t at = hash_position(p) & (size - 1);
        while (table[at] != UINT32_MAX) {
            const float *q = mesh->position[table[at]];
            if (q[0] == p[0] && q[1] == p[1] && q[2] == p[2]) break;
            at = (at + 1) & (size - 1);
        }
        if (table[at] == UINT32_MAX) table[at] = v;
        twin[v] = table[at];
    }
    free(table);
    return true;
}

// --- Rings.

// Counts, then stores: each corner of a triangle has the two other corners as neighbours. A
// neighbour that shares two triangles is stored twice, so an edge at the mesh's border gets half
// the weight.
static bool find_rings(MeshTurns *turns, const Mesh *mesh)
{
    uint32_t *count = turns->first;
    for (int fill = 0; fill < 2; ++fill) {
        for (uint32_t t = 0; t < mesh->triangle_count; ++t)
            for (int i = 0; i < 3; ++i) {
                uint32_t v = turns->twin[mesh->triangle[t][i]];
                if (!fill) {
                    count[v + 1] += 2;
                    continue;
                }
                for (int other = 1; other < 3; ++other)
                    turns->neighbour[count[v]++] = turns->twin[mesh->triangle[t][(i + other) % 3]];
            }
        if (fill) break;
        for (uint32_t v = 0; v < mesh->vertex_count; ++v) count[v + 1] += count[v];
        turns->neighbour = malloc(((size_t)count[mesh->vertex_count] + 1) * sizeof(uint32_t));
        turns->share = calloc((size_t)count[mesh->vertex_count] + 1, sizeof *turns->share);
        if (!turns->neighbour || !turns->share) return false;
    }
    // Storing has advanced each start to the next vertex's.
    memmove(&count[1], count, mesh->vertex_count * sizeof *count);
    count[0] = 0;
    return true;
}

// The two tangent vectors, as weighted sums of the ring's offsets.
static void find_tangents(const MeshTurns *turns, uint32_t v, const float (*position)[3],
                          Double3 tangent[2])
{
    memset(tangent, 0, 2 * sizeof *tangent);
    for (uint32_t i = turns->first[v]; i < turns->first[v + 1]; ++i) {
        const float *p = position[v], *q = position[turns->neighbour[i]];
        for (int k = 0; k < 3; ++k) {
            double offset = (double)q[k] - (double)p[k];
            tangent[0][k] += turns->share[i][0] * offset;
            tangent[1][k] += turns->share[i][1] * offset;
        }
    }
}

// The rotation part of the linear map from the tangent plane to the two tangents: its columns and
// the normal.
static bool find_frame(const Double3 tangent[2], Double3 frame[3])
{
    Double3 along, across;
    double3_cross(tangent[0], tangent[1], frame[2]);
    double area = double3_normalize(frame[2]);
    double3_copy(tangent[0], along);
    double length = double3_normalize(along);
    // The ring has collapsed to a line or a point.
    if (!(area > 1e-6 * double3_length(tangent[1]) * length) || !(length > 0)) return false;
    double3_cross(frame[2], along, across);
    // In the basis (along, across) the map is the matrix [[length, b], [0, d]]. Its rotation part
    // turns by the angle with tangent (0 - b)/(length + d).
    double b = double3_dot(tangent[1], along), d = double3_dot(tangent[1], across);
    double cosine = length + d, sine = -b, norm = sqrt(cosine * cosine + sine * sine);
    for (int k = 0; k < 3; ++k) {
        frame[0][k] = (cosine * along[k] + sine * across[k]) / norm;
        frame[1][k] = (cosine * across[k] - sine * along[k]) / norm;
    }
    return true;
}

static void find_basis(const Double3 normal, Double3 x, Double3 y)
{
    Double3 axis = {fabs(normal[0]) < 0.6, 0, 0};
    axis[1] = axis[0] == 0;
    double3_cross(normal, axis, x);
    double3_normalize(x);
    double3_cross(normal, x, y);
}

// The weights of the ring's offsets. With (x, y) as an offset's coordinates in the tangent plane,
// its weight is the inverse of sum (x, y)(x, y)^T times (x, y). Then the columns sum weight *
// offset are the least-squares map from the plane to the offsets.
static void make_shares(MeshTurns *turns, const Mesh *mesh, uint32_t v)
{
    Double3 normal, x, y;
    double xx = 0, xy = 0, yy = 0;
    double3_from_float(mesh->normal[v], normal);
    if (!(double3_normalize(normal) > 0)) return;
    find_basis(normal, x, y);
    for (uint32_t i = turns->first[v]; i < turns->first[v + 1]; ++i) {
        Double3 offset, p, q;
        double3_from_float(mesh->position[v], p);
        double3_from_float(mesh->position[turns->neighbour[i]], q);
        double3_subtract(q, p, offset);
        double a = double3_dot(offset, x), b = double3_dot(offset, y);
        turns->share[i][0] = a, turns->share[i][1] = b;
        xx += a * a, xy += a * b, yy += b * b;
    }
    double determinant = xx * yy - xy * xy, trace = xx + yy;
    bool flat = !(determinant > 1e-9 * trace * trace);
    for (uint32_t i = turns->first[v]; i < turns->first[v + 1]; ++i) {
        double a = turns->share[i][0], b = turns->share[i][1];
        turns->share[i][0] = flat ? 0 : (yy * a - xy * b) / determinant;
        turns->share[i][1] = flat ? 0 : (xx * b - xy * a) / determinant;
    }
    Double3 tangent[2];
    find_tangents(turns, v, (const float(*)[3])mesh->position, tangent);
    if (!find_frame((const Double3 *)tangent, turns->frame[v]))
        memset(turns->frame[v], 0, sizeof turns->frame[v]);
}

// Normals are computed on the welded mesh, so that both sides of a seam have the same normal.
static bool smooth_normals(Mesh *welded, const MeshTurns *turns, const Mesh *mesh)
{
    *welded = *mesh;
    welded->triangle = malloc(((size_t)mesh->triangle_count + 1) * sizeof *welded->triangle);
    welded->normal = calloc((size_t)mesh->vertex_count + 1, sizeof *welded->normal);
    if (!welded->triangle || !welded->normal) return false;
    for (uint32_t t = 0; t < mesh->triangle_count; ++t)
        for (int i = 0; i < 3; ++i) welded->triangle[t][i] = turns->twin[mesh->triangle[t][i]];
    mesh_compute_normals(welded);
    return true;
}

static bool build(MeshTurns *turns, const Mesh *rest)
{
    size_t n = rest->vertex_count;
    turns->vertex_count = rest->vertex_count;
    turns->first = calloc(n + 2, sizeof *turns->first);
    turns->frame = calloc(n + 1, sizeof *turns->frame);
    turns->twin = calloc(n + 1, sizeof *turns->twin);
    Mesh welded = {0};
    bool good = turns->first && turns->frame && turns->twin && find_twins(turns->twin, rest) &&
                find_rings(turns, rest) && smooth_normals(&welded, turns, rest);
    for (uint32_t v = 0; good && v < n; ++v)
        if (turns->twin[v] == v) make_shares(turns, &welded, v);
    free(welded.triangle);
    free(welded.normal);
    return good;
}

Result mesh_turns_create(MeshTurns *turns, const Mesh *rest, Error *error)
{
    *turns = (MeshTurns){0};
    // The limits of 32-bit counts: six neighbours per triangle, and a hash table of twice the
    // number of vertices.
    if (rest->triangle_count > UINT32_MAX / 8 || rest->vertex_count > UINT32_MAX / 4)
        return error_set(error, RESULT_BAD_INPUT,
                         "the mesh: %u vertices and %u triangles: expected fewer than 2^30 "
                         "vertices and fewer than 2^29 triangles",
                         rest->vertex_count, rest->triangle_count);
    if (build(turns, rest)) return RESULT_OK;
    mesh_turns_destroy(turns);
    return error_set(error, RESULT_FAILED, "no memory for the turns of %u vertices",
                     rest->vertex_count);
}

// The quaternion of the rotation now * rest^T, where the frames' vectors are the columns (after
// Shepperd 1978).
static void quaternion_between(const Double3 rest[3], const Double3 now[3], double q[4])
{
    double m[3][3] = {{0}};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int c = 0; c < 3; ++c) m[i][j] += now[c][i] * rest[c][j];
    double trace = m[0][0] + m[1][1] + m[2][2];
    int largest = 3;
    for (int k = 0; k < 3; ++k)
        if (m[k][k] > (largest == 3 ? trace : m[largest][largest])) largest = k;
    if (largest == 3) {
        q[3] = 1 + trace;
        for (int k = 0; k < 3; ++k)
            q[k] = m[(k + 2) % 3][(k + 1) % 3] - m[(k + 1) % 3][(k + 2) % 3];
    } else {
        int i = largest, j = (i + 1) % 3, k = (i + 2) % 3;
        q[i] = 1 + 2 * m[i][i] - trace;
        q[j] = m[i][j] + m[j][i];
        q[k] = m[i][k] + m[k][i];
        q[3] = m[k][j] - m[j][k];
    }
    double norm = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int k = 0; k < 4; ++k) q[k] /= norm;
}

void mesh_turns_find(const MeshTurns *turns, uint32_t vertex, const float (*position)[3],
                     double turn[4])
{
    uint32_t v = turns->twin[vertex];
    Double3 tangent[2], frame[3];
    const double none[4] = {0, 0, 0, 1};
    memcpy(turn, none, sizeof none);
    if (double3_dot(turns->frame[v][2], turns->frame[v][2]) == 0) return;
    find_tangents(turns, v, position, tangent);
    if (find_frame((const Double3 *)tangent, frame))
        quaternion_between((const Double3 *)turns->frame[v], (const Double3 *)frame, turn);
}
