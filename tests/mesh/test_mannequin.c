// SPDX-License-Identifier: MIT
// The mannequin's head: its distance function and its mesh.
#include "mesh/head.h"
#include "mesh/stand_in.h"
#include "mesh/surface.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

enum { TRIANGLES = 6000 };

static Mesh make(void)
{
    Mesh mesh;
    assert_int_equal(head_make_mesh(&mesh, TRIANGLES, NULL), RESULT_OK);
    return mesh;
}

// An edge's two ends in the order of their numbers, and its direction.
static int compare_edges(const void *a, const void *b)
{
    const uint32_t *p = a, *q = b;
    for (int i = 0; i < 3; i++)
        if (p[i] != q[i]) return p[i] < q[i] ? -1 : 1;
    return 0;
}

// Each edge belongs to two triangles with opposite directions, and V - E + F = 2: one closed piece
// without a hole. The volume is positive, so that triangles face outwards.
static void the_mesh_is_closed_and_oriented(void **state)
{
    (void)state;
    Mesh mesh = make();
    uint32_t count = 3 * mesh.triangle_count, (*edge)[3] = malloc(count * sizeof *edge);
    double volume = 0.0;
    assert_non_null(edge);
    for (uint32_t c = 0; c < count; c++) {
        const uint32_t *corner = mesh.triangle[c / 3];
        uint32_t a = corner[c % 3], b = corner[(c % 3 + 1) % 3];
        edge[c][0] = a < b ? a : b, edge[c][1] = a < b ? b : a, edge[c][2] = a < b;
    }
    qsort(edge, count, sizeof *edge, compare_edges);
    for (uint32_t c = 0; c < count; c += 2) {
        assert_memory_equal(edge[c], edge[c + 1], 8);
        assert_true(edge[c][2] == 0 && edge[c + 1][2] == 1);
        assert_true(c + 2 == count || compare_edges(edge[c + 1], edge[c + 2]) < 0);
        assert_true(c + 2 == count || memcmp(edge[c], edge[c + 2], 8) != 0);
    }
    assert_int_equal((int)mesh.vertex_count - (int)count / 2 + (int)mesh.triangle_count, 2);
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        Double3 a, b, c, normal;
        double3_from_float(mesh.position[mesh.triangle[t][0]], a);
        double3_from_float(mesh.position[mesh.triangle[t][1]], b);
        double3_from_float(mesh.position[mesh.triangle[t][2]], c);
        double3_cross(b, c, normal);
        volume += double3_dot(a, normal) / 6.0;
    }
    // An adult's head and neck have about 4.5 litres, and the shoulders and chest about as much.
    assert_true(volume > 0.006 && volume < 0.012);
    free(edge);
    mesh_destroy(&mesh);
}

// Vertices are rounded to 1e-5 m per coordinate, so that they move by up to sqrt(3)/2 1e-5 m, and
// distances change by at most 1.2 times that.
static void vertices_lie_on_the_surface(void **state)
{
    (void)state;
    Mesh mesh = make();
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        Double3 at;
        double3_from_float(mesh.position[v], at);
        assert_true(fabs(head_distance(at)) < 1.2 * 0.87e-5 + 2e-6);
    }
    assert_true(mesh.triangle_count <= TRIANGLES && mesh.triangle_count > TRIANGLES - 3);
    mesh_destroy(&mesh);
}

// The distance function is exactly symmetric. The mesh's triangles are not, but the mirror images
// of vertices lie within the height of a facet: on curves with a radius of 15 mm, edges of 12 mm
// deviate by 1.2 mm, and most by far less.
static void left_and_right_are_alike(void **state)
{
    (void)state;
    Mesh mesh = make();
    Surface surface;
    SurfacePoint nearest = {0};
    double sum = 0.0;
    assert_int_equal(surface_create(&surface, &mesh, "head", NULL), RESULT_OK);
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        Double3 at, mirrored;
        double3_from_float(mesh.position[v], at);
        double3_copy(at, mirrored);
        mirrored[0] = -mirrored[0];
        assert_true(head_distance(at) == head_distance(mirrored));
        double off = fabs(surface_nearest(&surface, mirrored, &nearest));
        assert_true(off < 1.2e-3);
        sum += off;
    }
    assert_true(sum / mesh.vertex_count < 1e-4);
    surface_destroy(&surface);
    mesh_destroy(&mesh);
}

// The distance from a point to the surface in a direction.
static double reach(const Double3 from, const Double3 direction)
{
    Double3 at;
    for (double t = 0.3; t > 0.0; t -= 1e-4) {
        double3_copy(from, at);
        double3_add_scaled(at, t, direction);
        if (head_distance(at) < 0.0) return t;
    }
    return 0.0;
}

// Loomis: the head's width, height and depth, without ears and nose, are as 0.75 : 1 : 0.87, within
// a tenth. The nose reaches 15 to 30 mm farther than the lips, the ears stand out, and the neck is
// narrower.
static void the_head_is_well_proportioned(void **state)
{
    (void)state;
    const Double3 up = {0, 1, 0}, down = {0, -1, 0}, right = {1, 0, 0}, ahead = {0, 0, 1},
                  back = {0, 0, -1}, high = {0, 0.03, -0.02}, chin = {0, -0.08, 0.075},
                  brow = {0, 0.03, 0}, ear = {0, -0.02, -0.012}, neck = {0, -0.12, -0.03},
                  tip = {0, -0.041, 0}, lips = {0, -0.065, 0};
    double height = reach(brow, up) + 0.03 + 0.08 + reach(chin, down);
    double width = 2.0 * reach(high, right), depth = reach(brow, ahead) + reach(brow, back);
    assert_true(fabs(height - 0.23) < 0.005);
    assert_true(fabs(width / height / 0.75 - 1.0) < 0.1);
    assert_true(fabs(depth / height / 0.87 - 1.0) < 0.1);
    double nose = reach(tip, ahead) - reach(lips, ahead);
    assert_true(nose > 0.010 && nose < 0.030);
    assert_true(reach(ear, right) > 0.5 * width - 0.002);
    assert_true(reach(neck, right) < 0.85 * 0.5 * width);
}

// The numbers that the build wrote into the programs equal those of the head's formulas.
static void the_stand_in_is_the_head(void **state)
{
    (void)state;
    Mesh made, kept;
    assert_int_equal(head_make_mesh(&made, STAND_IN_TRIANGLES, NULL), RESULT_OK);
    assert_int_equal(stand_in_make_mesh(&kept, NULL), RESULT_OK);
    assert_int_equal(kept.vertex_count, made.vertex_count);
    assert_int_equal(kept.triangle_count, made.triangle_count);
    assert_memory_equal(kept.position, made.position, made.vertex_count * sizeof *made.position);
    assert_memory_equal(kept.normal, made.normal, made.vertex_count * sizeof *made.normal);
    assert_memory_equal(kept.triangle, made.triangle, made.triangle_count * sizeof *made.triangle);
    mesh_destroy(&made);
    mesh_destroy(&kept);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_mesh_is_closed_and_oriented),
        cmocka_unit_test(vertices_lie_on_the_surface),
        cmocka_unit_test(left_and_right_are_alike),
        cmocka_unit_test(the_head_is_well_proportioned),
        cmocka_unit_test(the_stand_in_is_the_head),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
