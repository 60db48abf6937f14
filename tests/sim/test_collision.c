// SPDX-License-Identifier: MIT
// Colliders: where they push a particle, and the text that describes them. Whole strands are tested
// in test_solvers_collision.c.
#include "sim/collision.h"
#include "support/twin.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// Positions of up to 0.5 m are rounded by 3e-8 m each, and a distance by a few of these.
static const double ROUNDING = 2e-7;

static const double MARGIN = 0.001; // the default of collision_margin

// --- One particle on one link: the exact position after a push.

enum { PAIR = 2 };

// A link without forces goes from the origin to `tip`, at rest. `pushed`: the tip's position after
// a step among the colliders of `text`.
static void push_pair(const Vec tip, const char *text, const char *algo, Vec pushed)
{
    Vec start[PAIR] = {{0, 0, 0}}, q[PAIR];
    HairFixture fixture;
    vec_copy(tip, start[1]);
    fixture_create(&fixture, (const Vec *)start, 1, PAIR, algo, "", 0, 0);
    fixture.step.gravity[1] = 0;
    fixture_collide(&fixture, text);
    fixture_step(&fixture);
    twin_read_strand(&fixture, 0, q);
    vec_copy(q[1], pushed);
    fixture_destroy(&fixture);
}

static void assert_at(const Vec got, double x, double y, double z)
{
    const Vec expected = {x, y, z};
    Vec off;
    vec_add_scaled(got, -1, expected, off);
    if (!(vec_norm(off) < ROUNDING)) fail_msg("got %g %g %g", got[0], got[1], got[2]);
}

// The link turns in the plane of the link and the sphere's centre, until the tip lies on two
// spheres: of radius 0.1 around the root, and of radius 0.05 around (0.1, -0.03, 0).
static void a_sphere_pushes_to_its_surface(void **state)
{
    (void)state;
    const double R = 0.05 + MARGIN, l = 0.1, cx = 0.1, cy = -0.03, cc = cx * cx + cy * cy;
    const double along = (cc + l * l - R * R) / (2 * cc), across = sqrt(l * l / cc - along * along);
    static const char *const algos[] = {"dftl", "chain", "split"};
    for (size_t i = 0; i < sizeof algos / sizeof *algos; ++i) {
        Vec pushed;
        push_pair((const Vec){l, 0, 0}, "sphere:0.1,-0.03,0,0.05", algos[i], pushed);
        assert_at(pushed, along * cx - across * cy, along * cy + across * cx, 0);
    }
}

static void planes_push_to_their_height(void **state)
{
    (void)state;
    const double up = 0.02 + MARGIN, side = sqrt(0.01 - up * up);
    Vec pushed;
    push_pair((const Vec){0.06, -0.08, 0}, "ground:0.02", "dftl", pushed);
    assert_at(pushed, side, up, 0);
    push_pair((const Vec){0, 0.08, -0.06}, "plane:0,-3,0,0.02", "dftl", pushed);
    assert_at(pushed, 0, -up, -side);
}

// Distance from the rounded cone between (0.1, -0.1, 0) with radius 0.02 and (0.1, 0.1, 0) with
// radius 0.06, as the minimum over spheres between the two.
static double cone_distance(const Vec p)
{
    double least = 1;
    for (int i = 0; i <= 20000; ++i) {
        double u = i / 20000.0;
        const Vec from = {p[0] - 0.1, p[1] + 0.1 - 0.2 * u, p[2]};
        least = fmin(least, vec_norm(from) - 0.02 - 0.04 * u);
    }
    return least;
}

// Near the side and both ends: the tip moves onto the surface, no farther than necessary, in the
// plane of the link and the axis. The minimum over 20,000 spheres errs by 0.2/20000/2 times the
// slope at most.
static void a_capsule_of_two_radii_pushes_to_its_surface(void **state)
{
    (void)state;
    static const Vec tips[] = {
        {0.07, 0, 0.005}, {0.07, 0.03, 0}, {0.08, -0.105, 0.002}, {0.07, 0.14, 0}};
    for (size_t i = 0; i < sizeof tips / sizeof *tips; ++i) {
        Vec pushed;
        double inside = cone_distance(tips[i]);
        push_pair(tips[i], "capsule:0.1,-0.1,0,0.02, 0.1,0.1,0,0.06", "dftl", pushed);
        double length = vec_norm(pushed) - vec_norm(tips[i]);
        assert_true(inside < MARGIN);
        assert_true(fabs(length) < ROUNDING);
        assert_true(fabs(cone_distance(pushed) - MARGIN) < 2e-6);
    }
}

static void a_capsule_inside_its_larger_end_is_a_sphere(void **state)
{
    (void)state;
    Vec a, b;
    push_pair((const Vec){0.1, 0, 0}, "sphere:0.1,-0.03,0,0.05", "dftl", a);
    push_pair((const Vec){0.1, 0, 0}, "capsule:0.1,-0.03,0,0.05, 0.1,-0.02,0,0.01", "dftl", b);
    assert_memory_equal(a, b, sizeof a);
}

// The root rises by 5 cm, and the sphere under the tip rises with it or stays.
static void a_world_collider_stays_where_it_is(void **state)
{
    (void)state;
    Vec start[PAIR] = {{0, 0, 0}, {0.1, 0, 0}};
    static const char *const texts[] = {"world:sphere:0.1,-0.08,0,0.05", "sphere:0.1,-0.08,0,0.05"};
    for (int head = 0; head < 2; ++head) {
        HairFixture fixture;
        fixture_create(&fixture, (const Vec *)start, 1, PAIR, "dftl", "", 0, 0);
        fixture_collide(&fixture, texts[head]);
        fixture.step.gravity[1] = 0;
        fixture.step.head.translation[1] = 0.05f;
        fixture_step(&fixture);
        SolverReport report = {0};
        solver_report(&fixture.solver, &report);
        assert_int_equal(report.contacts, head);
        fixture_destroy(&fixture);
    }
}

// --- Meshes.

// A cube of 20 cm at `middle`, rotated by this quaternion.
static void make_cube(Mesh *mesh, const float middle[3], const versor turn)
{
    static const uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    assert_int_equal(mesh_create(mesh, 8, 12, NULL), RESULT_OK);
    for (int i = 0; i < 8; ++i) {
        float *at = mesh->position[i];
        for (int k = 0; k < 3; ++k) at[k] = i >> k & 1 ? 0.1f : -0.1f;
        glm_quat_rotatev((float *)turn, at, at);
        glm_vec3_add(at, (float *)middle, at);
    }
    for (int i = 0; i < 12; ++i)
        for (int k = 0; k < 3; ++k) mesh->triangle[i][k] = quads[i / 2][k == 0 ? 0 : k + i % 2];
}

// A strand from the origin whose middle particle is inside the collider of `text` or the field, and
// whose tip is outside. `pushed`: where the middle particle is pushed to.
static void push_elbow(const Vec middle, const vec3 normal, const char *text,
                       const DistanceField *field, Vec pushed)
{
    enum { ELBOW = 3 };
    Vec start[ELBOW] = {{0}}, q[ELBOW];
    HairFixture fixture;
    vec_copy(middle, start[1]);
    for (int k = 0; k < 3; ++k) start[2][k] = middle[k] + 0.05 * (double)normal[k];
    fixture_create(&fixture, (const Vec *)start, 1, ELBOW, "dftl", "", 0, 0);
    fixture.step.gravity[1] = 0;
    fixture.field = field;
    fixture_collide(&fixture, text);
    fixture_step(&fixture);
    twin_read_strand(&fixture, 0, q);
    vec_copy(q[1], pushed);
    fixture_destroy(&fixture);
}

// Near the middle of each side of a cube, rotated about no axis of the grid, the field equals the
// plane of that side, and pushes a particle to the same position as the plane does. The roots are
// 30 cm away, outside the grid but near enough for the strand to reach it. Measured, with the
// field's samples and positions among them: 9.1e-7 m; three times that is allowed.
static void a_mesh_pushes_as_the_planes_of_its_sides_do(void **state)
{
    (void)state;
    versor turn = {0.2f, -0.3f, 0.1f, 0.927362f};
    double worst = 0;
    glm_quat_normalize(turn);
    for (int side = 0; side < 6; ++side) {
        vec3 normal = {0}, along = {0}, centre;
        Vec middle, pushed, expected, moved, off;
        char text[200];
        Mesh cube;
        DistanceField field;
        normal[side / 2] = side % 2 ? 1 : -1, along[(side / 2 + 1) % 3] = 1;
        glm_quat_rotatev(turn, normal, normal);
        glm_quat_rotatev(turn, along, along);
        glm_vec3_scale(normal, -0.4f, centre); // the side is 30 cm from the root
        make_cube(&cube, centre, turn);
        for (int k = 0; k < 3; ++k) middle[k] = (double)(-0.304f * normal[k] + 0.02f * along[k]);
        snprintf(text, sizeof text, "plane:%.9g,%.9g,%.9g,-0.3", (double)normal[0],
                 (double)normal[1], (double)normal[2]);
        push_elbow(middle, normal, text, NULL, expected);
        assert_int_equal(distance_field_create(&field, fixture_gpu(), &cube, 20, NULL), RESULT_OK);
        push_elbow(middle, normal, "", &field, pushed);
        vec_add_scaled(pushed, -1, middle, moved);
        vec_add_scaled(pushed, -1, expected, off);
        assert_true(vec_norm(moved) > 0.004);
        worst = fmax(worst, vec_norm(off));
        distance_field_destroy(&field);
        mesh_destroy(&cube);
    }
    print_message("a mesh pushes to within %.2g m\n", worst);
    assert_true(worst < 3 * 9.1e-7);
}

// --- Roots inside a collider.

enum { BURIED = 9 };
static const double BURIED_LINK = 0.01, DEPTH = 0.035; // of the root below the margin, m

// A strand along x from a root below the ground, which rises by `rise` per metre.
static void lay_buried(HairFixture *fixture, const char *algo, double rise)
{
    Vec start[BURIED] = {{0, MARGIN - DEPTH, 0}};
    for (int j = 1; j < BURIED; ++j) {
        start[j][0] = start[j - 1][0] + BURIED_LINK * sqrt(1 - rise * rise);
        start[j][1] = start[j - 1][1] + BURIED_LINK * rise, start[j][2] = 0;
    }
    fixture_create(fixture, (const Vec *)start, 1, BURIED, algo, "", 0, 0);
    fixture->step.gravity[1] = 0;
    fixture_collide(fixture, "ground:0");
}

// A root's depth is allowed to end after twice that length along the strand: a level strand is
// pushed exactly to that limit.
static void a_strand_leaves_half_as_far_as_it_goes(void **state)
{
    (void)state;
    static const char *const algos[] = {"dftl", "chain", "split"};
    for (size_t i = 0; i < sizeof algos / sizeof *algos; ++i) {
        Vec q[BURIED];
        HairFixture fixture;
        lay_buried(&fixture, algos[i], 0);
        fixture_step(&fixture);
        twin_read_strand(&fixture, 0, q);
        for (int j = 1; j < BURIED; ++j) {
            double need = MARGIN - fmax(DEPTH - 0.5 * j * BURIED_LINK, 0);
            if (!(fabs(q[j][1] - need) < ROUNDING))
                fail_msg("%s: particle %d at %g, not %g", algos[i], j, q[j][1], need);
        }
        fixture_destroy(&fixture);
    }
}

// A strand that rises by slightly more than half its length has no contact; one that rises slightly
// less has.
static void a_strand_that_leaves_faster_is_not_pushed(void **state)
{
    (void)state;
    for (int touches = 0; touches < 2; ++touches) {
        SolverReport report = {0};
        HairFixture fixture;
        lay_buried(&fixture, "dftl", touches ? 0.499 : 0.501);
        fixture_step(&fixture);
        solver_report(&fixture.solver, &report);
        // all particles for which 0.5 s is below DEPTH
        assert_int_equal(report.contacts, touches ? 7 : 0);
        fixture_destroy(&fixture);
    }
}

// --- Reach: no collider that hair can touch is skipped.

// A tip at either end of a capsule 3 m long, whose middle is 1.5 m away.
static void hair_at_the_ends_of_a_long_capsule_is_pushed(void **state)
{
    (void)state;
    static const char *const texts[] = {"capsule:0.1,-0.03,0,0.05, 0.1,-0.03,-3,0.05",
                                        "capsule:0.1,-0.03,3,0.05, 0.1,-0.03,0,0.05"};
    for (int i = 0; i < 2; ++i) {
        Vec pushed, expected;
        push_pair((const Vec){0.1, 0, 0}, "sphere:0.1,-0.03,0,0.05", "dftl", expected);
        push_pair((const Vec){0.1, 0, 0}, texts[i], "dftl", pushed);
        assert_at(pushed, expected[0], expected[1], expected[2]);
    }
}

// A particle 5 mm off upright falls about its root for 0.7 s onto a ball below the root. It reaches
// only the uppermost 4 mm of the ball.
static void upright_hair_falls_onto_what_is_below(void **state)
{
    (void)state;
    const double link = 0.1, ball = 0.03;
    const Vec start[PAIR] = {{0, 0, 0}, {0.005, sqrt(link * link - 0.005 * 0.005), 0}};
    HairFixture fixture;
    double lowest = 1;
    fixture_create(&fixture, start, 1, PAIR, "chain", "", 0, 0);
    fixture_collide(&fixture, "sphere:0,-0.126,0,0.03");
    for (int i = 0; i < 120; ++i) {
        Vec q[PAIR];
        fixture_step(&fixture);
        twin_read_strand(&fixture, 0, q);
        lowest = fmin(lowest, q[1][1]);
        double inside = ball + MARGIN - hypot(q[1][0], q[1][1] + 0.126);
        if (!(inside < ROUNDING * fixture_rounding())) fail_msg("%g m inside", inside);
    }
    assert_true(lowest < -0.9 * link); // it reached the ball
    fixture_destroy(&fixture);
}

// --- The list of colliders.

static void assert_refused(const char *text, const char *part)
{
    Colliders colliders = {0};
    Error error = {{0}};
    assert_int_equal(colliders_parse(&colliders, text, &error), RESULT_USAGE);
    if (!strstr(error.text, part)) fail_msg("'%s' lacks '%s'", error.text, part);
    colliders_destroy(&colliders);
}

static void a_text_lists_shapes(void **state)
{
    (void)state;
    Colliders colliders = {0};
    const char *text =
        " sphere:1,2,3,4; world:capsule:0,0,0,1,0,2,0,.5;ground:-1.5 ; plane:0,0,2,1;";
    assert_int_equal(colliders_parse(&colliders, text, &(Error){{0}}), RESULT_OK);
    assert_int_equal(colliders.count, 4);
    assert_true(colliders.list[0].kind == COLLIDER_SPHERE && !colliders.list[0].world);
    assert_true(colliders.list[1].kind == COLLIDER_CAPSULE && colliders.list[1].world);
    assert_true(colliders.list[1].numbers[7] == 0.5f);
    assert_true(colliders.list[2].world && colliders.list[2].numbers[0] == -1.5f);
    assert_true(colliders.list[3].numbers[2] == 1);
    colliders_destroy(&colliders);
    assert_refused("sphere:1,2,3", "sphere:x,y,z,radius");
    assert_refused("sphere:1,2,3,-1", "radius");
    assert_refused("sphere:1,2,3,1,", "expected sphere:x,y,z,radius");
    assert_refused("ground:1 2", "got 'ground:1 2', expected ground:");
    assert_refused("sphere:1,2,3,1e9", "from -1000000 to 1000000");
    assert_refused("ball:1,2,3,4", "one of sphere:x,y,z,radius; capsule:");
    assert_refused("plane:0,0,0,1", "direction");
    assert_refused("ground:0; ; ground:1", "expected");
    assert_refused("ground:nan", "height");
}

static void the_uniform_block_lies_as_c_has_it(void **state)
{
    (void)state;
    Vec start[PAIR] = {{0, 0, 0}, {0.1, 0, 0}};
    HairFixture fixture;
    Collision collision;
    fixture_create(&fixture, (const Vec *)start, 1, PAIR, "none", "", 0, 0);
    fixture_collide(&fixture, "ground:0; sphere:0,0,0,1");
    const SolverSetup setup = {.gpu = fixture_gpu(),
                               .hair = &fixture.hair,
                               .params = &fixture.params,
                               .colliders = &fixture.colliders};
    assert_int_equal(collision_create(&collision, &setup, COLLISION_SEGMENTS, NULL, &(Error){{0}}),
                     RESULT_OK);
#define ASSERT_OFFSET(member)                                                                      \
    fixture_assert_offset(collision.pass.program, "CollideParams." #member,                        \
                          offsetof(CollideParams, member))
    ASSERT_OFFSET(head_rotation);
    ASSERT_OFFSET(head_translation_old);
    ASSERT_OFFSET(head_turn_back);
    ASSERT_OFFSET(field_low);
    ASSERT_OFFSET(field_size);
    ASSERT_OFFSET(dt);
    ASSERT_OFFSET(margin);
    ASSERT_OFFSET(stamp);
    ASSERT_OFFSET(part), ASSERT_OFFSET(strand_count);
    ASSERT_OFFSET(carried);
    ASSERT_OFFSET(shapes[0]);
    collision_destroy(&collision);
    fixture_destroy(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_text_lists_shapes),
        cmocka_unit_test(the_uniform_block_lies_as_c_has_it),
        cmocka_unit_test(a_sphere_pushes_to_its_surface),
        cmocka_unit_test(planes_push_to_their_height),
        cmocka_unit_test(a_capsule_of_two_radii_pushes_to_its_surface),
        cmocka_unit_test(a_capsule_inside_its_larger_end_is_a_sphere),
        cmocka_unit_test(a_world_collider_stays_where_it_is),
        cmocka_unit_test(a_mesh_pushes_as_the_planes_of_its_sides_do),
        cmocka_unit_test(a_strand_leaves_half_as_far_as_it_goes),
        cmocka_unit_test(a_strand_that_leaves_faster_is_not_pushed),
        cmocka_unit_test(hair_at_the_ends_of_a_long_capsule_is_pushed),
        cmocka_unit_test(upright_hair_falls_onto_what_is_below),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
