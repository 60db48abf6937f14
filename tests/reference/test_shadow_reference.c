// SPDX-License-Identifier: MIT
#include "support/shadow_stage.h"

#include <math.h>
#include <string.h>

static void exact_light_multiplies_through_layers(void **state)
{
    (void)state;
    ShadowStage stage;
    shadow_stage_open(&stage, shadow_stage_layers(5), 0.01f, 0.3f, NULL, &LIGHT_ABOVE);
    shadow_assert_near(shadow_stage_exact(&stage, 0.1, 1, 0), 1, 0); // in front of all fibres
    for (int n = 1; n <= 5; ++n) {
        shadow_assert_near(shadow_stage_exact(&stage, 0.1, 0.05 - 0.1 * n, 0.0099), pow(0.7, n),
                           1e-6);
        shadow_assert_near(shadow_stage_exact(&stage, 0.1, 0.05 - 0.1 * n, 0.0101), 1, 0);
    }
    shadow_assert_near(shadow_stage_exact(&stage, 0.51, -1, 0), 1, 0); // beyond the ends
    const double on_the_second[3] = {0.1, -0.1 - 1e-4, 0};
    shadow_assert_near(shadow_reference_light(&stage.reference, on_the_second, 0.01), 0.7, 1e-6);
    shadow_stage_close(&stage);
}

// Every straight ray through a bent ribbon crosses it once: no joint counts twice or is missed.
static void exact_light_meets_a_joint_once(void **state)
{
    (void)state;
    enum { VERTICES = 12 };
    Strands strands;
    ShadowStage stage;
    NEEDED(strands_create(&strands, 1, VERTICES, error));
    strands.first[1] = VERTICES;
    for (int j = 0; j < VERTICES; ++j) {
        strands.position[j][0] = 0.5f * cosf(0.3f * (float)j);
        strands.position[j][2] = 0.5f * sinf(0.3f * (float)j);
        strands.position[j][1] = 0.03f * (float)j;
    }
    shadow_stage_open(&stage, strands, 0.05f, 0.4f, NULL, &LIGHT_ABOVE);
    for (int i = 5; i < 595; ++i) // not at the ends, which are straight cuts
        for (int k = -4; k <= 4; ++k) {
            double angle = 3.3 * i / 600, r = 0.495 + 0.01 * k;
            shadow_assert_near(shadow_stage_exact(&stage, r * cos(angle), -1, r * sin(angle)), 0.6,
                               1e-6);
        }
    shadow_stage_close(&stage);
}

static void exact_light_ends_at_the_mesh(void **state)
{
    (void)state;
    ShadowStage stage;
    Mesh mesh = shadow_stage_square(-0.05f, 0.3f);
    shadow_stage_open(&stage, shadow_stage_layers(2), 0.01f, 0.3f, &mesh, &LIGHT_ABOVE);
    shadow_assert_near(shadow_stage_exact(&stage, 0.1, -0.04, 0), 0.7, 1e-6);
    shadow_assert_near(shadow_stage_exact(&stage, 0.1, -0.06, 0), 0, 0);
    shadow_assert_near(shadow_stage_exact(&stage, 0.1, -0.06, 0.299), 0, 0);
    shadow_assert_near(shadow_stage_exact(&stage, 0.4, -0.2, 0), 0.49, 1e-6);
    shadow_stage_close(&stage);
    mesh_destroy(&mesh);
}

// In a lamp's light, an object at half the distance casts a shadow twice as large: a fibre half-way
// to the plane y = -2 has a shadow twice as wide.
static void exact_light_of_a_lamp_spreads(void **state)
{
    (void)state;
    ShadowStage stage;
    shadow_stage_open(&stage, shadow_stage_layers(1), 0.01f, 0.3f, NULL, &LIGHT_LAMP);
    double x = 2 * 0.1 - 0.3;                      // below the fibre's point at 0.1
    for (double side = -1; side <= 1; side += 2) { // there the fibre's middle is at z = -0.1
        shadow_assert_near(shadow_stage_exact(&stage, x, -2, -0.1 + side * 0.0199), 0.7, 1e-6);
        shadow_assert_near(shadow_stage_exact(&stage, x, -2, -0.1 + side * 0.0203), 1, 0);
    }
    shadow_assert_near(shadow_stage_exact(&stage, x, 0.01, -0.1), 1, 0);
    shadow_assert_near(shadow_stage_exact(&stage, 0.3, 3, 0.1), 1, 0); // behind the lamp
    shadow_stage_close(&stage);
}

// The mesh covers all that is on one side of the axis of every fibre.
static void light_is_the_mean_across_the_fibre(void **state)
{
    enum { LAYERS = 2, VERTICES = 5 };
    float left[LAYERS * VERTICES];
    (void)state;
    for (int side = 0; side <= 2; side += 2) {
        ShadowStage stage;
        Mesh mesh = shadow_stage_square(0.05f, 1);
        for (int v = 0; v < 4; ++v) mesh.position[v][side] += 1;
        shadow_stage_open(&stage, shadow_stage_layers(LAYERS), 0.01f, 0.3f, &mesh, &LIGHT_ABOVE);
        shadow_reference_fill(&stage.reference, &stage.item, left);
        // Side 0: from the middle of the fibre on, which is vertex 2.
        for (int v = 0; v < LAYERS * VERTICES; ++v) {
            int j = v % VERTICES;
            double lit = side || j == 2 ? 0.5 : j < 2;
            shadow_assert_near(left[v], lit * pow(0.7, v / VERTICES), 1e-6);
        }
        shadow_stage_close(&stage);
        mesh_destroy(&mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_light_multiplies_through_layers),
        cmocka_unit_test(exact_light_meets_a_joint_once),
        cmocka_unit_test(exact_light_ends_at_the_mesh),
        cmocka_unit_test(exact_light_of_a_lamp_spreads),
        cmocka_unit_test(light_is_the_mean_across_the_fibre),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
