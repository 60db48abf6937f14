// SPDX-License-Identifier: MIT
#include "support/stage.h"

#include "support/needed.h"

#include "base/random.h"
#include "passes/passes.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

const RendererOptions TRANSPARENT = {.width = SIDE, .height = SIDE};
const RendererOptions BLACK = {.width = SIDE, .height = SIDE, .background = {0, 0, 0, 1}};

static const char *const NAMES[] = {"", "quads", "blocks", "compute"};

Raster raster;
Studio studio;

void stage_open(const RendererOptions *options)
{
    RendererOptions mine = *options;
    mine.raster = raster;
    studio_open(&studio, &mine);
}

static int open_studio(void **state)
{
    (void)state;
    stage_open(&TRANSPARENT);
    print_message("drawing %s with %s\n", NAMES[raster], studio.gpu.renderer);
    return 0;
}

static int close_studio(void **state)
{
    (void)state;
    studio_close(&studio);
    return 0;
}

int clear_studio(void **state)
{
    (void)state;
    studio_clear(&studio);
    studio.light = (Light){0};
    return 0;
}

void use(const RendererOptions *options)
{
    RendererOptions mine = *options;
    mine.raster = raster;
    studio_set_options(&studio, &mine);
}

uint32_t add_line(const float from[3], const float to[3], float radius, float opacity)
{
    enum { VERTICES = 5 };
    float position[VERTICES][3];
    for (int j = 0; j < VERTICES; ++j)
        for (int k = 0; k < 3; ++k)
            position[j][k] = from[k] + (to[k] - from[k]) * (float)j / (VERTICES - 1);
    Strands strands = studio_strands(1, VERTICES, (const float(*)[3])position);
    uint32_t item = studio_add(&studio, &strands, radius, opacity);
    strands_destroy(&strands);
    return item;
}

static void add_lit(const Strands *strands, float radius, float opacity)
{
    uint32_t item = studio_add(&studio, strands, radius, opacity);
    studio.material[item].diffuse = 1; // colours that differ along every strand
    studio.material[item].ambient = 0.1f;
    studio.light = (Light){.direction = {0.6f, 0.8f, 0}, .color = {1, 0.8f, 0.5f}, .intensity = 1};
}

void add_tangle(uint32_t count, float radius, float opacity, const uint32_t *order)
{
    Strands strands = studio_tangle(7, SIDE, count, 12, 8, 0.2, order);
    add_lit(&strands, radius, opacity);
    strands_destroy(&strands);
}

void add_zigzags(uint32_t count, float radius, float opacity)
{
    enum { VERTICES = 12 };
    float(*position)[3] = malloc(count * VERTICES * sizeof *position);
    assert_non_null(position);
    Random random = random_create(11, 0);
    for (uint32_t s = 0; s < count; ++s) {
        double turn = 2 * GLM_PI * random_real(&random), way[2] = {cos(turn), sin(turn)}, x[3];
        for (int k = 0; k < 3; ++k) x[k] = (random_real(&random) - 0.5) * SIDE;
        for (int j = 0; j < VERTICES; ++j) {
            float *at = position[s * VERTICES + (uint32_t)j];
            double along = 6 * j, beside = j % 2 ? 1 : -1;
            at[0] = (float)(x[0] + along * way[0] - beside * way[1]);
            at[1] = (float)(x[1] + along * way[1] + beside * way[0]);
            at[2] = (float)(x[2] + 3 * j);
        }
    }
    Strands strands = studio_strands(count, VERTICES, (const float(*)[3])position);
    free(position);
    add_lit(&strands, radius, opacity);
    strands_destroy(&strands);
}

Strands crowd(uint32_t count)
{
    float(*position)[3] = malloc((size_t)count * 2 * sizeof *position);
    assert_non_null(position);
    for (uint32_t i = 0; i < 2 * count; ++i)
        for (int k = 0; k < 3; ++k) position[i][k] = k ? 0 : i % 2 ? 4 : -4;
    Strands strands = studio_strands(count, 2, (const float(*)[3])position);
    free(position);
    return strands;
}

struct Passes *stage_passes(void)
{
    assert_ptr_equal(studio.renderer.backend, &DRAW_PASSES);
    return studio.renderer.state;
}

uint64_t stage_base_version(void)
{
    return studio.renderer.backend == &DRAW_LANES ? stage_lanes_base_version()
                                                  : stage_passes()->base.version;
}

// Light from all directions in several colours, with a bright spot.
static const Environment *find_environment(void)
{
    enum { HEIGHT = 8, WIDTH = 2 * HEIGHT };
    static EnvironmentPart parts[ENVIRONMENT_PARTS];
    float pixels[HEIGHT][WIDTH][3];
    static const Environment kept = {.parts = parts};
    Environment made = {0};
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x)
            for (int c = 0; c < 3; ++c)
                pixels[y][x][c] =
                    0.1f * (float)((3 * x + 5 * y + 7 * c) % 8) + (x == 5 && y == 2 ? 8 : 0);
    const Image image = {WIDTH, HEIGHT, 3, (uint8_t *)pixels, IMAGE_FLOAT};
    NEEDED(environment_create(&made, &image, error));
    memcpy(parts, made.parts, sizeof parts);
    environment_destroy(&made);
    return &kept;
}

Ambient stage_ambient(StageSky sky)
{
    Ambient ambient = {0};
    if (sky == STAGE_SKY)
        ambient = (Ambient){.sky = {0.5f, 0.6f, 0.9f}, .ground = {0.2f, 0.1f, 0.1f}};
    if (sky == STAGE_ENVIRONMENT)
        ambient = (Ambient){.environment = find_environment(),
                            .axes = {{{0.8f, 0, -0.6f}, {0, 1, 0}, {0.6f, 0, 0.8f}}},
                            .strength = 0.7f};
    return ambient;
}

void stage_draw_lit(const Light *lights, uint32_t count, StageSky sky)
{
    const Ambient ambient = stage_ambient(sky);
    View view;
    studio_view(&view, SIDE, SIDE);
    const RenderFrame frame = {.view = &view,
                               .lights = lights,
                               .light_count = count,
                               .ambient = &ambient,
                               .head_rotation = {0, 0, 0, 1}};
    NEEDED(
        renderer_draw(&studio.renderer, &frame, studio.items, studio.count, &studio.image, error));
}

uint8_t *draw_copy(size_t *size)
{
    studio_draw(&studio);
    return studio_copy(&studio, size);
}

void assert_draws_the_same(const uint8_t *expected, size_t size)
{
    studio_draw(&studio);
    assert_memory_equal(studio.image.pixels, expected, size);
}

double alpha_sum(void)
{
    double sum = 0;
    for (int y = 0; y < SIDE; ++y)
        for (int x = 0; x < SIDE; ++x) sum += studio_pixel(&studio, x, y)[3] / 255.0;
    return sum;
}

double srgb(double linear)
{
    return 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055);
}

Mesh make_square(float half)
{
    Error error = {{0}};
    Mesh mesh;
    assert_int_equal(mesh_create(&mesh, 4, 2, &error), RESULT_OK);
    for (int v = 0; v < 4; ++v) {
        memcpy(mesh.position[v], (float[3]){v & 1 ? half : -half, v & 2 ? half : -half, 0}, 12);
        mesh.normal[v][2] = 1;
    }
    const uint32_t triangles[2][3] = {{0, 1, 2}, {2, 1, 3}};
    memcpy(mesh.triangle, triangles, sizeof triangles);
    return mesh;
}

int stage_run_count(const struct CMUnitTest *tests, size_t count, Raster first, Raster last)
{
    int failed = 0;
    for (raster = first; raster <= last; ++raster)
        failed += _cmocka_run_group_tests("renderer", tests, count, open_studio, close_studio);
    return failed;
}

float float_at(const Image *image, size_t i)
{
    float light;
    memcpy(&light, image->pixels + 4 * i, 4);
    return light;
}

double level_at(const Image *image, size_t i)
{
    uint16_t sixteen;
    if (image->kind == IMAGE_8) return image->pixels[i];
    if (image->kind == IMAGE_FLOAT) return srgb(fmin((double)float_at(image, i), 1));
    memcpy(&sixteen, image->pixels + 2 * i, 2);
    return sixteen / 257.0;
}
