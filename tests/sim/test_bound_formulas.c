// SPDX-License-Identifier: MIT
// Hair bound to meshes whose motion has a formula: the roots' positions and rotations.
#include "support/body_fixture.h"
#include "support/shapes.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double PI = 3.14159265358979;
static const double RADIUS = 0.1;

enum { STRANDS = 24, VERTICES = 6 };

// Straight strands along the surface's normals; `root` places each (m).
static void make_strands(Strands *strands, void (*root)(uint32_t s, Double3 place, Double3 normal))
{
    strands_destroy(strands);
    assert_int_equal(strands_create(strands, STRANDS, STRANDS * VERTICES, NULL), RESULT_OK);
    for (uint32_t s = 0; s <= STRANDS; ++s) strands->first[s] = s * VERTICES;
    for (uint32_t s = 0; s < STRANDS; ++s) {
        Double3 place, normal;
        root(s, place, normal);
        for (uint32_t j = 0; j < VERTICES; ++j)
            for (int k = 0; k < 3; ++k)
                strands->position[s * VERTICES + j][k] = (float)(place[k] + 0.02 * j * normal[k]);
    }
}

// --- A cylinder about y that twists: the ring at height y turns by shear * y / RADIUS.

static const double HEIGHT = 0.4, SPEED = 0.5, TWIST_TIME = 0.3;

static void twist(double time, const double rest[3], double place[3])
{
    double turn = SPEED * time * rest[1] / RADIUS, c = cos(turn), s = sin(turn);
    place[0] = c * rest[0] + s * rest[2];
    place[1] = rest[1];
    place[2] = c * rest[2] - s * rest[0];
}

static void cylinder_root(uint32_t s, Double3 place, Double3 normal)
{
    double angle = 2.399963 * s;
    normal[0] = cos(angle), normal[1] = 0, normal[2] = -sin(angle);
    for (int k = 0; k < 3; ++k) place[k] = RADIUS * normal[k];
    place[1] = HEIGHT * (0.2 + 0.6 * s / STRANDS); // rings at the ends have neighbours on one side
}

static void make_cylinder(Mesh *mesh, uint32_t rows)
{
    uint32_t sectors = 2 * rows, t = 0;
    assert_int_equal(mesh_create(mesh, sectors * (rows + 1), 2 * sectors * rows, NULL), RESULT_OK);
    for (uint32_t j = 0; j <= rows; ++j)
        for (uint32_t i = 0; i < sectors; ++i) {
            double angle = 2 * PI * i / sectors;
            float *p = mesh->position[j * sectors + i];
            p[0] = (float)(RADIUS * cos(angle)), p[2] = (float)(-RADIUS * sin(angle));
            p[1] = (float)(HEIGHT * j / rows);
        }
    for (uint32_t j = 0; j < rows; ++j)
        for (uint32_t i = 0; i < sectors; ++i) {
            uint32_t a = j * sectors + i, b = j * sectors + (i + 1) % sectors;
            memcpy(mesh->triangle[t++], (uint32_t[]){a, b, b + sectors}, 12);
            memcpy(mesh->triangle[t++], (uint32_t[]){a, b + sectors, a + sectors}, 12);
        }
    mesh_compute_normals(mesh);
}

// Bends strands at their first vertex so that they go on along the axis: a strand along the normal
// would not show a rotation about it.
static void bend_upwards(Strands *strands)
{
    for (uint32_t v = 0; v < strands->vertex_count; ++v) {
        if (v % VERTICES < 2) continue;
        memcpy(strands->position[v], strands->position[v - 1], sizeof strands->position[v]);
        strands->position[v][1] += 0.02f;
    }
}

// The largest errors of roots (m) and of strands against their roots (m, over 0.1 m).
static void twist_errors(uint32_t rows, double worst[2])
{
    BodyFixture fixture = {0};
    size_t count;
    simulation_fixture_create(&fixture.base, "none", "");
    make_strands(&fixture.base.strands, cylinder_root);
    bend_upwards(&fixture.base.strands);
    make_cylinder(&fixture.mesh, rows);
    body_fixture_bind(&fixture, twist, 60, 0, 40);
    simulation_fixture_start(&fixture.base);
    const Strands *rest = &fixture.base.strands;
    simulation_fixture_go(&fixture.base, (int)(60 * TWIST_TIME + 0.5));
    float(*now)[3] = body_fixture_positions(&fixture, false, &count);
    assert_int_equal(count, rest->vertex_count);
    worst[0] = worst[1] = 0;
    for (uint32_t s = 0; s < STRANDS; ++s) {
        Double3 root, place, normal;
        cylinder_root(s, root, normal);
        twist(TWIST_TIME, root, place);
        double turn = atan(0.5 * SPEED * TWIST_TIME);
        for (uint32_t j = 0; j < VERTICES; ++j) {
            Double3 from, off, turned;
            double3_from_float(rest->position[s * VERTICES + j], from);
            double3_subtract(from, root, off);
            // About the axis to the place on the twisted ring, then about the normal there.
            double along = off[1], out = double3_dot(off, normal);
            Double3 side = {place[2] / RADIUS, 0, -place[0] / RADIUS};
            for (int k = 0; k < 3; ++k)
                turned[k] = (k == 1 ? 0 : out * place[k] / RADIUS) +
                            along * ((k == 1) * cos(turn) + sin(turn) * side[k]);
            for (int k = 0; k < 3; ++k) {
                double error = fabs((double)now[s * VERTICES + j][k] - place[k] - turned[k]);
                worst[j > 0] = fmax(worst[j > 0], error);
            }
        }
    }
    free(now);
    body_fixture_destroy(&fixture);
}

static void strands_on_a_twisted_cylinder_follow_its_formula(void **state)
{
    (void)state;
    double coarse[2], fine[2];
    twist_errors(24, coarse);
    twist_errors(48, fine);
    // Roots are at most the ring's sagitta, (13 mm)^2 / (8 RADIUS), from the chords that they are
    // bound to, and strands turn by an error of the same order over the cylinder's radius.
    assert_true(coarse[0] < 2.1e-4 && coarse[1] < 2.1e-4);
    // Halving the edges divides the errors by 4; 3.5 allows for the roots' other places in the
    // triangles.
    assert_true(fine[0] < coarse[0] / 3.5 && fine[1] < coarse[1] / 3.5);
}

// --- A balloon, with roots in the middle of triangles. It does not turn anywhere.

static Mesh balloon;

static void balloon_root(uint32_t s, Double3 place, Double3 normal)
{
    const uint32_t *corner = balloon.triangle[s * (balloon.triangle_count / STRANDS)];
    memset(place, 0, sizeof(Double3));
    for (int c = 0; c < 3; ++c)
        for (int k = 0; k < 3; ++k) place[k] += (double)balloon.position[corner[c]][k] / 3;
    for (int k = 0; k < 3; ++k) normal[k] = place[k] / double3_length(place);
}

static void swell(double factor, const double rest[3], double place[3])
{
    for (int k = 0; k < 3; ++k) place[k] = factor * rest[k];
}

static void breathe(double time, const double rest[3], double place[3])
{
    swell(1 + 0.2 * sin(4 * time), rest, place);
}

static void inflate(double time, const double rest[3], double place[3])
{
    swell(1 + 0.5 * time, rest, place);
}

static void create_balloon(BodyFixture *fixture, const char *algo, BodyMotion *motion, double start)
{
    *fixture = (BodyFixture){0};
    simulation_fixture_create(&fixture->base, algo, "");
    shapes_make_sphere(&fixture->mesh, 12, 18, (float)RADIUS);
    balloon = fixture->mesh;
    make_strands(&fixture->base.strands, balloon_root);
    body_fixture_bind(fixture, motion, 24, start, 30);
}

// Each strand must be where its root's motion alone takes it.
static void check_moved(BodyFixture *fixture, BodyMotion *motion, double time, double allowed)
{
    size_t count;
    float(*now)[3] = body_fixture_positions(fixture, false, &count);
    for (uint32_t v = 0; v < count; ++v) {
        Double3 rest, root, moved;
        double3_from_float(fixture->base.strands.position[v], rest);
        double3_from_float(fixture->base.strands.position[v - v % VERTICES], root);
        motion(time, root, moved);
        for (int k = 0; k < 3; ++k) {
            double off = fabs((double)now[v][k] - rest[k] - (moved[k] - root[k]));
            if (!(off < allowed))
                fail_msg("%g s: vertex %u is off by %g m", time, v % VERTICES, off);
        }
    }
    free(now);
}

static void a_breathing_balloon_moves_roots_and_turns_nothing(void **state)
{
    (void)state;
    BodyFixture fixture;
    create_balloon(&fixture, "none", breathe, -0.25);
    simulation_fixture_start(&fixture.base);
    // Slopes of the splines, differences over 2 h = 1/12 s, err by h^2 f"'/6 with
    // f"' = 0.02 * 64 m/s^3. Between two samples that gives h 0.0962 times as much, 1.5e-6 m.
    // Rotations of rings 1 cm wide err by 1e-8/1e-2, over strands of 0.1 m: 1e-7 m.
    for (int frame = 1; frame <= 40; frame += 3) {
        simulation_fixture_go(&fixture.base, frame);
        check_moved(&fixture, breathe, frame / 60.0, 2e-6);
    }
    body_fixture_destroy(&fixture);
}

// At constant speed and without forces, strands are at rest as seen from their roots.
static void hair_on_a_balloon_of_even_speed_is_at_rest(void **state)
{
    (void)state;
    static const char *const algos[] = {"split", "chain"};
    for (int i = 0; i < 2; ++i) {
        BodyFixture fixture;
        create_balloon(&fixture, algos[i], inflate, -0.25);
        RunParams *run = &fixture.base.scene.run;
        memset(run->gravity, 0, sizeof run->gravity);
        memset(run->wind, 0, sizeof run->wind);
        fixture.base.scene.sections[0].params.drag = 0;
        simulation_fixture_start(&fixture.base);
        simulation_fixture_go(&fixture.base, 30);
        // The start's velocity is a difference over 2 ms of (4, 4, 1, 1) positions, each rounded by
        // 3.7e-9 m: 1.9e-5 m/s at most, in 0.5 s.
        check_moved(&fixture, inflate, 0.5, 1e-5);
        body_fixture_destroy(&fixture);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strands_on_a_twisted_cylinder_follow_its_formula),
        cmocka_unit_test(a_breathing_balloon_moves_roots_and_turns_nothing),
        cmocka_unit_test(hair_on_a_balloon_of_even_speed_is_at_rest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
