// SPDX-License-Identifier: MIT
#include "mesh/scalp.h"

#include "base/random.h"

#include <math.h>
#include <stddef.h>

static const double SPHERE_RADIUS = 0.1;
static const double NECK_DEPTH = 0.19, NECK_BEGIN = 0.7 * M_PI;

// An axis-aligned ellipsoid around the origin, which need not be its centre.
typedef struct Ellipsoid {
    Double3 center, axis;
} Ellipsoid;

// Solves |(t d - c) / a| = 1 for the positive t.
static double ellipsoid_radius(const Ellipsoid *ellipsoid, const Double3 direction)
{
    double a = 0.0, b = 0.0, c = -1.0;
    for (int i = 0; i < 3; i++) {
        double d = direction[i] / ellipsoid->axis[i];
        double m = ellipsoid->center[i] / ellipsoid->axis[i];
        a += d * d;
        b += d * m;
        c += m * m;
    }
    return (b + sqrt(b * b - a * c)) / a;
}

// Skull, face with jaw, and a neck without end, joined softly: the 14-norm of three radii is a
// smooth maximum.
static double endless_head_radius(const Double3 direction)
{
    static const Ellipsoid parts[] = {
        {{0.0, 0.018, -0.008}, {0.074, 0.090, 0.096}},
        {{0.0, -0.045, 0.030}, {0.056, 0.078, 0.062}},
        {{0.0, -0.150, -0.022}, {0.054, 0.210, 0.056}},
    };
    static const struct {
        Double3 direction;    // unit length
        double height, width; // metres; radians or so
    } bumps[] = {
        {{0.0, -0.259, 0.966}, 0.016, 0.13},     // nose
        {{0.0, -0.556, 0.831}, 0.005, 0.14},     // lips
        {{0.0, -0.755, 0.656}, 0.006, 0.16},     // chin
        {{0.314, -0.010, 0.949}, -0.006, 0.16},  // left eye
        {{-0.314, -0.010, 0.949}, -0.006, 0.16}, // right eye
        {{0.978, -0.130, -0.163}, 0.012, 0.15},  // left ear
        {{-0.978, -0.130, -0.163}, 0.012, 0.15}, // right ear
    };
    double sum = 0.0, bump = 0.0;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        sum += pow(ellipsoid_radius(&parts[i], direction), 14.0);
    for (size_t i = 0; i < sizeof bumps / sizeof *bumps; i++) {
        Double3 off;
        double3_subtract(direction, bumps[i].direction, off);
        bump += bumps[i].height * exp(-double3_dot(off, off) / (bumps[i].width * bumps[i].width));
    }
    return pow(sum, 1.0 / 14.0) + bump;
}

// The neck ends in a plane.
double scalp_radius(ScalpShape shape, const Double3 direction)
{
    if (shape == SCALP_SPHERE) return SPHERE_RADIUS;
    double radius = endless_head_radius(direction);
    return direction[1] < 0.0 ? fmin(radius, NECK_DEPTH / -direction[1]) : radius;
}

// For r(d), with r extended to all p as r(p / |p|), F(p) = |p| - r is 0 on the surface and its
// gradient, d - grad r, points along the normal.
void scalp_normal(ScalpShape shape, const Double3 direction, Double3 normal)
{
    const double step = 1e-4;
    double radius = scalp_radius(shape, direction);
    for (int i = 0; i < 3; i++) {
        Double3 ahead, behind;
        double3_copy(direction, ahead);
        double3_copy(direction, behind);
        ahead[i] += step;
        behind[i] -= step;
        double3_normalize(ahead);
        double3_normalize(behind);
        double slope = (scalp_radius(shape, ahead) - scalp_radius(shape, behind)) / (2.0 * step);
        normal[i] = shape == SCALP_SPHERE ? direction[i] : direction[i] - slope / radius;
    }
    double3_normalize(normal);
}

static bool has_hair(ScalpShape shape, const Double3 direction, bool everywhere)
{
    if (shape == SCALP_SPHERE) return everywhere || direction[1] > 0.2;
    // The hair line, from the nape past the ears to the forehead.
    double flat = sqrt(direction[0] * direction[0] + direction[2] * direction[2]);
    double forward = flat > 1e-9 ? 0.5 + 0.5 * direction[2] / flat : 0.5;
    return direction[1] > -0.42 + 1.04 * pow(forward, 1.2);
}

// Area of the surface per area of the unit sphere.
static double area_ratio(ScalpShape shape, const Double3 direction)
{
    Double3 normal;
    double radius = scalp_radius(shape, direction);
    scalp_normal(shape, direction, normal);
    return radius * radius / double3_dot(normal, direction);
}

// Archimedes: even in y and in the angle about the y axis is even on the sphere.
static void map_to_sphere(double u, double v, Double3 direction)
{
    double y = 1.0 - 2.0 * u, flat = sqrt(fmax(0.0, 1.0 - y * y));
    direction[0] = flat * sin(2.0 * M_PI * v);
    direction[1] = y;
    direction[2] = flat * cos(2.0 * M_PI * v);
}

ScalpRoots scalp_roots_begin(ScalpShape shape, bool everywhere, uint32_t seed)
{
    ScalpRoots roots = {.shape = shape, .everywhere = everywhere};
    Random random = random_create(seed, 0x726f6f7473); // "roots"
    for (int i = 0; i < 3; i++) roots.shift[i] = random_real(&random);
    enum { GRID = 64 };
    for (int i = 0; i < GRID * GRID; i++) {
        Double3 direction;
        map_to_sphere((i / GRID + 0.5) / GRID, (i % GRID + 0.5) / GRID, direction);
        if (has_hair(shape, direction, everywhere))
            roots.heaviest = fmax(roots.heaviest, area_ratio(shape, direction));
    }
    roots.heaviest *= 1.05; // the grid may have missed the very top
    return roots;
}

// Points of a low-discrepancy sequence in three dimensions (additive recurrence with powers of the
// inverse of g, g^4 = g + 1: Roberts 2018, "The unreasonable effectiveness of quasirandom
// sequences"). Two dimensions give the direction, the third thins out by area.
void scalp_roots_next(ScalpRoots *roots, Double3 direction)
{
    static const Double3 alpha = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
    for (;;) {
        Double3 point;
        for (int i = 0; i < 3; i++) {
            double x = roots->shift[i] + alpha[i] * (double)roots->next;
            point[i] = x - floor(x);
        }
        roots->next++;
        map_to_sphere(point[0], point[1], direction);
        if (!has_hair(roots->shape, direction, roots->everywhere)) continue;
        if (point[2] * roots->heaviest <= area_ratio(roots->shape, direction)) return;
    }
}

static void set_triangle(Mesh *mesh, uint32_t t, const uint32_t triangle[3], const uint32_t uv[3])
{
    for (int k = 0; k < 3; k++) {
        mesh->triangle[t][k] = triangle[k];
        mesh->triangle_uv[t][k] = uv[k];
    }
}

// Texture coordinates have a column more than there are vertices around: the seam, at the back.
static void add_ring_triangles(Mesh *mesh, uint32_t ring, uint32_t rings)
{
    uint32_t around = 2 * rings, t = ring == 0 ? 0 : around * (2 * ring - 1);
    uint32_t top = 1 + (ring - 1) * around, bottom = 1 + ring * around, last = rings - 1;
    for (uint32_t i = 0; i < around; i++) {
        uint32_t next = (i + 1) % around;
        uint32_t a = ring == 0 ? 0 : top + i,
                 b = ring == last ? mesh->vertex_count - 1 : bottom + i;
        uint32_t upper = ring * (around + 1) + (i + rings) % around, lower = upper + around + 1;
        if (ring != last)
            set_triangle(mesh, t++, (uint32_t[]){a, b, bottom + next},
                         (uint32_t[]){upper, lower, lower + 1});
        if (ring != 0)
            set_triangle(mesh, t++, (uint32_t[]){a, ring == last ? b : bottom + next, top + next},
                         (uint32_t[]){upper, lower + (ring != last), upper + 1});
    }
}

static void direction_at(double angle, double turn, Double3 direction)
{
    direction[0] = sin(angle) * sin(turn);
    direction[1] = cos(angle);
    direction[2] = sin(angle) * cos(turn);
}

// The angle from the top at which the neck comes to the plane where it ends.
static double neck_edge(double turn)
{
    double inside = NECK_BEGIN, outside = M_PI;
    for (int i = 0; i < 50; i++) {
        double angle = 0.5 * (inside + outside);
        Double3 direction;
        direction_at(angle, turn, direction);
        if (-direction[1] * endless_head_radius(direction) < NECK_DEPTH)
            inside = angle;
        else
            outside = angle;
    }
    return outside;
}

// The angle of a ring from the top: even steps, but on the neck, where they are such that one ring
// runs along its edge, which would be ragged else.
static double ring_angle(ScalpShape shape, uint32_t ring, uint32_t rings, double turn)
{
    double even = M_PI * ring / rings;
    if (shape == SCALP_SPHERE || even <= NECK_BEGIN) return even;
    double edge = neck_edge(turn), edge_ring = round(rings * neck_edge(0.0) / M_PI);
    double first = floor(rings * NECK_BEGIN / M_PI), begin = M_PI * first / rings;
    if (ring <= edge_ring) return begin + (edge - begin) * (ring - first) / (edge_ring - first);
    return edge + (M_PI - edge) * (ring - edge_ring) / (rings - edge_ring);
}

Result scalp_make_mesh(Mesh *mesh, ScalpShape shape, uint32_t rings, Error *error)
{
    uint32_t around = 2 * rings;
    TRY(mesh_create(mesh, 2 + (rings - 1) * around, 2 * (rings - 1) * around, error));
    TRY(mesh_create_uv(mesh, (rings + 1) * (around + 1), error));
    for (uint32_t i = 0; i < mesh->uv_count; i++) {
        mesh->uv[i][0] = (float)(i % (around + 1)) / (float)around;
        mesh->uv[i][1] = 1.0f - (float)(i / (around + 1)) / (float)rings;
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        uint32_t ring = v == 0 ? 0 : 1 + (v - 1) / around;
        double turn = 2.0 * M_PI * ((v - 1) % around) / around;
        Double3 direction;
        direction_at(ring_angle(shape, ring, rings, turn), turn, direction);
        double radius = scalp_radius(shape, direction);
        for (int i = 0; i < 3; i++) mesh->position[v][i] = (float)(radius * direction[i]);
    }
    for (uint32_t ring = 0; ring < rings; ring++) add_ring_triangles(mesh, ring, rings);
    mesh_compute_normals(mesh);
    return RESULT_OK;
}

Result scalp_append_shoulders(Mesh *mesh, Error *error)
{
    static const float cones[][2][4] = {
        {{0, -0.15f, -0.02f, 0.05f}, {0, -0.26f, -0.03f, 0.075f}},
        {{0.03f, -0.225f, -0.03f, 0.055f}, {0.165f, -0.255f, -0.03f, 0.052f}},
        {{-0.03f, -0.225f, -0.03f, 0.055f}, {-0.165f, -0.255f, -0.03f, 0.052f}},
        {{0.172f, -0.262f, -0.03f, 0.05f}, {0.2f, -0.4f, -0.02f, 0.042f}},
        {{-0.172f, -0.262f, -0.03f, 0.05f}, {-0.2f, -0.4f, -0.02f, 0.042f}},
        {{0.065f, -0.33f, -0.02f, 0.095f}, {-0.065f, -0.33f, -0.02f, 0.095f}},
    };
    for (size_t i = 0; i < sizeof cones / sizeof *cones; ++i)
        TRY(mesh_append_cone(mesh, cones[i][0], cones[i][1], 12, error));
    return RESULT_OK;
}
