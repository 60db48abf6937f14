// SPDX-License-Identifier: MIT
#include "mesh/scalp.h"

#include "base/parallel.h"
#include "base/random.h"
#include "mesh/head.h"

#include <math.h>
#include <stddef.h>

static const double SPHERE_RADIUS = 0.1;

static double distance_along(const HeadPatch *patch, const Double3 direction, double radius)
{
    const Double3 at = {radius * direction[0], radius * direction[1], radius * direction[2]};
    return head_patch_distance(patch, at);
}

// Narrows a bracket around the surface to 1e-14 m by the Illinois method, a regula falsi that
// halves the value of an end that was kept twice (Dowell and Jarratt 1971, "A modified regula falsi
// method for computing the root of an equation").
static void narrow(const HeadPatch *patch, const Double3 direction, double *inside, double *outside)
{
    enum { ROUNDS = 40 };
    double below = distance_along(patch, direction, *inside);
    double above = distance_along(patch, direction, *outside);
    int before = 0;
    for (int i = 0; i < ROUNDS && below < 0.0 && above > 0.0 && *outside - *inside > 1e-14; i++) {
        double middle = *outside - above * (*outside - *inside) / (above - below);
        if (!(middle > *inside && middle < *outside)) middle = 0.5 * (*inside + *outside);
        double value = distance_along(patch, direction, middle);
        int side = value < 0.0 ? -1 : 1;
        if (side < 0) {
            *inside = middle, below = value;
            if (before == side) above *= 0.5;
        } else {
            *outside = middle, above = value;
            if (before == side) below *= 0.5;
        }
        before = side;
    }
}

// The radius of the surface, which is within 2 mm below the radius `outside`. The result is that of
// 40 plain bisections, so that it does not depend on the method. Only the first ones, and those
// within the bracket of narrow(), need to evaluate the distance.
static double find_crossing(const Double3 direction, double outside)
{
    enum { HALVINGS = 40, PLAIN = 6 };
    const double wide = 0.002;
    double inside = outside - wide, low = inside, high = outside;
    HeadPatch patch;
    Double3 at = {0};
    for (int k = 0; k < 3; k++) at[k] = outside * direction[k];
    head_patch_find(&patch, at, wide);
    for (int i = 0; i < HALVINGS; i++) {
        if (i == PLAIN) {
            low = inside, high = outside;
            narrow(&patch, direction, &low, &high);
        }
        double middle = 0.5 * (inside + outside);
        bool under = i >= PLAIN && (middle <= low || middle >= high)
                         ? middle <= low
                         : distance_along(&patch, direction, middle) < 0.0;
        *(under ? &inside : &outside) = middle;
    }
    return outside;
}

double scalp_distance(ScalpShape shape, const Double3 at)
{
    return shape == SCALP_SPHERE ? double3_length(at) - SPHERE_RADIUS : head_distance(at);
}

static void lift_off_sphere(Double3 point, double gap)
{
    Double3 direction;
    double3_copy(point, direction);
    double distance = double3_normalize(direction);
    double least = distance > 0.0 ? SPHERE_RADIUS + gap : 0.0;
    if (distance >= least) return;
    for (int i = 0; i < 3; i++) point[i] = least * direction[i];
}

void scalp_lift(ScalpShape shape, Double3 point, double gap)
{
    enum { ROUNDS = 4 };
    if (shape == SCALP_SPHERE) {
        lift_off_sphere(point, gap);
        return;
    }
    for (int i = 0; i < ROUNDS; i++) {
        HeadPatch patch;
        Double3 normal;
        double lack = gap - head_patch_find(&patch, point, HEAD_NORMAL_REACH);
        if (lack <= 0.0) return;
        head_patch_normal(&patch, point, normal);
        double3_add_scaled(point, lack, normal);
    }
}

static double smooth(double low, double high, double x)
{
    double t = fmin(fmax((x - low) / (high - low), 0.0), 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// The height of the hair line as a function of z: from the nape, behind and over the ears, past the
// temples to the forehead. docs/fur.md has the formula.
static double hair_line(double z)
{
    return -0.085 + 0.099 * smooth(-0.06, -0.022, z) + 0.056 * smooth(0.015, 0.075, z);
}

static bool has_hair(ScalpShape shape, const Double3 direction, double radius, bool everywhere)
{
    if (shape == SCALP_SPHERE) return everywhere || direction[1] > 0.2;
    double y = radius * direction[1], z = radius * direction[2];
    return y > hair_line(z);
}

// Area of the surface per area of the unit sphere.
static double area_ratio(double radius, double across)
{
    return radius * radius / fmax(across, 0.2);
}

// Whether hair may grow in a direction in which the surface is below the radius `outside`. A
// conservative test: the hair line rises with z, so it is enough to test the ends of the range.
static bool may_have_hair(const Double3 direction, double outside)
{
    const double least = 0.05; // a lower bound of the head's radius
    double high = direction[1] > 0.0 ? outside : least, near = direction[2] > 0.0 ? least : outside;
    return high * direction[1] > hair_line(near * direction[2]);
}

// Finds the outermost point of the head in a direction: sphere tracing from outside, then an exact
// search. Returns false early if no hair can grow there or if the area ratio is below `least`; the
// 0.2 allows for the change of the normal between the last step and the surface.
static bool find_head_root(double least, ScalpRoot *root)
{
    const double *direction = root->direction;
    double outside = 0.4, step = 1.0;
    Double3 at = {0};
    if (direction[1] < -0.8) return false; // the neck
    for (int i = 0; i < 200 && step >= 1e-4; i++) {
        if (!may_have_hair(direction, outside)) return false;
        for (int k = 0; k < 3; k++) at[k] = outside * direction[k];
        step = 0.5 * head_distance(at);
        if (step >= 1e-4) outside -= step;
    }
    head_normal(at, root->normal);
    if (least > area_ratio(outside, double3_dot(root->normal, direction) - 0.2)) return false;
    root->radius = find_crossing(direction, outside);
    if (!has_hair(SCALP_HEAD, direction, root->radius, false)) return false;
    for (int k = 0; k < 3; k++) at[k] = root->radius * direction[k];
    head_normal(at, root->normal);
    return least <= area_ratio(root->radius, double3_dot(root->normal, direction));
}

// Finds the radius and the normal of the root in its direction. False if no hair grows there or if
// the area ratio is below `least`.
static bool find_root(const ScalpRoots *roots, double least, ScalpRoot *root)
{
    if (roots->shape == SCALP_HEAD) return find_head_root(least, root);
    root->radius = SPHERE_RADIUS;
    double3_copy(root->direction, root->normal);
    return has_hair(roots->shape, root->direction, root->radius, roots->everywhere) &&
           least <= area_ratio(root->radius, double3_dot(root->normal, root->direction));
}

// Maps the unit square uniformly to the sphere. By Archimedes' theorem, that is uniform in y and in
// the angle about the y axis.
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
        ScalpRoot root = {0};
        map_to_sphere((i / GRID + 0.5) / GRID, (i % GRID + 0.5) / GRID, root.direction);
        if (find_root(&roots, 0.0, &root))
            roots.heaviest = fmax(
                roots.heaviest, area_ratio(root.radius, double3_dot(root.normal, root.direction)));
    }
    roots.heaviest *= 1.05; // the grid may have missed the maximum
    return roots;
}

// Element `number` of a three-dimensional low-discrepancy sequence: an additive recurrence with the
// powers of 1/g, g^4 = g + 1 (Roberts 2018, "The unreasonable effectiveness of quasirandom
// sequences"). Two dimensions give the direction; the third rejects candidates in proportion to the
// area. False if it is rejected.
static bool find_candidate(const ScalpRoots *roots, uint64_t number, ScalpRoot *root)
{
    static const Double3 alpha = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
    Double3 point;
    for (int i = 0; i < 3; i++) {
        double x = roots->shift[i] + alpha[i] * (double)number;
        point[i] = x - floor(x);
    }
    map_to_sphere(point[0], point[1], root->direction);
    return find_root(roots, point[2] * roots->heaviest, root);
}

enum { CANDIDATES = 1024 };

typedef struct Candidates {
    const ScalpRoots *roots;
    ScalpRoot root[CANDIDATES];
    bool good[CANDIDATES];
    int parts;
} Candidates;

static void find_part(void *data, int part)
{
    Candidates *candidates = data;
    int parts = candidates->parts;
    for (int i = CANDIDATES * part / parts; i < CANDIDATES * (part + 1) / parts; i++)
        candidates->good[i] = find_candidate(
            candidates->roots, candidates->roots->next + (uint64_t)i, &candidates->root[i]);
}

void scalp_roots_take(ScalpRoots *roots, ScalpRoot *root, uint32_t count)
{
    Candidates candidates = {.roots = roots, .parts = parallel_threads()};
    for (uint32_t found = 0; found < count;) {
        parallel_run(candidates.parts, find_part, &candidates);
        int i = 0;
        for (; i < CANDIDATES && found < count; i++)
            if (candidates.good[i]) root[found++] = candidates.root[i];
        roots->next += (uint64_t)i;
    }
}

static void set_triangle(Mesh *mesh, uint32_t t, const uint32_t triangle[3], const uint32_t uv[3])
{
    for (int k = 0; k < 3; k++) {
        mesh->triangle[t][k] = triangle[k];
        mesh->triangle_uv[t][k] = uv[k];
    }
}

// There is one more column of texture coordinates than of vertices, because of the seam at the
// back.
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

Result scalp_make_mesh(Mesh *mesh, ScalpShape shape, uint32_t rings, Error *error)
{
    uint32_t around = 2 * rings;
    if (shape == SCALP_HEAD) return head_make_mesh(mesh, 4 * rings * (rings - 1), error);
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
        direction_at(M_PI * ring / rings, turn, direction);
        for (int i = 0; i < 3; i++) mesh->position[v][i] = (float)(SPHERE_RADIUS * direction[i]);
    }
    for (uint32_t ring = 0; ring < rings; ring++) add_ring_triangles(mesh, ring, rings);
    mesh_compute_normals(mesh);
    return RESULT_OK;
}
