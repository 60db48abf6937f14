// SPDX-License-Identifier: MIT
// The light that C computes at points of hair against shaders: images of the same ribbons by blocks
// and by compute.
#include "draw/hair_paint.h"
#include "support/needed.h"
#include "support/stage.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Initialisers of lights.
// clang-format off
#define SUN {.direction = {0.48f, 0.6f, 0.64f}, .color = {1, 0.8f, 0.5f}, .intensity = 1, .shadow = true}
#define WIDE_SUN {.direction = {0.48f, 0.6f, 0.64f}, .color = {1, 0.8f, 0.5f}, .intensity = 1, \
    .radius = 15, .shadow = true}
#define BACK {.direction = {-0.6f, 0, -0.8f}, .color = {0.3f, 0.6f, 1}, .intensity = 1}
#define LAMP {.kind = LIGHT_POINT, .position = {-50, 100, 90}, .distance = 100, .color = {1, 1, 1}, \
    .intensity = 1, .shadow = true}
#define SPOT {.kind = LIGHT_SPOT, .position = {20, 300, 100}, .direction = {0, -0.95f, -0.3122f}, \
    .inner_deg = 10, .outer_deg = 25, .distance = 300, .color = {1, 0.2f, 0.2f}, .intensity = 2}
// clang-format on

typedef enum Painting { PLAIN, VARIED, WARM, PAINTED } Painting;

typedef struct Case {
    const char *name;
    Light lights[2];
    uint32_t light_count;
    Shading shading;
    Lobes lobes;
    Shadow shadow;
    Painting painting;
    StageSky sky;
} Case;

static const Case CASES[] = {
    {.name = "kajiya, sun", .lights = {SUN}, .light_count = 1},
    {.name = "kajiya, sky", .sky = STAGE_SKY},
    {.name = "kajiya, an environment", .sky = STAGE_ENVIRONMENT},
    {.name = "kajiya, lamp and spot, varied colours",
     .lights = {LAMP, SPOT},
     .light_count = 2,
     .painting = WARM},
    {.name = "kajiya, deep shadows", .lights = {SUN}, .light_count = 1, .shadow = SHADOW_DOM},
    {.name = "kajiya, approximated shadows, painted",
     .lights = {SUN, LAMP},
     .light_count = 2,
     .shadow = SHADOW_APPROX,
     .painting = PAINTED},
    {.name = "energy, sun and back, a table of its own",
     .lights = {SUN, BACK},
     .light_count = 2,
     .shading = SHADING_MARSCHNER},
    {.name = "gauss, lamp and spot, a table of its own, sky",
     .lights = {LAMP, SPOT},
     .light_count = 2,
     .shading = SHADING_MARSCHNER,
     .lobes = LOBES_GAUSS,
     .sky = STAGE_SKY},
    {.name = "energy, a wide sun and a narrow lamp, deep shadows",
     .lights = {WIDE_SUN, LAMP},
     .light_count = 2,
     .shading = SHADING_MARSCHNER,
     .shadow = SHADOW_DOM},
    {.name = "gauss, a wide sun",
     .lights = {WIDE_SUN},
     .light_count = 1,
     .shading = SHADING_MARSCHNER,
     .lobes = LOBES_GAUSS},
    {.name = "energy, varied brightness",
     .lights = {SUN, BACK},
     .light_count = 2,
     .shading = SHADING_MARSCHNER,
     .painting = VARIED},
    {.name = "energy, the table of all colours",
     .lights = {SUN, BACK},
     .light_count = 2,
     .shading = SHADING_MARSCHNER,
     .painting = WARM},
    {.name = "gauss, painted, deep shadows, light among hair",
     .lights = {SUN, LAMP},
     .light_count = 2,
     .shading = SHADING_MARSCHNER,
     .lobes = LOBES_GAUSS,
     .shadow = SHADOW_DOM,
     .painting = PAINTED,
     .sky = STAGE_SKY},
};

static void paint_strands(uint32_t item, uint32_t count)
{
    Strands strands = {.strand_count = count, .vertex_count = count * 12};
    Paint paint = {.colors_from_file = true, .vertex_count = strands.vertex_count};
    strands.first = malloc((count + 1) * sizeof *strands.first);
    paint.color = malloc(strands.vertex_count * sizeof *paint.color);
    paint.thickness = malloc(strands.vertex_count * sizeof *paint.thickness);
    assert_true(strands.first && paint.color && paint.thickness);
    for (uint32_t s = 0; s <= count; ++s) strands.first[s] = 12 * s;
    for (uint32_t v = 0; v < strands.vertex_count; ++v) {
        for (uint32_t k = 0; k < 4; ++k)
            paint.color[v][k] = k < 3 ? 0.3f + 0.6f * (float)((v + 7 * k) % 11) / 10 : 0.8f;
        paint.thickness[v] = 0.6f + 0.1f * (float)(v % 5);
    }
    NEEDED(hair_paint_upload(&studio.hair[item], &strands, &paint, &studio.gpu.limits, error));
    free(strands.first);
    free(paint.color);
    free(paint.thickness);
}

// Sets a material with a large share of specular light, so that errors of highlights are visible.
static void dress(const Case *of, uint32_t count)
{
    SectionParams *material = &studio.material[0];
    material->shading = of->shading;
    material->lobes = of->lobes;
    material->ambient = 0.5f;
    material->diffuse = 0.7f;
    material->specular1 = 0.4f;
    material->specular2 = 0.6f;
    material->shadow_opacity = 0.5f;
    material->cone_angle = 3;
    material->color_variation = of->painting == VARIED || of->painting == WARM ? 0.35f : 0;
    material->warmth_variation = of->painting == WARM ? 0.1f : 0;
    for (int k = 0; k < 3; ++k) material->color[k] = 0.8f - 0.2f * (float)k;
    if (of->painting == PAINTED) paint_strands(0, count);
}

static float *draw_light(const Case *of, Raster by)
{
    RendererOptions options = BLACK;
    options.kind = IMAGE_FLOAT;
    options.shadow = (ShadowOptions){.kind = of->shadow, .side = 128, .spacing = 200};
    options.scatter = (ScatterOptions){.kind = SCATTER_GRID, .cells = 10};
    raster = by;
    use(&options);
    stage_draw_lit(of->lights, of->light_count, of->sky);
    size_t size;
    return (float *)(void *)studio_copy(&studio, &size);
}

// Both keep light in levels of 11 bits, which err by half a level, and mix them by the same shares:
// 2^-11 of the light, and 1e-4 for sines and powers. A strand's colour between two slices of its
// section's table differs from the nearer slice by at most 0.35 / 15 / 0.65; from there TT is
// extrapolated with power 1 instead of 0.5 to 1.5, and TRT with 2 instead of 1 to 3. In deep maps,
// a point that is rounded to another texel changes its light by up to 0.2, and compute stores the
// ends of strands as directions of 8 bits: a hundredth of the values may differ by more.
static void blocks_shade_as_compute_does(void **state)
{
    (void)state;
    enum { COUNT = 60, VALUES = SIDE * SIDE * 3 };
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; ++c) {
        const Case *of = &CASES[c];
        add_zigzags(COUNT, 1, 1);
        dress(of, COUNT);
        float *blocks = draw_light(of, RASTER_BLOCKS), *compute = draw_light(of, RASTER_COMPUTE);
        double bound = of->painting == VARIED ? 0.35 / 15 / 0.65 : 1.0 / 2048 + 2e-4, sum = 0,
               off = 0, most = 0;
        int beyond = 0, lit = 0;
        for (int i = 0; i < VALUES; ++i) {
            double a = (double)blocks[i], b = (double)compute[i], d = fabs(a - b);
            assert_true(isfinite(a) && isfinite(b));
            sum += b, off += d, lit += b > 0.01;
            most = fmax(most, d / (b + 0.01));
            beyond += d > bound * b + 2e-4;
        }
        print_message("%s: %.2g of the light in the mean, at most %.2g, %d of %d beyond %.2g\n",
                      of->name, off / sum, most, beyond, lit, bound);
        assert_true(lit > VALUES / 50);
        if (beyond > lit / 100 || off > bound * sum)
            fail_msg("%s: %d of %d values off", of->name, beyond, lit);
        free(blocks);
        free(compute);
        studio_clear(&studio);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {CLAIM(blocks_shade_as_compute_does)};
    return stage_run_one(tests, RASTER_COMPUTE);
}
