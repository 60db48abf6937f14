// SPDX-License-Identifier: MIT
// Rotations of a mesh at its vertices, points bound to it, and fitted rigid motions.
#include "mesh/mesh_binding.h"
#include "support/shapes.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const RigidMotion MOTION = {
    {0.18257418583505536, 0.3651483716701107, 0.5477225575051661, 0.7302967433402214},
    {1, -0.5, 0.25}};

static void move_all(const Mesh *mesh, const RigidMotion *motion, float (*to)[3])
{
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        Double3 p, q;
        double3_from_float(mesh->position[v], p);
        rigid_motion_apply(motion, p, q);
        for (int k = 0; k < 3; ++k) to[v][k] = (float)q[k];
    }
}

// The angle between two rotations, rad.
static double angle_between(const double a[4], const double b[4])
{
    double dot = fabs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]);
    return 2 * acos(fmin(dot, 1));
}

static void a_rigid_motion_turns_every_ring(void **state)
{
    (void)state;
    Mesh mesh;
    MeshTurns turns;
    shapes_make_sphere(&mesh, 20, 30, 0.1f);
    float(*moved)[3] = calloc(mesh.vertex_count, sizeof *moved);
    assert_int_equal(mesh_turns_create(&turns, &mesh, NULL), RESULT_OK);
    move_all(&mesh, &MOTION, moved);
    for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
        double turn[4];
        mesh_turns_find(&turns, v, (const float(*)[3])moved, turn);
        // Positions at 1 m are rounded by 6e-8 m; the rings of neighbours are at least 1.5 mm wide
        // here (at the poles).
        assert_true(angle_between(turn, MOTION.rotation) < 6e-8 / 1.5e-3 * 2);
    }
    // A growing balloon does not rotate.
    for (uint32_t v = 0; v < mesh.vertex_count; ++v)
        for (int k = 0; k < 3; ++k) moved[v][k] = 3 * mesh.position[v][k];
    for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
        double turn[4];
        mesh_turns_find(&turns, v, (const float(*)[3])moved, turn);
        assert_true(angle_between(turn, (const double[]){0, 0, 0, 1}) < 1e-5);
    }
    // A collapsed mesh has no rotation, and the result is finite.
    memset(moved, 0, mesh.vertex_count * sizeof *moved);
    for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
        double turn[4];
        mesh_turns_find(&turns, v, (const float(*)[3])moved, turn);
        assert_true(turn[3] == 1);
    }
    free(moved);
    mesh_turns_destroy(&turns);
    mesh_destroy(&mesh);
}

// A cylinder about z whose rings are rotated in proportion to z, which shears its surface.
static double worst_turn(int rows, double shear)
{
    const double radius = 0.1, height = 0.4;
    int sectors = 2 * rows, v = 0, t = 0;
    Mesh mesh;
    MeshTurns turns;
    assert_int_equal(
        mesh_create(&mesh, (uint32_t)(sectors * (rows + 1)), (uint32_t)(2 * sectors * rows), NULL),
        RESULT_OK);
    float(*moved)[3] = calloc(mesh.vertex_count, sizeof *moved);
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i < sectors; ++i, ++v) {
            double angle = 2 * 3.14159265358979 * i / sectors, z = height * j / rows,
                   twisted = angle + shear * z / radius;
            mesh.position[v][0] = (float)(radius * cos(angle));
            mesh.position[v][1] = (float)(radius * sin(angle));
            mesh.position[v][2] = (float)z;
            moved[v][0] = (float)(radius * cos(twisted));
            moved[v][1] = (float)(radius * sin(twisted));
            moved[v][2] = (float)z;
        }
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < sectors; ++i) {
            uint32_t a = (uint32_t)(j * sectors + i),
                     b = (uint32_t)(j * sectors + (i + 1) % sectors), n = (uint32_t)sectors;
            memcpy(mesh.triangle[t++], (uint32_t[]){a, b, b + n}, 12);
            memcpy(mesh.triangle[t++], (uint32_t[]){a, b + n, a + n}, 12);
        }
    mesh_compute_normals(&mesh);
    assert_int_equal(mesh_turns_create(&turns, &mesh, NULL), RESULT_OK);
    double worst = 0;
    for (int j = 1; j < rows; ++j)
        for (int i = 0; i < sectors; ++i) {
            int at = j * sectors + i;
            // The expected rotation: about the axis, then about the new normal by half of the
            // shear's angle in the opposite direction.
            double z = height * j / rows, about = shear * z / radius,
                   angle = 2 * 3.14159265358979 * i / sectors + about,
                   half = -0.5 * atan(0.5 * shear);
            RigidMotion first = {{0, 0, sin(about / 2), cos(about / 2)}, {0}},
                        second = {{sin(half) * cos(angle), sin(half) * sin(angle), 0, cos(half)},
                                  {0}},
                        both = rigid_motion_product(&second, &first);
            double turn[4];
            mesh_turns_find(&turns, (uint32_t)at, (const float(*)[3])moved, turn);
            worst = fmax(worst, angle_between(turn, both.rotation));
        }
    free(moved);
    mesh_turns_destroy(&turns);
    mesh_destroy(&mesh);
    return worst;
}

static void a_twisted_cylinder_turns_by_half_its_shear(void **state)
{
    (void)state;
    double coarse = worst_turn(24, 0.3), fine = worst_turn(48, 0.3), finer = worst_turn(96, 0.3);
    // Halving the edges divides the error by 4; 3.5 allows for rounding.
    assert_true(coarse < 0.02);
    assert_true(fine < coarse / 3.5 && finer < fine / 3.5);
}

static void twins_and_other_triangulations_make_no_difference(void **state)
{
    (void)state;
    // A square of 2 x 2 cells, cut along either diagonal and sheared: the ring of the middle vertex
    // has different triangles.
    const float rest[9][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0},
                              {2, 1, 0}, {0, 2, 0}, {1, 2, 0}, {2, 2, 0}};
    double turn[2][4];
    for (int cut = 0; cut < 2; ++cut) {
        Mesh mesh;
        MeshTurns turns;
        float moved[10][3];
        assert_int_equal(mesh_create(&mesh, 10, 8, NULL), RESULT_OK);
        memcpy(mesh.position, rest, sizeof rest);
        memcpy(mesh.position[9], rest[4], sizeof rest[4]); // the middle vertex again, as at a seam
        for (uint32_t j = 0, t = 0; j < 2; ++j)
            for (uint32_t i = 0; i < 2; ++i, t += 2) {
                uint32_t a = 3 * j + i, b = a + 1, c = a + 4, d = a + 3;
                const uint32_t one[2][3] = {{a, b, c}, {a, c, d}},
                               other[2][3] = {{a, b, d}, {b, c, d}};
                memcpy(mesh.triangle[t], cut ? other : one, sizeof one);
                for (int k = 0; k < 6; ++k)
                    if (mesh.triangle[t + (uint32_t)k / 3][k % 3] == 4 && j)
                        mesh.triangle[t + (uint32_t)k / 3][k % 3] = 9;
            }
        mesh_compute_normals(&mesh);
        for (int v = 0; v < 10; ++v) {
            moved[v][0] = mesh.position[v][0] + 0.4f * mesh.position[v][1];
            moved[v][1] = mesh.position[v][1], moved[v][2] = 0;
        }
        assert_int_equal(mesh_turns_create(&turns, &mesh, NULL), RESULT_OK);
        mesh_turns_find(&turns, 4, (const float(*)[3])moved, turn[cut]);
        double twin[4];
        mesh_turns_find(&turns, 9, (const float(*)[3])moved, twin);
        assert_memory_equal(twin, turn[cut], sizeof twin);
        assert_true(fabs(2 * atan2(turn[cut][2], turn[cut][3]) + atan(0.2)) < 1e-6);
        mesh_turns_destroy(&turns);
        mesh_destroy(&mesh);
    }
    assert_true(angle_between(turn[0], turn[1]) < 1e-6);
}

static void a_bound_point_keeps_its_place(void **state)
{
    (void)state;
    Mesh mesh;
    MeshTurns turns;
    MeshBinding binding;
    shapes_make_sphere(&mesh, 12, 18, 0.1f);
    const float points[3][3] = {{0.03f, 0.1f, 0.02f}, {0, 0, -0.099f}, {-0.07f, -0.07f, 0}};
    float(*moved)[3] = calloc(mesh.vertex_count, sizeof *moved);
    double(*turn)[4] = calloc(mesh.vertex_count, sizeof *turn);
    assert_int_equal(mesh_binding_create(&binding, &mesh, "ball", points, 3, NULL), RESULT_OK);
    assert_int_equal(mesh_turns_create(&turns, &mesh, NULL), RESULT_OK);
    assert_true(binding.median < 0.006f);
    move_all(&mesh, &MOTION, moved);
    for (uint32_t v = 0; v < mesh.vertex_count; ++v)
        mesh_turns_find(&turns, v, (const float(*)[3])moved, turn[v]);
    for (uint32_t i = 0; i < 3; ++i) {
        RigidMotion motion =
            mesh_binding_motion(&binding, i, (const float(*)[3])moved, (const double(*)[4])turn);
        Double3 p, expected, place;
        double3_from_float(points[i], p);
        rigid_motion_apply(&MOTION, p, expected);
        rigid_motion_apply(&motion, p, place);
        assert_true(double3_distance(place, expected) < 1e-6);
        assert_true(angle_between(motion.rotation, MOTION.rotation) < 1e-4);
    }
    free(moved);
    free(turn);
    mesh_turns_destroy(&turns);
    mesh_binding_destroy(&binding);
    mesh_destroy(&mesh);
}

static void the_best_fit_finds_a_rigid_motion(void **state)
{
    (void)state;
    const RigidMotion still = {{0, 0, 0, 1}, {0}};
    double from[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {1, 1, 1}}, to[5][3];
    for (int i = 0; i < 5; ++i) rigid_motion_apply(&MOTION, from[i], to[i]);
    RigidMotion found =
        rigid_motion_fit((const double(*)[3])from, (const double(*)[3])to, 5, &still);
    assert_true(angle_between(found.rotation, MOTION.rotation) < 1e-7);
    assert_true(double3_distance(found.translation, MOTION.translation) < 1e-9);
    // Two points do not determine the rotation about their line: none is made.
    double line[2][3] = {{0, 0, 0}, {1, 0, 0}}, lifted[2][3] = {{0, 0, 1}, {1, 0, 1}};
    found = rigid_motion_fit((const double(*)[3])line, (const double(*)[3])lifted, 2, &still);
    assert_true(angle_between(found.rotation, still.rotation) < 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_rigid_motion_turns_every_ring),
        cmocka_unit_test(a_twisted_cylinder_turns_by_half_its_shear),
        cmocka_unit_test(twins_and_other_triangulations_make_no_difference),
        cmocka_unit_test(a_bound_point_keeps_its_place),
        cmocka_unit_test(the_best_fit_finds_a_rigid_motion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
