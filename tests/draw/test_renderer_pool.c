// SPDX-License-Identifier: MIT
// The A-buffer's pool grows as needed; where it may not grow, the image is drawn in bands.
#include "support/needed.h"
#include "support/stage.h"

#include <stdlib.h>
#include <string.h>

enum { SMALL_POOL = 1 << 17 }; // for a tangle of strands

static void a_pool_that_is_too_small_grows(void **state)
{
    (void)state;
    const RendererOptions large = {.width = 1024, .height = 1024, .background = {0, 0, 0, 1}};
    size_t size;
    use(&large);
    add_tangle(3000, 6, 0.4f, NULL);
    uint8_t *first = draw_copy(&size);
    assert_true(studio.renderer.counts.redraws > 0);
    assert_int_equal(studio.renderer.counts.bands, 1);
    assert_draws_the_same(first, size);
    assert_int_equal(studio.renderer.counts.redraws, 0);
    free(first);
}

static void bands_give_the_same_picture(void **state)
{
    (void)state;
    RendererOptions small = BLACK;
    small.pool_bytes = SMALL_POOL;
    size_t size;
    use(&BLACK);
    add_tangle(1500, 2, 0.4f, NULL);
    uint8_t *expected = draw_copy(&size);
    uint64_t fragments = studio.renderer.counts.fragments;
    assert_int_equal(studio.renderer.counts.bands, 1);
    use(&small);
    assert_draws_the_same(expected, size);
    assert_true(studio.renderer.counts.bands > 4);
    assert_int_equal(studio.renderer.counts.fragments, fragments);
    assert_draws_the_same(expected, size);
    free(expected);
}

static void bands_are_no_more_than_the_pool_asks_for(void **state)
{
    (void)state;
    RendererOptions small = BLACK;
    small.pool_bytes = SMALL_POOL;
    size_t size;
    use(&small);
    add_tangle(1500, 2, 0.4f, NULL);
    uint8_t *first = draw_copy(&size);
    assert_draws_the_same(first, size);
    free(first);
    const RendererCounts *counts = &studio.renderer.counts;
    uint64_t node_bytes = 16, least = counts->fragments * node_bytes / SMALL_POOL + 1;
    assert_in_range(counts->bands, least, 3 * least);
    assert_int_equal(counts->pool_bytes, small.pool_bytes);
}

static Image late_image(const RendererOptions *options)
{
    Image image;
    NEEDED(image_create(&image, options->width, options->height, 3, error));
    return image;
}

// The first image is read after the next has been started and has found the pool too small. Both
// images equal those that are drawn one at a time.
static void an_image_that_comes_late_has_all_of_its_hair(void **state)
{
    (void)state;
    const RendererOptions large = {.width = 256, .height = 256, .background = {0, 0, 0, 1}};
    Renderer *renderer = &studio.renderer;
    uint8_t *expected[2];
    size_t size;
    View view[2];
    use(&large);
    add_tangle(3000, 6, 0.4f, NULL);
    studio_view(&view[0], 256, 256);
    studio_view(&view[1], 256, 256);
    view[1].projection[0][0] *= 2; // less hair is visible
    for (int i = 0; i < 2; ++i) {
        studio_draw_view(&studio, &view[i]);
        expected[i] = studio_copy(&studio, &size);
    }
    use(&large); // makes the pool small again
    Image image[2] = {late_image(&large), late_image(&large)};
    int place[2];
    for (int i = 0; i < 2; ++i) {
        RenderFrame frame = {.view = &view[i],
                             .lights = &studio.light,
                             .light_count = studio.light.intensity != 0,
                             .head_rotation = {0, 0, 0, 1}};
        place[i] = renderer_place(renderer);
        NEEDED(renderer_begin(renderer, &frame, studio.items, studio.count, &image[i], error));
        assert_true(renderer_is_late(renderer));
        NEEDED(renderer_settle(renderer, error));
        if (i == 0) assert_true(renderer->counts.redraws > 0);
    }
    for (int i = 0; i < 2; ++i) {
        NEEDED(renderer_take(renderer, place[i], &image[i], error));
        assert_memory_equal(image[i].pixels, expected[i], size);
        image_destroy(&image[i]);
        free(expected[i]);
    }
}

// The image is drawn again after another renderer has drawn: with its own shadows.
static void an_image_that_is_drawn_again_has_its_own_shadows(void **state)
{
    (void)state;
    const RendererOptions large = {.width = 256,
                                   .height = 256,
                                   .background = {0, 0, 0, 1},
                                   .shadow = {.kind = SHADOW_DOM, .side = 256, .spacing = 2}};
    RendererOptions other_options = BLACK;
    Renderer *renderer = &studio.renderer, other;
    Image image = late_image(&large), other_image = late_image(&other_options);
    size_t size;
    View view;
    int place;
    other_options.raster = RASTER_QUADS;
    other_options.shadow = (ShadowOptions){.kind = SHADOW_DOM, .side = 64, .spacing = 100};
    use(&large);
    add_tangle(3000, 6, 0.4f, NULL);
    studio.light.shadow = true;
    uint8_t *expected = draw_copy(&size);
    use(&large); // makes the pool small again
    studio_view(&view, 256, 256);
    RenderFrame frame = {
        .view = &view, .lights = &studio.light, .light_count = 1, .head_rotation = {0, 0, 0, 1}};
    NEEDED(renderer_create(&other, &studio.gpu, &studio.timer, &other_options, error));
    place = renderer_place(renderer);
    NEEDED(renderer_begin(renderer, &frame, studio.items, studio.count, &image, error));
    NEEDED(renderer_draw(&other, &frame, studio.items, studio.count, &other_image, error));
    NEEDED(renderer_settle(renderer, error));
    assert_true(renderer->counts.redraws > 0);
    NEEDED(renderer_take(renderer, place, &image, error));
    assert_memory_equal(image.pixels, expected, size);
    assert_memory_not_equal(image.pixels, other_image.pixels, size);
    renderer_destroy(&other);
    image_destroy(&image);
    image_destroy(&other_image);
    free(expected);
}

// All its pixels lie in one 8x8 block and therefore in one shard.
static void a_small_picture_uses_the_whole_pool(void **state)
{
    (void)state;
    RendererOptions small = BLACK;
    small.width = small.height = 8;
    small.pool_bytes = 1 << 18;
    use(&small);
    add_tangle(20000, 2, 0.4f, NULL);
    size_t size;
    free(draw_copy(&size));
    assert_true(studio.renderer.counts.fragments > 4096);
    assert_int_equal(studio.renderer.counts.bands, 1);
}

// CPU drivers end loops silently after 65,535 iterations: that must be an error instead of a wrong
// image.
static void more_layers_than_a_loop_can_visit_are_an_error(void **state)
{
    (void)state;
    enum { COUNT = 66000 };
    if (!studio.gpu.software) skip();
    RendererOptions pixel = BLACK;
    pixel.width = pixel.height = 1;
    use(&pixel);
    Strands strands = crowd(COUNT);
    studio_add(&studio, &strands, 0.4f, 0.001f);
    View view;
    Error error = {{0}};
    studio_view(&view, 1, 1);
    RenderFrame frame = {.view = &view, .head_rotation = {0, 0, 0, 1}};
    assert_int_equal(
        renderer_draw(&studio.renderer, &frame, studio.items, studio.count, &studio.image, &error),
        RESULT_FAILED);
    assert_non_null(strstr(error.text, "a pixel has more than"));
    strands_destroy(&strands);
}

static void a_row_that_no_pool_holds_is_an_error(void **state)
{
    (void)state;
    RendererOptions tiny = BLACK;
    tiny.pool_bytes = 1; // the smallest possible
    use(&tiny);
    add_tangle(3000, 8, 0.4f, NULL);
    View view;
    Error error = {{0}};
    studio_view(&view, SIDE, SIDE);
    RenderFrame frame = {.view = &view, .head_rotation = {0, 0, 0, 1}};
    assert_int_equal(
        renderer_draw(&studio.renderer, &frame, studio.items, studio.count, &studio.image, &error),
        RESULT_FAILED);
    assert_non_null(strstr(error.text, "one row"));
}

// Where the pool is short of memory, bands end between pixels, never between a pixel's samples.
static void samples_do_not_depend_on_bands(void **state)
{
    (void)state;
    size_t size;
    RendererOptions options = BLACK;
    options.samples = 2;
    add_tangle(300, 0.7f, 0.6f, NULL);
    use(&options);
    uint8_t *expected = draw_copy(&size);
    assert_int_equal(studio.renderer.counts.bands, 1);
    options.pool_bytes = 1 << 16;
    use(&options);
    assert_draws_the_same(expected, size);
    assert_true(studio.renderer.counts.bands > 1);
    free(expected);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        CLAIM(a_pool_that_is_too_small_grows),
        CLAIM(an_image_that_comes_late_has_all_of_its_hair),
        CLAIM(an_image_that_is_drawn_again_has_its_own_shadows),
        CLAIM(bands_give_the_same_picture),
        CLAIM(bands_are_no_more_than_the_pool_asks_for),
        CLAIM(a_small_picture_uses_the_whole_pool),
        CLAIM(more_layers_than_a_loop_can_visit_are_an_error),
        CLAIM(a_row_that_no_pool_holds_is_an_error),
        CLAIM(samples_do_not_depend_on_bands),
    };
    return stage_run_one(tests, RASTER_QUADS);
}
