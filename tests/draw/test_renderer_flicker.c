// SPDX-License-Identifier: MIT
// Slow changes of the scene change the image slowly: nothing flickers. Flicker is the difference
// between a pixel's value and the mean of its values in the image before and the image after.
#include "base/random.h"
#include "support/stage.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 12, COUNT = 300, VERTICES = 12, PICTURE = 96 };

// Draws hair with shadows, moved by (dx, dy) px, with a light `deg` off the vertical.
static void draw_frame(float dx, float dy, float deg)
{
    static float position[COUNT][VERTICES][3];
    Random random = random_create(7, 0);
    for (int s = 0; s < COUNT; ++s) {
        double x[3], d[3], turn[3];
        for (int k = 0; k < 3; ++k) x[k] = (random_real(&random) - 0.5) * PICTURE;
        random_direction(&random, d);
        random_direction(&random, turn);
        for (int j = 0; j < VERTICES; ++j)
            for (int k = 0; k < 3; ++k) {
                position[s][j][k] = (float)x[k] + (k == 0 ? dx : k == 1 ? dy : 0);
                x[k] += 5 * d[k];
                d[k] += 0.2 * turn[k];
            }
    }
    Strands strands = studio_strands(COUNT, VERTICES, (const float(*)[3])position);
    studio_clear(&studio);
    uint32_t item = studio_add(&studio, &strands, 0.5f, 0.6f);
    studio.material[item].diffuse = 1;
    studio.material[item].ambient = 0.1f;
    float angle = glm_rad(deg);
    studio.light = (Light){.direction = {sinf(angle), cosf(angle), 0},
                           .color = {1, 1, 1},
                           .intensity = 1,
                           .shadow = true};
    strands_destroy(&strands);
    studio_draw(&studio);
}

static double value_at(const uint8_t *pixels, size_t i)
{
    uint16_t value;
    memcpy(&value, pixels + 2 * i, 2);
    return value / 257.0;
}

// RMS flicker in levels of 255, over pixels that are not black in all images, while hair moves by
// (dx, dy) px and the light turns by `deg` per frame.
static double flicker(const RendererOptions *options, float dx, float dy, float deg)
{
    uint8_t *frames[FRAMES];
    size_t size, count = 0;
    double sum = 0;
    use(options);
    for (int i = 0; i < FRAMES; ++i) {
        draw_frame((float)i * dx, (float)i * dy, 30 + (float)i * deg);
        frames[i] = studio_copy(&studio, &size);
    }
    for (int i = 1; i + 1 < FRAMES; ++i)
        for (size_t v = 0; v < size / 2; ++v) {
            double before = value_at(frames[i - 1], v), now = value_at(frames[i], v),
                   after = value_at(frames[i + 1], v), off = now - 0.5 * (before + after);
            if (before + now + after == 0) continue;
            sum += off * off;
            ++count;
        }
    for (int i = 0; i < FRAMES; ++i) free(frames[i]);
    assert_true(count > 10000);
    return sqrt(sum / (double)count);
}

static RendererOptions options_of(int samples, Shadow shadow)
{
    return (RendererOptions){.width = PICTURE,
                             .height = PICTURE,
                             .kind = IMAGE_16,
                             .samples = samples,
                             .background = {0, 0, 0, 1},
                             .shadow = {.kind = shadow, .side = 256, .spacing = 200}};
}

// Measured: 1.1 (quads) and 0.8 (blocks). Most of it occurs where a ribbon's edge enters a pixel,
// because the sRGB curve is steep there: a value that grows from 0 by 1/400 of white per frame
// flickers by 4 levels in the first frame.
static void hair_that_moves_does_not_flicker(void **state)
{
    (void)state;
    for (int samples = 1; samples <= 2; ++samples) {
        RendererOptions options = options_of(samples, SHADOW_NONE);
        double off = flicker(&options, 0.05f, 0.02f, 0);
        print_message("%d samples, moving hair: %.3f levels\n", samples, off);
        assert_true(off < 1.3);
    }
}

static void hair_that_moves_through_shadows_does_not_flicker(void **state)
{
    (void)state;
    RendererOptions options = options_of(1, SHADOW_DOM);
    double off = flicker(&options, 0.05f, 0.02f, 0);
    print_message("moving hair with shadows: %.3f levels\n", off);
    assert_true(off < 1.3);
}

// Measured: 0.7. The light at a particle jumps where the edge of a fibre passes in front of it,
// because the shadow map has texels.
static void a_light_that_moves_does_not_make_hair_flicker(void **state)
{
    (void)state;
    RendererOptions options = options_of(1, SHADOW_DOM);
    double off = flicker(&options, 0, 0, 0.1f);
    print_message("moving light: %.3f levels\n", off);
    assert_true(off < 0.9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        CLAIM(hair_that_moves_does_not_flicker),
        CLAIM(hair_that_moves_through_shadows_does_not_flicker),
        CLAIM(a_light_that_moves_does_not_make_hair_flicker),
    };
    return stage_run(tests);
}
