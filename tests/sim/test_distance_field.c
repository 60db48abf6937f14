// SPDX-License-Identifier: MIT
// Distance fields against exact distances.
#include "formats/mesh_read.h"
#include "mesh/scalp.h"
#include "support/hair_fixture.h"
#include "support/shapes.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef double Point[3];

static double dot(const Point a, const Point b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void minus(const Point a, const Point b, Point r)
{
    for (int k = 0; k < 3; ++k) r[k] = a[k] - b[k];
}

static double distance_to_segment(const Point p, const Point a, const Point b)
{
    Point e, r;
    minus(b, a, e);
    minus(p, a, r);
    double t = fmin(fmax(dot(r, e) / fmax(dot(e, e), 1e-300), 0), 1);
    for (int k = 0; k < 3; ++k) r[k] -= t * e[k];
    return sqrt(dot(r, r));
}

// Distance by barycentric coordinates in double precision.
static double distance_to_triangle(const Point p, const Point a, const Point b, const Point c)
{
    Point u, v, r;
    minus(b, a, u);
    minus(c, a, v);
    minus(p, a, r);
    double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), ru = dot(r, u), rv = dot(r, v);
    double determinant = uu * vv - uv * uv;
    double s = (vv * ru - uv * rv) / determinant, t = (uu * rv - uv * ru) / determinant;
    if (determinant > 0 && s >= 0 && t >= 0 && s + t <= 1) {
        for (int k = 0; k < 3; ++k) r[k] -= s * u[k] + t * v[k];
        return sqrt(dot(r, r));
    }
    return fmin(distance_to_segment(p, a, b),
                fmin(distance_to_segment(p, b, c), distance_to_segment(p, c, a)));
}

static void corner(const Mesh *mesh, uint32_t t, int i, Point r)
{
    for (int k = 0; k < 3; ++k) r[k] = (double)mesh->position[mesh->triangle[t][i]][k];
}

// The generalised winding number: the sum of solid angles, divided by 4 pi (van Oosterom and
// Strackee).
static double winding(const Mesh *mesh, const Point p)
{
    double sum = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        Point a, b, c;
        corner(mesh, t, 0, a), corner(mesh, t, 1, b), corner(mesh, t, 2, c);
        minus(a, p, a), minus(b, p, b), minus(c, p, c);
        double la = sqrt(dot(a, a)), lb = sqrt(dot(b, b)), lc = sqrt(dot(c, c));
        double volume = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                        a[2] * (b[0] * c[1] - b[1] * c[0]);
        sum += atan2(volume, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
    }
    return sum / (2 * 3.14159265358979323846);
}

static double mesh_distance(const Mesh *mesh, const Point p)
{
    double least = 1e30;
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        Point a, b, c;
        corner(mesh, t, 0, a), corner(mesh, t, 1, b), corner(mesh, t, 2, c);
        least = fmin(least, distance_to_triangle(p, a, b, c));
    }
    return least;
}

static float *read_values(const DistanceField *field)
{
    float *values = gpu_buffer_read(&field->values);
    assert_non_null(values);
    return values;
}

static DistanceField compute(const Mesh *mesh, uint32_t resolution, float **values)
{
    DistanceField field;
    Error error = {{0}};
    if (distance_field_create(&field, fixture_gpu(), mesh, resolution, &error) != RESULT_OK)
        fail_msg("%s", error.text);
    *values = read_values(&field);
    return field;
}

static void grid_point(const DistanceField *field, size_t i, Point p)
{
    const size_t at[3] = {i % field->size[0], i / field->size[0] % field->size[1],
                          i / field->size[0] / field->size[1]};
    for (int k = 0; k < 3; ++k)
        p[k] = (double)field->low[k] + (double)at[k] * (double)field->spacing;
}

// A box of 12 triangles that face outwards.
static void make_box(Mesh *mesh, const float half[3])
{
    static const uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    assert_int_equal(mesh_create(mesh, 8, 12, NULL), RESULT_OK);
    for (int i = 0; i < 8; ++i)
        for (int k = 0; k < 3; ++k) mesh->position[i][k] = i >> k & 1 ? half[k] : -half[k];
    for (int i = 0; i < 12; ++i)
        for (int k = 0; k < 3; ++k) mesh->triangle[i][k] = quads[i / 2][k == 0 ? 0 : k + i % 2];
}

// The largest error of every `stride`th sample, in spacings, and the number of samples with a wrong
// sign farther than 1e-4 spacings from the surface.
typedef struct Judgement {
    double error;
    size_t wrong;
} Judgement;

static Judgement judge(const DistanceField *field, const float *values, size_t stride,
                       double (*exact)(const void *shape, const Point p), const void *shape)
{
    Judgement judgement = {0};
    for (size_t i = 0; i < distance_field_count(field); i += stride) {
        Point p;
        grid_point(field, i, p);
        double expected = exact(shape, p), got = (double)values[i];
        double off = fabs(fabs(got) - fabs(expected)) / (double)field->spacing;
        judgement.error = fmax(judgement.error, off);
        judgement.wrong +=
            (got < 0) != (expected < 0) && fabs(expected) > 1e-4 * (double)field->spacing;
    }
    return judgement;
}

static double exact_box(const void *shape, const Point p)
{
    const float *half = shape;
    double inside = -1e30, outside = 0;
    for (int k = 0; k < 3; ++k) {
        double d = fabs(p[k]) - (double)half[k];
        inside = fmax(inside, d);
        outside += fmax(d, 0) * fmax(d, 0);
    }
    return inside < 0 ? inside : sqrt(outside);
}

static double exact_mesh(const void *shape, const Point p)
{
    double distance = mesh_distance(shape, p);
    return fabs(winding(shape, p)) >= 0.5 ? -distance : distance;
}

static double exact_sphere(const void *shape, const Point p)
{
    return sqrt(dot(p, p)) - (double)*(const float *)shape;
}

// The box's sides fall on no grid points; then the box is a cube of 16 spacings, whose sides fall
// exactly on grid points.
static void a_box_has_exact_distances_and_signs(void **state)
{
    (void)state;
    static const float halves[2][3] = {{0.11f, 0.07f, 0.05f}, {0.5f, 0.5f, 0.5f}};
    for (int i = 0; i < 2; ++i) {
        Mesh box;
        float *values;
        make_box(&box, halves[i]);
        DistanceField field = compute(&box, i ? 16 : 33, &values);
        Judgement judgement = judge(&field, values, 1, exact_box, halves[i]);
        assert_true(judgement.error < 1e-5); // rounding of coordinates up to 20 spacings
        assert_int_equal(judgement.wrong, 0);
        free(values);
        distance_field_destroy(&field);
        mesh_destroy(&box);
    }
}

// The 64 x 128 facets are within 0.1 (1 - cos(pi/65)) = 1.2e-4 m of the sphere.
static void a_sphere_has_its_distances(void **state)
{
    (void)state;
    Mesh sphere;
    float radius = 0.1f, *values;
    shapes_make_sphere(&sphere, 64, 128, radius);
    DistanceField field = compute(&sphere, 40, &values);
    Judgement judgement = judge(&field, values, 1, exact_sphere, &radius);
    assert_true(judgement.error < 1.2e-4 / 0.005 + 0.2);
    judgement = judge(&field, values, 97, exact_mesh, &sphere);
    assert_int_equal(judgement.wrong, 0);
    free(values);
    distance_field_destroy(&field);
    mesh_destroy(&sphere);
}

// Every grid point against every triangle, in spacings. Within the band of two spacings, distances
// are exact: measured 3.7e-6; coordinates of up to 40 spacings are rounded by 2.4e-6 each. Outside
// the band, they are distances to the nearest of many surface points that flooding finds: one pass
// less would increase the turned box's mean error 1.7 times. These errors depend on the passes and
// not on rounding, so that 1.3 times the measured value is allowed.
static void judge_all(const Mesh *mesh, uint32_t resolution, double most, double mean)
{
    float *values;
    DistanceField field = compute(mesh, resolution, &values);
    double near = 0, far = 0, sum = 0;
    size_t count = distance_field_count(&field), farther = 0;
    for (size_t i = 0; i < count; ++i) {
        Point p;
        grid_point(&field, i, p);
        double exact = mesh_distance(mesh, p) / (double)field.spacing;
        double off = fabs(fabs((double)values[i]) / (double)field.spacing - exact);
        if (exact < 2)
            near = fmax(near, off);
        else
            far = fmax(far, off), sum += off, ++farther;
    }
    print_message("%zu points: off by %.2g near, beyond by up to %.3g, on average %.3g\n", count,
                  near, far, sum / (double)farther);
    assert_true(near < 1.1e-5);
    assert_true(far < most && sum < mean * (double)farther);
    free(values);
    distance_field_destroy(&field);
}

static void every_point_has_its_distance(void **state)
{
    (void)state;
    Mesh sphere, head, box;
    shapes_make_sphere(&sphere, 8, 12, 0.1f);
    assert_int_equal(scalp_make_mesh(&head, SCALP_HEAD, 6, NULL), RESULT_OK);
    make_box(&box, (const float[3]){0.11f, 0.07f, 0.05f});
    for (int i = 0; i < 8; ++i) {
        float *at = box.position[i], x = at[0], y = at[1];
        at[0] = 0.8f * x - 0.6f * y, at[1] = 0.6f * x + 0.8f * y;
    }
    judge_all(&sphere, 24, 0.179 * 1.3, 3.39e-3 * 1.3);
    judge_all(&head, 20, 0.0636 * 1.3, 1.38e-3 * 1.3);
    judge_all(&box, 33, 0.0293 * 1.3, 7.36e-4 * 1.3);
    mesh_destroy(&sphere);
    mesh_destroy(&head);
    mesh_destroy(&box);
}

// Two triangles at the ends of a long, thin grid: flooding must come to its middle along every
// axis.
static void distances_reach_across_every_axis(void **state)
{
    (void)state;
    for (int axis = 0; axis < 3; ++axis) {
        Mesh mesh;
        assert_int_equal(mesh_create(&mesh, 6, 2, NULL), RESULT_OK);
        for (int v = 0; v < 6; ++v) {
            mesh.position[v][axis] = v < 3 ? 0 : 1;
            mesh.position[v][(axis + 1) % 3] = v % 3 == 1 ? 0.05f : 0;
            mesh.position[v][(axis + 2) % 3] = v % 3 == 2 ? 0.05f : 0;
            mesh.triangle[v / 3][v % 3] = (uint32_t)v;
        }
        judge_all(&mesh, 100, 2e-5, 1e-5); // coordinates of 107 spacings are rounded by 6.4e-6
        mesh_destroy(&mesh);
    }
}

static void read_head(Mesh *mesh)
{
    Error error = {{0}};
    if (mesh_read(mesh, "assets/head.obj", 1, false, &error) != RESULT_OK)
        fail_msg("%s", error.text);
}

// Beyond two spacings, distances are those to the nearest of many surface points: measured 0.0705;
// 1.3 times that is allowed. Compared with all triangles and the generalised winding number in
// double precision.
static void the_bundled_head_has_exact_distances(void **state)
{
    (void)state;
    Mesh head;
    float *values;
    read_head(&head);
    DistanceField field = compute(&head, 64, &values);
    Judgement judgement = judge(&field, values, 263, exact_mesh, &head);
    assert_true(judgement.error < 0.0705 * 1.3);
    assert_int_equal(judgement.wrong, 0);
    free(values);
    distance_field_destroy(&field);
    mesh_destroy(&head);
}

// Forty triangles at four places are missing: signs equal those of the complete head.
static void holes_do_not_change_the_signs(void **state)
{
    (void)state;
    Mesh head, open;
    float *whole, *holed;
    read_head(&head);
    read_head(&open);
    for (uint32_t hole = 0; hole < 4; ++hole) {
        uint32_t at = (hole + 1) * open.triangle_count / 5;
        memmove(open.triangle[at], open.triangle[at + 10],
                (open.triangle_count - at - 10) * sizeof *open.triangle);
        open.triangle_count -= 10;
    }
    DistanceField a = compute(&head, 48, &whole), b = compute(&open, 48, &holed);
    size_t different = 0;
    assert_int_equal(distance_field_count(&a), distance_field_count(&b));
    for (size_t i = 0; i < distance_field_count(&a); ++i)
        different += (whole[i] < 0) != (holed[i] < 0) && fabsf(whole[i]) > 0.5f * a.spacing;
    assert_int_equal(different, 0);
    free(whole);
    free(holed);
    distance_field_destroy(&a);
    distance_field_destroy(&b);
    mesh_destroy(&head);
    mesh_destroy(&open);
}

static void a_mesh_turned_inside_out_is_the_same(void **state)
{
    (void)state;
    const float half[3] = {0.11f, 0.07f, 0.05f};
    Mesh box;
    float *values;
    make_box(&box, half);
    for (uint32_t t = 0; t < box.triangle_count; ++t) {
        uint32_t corner_0 = box.triangle[t][0];
        box.triangle[t][0] = box.triangle[t][1];
        box.triangle[t][1] = corner_0;
    }
    DistanceField field = compute(&box, 20, &values);
    Judgement judgement = judge(&field, values, 1, exact_box, half);
    assert_int_equal(judgement.wrong, 0);
    free(values);
    distance_field_destroy(&field);
    mesh_destroy(&box);
}

// Closed surfaces have integer winding numbers everywhere: tests the head inside the skull, neck,
// nose and shoulder, under the chin, and outside.
static void the_head_is_closed(void **state)
{
    (void)state;
    static const Point points[] = {{0, 0, 0},           {0, -0.16, -0.03}, {0, -0.03, 0.085},
                                   {0.1, -0.25, -0.04}, {0, -0.14, 0.06},  {0.3, 0, 0}};
    Mesh head;
    assert_int_equal(scalp_make_mesh(&head, SCALP_HEAD, 24, NULL), RESULT_OK);
    for (size_t i = 0; i < sizeof points / sizeof *points; ++i)
        assert_true(fabs(winding(&head, points[i]) - (i < 4)) < 1e-6);
    mesh_destroy(&head);
}

// The second time, the field is read from disk with the same bits; a damaged file is ignored.
static void a_field_is_kept_on_disk(void **state)
{
    const float half[3] = {0.1f, 0.05f, 0.05f};
    Mesh box;
    float *values[3];
    make_box(&box, half);
    setenv("XDG_CACHE_HOME", temporary_path(state, "cache"), 1);
    for (int i = 0; i < 3; ++i) {
        DistanceField field;
        Error error = {{0}};
        bool read;
        char *name = distance_field_cache_name(&box, 24);
        if (i == 2) {
            FILE *file = fopen(name, "r+b");
            assert_non_null(file);
            fseek(file, -100, SEEK_END);
            fputc(1, file);
            fclose(file);
        }
        assert_int_equal(
            distance_field_create_cached(&field, fixture_gpu(), &box, 24, &read, &error),
            RESULT_OK);
        assert_int_equal(read, i == 1);
        values[i] = read_values(&field);
        assert_memory_equal(values[i], values[0], distance_field_count(&field) * sizeof(float));
        distance_field_destroy(&field);
        free(name);
    }
    char *other = distance_field_cache_name(&box, 25), *same = distance_field_cache_name(&box, 24);
    assert_string_not_equal(other, same);
    free(other);
    free(same);
    for (int i = 0; i < 3; ++i) free(values[i]);
    mesh_destroy(&box);
}

// A thousand large triangles in one place, each many times, would take minutes at the usual
// resolution.
static void many_triangles_in_one_place_take_little_time(void **state)
{
    enum { CORNERS = 60, TRIANGLES = 3000 };
    Mesh box, head, heap, once;
    float *values, *wanted;
    uint32_t seed = 1;
    (void)state;
    make_box(&box, (const float[3]){0.1f, 0.1f, 0.1f});
    read_head(&head);
    for (uint32_t resolution = 64; resolution <= FIELD_MOST; resolution *= 8) {
        assert_int_equal(distance_field_affordable(&box, resolution), resolution);
        assert_int_equal(distance_field_affordable(&head, resolution), resolution);
    }
    assert_int_equal(mesh_create(&heap, CORNERS, TRIANGLES, NULL), RESULT_OK);
    for (int i = 0; i < CORNERS * 3; ++i)
        heap.position[i / 3][i % 3] = (float)((seed = seed * 1664525 + 1013904223) >> 8) * 0x1p-24f;
    for (int i = 0; i < TRIANGLES; ++i)
        for (uint32_t k = 0; k < 3; ++k)
            heap.triangle[i][k] = 20 * k + ((seed = seed * 1664525 + 1013904223) >> 8) % 20;
    assert_in_range(distance_field_affordable(&heap, 64), 2, 20);
    // Triangles that occur again change nothing.
    assert_int_equal(mesh_create(&once, 8, 24, NULL), RESULT_OK);
    memcpy(once.position, box.position, 8 * sizeof *box.position);
    for (int i = 0; i < 24; ++i)
        for (int k = 0; k < 3; ++k) once.triangle[i][k] = box.triangle[i / 2][(k + i) % 3];
    DistanceField field = compute(&once, 16, &values), same = compute(&box, 16, &wanted);
    assert_memory_equal(values, wanted, distance_field_count(&field) * sizeof *values);
    distance_field_destroy(&field);
    distance_field_destroy(&same);
    free(values);
    free(wanted);
    mesh_destroy(&once);
    mesh_destroy(&heap);
    mesh_destroy(&head);
    mesh_destroy(&box);
}

// If a driver's storage blocks are small, the work is done in parts, and the field is equal to the
// bit. The limit here is the grid's largest buffer; the work in one piece would take several times
// as much.
static void any_mesh_fits_into_the_limits_of_the_driver(void **state)
{
    (void)state;
    Mesh sphere;
    float *values, *other;
    shapes_make_sphere(&sphere, 100, 200, 0.1f);
    DistanceField field = compute(&sphere, 8, &values), parts;
    Gpu small = *fixture_gpu();
    small.limits.storage_block = (int64_t)distance_field_count(&field) * 16;
    assert_true(small.limits.storage_block < (int64_t)sphere.triangle_count * 16 / 4);
    Error error = {{0}};
    if (distance_field_create(&parts, &small, &sphere, 8, &error) != RESULT_OK)
        fail_msg("%s", error.text);
    other = read_values(&parts);
    assert_memory_equal(other, values, distance_field_count(&field) * sizeof(float));
    free(values);
    free(other);
    distance_field_destroy(&field);
    distance_field_destroy(&parts);
    mesh_destroy(&sphere);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_has_exact_distances_and_signs),
        cmocka_unit_test(a_sphere_has_its_distances),
        cmocka_unit_test(every_point_has_its_distance),
        cmocka_unit_test(distances_reach_across_every_axis),
        cmocka_unit_test(the_bundled_head_has_exact_distances),
        cmocka_unit_test(holes_do_not_change_the_signs),
        cmocka_unit_test(a_mesh_turned_inside_out_is_the_same),
        cmocka_unit_test(the_head_is_closed),
        cmocka_unit_test(many_triangles_in_one_place_take_little_time),
        cmocka_unit_test(any_mesh_fits_into_the_limits_of_the_driver),
        cmocka_unit_test_setup_teardown(a_field_is_kept_on_disk, temporary_create,
                                        temporary_destroy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
