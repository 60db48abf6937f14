// SPDX-License-Identifier: MIT
// The white furnace: hair that absorbs no light is invisible under a sky as bright as the
// background. The test passes only if no light is lost or gained in the fibre's lobes, in the light
// grid, at the grid's edge, and towards the eye.
#include "bench/light_case.h"
#include "bench/light_stage.h"
#include "support/hair_fixture.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

// The error that the documentation states for the hair's mean and for the RMS of 8 x 8 pixel
// blocks. Its causes: the sky is sampled in 48 directions, the grid has cells, and lobes are
// blurred by the width of a direction.
static const double STATED = 0.03;
// The RMS of pixels of skin beside hair: cells are coarse beside the edge of the hair.
static const double STATED_ON_SKIN = 0.03;
enum { WIDTH = 160, HEIGHT = 120 };

typedef struct Furnace {
    const char *groom, *place; // groom: file of tests/data/light/grooms; place: camera keys of the
                               // scene
    const char *flags;
} Furnace;

static void write_scene(const Furnace *furnace, const char *path)
{
    char folder[4096];
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_non_null(getcwd(folder, sizeof folder));
    fprintf(file,
            "{\"sections\": [{\"file\": \"%s/tests/data/light/grooms/%s\", \"unit\": \"m\", "
            "\"algo\": \"none\", \"shading\": \"marschner\", \"radius\": 0.0001, \"tip_ratio\": 1, "
            "\"opacity\": 1, \"color\": \"#ffffff\", \"color_variation\": 0}], \"lights\": [], "
            "\"sky\": \"#ffffff\", \"ground\": \"#ffffff\", \"background\": \"#ffffff\", "
            "\"shadow\": \"dom\", \"samples\": 2, \"size\": [%d, %d], %s}",
            folder, furnace->groom, WIDTH, HEIGHT, furnace->place);
    assert_int_equal(fclose(file), 0);
}

static void draw(LightStage *stage, const char *path, const char *const flags[3])
{
    Error error;
    if (light_stage_create(stage, fixture_gpu(), path, flags, &error)) fail_msg("%s", error.text);
    if (light_stage_draw(stage, true, &error)) fail_msg("%s", error.text);
}

// Compares the hair with the background: the mean difference, and the RMS over blocks, each
// weighted by its hair coverage.
static void require_unseen(const Image *light, const Image *coverage, const char *name)
{
    double off[3] = {0}, squares[3] = {0}, weight = 0;
    int blocks = 0;
    for (int row = 0; row < HEIGHT / LIGHT_BLOCK_PX; ++row)
        for (int column = 0; column < WIDTH / LIGHT_BLOCK_PX; ++column) {
            double lit[4], covered[4];
            light_case_block(light, column, row, lit);
            light_case_block(coverage, column, row, covered);
            if (!(covered[0] > 0)) continue;
            ++blocks, weight += covered[0];
            for (int k = 0; k < 3; ++k) {
                off[k] += lit[k] - 1;
                squares[k] += (lit[k] - 1) * (lit[k] - 1) / covered[0];
            }
        }
    assert_true(blocks >= 20);
    for (int k = 0; k < 3; ++k) {
        double mean = off[k] / weight, rms = sqrt(squares[k] / weight);
        print_message("%s, channel %d: mean %+.4f, RMS of %d blocks %.4f\n", name, k, mean, blocks,
                      rms);
        if (!(fabs(mean) <= STATED && rms <= STATED))
            fail_msg("%s, channel %d: mean %+.4f, RMS of blocks %.4f: expected at most %g", name, k,
                     mean, rms, STATED);
    }
}

static void require_furnace(void **state, const char *groom, const char *place, const char *flags)
{
    const Furnace setting = {groom, place, flags}, *furnace = &setting;
    LightStage lit, covered;
    char name[128];
    const char *path = temporary_path(state, "furnace.json");
    write_scene(furnace, path);
    draw(&lit, path, (const char *[]){furnace->flags, "", ""});
    draw(&covered, path, (const char *[]){furnace->flags, "--aov coverage", ""});
    snprintf(name, sizeof name, "%s %s", furnace->groom, furnace->flags);
    require_unseen(&lit.image, &covered.image, name);
    light_stage_destroy(&lit);
    light_stage_destroy(&covered);
}

#define CURLS     "curls3k.tfx", "\"margin\": 0.01"
#define FUR       "fur.tfx", "\"margin\": 0.01"
#define FUR_AHEAD "fur.tfx", "\"eye\": [0, 0, 1], \"target\": [0, 0, 0], \"fov\": 40"

static void curls_vanish(void **state)
{
    require_furnace(state, CURLS, "--raster blocks");
}

// With fewer cells than usual: the light of each is found by shaders here, which takes a CPU long.
static void curls_vanish_as_triangles(void **state)
{
    require_furnace(state, CURLS, "--raster quads --scatter-cells 16");
}

static void curls_vanish_with_tilted_scales(void **state)
{
    require_furnace(state, CURLS, "--cone-angle 3 --roughness 8 --azimuthal-roughness 20");
}

static void fur_vanishes(void **state)
{
    require_furnace(state, FUR, "--raster blocks");
}

// White skin among white hair: each sends the other as much light as it hides of the sky, so both
// are as bright as the sky. Stated for the mean and the RMS of pixels of skin alone, and for the
// mean of hair; measured 0.999, 0.027 and 1.005.
static void skin_and_the_hair_around_it_vanish(void **state)
{
    const char *path = temporary_path(state, "furnace.json"),
               *head = "--mesh assets/head.obj --mesh-color #ffffff --scalp-tint 0";
    const Furnace setting = {CURLS, ""};
    LightStage lit, covered;
    write_scene(&setting, path);
    draw(&lit, path, (const char *[]){head, "", ""});
    draw(&covered, path, (const char *[]){head, "--aov coverage", ""});
    const float *light = (const float *)(void *)lit.image.pixels,
                *coverage = (const float *)(void *)covered.image.pixels;
    double sum = 0, squares = 0, beside = 0, hair = 0;
    int skin = 0;
    for (int i = 0; i < WIDTH * HEIGHT; ++i) {
        double off = (double)light[(size_t)i * (size_t)lit.image.channels] - 1,
               share = (double)coverage[(size_t)i * (size_t)covered.image.channels];
        if (share > 0) beside += off, hair += share;
        if (share > 0 || off == 0) continue;
        sum += off, squares += off * off, ++skin;
    }
    print_message("skin: mean %.4f, RMS %.4f of %d px; hair: mean %.4f of %g px\n", 1 + sum / skin,
                  sqrt(squares / skin), skin, 1 + beside / hair, hair);
    assert_true(skin > 1000 && fabs(sum / skin) < STATED);
    assert_true(sqrt(squares / skin) < STATED_ON_SKIN);
    assert_true(hair > 1000 && fabs(beside / hair) < STATED);
    light_stage_destroy(&lit);
    light_stage_destroy(&covered);
}

// An environment of one constant color lights hair and skin like the sky, whichever way it is
// turned.
static void an_even_environment_is_a_sky(void **state)
{
    static const float PIXELS[2][3] = {{1, 0.5f, 0.25f}, {1, 0.5f, 0.25f}};
    const Furnace setting = {CURLS, ""};
    char flags[4096];
    LightStage sky, even;
    char path[512];
    snprintf(path, sizeof path, "%s", temporary_path(state, "furnace.json"));
    const char *image = temporary_path(state, "even.pfm");
    FILE *file = fopen(image, "wb");
    assert_non_null(file);
    fputs("PF\n2 1\n-1.0\n", file);
    assert_int_equal(fwrite(PIXELS, sizeof PIXELS, 1, file), 1);
    assert_int_equal(fclose(file), 0);
    write_scene(&setting, path);
    // sRGB of 1, 0.5 and 0.25
    const char *small = "--size 80x60 --samples 1 --mesh assets/head.obj --color brown";
    draw(&sky, path,
         (const char *[]){small, "--sky 1,0.7353569,0.5370987", "--ground 1,0.7353569,0.5370987"});
    snprintf(flags, sizeof flags, "--environment %s --environment-turn 70", image);
    draw(&even, path, (const char *[]){small, flags, "--environment-strength 1"});
    const float *a = (const float *)(void *)sky.image.pixels,
                *b = (const float *)(void *)even.image.pixels;
    double sum = 0;
    for (size_t i = 0; i < (size_t)80 * 60 * (size_t)sky.image.channels; ++i) {
        if (!(fabsf(a[i] - b[i]) <= 2e-3f)) // two steps of halves below 1
            fail_msg("%zu: %g in the environment, %g in the sky", i, (double)b[i], (double)a[i]);
        sum += fabs((double)a[i] - 1) > 0.1;
    }
    assert_true(sum > 1000); // pixels of mesh and hair
    light_stage_destroy(&sky);
    light_stage_destroy(&even);
}

// An environment that is 1 + y / 2 in the direction (x, y, z) is the background at the left edge of
// the image, where the camera's rays are known: as bright as it is, times strength and exposure.
static void an_environment_is_the_background(void **state)
{
    enum { TALL = 64, W = 80, H = 60 };
    static float pixels[TALL][2 * TALL][3]; // PFM: the lowest row first
    static const char *const rasters[] = {"--raster blocks", "--raster compute", "--raster quads"};
    char flags[4096], path[512];
    snprintf(path, sizeof path, "%s", temporary_path(state, "furnace.json"));
    const char *image = temporary_path(state, "upright.pfm");
    for (int row = 0; row < TALL; ++row)
        for (int i = 0; i < 2 * TALL * 3; ++i)
            pixels[row][i / 3][i % 3] = 1 - 0.5f * (float)cos(M_PI * (row + 0.5) / TALL);
    FILE *file = fopen(image, "wb");
    assert_non_null(file);
    fprintf(file, "PF\n%d %d\n-1.0\n", 2 * TALL, TALL);
    assert_int_equal(fwrite(pixels, sizeof pixels, 1, file), 1);
    assert_int_equal(fclose(file), 0);
    const Furnace setting = {FUR_AHEAD, ""};
    write_scene(&setting, path);
    snprintf(flags, sizeof flags, "--environment %s --environment-strength 0.5 --exposure 2",
             image);
    for (int i = 0; i < 3; ++i) {
        LightStage stage;
        draw(&stage, path,
             (const char *[]){"--size 80x60 --shadow none --environment-background", flags,
                              rasters[i]});
        const float *light = (const float *)(void *)stage.image.pixels;
        const double slope = tan(20 * M_PI / 180);
        for (int y = 0; y < H; ++y) {
            double up = (1 - 2 * (y + 0.5) / H) * slope, across = (1 - 1. / W) * slope * W / H,
                   expected = 2 + up / sqrt(up * up + across * across + 1),
                   found = (double)light[(size_t)y * W * (size_t)stage.image.channels];
            if (!(fabs(found - expected) < 4e-3)) // halves are rounded by 1e-3
                fail_msg("%s, row %d: %g, not %g", rasters[i], y, found, expected);
        }
        light_stage_destroy(&stage);
    }
}

int main(void)
{
#define WITH_FILES(test) cmocka_unit_test_setup_teardown(test, temporary_create, temporary_destroy)
    const struct CMUnitTest tests[] = {
        WITH_FILES(curls_vanish),
        WITH_FILES(curls_vanish_as_triangles),
        WITH_FILES(curls_vanish_with_tilted_scales),
        WITH_FILES(fur_vanishes),
        WITH_FILES(skin_and_the_hair_around_it_vanish),
        WITH_FILES(an_even_environment_is_a_sky),
        WITH_FILES(an_environment_is_the_background),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
