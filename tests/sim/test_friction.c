// SPDX-License-Identifier: MIT
// Coulomb friction against closed formulas: one particle on a plane or a ball, whose link to its
// root is perpendicular to the sliding direction. All particles are treated alike.
#include "support/hair_fixture.h"
#include "support/twin.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define MARGIN 0.001                         // the default
static const double FRICTION = (double)0.3f; // the default
static const double G = (double)9.81f, RATE = 240, LINK = 1;

// Particles, second-order velocities and, in split, segments with a tip. The bounds are errors of
// angles in rad: three times what was measured (dftl's damping), or three times what rounding
// causes over 60 steps, where the velocity errs by half a unit of positions up to 0.25 m per step:
// 2^-27 sqrt(60^3/3) / sqrt(3) = 1.2e-6 on any driver (measured: 2.2e-7).
static const struct {
    const char *algo;
    double slide, halt;
} SOLVERS[] = {{"dftl", 9e-5, 4.6e-4}, {"chain", 3.5e-6, 5.3e-5}, {"split", 3.5e-6, 1.9e-5}};
enum { PAIR = 2, SOLVER_COUNT = sizeof SOLVERS / sizeof *SOLVERS };

static void lay_pair(HairFixture *fixture, const char *algo, const char *text, const Vec root,
                     const Vec tip)
{
    Vec start[PAIR];
    vec_copy(root, start[0]);
    vec_copy(tip, start[1]);
    fixture_create(fixture, (const Vec *)start, 1, PAIR, algo, "", 0, 0);
    fixture->step.dt = 1 / RATE;
    fixture_collide(fixture, text);
}

// The tip's angle about the vertical through the root, from z to x, after this number of further
// steps.
static double angle_after(HairFixture *fixture, int steps)
{
    Vec q[PAIR];
    for (int i = 0; i < steps; ++i) fixture_step(fixture);
    twin_read_strand(fixture, 0, q);
    return atan2(q[1][0], q[1][2]);
}

// --- On a slope. The link is level, and gravity pulls its tip across the link.

static void lay_on_plane(HairFixture *fixture, const char *algo)
{
    lay_pair(fixture, algo, "ground:0", (const Vec){0, MARGIN, 0}, (const Vec){0, MARGIN, LINK});
}

// Gravity as on a slope with this tangent.
static void tilt(HairFixture *fixture, double tangent)
{
    double cosine = 1 / sqrt(1 + tangent * tangent);
    fixture->step.gravity[0] = (float)(G * tangent * cosine);
    fixture->step.gravity[1] = (float)(-G * cosine);
}

// The angle by which a pendulum on a slope turns from rest in t seconds: phi'' = (g sin a cos phi -
// friction g cos a) / l, by the midpoint rule in tiny steps.
static double slope_angle(double tangent, double t)
{
    enum { STEPS = 10000 };
    double angle = 0, rate = 0, h = t / STEPS, cosine = 1 / sqrt(1 + tangent * tangent);
    for (int i = 0; i < STEPS; ++i) {
        double middle = angle + 0.5 * h * rate;
        double gain = h * G * cosine * (tangent * cos(middle) - FRICTION) / LINK;
        angle += h * (rate + 0.5 * gain);
        rate += gain;
    }
    return angle;
}

// The angle that the tip loses at the start, rad: in the first step, friction only slows the tip
// down, and from the next step on it also holds it back (otherwise resting hair would creep).
static double first_step(double tangent)
{
    return 0.5 * FRICTION * G / sqrt(1 + tangent * tangent) / (RATE * RATE * LINK);
}

// At 3 % less than the tangent that friction can hold, hair stays, from the second step on within
// what the contact's rounds leave (collide.comp): each step's is half the last one's.
static void hair_holds_on_a_slope_below_the_angle_of_friction(void **state)
{
    (void)state;
    for (int i = 0; i < SOLVER_COUNT; ++i) {
        HairFixture fixture;
        double tangent = 0.97 * FRICTION;
        lay_on_plane(&fixture, SOLVERS[i].algo);
        tilt(&fixture, tangent);
        double first = angle_after(&fixture, 1), later = angle_after(&fixture, 239);
        if (!(fabs(first) < first_step(tangent)))
            fail_msg("%s: slips by %g at first", SOLVERS[i].algo, first);
        if (!(fabs(later - first) < 5e-6))
            fail_msg("%s: creeps by %g", SOLVERS[i].algo, later - first);
        fixture_destroy(&fixture);
    }
}

static void hair_slides_on_a_slope_beyond_the_angle_of_friction(void **state)
{
    (void)state;
    static const double ratios[] = {1.03, 1.5, 3};
    enum { STEPS = 60 };
    for (int i = 0; i < SOLVER_COUNT; ++i)
        for (int k = 0; k < 3; ++k) {
            HairFixture fixture;
            double tangent = ratios[k] * FRICTION;
            lay_on_plane(&fixture, SOLVERS[i].algo);
            tilt(&fixture, tangent);
            double angle = angle_after(&fixture, STEPS),
                   exact = slope_angle(tangent, STEPS / RATE) + first_step(tangent);
            print_message("%s, slope of %g times friction: turns by %.4g, off by %.2g\n",
                          SOLVERS[i].algo, ratios[k], angle, angle - exact);
            assert_true(fabs(angle - exact) < SOLVERS[i].slide);
            fixture_destroy(&fixture);
        }
}

// On level ground, a sliding tip loses friction g dt of its speed per step until it stops, and then
// rests.
static void hair_slides_to_a_halt(void **state)
{
    (void)state;
    for (int i = 0; i < SOLVER_COUNT; ++i) {
        HairFixture fixture;
        lay_on_plane(&fixture, SOLVERS[i].algo);
        tilt(&fixture, 3 * FRICTION);
        double before = angle_after(&fixture, 60), start = angle_after(&fixture, 1);
        double speed = start - before, loss = FRICTION * G / (LINK * RATE * RATE); // per step
        int steps = (int)(speed / loss);
        double end = start + steps * (speed - 0.5 * loss * (steps + 1));
        tilt(&fixture, 0);
        double there = angle_after(&fixture, steps + 2), later = angle_after(&fixture, 240);
        print_message("%s stops after %d steps and %.4g, off by %.2g\n", SOLVERS[i].algo, steps,
                      there - start, there - end);
        assert_true(fabs(there - end) < SOLVERS[i].halt);
        assert_true(fabs(later - there) < 0x1p-23 * fixture_rounding());
        fixture_destroy(&fixture);
    }
}

// --- On a ball that rotates about the vertical through the root, with the head.

// Quaternion product.
static void turn_about_y(const double base[4], double angle, float rotation[4])
{
    double s = sin(angle / 2), c = cos(angle / 2);
    const double product[4] = {c * base[0] + s * base[2], c * base[1] + s * base[3],
                               c * base[2] - s * base[0], c * base[3] - s * base[1]};
    for (int k = 0; k < 4; ++k) rotation[k] = (float)product[k];
}

// The ball accelerates the tip by friction g along its surface as long as the ball is faster; then
// the tip moves with it, behind by speed^2 / (2 friction g / link). The link is inclined by beta/2,
// so that a step's depth in the ball is cos^2(beta/2) of the depth in a plane: 1.6 % less. The lag
// may differ by that (and differs by half of it).
static void a_turning_ball_drags_hair_along(void **state)
{
    (void)state;
    // With two base rotations of the head, none and 90 degrees about x: with the latter, the axis
    // of the motion is not the axis of the rotation.
    static const double bases[2][4] = {{0, 0, 0, 1}, {M_SQRT1_2, 0, 0, M_SQRT1_2}};
    static const char *const texts[2] = {"sphere:0,-4,0,4", "sphere:0,0,4,4"};
    static const Vec roots[2] = {{0, MARGIN, 0}, {0, 0, -MARGIN}};
    const double R = 4 + MARGIN, beta = 2 * asin(LINK / (2 * R)), flatter = pow(sin(beta / 2), 2);
    const double speed = 2, gain = FRICTION * G / LINK, lag = speed * speed / (2 * gain);
    const Vec tip = {0, R * cos(beta) - 4, R * sin(beta)};
    for (int i = 0; i < 2 * SOLVER_COUNT; ++i) {
        HairFixture fixture;
        const char *algo = SOLVERS[i / 2].algo;
        double angle = 0, late = 0;
        lay_pair(&fixture, algo, texts[i % 2], roots[i % 2], tip);
        for (int k = 1; k <= 240; ++k) {
            double t = k / RATE;
            turn_about_y(bases[i % 2], speed * t, fixture.step.head.rotation);
            angle = angle_after(&fixture, 1);
            if (k == 200) late = angle;
            double exact = t * gain < speed ? gain * t * t / 2 : speed * t - lag;
            if (!(fabs(angle - exact) < flatter * lag))
                fail_msg("%s: at %g s turned by %g, not by %g", algo, t, angle, exact);
        }
        print_message("%s, base %d: lags by %.4g, ideally %.4g\n", algo, i % 2, speed - angle, lag);
        // Finally it moves with the ball: measured 2e-5; split is slower by 1.8e-3.
        assert_true(fabs((angle - late) * RATE / (40 * speed) - 1) < 5e-3);
        fixture_destroy(&fixture);
    }
}

// --- On a ball that rotates far in one step.

static const Vec BALL = {0, -4, 0}; // its centre; its radius is 4 m

// A point on the ball, above (x, z).
static void put_on_ball(double x, double z, Vec at)
{
    at[0] = x, at[1] = sqrt(pow(4 + MARGIN, 2) - x * x - z * z) - 4, at[2] = z;
}

// A link whose root is off the axis: its tip before and after a step in which the ball rotates by
// 60 degrees. Returns how deep the tip was inside the ball.
static double turn_far(float friction, Vec before, Vec after, Vec root_after)
{
    HairFixture fixture;
    Vec root, tip, q[PAIR];
    SolverReport report = {0};
    static const double upright[4] = {0, 0, 0, 1};
    put_on_ball(0.5, 0, root);
    put_on_ball(0.5, 1, tip);
    lay_pair(&fixture, "dftl", "sphere:0,-4,0,4", root, tip);
    fixture.params.friction = friction;
    fixture_solve_anew(&fixture);
    fixture_step(&fixture);
    twin_read_strand(&fixture, 0, q);
    vec_copy(q[1], before);
    turn_about_y(upright, M_PI / 3, fixture.step.head.rotation);
    fixture_step(&fixture);
    twin_read_strand(&fixture, 0, q);
    vec_copy(q[0], root_after);
    vec_copy(q[1], after);
    solver_report(&fixture.solver, &report);
    fixture_destroy(&fixture);
    return (double)report.deepest_found;
}

static void cross(const Vec a, const Vec b, Vec r)
{
    for (int k = 0; k < 3; ++k)
        r[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

// The ball's point under the tip has moved along the rotation's arc and not along the tangent.
// Friction cancels the tip's slip relative to it by up to friction times the push, as far as the
// link allows, which is across the link. The link takes its part of the push: along the normal n
// the tip only moves by 1 - (n.e)^2 of it. The formula neglects the depth relative to the ball's
// radius, and the path relative to the link's length.
static void friction_acts_against_the_slip_on_a_ball_that_turns_far(void **state)
{
    (void)state;
    const double cosine = cos(M_PI / 3), sine = sin(M_PI / 3);
    Vec before, smooth, rough, root, normal, slip, link, across, shift;
    turn_far(0, before, smooth, root);
    double depth = turn_far((float)FRICTION, before, rough, root);
    const Vec back = {cosine * smooth[0] - sine * smooth[2], smooth[1],
                      sine * smooth[0] + cosine * smooth[2]};
    vec_add_scaled(back, -1, before, slip);
    vec_add_scaled(smooth, -1, BALL, normal);
    vec_add_scaled(slip, -vec_dot(slip, normal) / vec_dot(normal, normal), normal, slip);
    vec_add_scaled(smooth, -1, root, link);
    cross(normal, link, across);
    vec_add_scaled(rough, -1, smooth, shift);
    double sine_of_link = vec_dot(normal, link) / (vec_norm(normal) * vec_norm(link)),
           push = depth / (1 - sine_of_link * sine_of_link);
    double expected =
        -FRICTION * push * vec_dot(slip, across) / (vec_norm(slip) * vec_norm(across));
    double got = vec_dot(shift, across) / vec_norm(across);
    print_message("%.4g deep, friction moves the tip by %.4g, expected %.4g\n", depth, got,
                  expected);
    assert_true(fabs(expected) > 0.5 * FRICTION * depth);
    assert_true(fabs(got / expected - 1) < depth / 4 + got / vec_norm(link));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hair_holds_on_a_slope_below_the_angle_of_friction),
        cmocka_unit_test(hair_slides_on_a_slope_beyond_the_angle_of_friction),
        cmocka_unit_test(hair_slides_to_a_halt),
        cmocka_unit_test(a_turning_ball_drags_hair_along),
        cmocka_unit_test(friction_acts_against_the_slip_on_a_ball_that_turns_far),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
