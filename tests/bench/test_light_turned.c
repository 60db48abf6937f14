// SPDX-License-Identifier: MIT
// Multiple scattering does not depend on the orientation of the scene: straight hair and the camera
// turn together about the light's axis, which changes their orientation relative to the directions
// that the light grid follows. The light that scattering adds to the image must stay the same.
#include "bench/light_case.h"
#include "bench/light_stage.h"
#include "formats/format.h"
#include "gen/strands_make.h"
#include "support/hair_fixture.h"
#include "support/needed.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { TURNS = 8, WIDTH = 160, HEIGHT = 120 };

// The axis is z: the light shines along -z.
static void turn_about_axis(double angle, const double from[3], double to[3])
{
    double c = cos(angle), s = sin(angle);
    to[0] = c * from[0] - s * from[1];
    to[1] = s * from[0] + c * from[1];
    to[2] = from[2];
}

// Fewer and thicker strands than reference hair of 6,000 strands 0.15 mm thick, but of the same
// density.
static void write_groom(const char *path, double angle)
{
    StrandsRecipe recipe = strands_make_recipe(STRANDS_STYLE_STRAIGHT);
    Strands strands;
    recipe.count = 2000, recipe.vertices = 16, recipe.length = 0.35f, recipe.seed = 5;
    NEEDED(strands_make(&strands, &recipe, error));
    for (uint32_t i = 0; i < strands.vertex_count; ++i) {
        float *x = strands.position[i];
        // Leans the hair towards the light first: light falls on it at 32 degrees.
        const double leant[3] = {x[0], 0.848 * (double)x[1] - 0.53 * (double)x[2],
                                 0.53 * (double)x[1] + 0.848 * (double)x[2]};
        double turned[3];
        turn_about_axis(angle, leant, turned);
        for (int k = 0; k < 3; ++k) x[k] = (float)turned[k];
    }
    NEEDED(format_write(path, FORMAT_TFX4, &strands, error));
    strands_destroy(&strands);
}

static void write_scene(const char *path, const char *groom, const char *color, double angle)
{
    const double still[2][3] = {{-0.56, 0.2, 1.4}, {0, -0.06, -0.1}};
    double eye[3], target[3];
    turn_about_axis(angle, still[0], eye);
    turn_about_axis(angle, still[1], target);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(
        file,
        "{\"sections\": [{\"file\": \"%s\", \"unit\": \"m\", \"algo\": \"none\", \"shading\": "
        "\"marschner\", \"radius\": 0.00045, \"tip_ratio\": 1, \"opacity\": 1, \"transmission\": "
        "\"%s\", \"color_variation\": 0, \"cone_angle\": 0, \"roughness\": 4, "
        "\"azimuthal_roughness\": 12}], \"lights\": [{\"direction\": [0, 0, -1], "
        "\"intensity\": 1, \"color\": \"#ffffff\", \"shadow\": true}], \"sky\": \"#000000\", "
        "\"ground\": \"#000000\", \"background\": \"#000000\", \"shadow\": \"dom\", "
        "\"samples\": 1, \"size\": [%d, %d], \"fov\": 30, \"eye\": [%.9f, %.9f, %.9f], "
        "\"target\": [%.9f, %.9f, %.9f]}",
        groom, color, WIDTH, HEIGHT, eye[0], eye[1], eye[2], target[0], target[1], target[2]);
    assert_int_equal(fclose(file), 0);
}

// Mean of all channels of the image.
static double draw_mean(const char *scene, const char *scatter)
{
    LightStage stage;
    double sum = 0;
    NEEDED(
        light_stage_create(&stage, fixture_gpu(), scene, (const char *[]){scatter, "", ""}, error));
    NEEDED(light_stage_draw(&stage, true, error));
    for (int row = 0; row < HEIGHT / LIGHT_BLOCK_PX; ++row)
        for (int column = 0; column < WIDTH / LIGHT_BLOCK_PX; ++column) {
            double mean[4];
            light_case_block(&stage.image, column, row, mean);
            sum += mean[0] + mean[1] + mean[2];
        }
    light_stage_destroy(&stage);
    return sum;
}

// `most`: the largest allowed ratio of standard deviation to mean.
static void require_steady(void **state, const char *color, double most)
{
    char groom[512], scene[512];
    double light[TURNS], sum = 0, squares = 0;
    snprintf(groom, sizeof groom, "%s", temporary_path(state, "turned.tfx"));
    snprintf(scene, sizeof scene, "%s", temporary_path(state, "turned.json"));
    for (int i = 0; i < TURNS; ++i) {
        double angle = 2 * M_PI * i / TURNS;
        write_groom(groom, angle);
        write_scene(scene, groom, color, angle);
        light[i] = draw_mean(scene, "--scatter grid") - draw_mean(scene, "--scatter none");
        sum += light[i] / TURNS;
    }
    assert_true(sum > 0);
    for (int i = 0; i < TURNS; ++i) {
        double off = light[i] / sum - 1;
        print_message("%s, turned by %d degrees: %.4f of the mean\n", color, 360 * i / TURNS,
                      1 + off);
        squares += off * off / TURNS;
    }
    print_message("%s: standard deviation %.4f\n", color, sqrt(squares));
    assert_true(sqrt(squares) < most);
}

// The bounds lie between the measured values 0.028 and 0.0222, and those without light_cone.c,
// 0.0345, and with half as many tangent classes, 0.0254.
static void blond_is_steady(void **state)
{
    require_steady(state, "0.95469,0.90633,0.79774", 0.03);
}

static void brown_is_steady(void **state)
{
    require_steady(state, "0.73536,0.63425,0.52711", 0.025);
}

int main(void)
{
#define WITH_FILES(test) cmocka_unit_test_setup_teardown(test, temporary_create, temporary_destroy)
    const struct CMUnitTest tests[] = {WITH_FILES(blond_is_steady), WITH_FILES(brown_is_steady)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
