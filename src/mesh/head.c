// SPDX-License-Identifier: MIT
#include "mesh/head.h"

#include "base/simd.h"
#include "mesh/simplify.h"
#include "mesh/surface_net.h"

#include <pthread.h>
#include <stddef.h>

// --- Parts, in the order in which they are joined to the result so far.

typedef enum PartKind {
    ADD,  // smooth union
    CUT,  // smooth difference
    KEEP, // smooth intersection
} PartKind;

typedef enum PartForm {
    EGG,  // an ellipsoid: a is the centre, b has the radii
    CONE, // a round cone, the hull of two spheres: a and b are centres with radii
} PartForm;

typedef enum PartSides {
    ONE,
    BOTH, // with its mirror image at -x
} PartSides;

typedef struct Part {
    PartKind kind;
    PartForm form;
    PartSides sides;
    double blend; // m, width over which the seam is rounded
    double a[4], b[4];
} Part;

// The proportions of a head of 0.23 m whose face is divided into thirds: hairline at 0.078, brow
// 0.012, base of the nose -0.054, chin -0.12. The eyes are at half the height.
static const Part PARTS[] = {
    // Skull.
    {ADD, EGG, ONE, 0.030, {0, 0.030, -0.025}, {0.078, 0.080, 0.082}},
    {ADD, EGG, ONE, 0.030, {0, 0.026, 0.016}, {0.067, 0.076, 0.072}},
    {ADD, EGG, ONE, 0.030, {0, -0.016, -0.052}, {0.060, 0.052, 0.047}},
    // Face, cheekbones, cheeks, jaw, chin.
    {ADD, EGG, ONE, 0.025, {0, -0.036, 0.026}, {0.060, 0.076, 0.051}},
    {ADD, CONE, BOTH, 0.026, {0.039, -0.028, 0.055, 0.014}, {0.060, -0.018, 0.018, 0.012}},
    {ADD, EGG, BOTH, 0.020, {0.032, -0.054, 0.040}, {0.026, 0.034, 0.030}},
    {ADD, EGG, BOTH, 0.020, {0.046, -0.042, 0.014}, {0.018, 0.034, 0.024}},
    {ADD, CONE, BOTH, 0.030, {0.043, -0.066, 0.006, 0.015}, {0.010, -0.104, 0.064, 0.013}},
    {ADD, EGG, ONE, 0.016, {0, -0.104, 0.071}, {0.019, 0.016, 0.016}},
    {ADD, EGG, ONE, 0.020, {0, -0.068, 0.0645}, {0.028, 0.034, 0.0275}},
    // Brows, sockets, lids.
    {ADD, CONE, BOTH, 0.020, {0.012, 0.013, 0.075, 0.0090}, {0.044, 0.015, 0.057, 0.007}},
    {CUT, EGG, BOTH, 0.016, {0.0315, -0.006, 0.094}, {0.022, 0.0140, 0.0175}},
    {ADD, EGG, BOTH, 0.004, {0.0325, -0.0040, 0.0615}, {0.0180, 0.0115, 0.0168}},
    {ADD, EGG, BOTH, 0.007, {0.0325, -0.0145, 0.0605}, {0.0160, 0.0080, 0.0140}},
    // Nose: body, bridge, tip, wings, nostrils.
    {ADD, EGG, ONE, 0.012, {0, -0.030, 0.079}, {0.0125, 0.026, 0.016}},
    {ADD, CONE, ONE, 0.014, {0, 0.006, 0.077, 0.0060}, {0, -0.036, 0.098, 0.0075}},
    {ADD, EGG, ONE, 0.010, {0, -0.0405, 0.0985}, {0.0095, 0.0085, 0.0115}},
    {ADD, EGG, BOTH, 0.010, {0.0105, -0.0440, 0.0880}, {0.0065, 0.0080, 0.0120}},
    {CUT, EGG, BOTH, 0.003, {0.0060, -0.0530, 0.0950}, {0.0030, 0.0036, 0.0055}},
    // Lips.
    {ADD, CONE, BOTH, 0.0060, {0.0035, -0.0727, 0.0868, 0.0062}, {0.0205, -0.0778, 0.0790, 0.0032}},
    {ADD, CONE, BOTH, 0.0030, {0.0000, -0.0848, 0.0866, 0.0080}, {0.0195, -0.0800, 0.0788, 0.0036}},
    {CUT, CONE, BOTH, 0.008, {0.0010, -0.0788, 0.0955, 0.0014}, {0.0160, -0.0790, 0.0872, 0.0008}},
    {CUT, EGG, ONE, 0.012, {0, -0.0955, 0.0965}, {0.018, 0.005, 0.007}},
    // Ears: shell, rim, lobe, hollow.
    {ADD, EGG, BOTH, 0.010, {0.0640, -0.018, -0.008}, {0.0120, 0.0240, 0.0150}},
    {ADD, EGG, BOTH, 0.008, {0.0715, -0.020, -0.010}, {0.0070, 0.0270, 0.0165}},
    {ADD, CONE, BOTH, 0.006, {0.0730, -0.006, 0.002, 0.0035}, {0.0770, 0.006, -0.009, 0.0040}},
    {ADD, CONE, BOTH, 0.006, {0.0770, 0.006, -0.009, 0.0040}, {0.0810, 0.000, -0.021, 0.0040}},
    {ADD, CONE, BOTH, 0.006, {0.0810, 0.000, -0.021, 0.0040}, {0.0810, -0.018, -0.024, 0.0038}},
    {ADD, CONE, BOTH, 0.006, {0.0810, -0.018, -0.024, 0.0038}, {0.0760, -0.036, -0.014, 0.0036}},
    {ADD, EGG, BOTH, 0.006, {0.0735, -0.043, -0.006}, {0.0050, 0.0085, 0.0070}},
    {CUT, EGG, BOTH, 0.005, {0.0830, -0.020, -0.007}, {0.0075, 0.0130, 0.0085}},
    // Neck with its sternocleidomastoids, shoulders, collarbones, chest.
    {ADD, CONE, ONE, 0.022, {0, -0.060, -0.024, 0.046}, {0, -0.210, -0.040, 0.052}},
    {ADD, CONE, BOTH, 0.020, {0.046, -0.066, -0.022, 0.008}, {0.011, -0.216, 0.012, 0.006}},
    {ADD, CONE, BOTH, 0.040, {0.014, -0.135, -0.052, 0.024}, {0.110, -0.236, -0.048, 0.026}},
    {ADD, CONE, BOTH, 0.030, {0.050, -0.268, -0.040, 0.050}, {0.140, -0.266, -0.042, 0.046}},
    {ADD, EGG, ONE, 0.040, {0, -0.325, -0.020}, {0.145, 0.110, 0.082}},
    {ADD, CONE, BOTH, 0.014, {0.014, -0.220, 0.012, 0.006}, {0.130, -0.224, -0.030, 0.007}},
    {KEEP, EGG, ONE, 0.030, {0, -0.080, -0.030}, {0.185, 0.225, 0.170}},
};

// Data of a part that do not depend on the point: the axis and sides of a round cone; the bounding
// box of the part with its mirror image, in |x|; and the smallest ratio of the part's distance
// bound to the distance from that box.
typedef struct Shape {
    Double3 axis;
    double length, slant, straight;
    Double3 low, high;
    double ratio;
} Shape;

enum { PART_COUNT = sizeof PARTS / sizeof *PARTS };
_Static_assert((int)PART_COUNT <= (int)HEAD_PARTS_MOST, "a patch has room for all parts");

// Neighbours in the table, which are skipped together.
typedef struct Group {
    Double3 low, high;
    double ratio, blend; // the smallest ratio, the largest blend
} Group;

enum { GROUP_PARTS = 4, GROUPS = (PART_COUNT + GROUP_PARTS - 1) / GROUP_PARTS };

static Shape shapes[PART_COUNT];
static Group groups[GROUPS];

// Quilez's bound of an ellipsoid's distance, with exact sign: (|p/r| - 1) |p/r| / |p/r^2|.
SIMD_INLINE double egg_distance(const Part *part, double x, double y, double z)
{
    const double *a = part->a, *r = part->b;
    double px = (x - a[0]) / r[0], py = (y - a[1]) / r[1], pz = (z - a[2]) / r[2];
    double qx = px / r[0], qy = py / r[1], qz = pz / r[2];
    double k = sqrt(px * px + py * py + pz * pz), l = sqrt(qx * qx + qy * qy + qz * qz);
    return l > 0.0 ? k * (k - 1.0) / l : -double_min(r[0], double_min(r[1], r[2]));
}

// A minimum that rounds the seam over the width `blend`. Twice differentiable, and exactly
// symmetric in a and b.
SIMD_INLINE double smooth_min(double a, double b, double blend)
{
    double least = a < b ? a : b, h = double_max(blend - fabs(a - b), 0.0) / blend;
    return least - h * h * h * blend / 6.0;
}

// Whether a distance bound of at least `ratio` times the distance to the box exceeds `distance` (>=
// 0).
SIMD_INLINE bool is_far(const Double3 low, const Double3 high, double ratio, double x, double y,
                        double z, double distance)
{
    double gap = double_max(0.0, double_max(low[0] - x, x - high[0]));
    gap = double_max(gap, double_max(low[1] - y, y - high[1]));
    gap = double_max(gap, double_max(low[2] - z, z - high[2]));
    return gap * ratio > distance;
}

// Points at which parts are evaluated together, on the parts' side (x >= 0), and their distances
// from the parts so far.
enum { SPOTS = 8 };
typedef struct SIMD_ALIGNED Spots {
    double x[SPOTS], y[SPOTS], z[SPOTS], sum[SPOTS];
} Spots;

// `side`: 1, or -1 for the mirror image.
SIMD_INLINE void find_eggs(const Part *part, const Spots *at, int count, double side,
                           double distance[SPOTS])
{
    for (int k = 0; k < count; k++)
        distance[k] = egg_distance(part, side * at->x[k], at->y[k], at->z[k]);
}

// Works in the plane of the axis and the point. The nearest point is on the slanted side or on one
// of the spheres.
SIMD_INLINE void find_cones(const Part *part, const Shape *shape, const Spots *at, int count,
                            double side, double distance[SPOTS])
{
    const double *a = part->a, *b = part->b, *axis = shape->axis;
    double foot[SPOTS], slanted[SPOTS], begin[SPOTS], end[SPOTS];
    for (int k = 0; k < count; k++) {
        double x = side * at->x[k], y = at->y[k], z = at->z[k], px = x - a[0], py = y - a[1],
               pz = z - a[2], ex = x - b[0], ey = y - b[1], ez = z - b[2];
        double along = px * axis[0] + py * axis[1] + pz * axis[2];
        double ax = px - along * axis[0], ay = py - along * axis[1], az = pz - along * axis[2];
        double flat = sqrt(ax * ax + ay * ay + az * az);
        foot[k] = along + flat * shape->slant / shape->straight;
        slanted[k] = flat * shape->straight + along * shape->slant - a[3];
        begin[k] = sqrt(px * px + py * py + pz * pz) - a[3];
        end[k] = sqrt(ex * ex + ey * ey + ez * ez) - b[3];
    }
    for (int k = 0; k < count; k++) {
        double past = foot[k] >= shape->length ? end[k] : slanted[k];
        distance[k] = foot[k] <= 0.0 ? begin[k] : past;
    }
}

SIMD_INLINE void find_distances(const Part *part, const Shape *shape, const Spots *at, int count,
                                double side, double distance[SPOTS])
{
    if (part->form == EGG)
        find_eggs(part, at, count, side, distance);
    else
        find_cones(part, shape, at, count, side, distance);
}

// Adds a part to the sums of the first `count` points. The mirror image is evaluated only where it
// is near enough to blend.
SIMD_INLINE void join_part(int i, Spots *at, int count)
{
    const Part *part = &PARTS[i];
    const Shape *shape = &shapes[i];
    double distance[SPOTS], mirrored[SPOTS], sign = part->kind == ADD ? 1.0 : -1.0,
                                             turned = part->kind == KEEP ? -1.0 : 1.0;
    find_distances(part, shape, at, count, 1.0, distance);
    int near = 0;
    for (int k = 0; part->sides == BOTH && k < count; k++)
        near += !is_far(shape->low, shape->high, shape->ratio, -at->x[k], at->y[k], at->z[k],
                        double_max(distance[k] + part->blend, 0.0));
    if (near) {
        find_distances(part, shape, at, count, -1.0, mirrored);
        for (int k = 0; k < count; k++)
            distance[k] = smooth_min(distance[k], mirrored[k], part->blend);
    }
    for (int k = 0; k < count; k++)
        at->sum[k] = sign * smooth_min(sign * at->sum[k], turned * distance[k], part->blend);
}

// The bound of an ellipsoid's distance is at least the distance times the shortest over the longest
// radius.
static void find_shape(const Part *part, Shape *shape)
{
    const double *a = part->a, *b = part->b;
    for (int i = 0; i < 3; i++) {
        double wide = part->form == EGG ? b[i] : double_max(a[3], b[3]);
        shape->low[i] = (part->form == EGG ? a[i] : double_min(a[i], b[i])) - wide;
        shape->high[i] = (part->form == EGG ? a[i] : double_max(a[i], b[i])) + wide;
    }
    shape->ratio = 1.0;
    if (part->form == EGG) {
        shape->ratio =
            double_min(b[0], double_min(b[1], b[2])) / double_max(b[0], double_max(b[1], b[2]));
        return;
    }
    double3_subtract(b, a, shape->axis);
    shape->length = double3_normalize(shape->axis);
    shape->slant = (a[3] - b[3]) / shape->length;
    shape->straight = sqrt(1.0 - shape->slant * shape->slant);
}

static void find_shapes(void)
{
    for (int i = 0; i < PART_COUNT; i++) {
        const Shape *shape = &shapes[i];
        Group *group = &groups[i / GROUP_PARTS];
        find_shape(&PARTS[i], &shapes[i]);
        if (i % GROUP_PARTS == 0) {
            double3_copy(shape->low, group->low);
            double3_copy(shape->high, group->high);
            group->ratio = 1.0;
        }
        for (int k = 0; k < 3; k++) {
            group->low[k] = double_min(group->low[k], shape->low[k]);
            group->high[k] = double_max(group->high[k], shape->high[k]);
        }
        // a KEEP part affects every point
        group->ratio = PARTS[i].kind == KEEP ? 0.0 : double_min(group->ratio, shape->ratio);
        group->blend = double_max(group->blend, PARTS[i].blend);
    }
}

// Skips parts that are too far away to change the result anywhere within `reach` of the point. Over
// that range the distance to a box changes by at most `reach`, and `sum` by at most 8 times as
// much, which bounds its gradient.
double head_patch_find(HeadPatch *patch, const Double3 point, double reach)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    Spots at = {.x = {fabs(point[0])}, .y = {point[1]}, .z = {point[2]}, .sum = {1.0}};
    double slack = 9.0 * reach, x = at.x[0], y = at.y[0], z = at.z[0];
    pthread_once(&once, find_shapes);
    double3_copy(point, patch->at);
    patch->reach = reach;
    patch->count = 0;
    for (int i = 0; i < PART_COUNT; i++) {
        const Shape *shape = &shapes[i];
        const Group *group = &groups[i / GROUP_PARTS];
        double sign = PARTS[i].kind == ADD ? 1.0 : -1.0, sum = at.sum[0];
        if (i % GROUP_PARTS == 0 && is_far(group->low, group->high, group->ratio, x, y, z,
                                           fabs(sum) + 1.2 * group->blend + slack)) {
            i += GROUP_PARTS - 1;
            continue;
        }
        if (PARTS[i].kind != KEEP &&
            is_far(shape->low, shape->high, shape->ratio, x, y, z,
                   double_max(sign * sum, 0.0) + 1.2 * PARTS[i].blend + slack))
            continue;
        patch->part[patch->count++] = (unsigned char)i;
        join_part(i, &at, 1);
    }
    return at.sum[0];
}

double head_patch_distance(const HeadPatch *patch, const Double3 point)
{
    Spots at = {.x = {fabs(point[0])}, .y = {point[1]}, .z = {point[2]}, .sum = {1.0}};
    for (int i = 0; i < patch->count; i++) join_part(patch->part[i], &at, 1);
    return at.sum[0];
}

double head_distance(const Double3 at)
{
    HeadPatch unused;
    return head_patch_find(&unused, at, 0.0);
}

// A patch, and points near it.
typedef struct Look {
    const HeadPatch *patch;
    Spots *at;
} Look;

SIMD_INLINE void look(const Look *look, int part)
{
    (void)part;
    for (int i = 0; i < look->patch->count; i++) join_part(look->patch->part[i], look->at, SPOTS);
}

SIMD_CALL(look, Look)

double head_patch_normal(const HeadPatch *patch, const Double3 point, Double3 normal)
{
    const double step = HEAD_NORMAL_REACH;
    Spots at;
    for (int k = 0; k < SPOTS; k++) { // both ways along each axis, then the point itself
        Double3 beside;
        double3_copy(point, beside);
        if (k < 6) beside[k / 2] += k % 2 ? -step : step;
        at.x[k] = fabs(beside[0]), at.y[k] = beside[1], at.z[k] = beside[2];
        at.sum[k] = 1.0;
    }
    call_look(&(Look){patch, &at});
    for (int i = 0; i < 3; i++) normal[i] = at.sum[2 * i] - at.sum[2 * i + 1];
    if (!(double3_normalize(normal) > 0.0)) normal[1] = 1.0;
    return at.sum[6];
}

void head_normal(const Double3 at, Double3 normal)
{
    HeadPatch patch;
    head_patch_find(&patch, at, HEAD_NORMAL_REACH);
    head_patch_normal(&patch, at, normal);
}

// --- The mesh.

// Edge length of the initial fine mesh along an axis, linear between the knots.
typedef struct Spacing {
    double place, edge; // m
} Spacing;

static const Spacing ACROSS[] = {{0.0, 0.0026}, {0.050, 0.0030}, {0.090, 0.0036}, {0.150, 0.0090}};
static const Spacing UP[] = {{-0.320, 0.0060}, {-0.200, 0.0060}, {-0.120, 0.0032}, {-0.070, 0.0020},
                             {-0.010, 0.0020}, {0.020, 0.0036},  {0.060, 0.0075},  {0.125, 0.0075}};
static const Spacing AHEAD[] = {{-0.130, 0.0075}, {-0.040, 0.0040}, {0.010, 0.0036},
                                {0.050, 0.0050},  {0.075, 0.0027},  {0.122, 0.0027}};

static double edge_at(const Spacing *spacing, size_t count, double at)
{
    size_t i = 0;
    while (i + 2 < count && spacing[i + 1].place < at) i++;
    const Spacing *s = spacing + i;
    double share = fmin(fmax((at - s[0].place) / (s[1].place - s[0].place), 0.0), 1.0);
    return s[0].edge + share * (s[1].edge - s[0].edge);
}

enum { LINES = 256 }; // room for the lines; the tables above need fewer

// Places planes from the first knot to the last. `mirrored` adds their mirror images. Returns the
// number of planes.
static uint32_t place_lines(const Spacing *spacing, size_t count, bool mirrored, double line[LINES])
{
    uint32_t found = 0;
    for (double at = spacing[0].place; at < spacing[count - 1].place && 2 * found < LINES;) {
        line[found++] = at;
        at += edge_at(spacing, count, at);
    }
    if (!mirrored) return found;
    for (uint32_t i = found; i-- > 0;) line[found - 1 + i] = line[i];
    for (uint32_t i = 0; i < found - 1; i++) line[i] = -line[2 * (found - 1) - i];
    return 2 * found - 1;
}

// Rounds to 0.01 mm or 1/10000 of a turn, which keeps text files small.
static void round_numbers(float *number, size_t count, double unit)
{
    for (size_t i = 0; i < count; i++)
        number[i] = (float)(floor((double)number[i] / unit + 0.5) * unit);
}

// Sets u from the longitude and v from the latitude of a vertex. `turns` is added to u for the
// seam.
static void set_uv(const Mesh *mesh, uint32_t vertex, int turns, float uv[2])
{
    Double3 p;
    double3_from_float(mesh->position[vertex], p);
    double3_normalize(p);
    uv[0] = (float)(0.5 + atan2(p[0], p[2]) / (2.0 * M_PI) + turns);
    uv[1] = (float)(0.5 + asin(p[1]) / M_PI);
}

// Whether the corner is on the other side of the seam (at the back of the head) than the rest of
// its triangle.
static bool is_beyond(const Mesh *mesh, const uint32_t triangle[3], int k)
{
    float most = 0.0f;
    for (int i = 0; i < 3; i++) most = fmaxf(most, mesh->uv[triangle[i]][0]);
    return most - mesh->uv[triangle[k]][0] > 0.5f;
}

// Corners on the other side of the seam get coordinates of their own, with u greater than 1.
static Result add_uv(Mesh *mesh, Error *error)
{
    uint32_t count = mesh->vertex_count;
    TRY(mesh_create_uv(mesh, count + 3 * mesh->triangle_count, error));
    for (uint32_t v = 0; v < count; v++) set_uv(mesh, v, 0, mesh->uv[v]);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            uint32_t vertex = mesh->triangle[t][k];
            mesh->triangle_uv[t][k] = vertex;
            if (!is_beyond(mesh, mesh->triangle[t], k)) continue;
            mesh->triangle_uv[t][k] = count;
            set_uv(mesh, vertex, 1, mesh->uv[count++]);
        }
    mesh->uv_count = count;
    round_numbers(mesh->uv[0], 2 * (size_t)count, 1e-4);
    return RESULT_OK;
}

// Importance for simplification: viewers look at the face, most at eyes and mouth, then at the
// ears. Shoulders are plain, and hair covers the skull.
static double look_at(const Double3 at)
{
    bool ahead = at[2] > 0.03 && at[1]<0.03, near = at[2]> 0.058 && at[1] > -0.095;
    if (at[1] < -0.13) return 0.5;
    if (ahead && near) return at[1] > -0.022 && fabs(at[0]) > 0.012 ? 80.0 : 20.0;
    if (ahead) return 5.0;
    return at[1] < 0.02 && fabs(at[0]) > 0.068 ? 3.0 : 0.5;
}

// As SurfaceNet.near; `own` is a HeadPatch.
static double measure_near(void *own, const Double3 at, Double3 normal)
{
    const double wide = 2e-4; // m, of most steps; a wider patch has more parts
    HeadPatch *patch = own;
    if (double3_distance(at, patch->at) + HEAD_NORMAL_REACH >= patch->reach)
        head_patch_find(patch, at, wide);
    return normal ? head_patch_normal(patch, at, normal) : head_patch_distance(patch, at);
}

Result head_make_mesh(Mesh *mesh, uint32_t triangle_count, Error *error)
{
    double x[LINES], y[LINES], z[LINES];
    HeadPatch patch = {.reach = -1.0};
    SurfaceNet net = {.distance = head_distance,
                      .near = measure_near,
                      .own = &patch,
                      .line = {x, y, z},
                      .smoothing = 3};
    net.count[0] = place_lines(ACROSS, sizeof ACROSS / sizeof *ACROSS, true, x);
    net.count[1] = place_lines(UP, sizeof UP / sizeof *UP, false, y);
    net.count[2] = place_lines(AHEAD, sizeof AHEAD / sizeof *AHEAD, false, z);
    TRY(surface_net_make(mesh, &net, error));
    TRY(simplify_mesh(mesh, triangle_count, look_at, error));
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        Double3 place;
        double3_from_float(mesh->position[v], place);
        surface_net_project(&net, place);
        for (int i = 0; i < 3; i++) mesh->position[v][i] = (float)place[i];
    }
    round_numbers(mesh->position[0], 3 * (size_t)mesh->vertex_count, HEAD_UNIT);
    mesh_compute_normals(mesh);
    return add_uv(mesh, error);
}
