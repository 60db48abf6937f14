// SPDX-License-Identifier: MIT
// Rod on the GPU against its double-precision form; its forces against finite differences of the
// energy; natural shapes. `tractrix-bench accuracy --part physics` compares it with elastic rods.
#include "sim/rest_shape.h"
#include "support/reference_rod.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

static void fibre(SectionParams *params)
{
    params->rest = REST_HANGING;
    params->style_stiffness = 0;
}

static void sprung(SectionParams *params)
{
    params->rest = REST_HANGING;
}

static void soft(SectionParams *params)
{
    fibre(params);
    params->youngs_modulus = 0.2f;
    params->bend_damping = 0;
}

static const TwinPair PAIR = {"rod", "", reference_rod_step, false};

static void it_equals_its_double_precision_twin(void **state)
{
    (void)state;
    static const TwinCase cases[] = {
        {2, 60, 1, 0.5, 100, 3 * 4.5e-6, fibre},  {8, 60, 1, 0.5, 100, 3 * 3.1e-6, fibre},
        {16, 60, 4, 0.5, 100, 3 * 4.4e-7, fibre}, {16, 240, 4, 0.5, 100, 3 * 3.1e-6, fibre},
        {32, 60, 4, 0.5, 60, 3 * 4.4e-7, fibre},  {16, 60, 4, 0.5, 100, 3 * 4.4e-7, sprung},
        {16, 60, 4, 0.5, 60, 3 * 1.1e-6, soft},
    };
    static const TwinCase uneven[] = {{8, 60, 1, 0.5, 60, 3 * 1.9e-6, fibre},
                                      {17, 60, 1, 0.5, 60, 3 * 1.9e-6, fibre}};
    twin_require(&PAIR, cases, sizeof cases / sizeof *cases);
    twin_require_uneven(&PAIR, uneven, 2);
}

// The energy's gradient by positions, with the twist at its minimum, equals finite differences.
static void forces_are_the_gradient_of_the_energy(void **state)
{
    (void)state;
    enum { N = 9 };
    const HeadPose head = {.rotation = {0.6f, 0, 0, 0.8f}};
    const double step = 1e-6;
    SectionParams params = {.youngs_modulus = 3.5f, .hair_radius = 35, .hair_density = 1300};
    TwinStrand strand;
    Vec q[N], gradient[N];
    twin_make_curl(q, N, 0, 2);
    twin_start(&strand, N, (const Vec *)q);
    for (int j = 1; j < N; ++j) {
        Vec way;
        for (int k = 0; k < 3; ++k) way[k] = q[j][k] - q[j - 1][k] + 0.01 * sin(7 * j + 3 * k);
        vec_add_scaled(strand.x[j - 1], strand.length[j] / vec_norm(way), way, strand.x[j]);
    }
    reference_rod_untwist(&strand, &head, &params, 200);
    double size = reference_rod_energy(&strand, &head, &params, gradient);
    assert_true(size > 1e-3);
    for (int j = 1; j < N; ++j) // moves that turn segment j and keep all lengths
        for (int k = 0; k < 3; ++k) {
            double energy[2], slope = 0;
            Vec e, across = {0};
            vec_add_scaled(strand.x[j], -1, strand.x[j - 1], e);
            across[k] = 1;
            vec_add_scaled(across, -e[k] / vec_dot(e, e), e, across);
            for (int i = j; i < N; ++i) slope += vec_dot(gradient[i], across);
            for (int side = 0; side < 2; ++side) {
                TwinStrand moved = strand;
                for (int i = j; i < N; ++i)
                    vec_add_scaled(strand.x[i], side ? step : -step, across, moved.x[i]);
                reference_rod_untwist(&moved, &head, &params, 200);
                energy[side] = reference_rod_energy(&moved, &head, &params, NULL);
            }
            assert_true(fabs((energy[1] - energy[0]) / (2 * step) - slope) < 1e-5 * size / 0.01);
        }
}

// --- The natural shape of a groom.

// A wave that leaves the head sideways and bends down, 0.1 to 0.3 m long.
static void make_groom(RestJoint *joints, int n, int number)
{
    double length = 0.1 + 0.02 * number, l = length / n, beyond = 9.81 * l,
           bend = 3.5e9 * 35e-6 * 35e-6 / (4 * 1300);
    for (int j = 1; j <= n; ++j) {
        double s = j * l, fall = fmin(6 * s, 1.4), size;
        joints[j] = (RestJoint){.length = l,
                                .bend = bend,
                                .beta = bend / (j == 1 ? l / 2 : l),
                                .weight = {0, j == n ? -beyond / 2 : -beyond, 0}};
        Vec t = {cos(fall) + 0.3 * sin(60 * s + number), -sin(fall), 0.3 * cos(60 * s)};
        size = vec_norm(t);
        for (int k = 0; k < 3; ++k) joints[j].t[k] = t[k] / size;
    }
}

// Torques of the joints equal those of the weight and of the forces that hold; no joint is bent by
// more than its limit, and what hangs freely is not held.
static void natural_shapes_balance_the_weight(void **state)
{
    (void)state;
    enum { N = 24 };
    const double ratio = 1 / 1.45;
    for (int number = 0; number < 10; ++number) {
        RestJoint joints[N + 1];
        Vec W = {0}, T = {0};
        make_groom(joints, N, number);
        rest_shape_solve(joints, N, ratio);
        for (int j = N; j >= 1; --j) {
            const RestJoint *joint = &joints[j];
            Vec bent, torque, off;
            double c = vec_dot(joint->a, joint->t), weight = vec_norm(joint->weight);
            vec_add_scaled(W, 1, joint->weight, W);
            vec_add_scaled(W, 1, joint->held, W);
            for (int k = 0; k < 3; ++k) {
                int y = (k + 1) % 3, z = (k + 2) % 3;
                bent[k] = joint->a[y] * joint->t[z] - joint->a[z] * joint->t[y];
                torque[k] = joint->length * (joint->t[y] * W[z] - joint->t[z] * W[y]);
            }
            vec_add_scaled(T, 1, torque, T);
            for (int k = 0; k < 3; ++k)
                off[k] = joint->beta * (bent[k] - ratio * joint->twist *
                                                      (joint->a[k] + joint->t[k]) / (1 + c)) -
                         T[k];
            assert_true(vec_norm(off) < 1e-6 * 9.81 * 0.3 * 0.3);
            assert_true(vec_norm(bent) < 0.91);
            if (j > N - 3) assert_true(vec_norm(joint->held) < 1e-12 * weight); // the tip hangs
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_equals_its_double_precision_twin),
        cmocka_unit_test(forces_are_the_gradient_of_the_energy),
        cmocka_unit_test(natural_shapes_balance_the_weight),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
