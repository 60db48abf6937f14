// SPDX-License-Identifier: MIT
// The compute rasteriser draws the same image as blocks, in both of its forms and in every run,
// however little memory its lists have.
#include "passes/passes.h"
#include "support/needed.h"
#include "support/stage.h"

#include "glsl/draw/draw.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const RendererOptions SMALL = {
    .width = 101, .height = 67, .background = {0.2f, 0.1f, 0.4f, 1}}; // px: no multiples of tiles

static void use_raster(const RendererOptions *options, Raster asked)
{
    raster = asked;
    use(options);
    raster = RASTER_COMPUTE;
}

// A mesh that slopes through the hair.
static void add_mesh(void)
{
    const float green[3] = {0, 1, 0};
    Error error = {{0}};
    Mesh mesh = make_square(30);
    for (int v = 0; v < 4; ++v) mesh.position[v][2] = 0.3f * mesh.position[v][0];
    assert_int_equal(renderer_set_mesh(&studio.renderer, &mesh, green, &error), RESULT_OK);
    mesh_destroy(&mesh);
}

// Bent strands, a wide one through the mesh, and wide ones that hide what is behind them. Compute
// rounds the ends of wide strands, so their ends lie outside the image. All pieces of a wide strand
// are equally far away.
static void add_hair(void)
{
    add_zigzags(600, 0.7f, 0.6f);
    add_line((float[3]){-80, -51.5f, 1}, (float[3]){80, 36.5f, 1}, 7, 0.5f);
    for (int i = 0; i < 2; ++i)
        add_line((float[3]){-60, -10.0f * (float)i, 30}, (float[3]){60, 25, 30}, 5, 1);
}

// --- Comparison with blocks.

typedef struct Difference {
    double rmse, largest; // levels
    double largest_light; // of float values
    double share;         // of values that differ by more than one level
} Difference;

static Difference find_difference(const Image *a, const Image *b)
{
    Difference found = {0};
    size_t count = (size_t)a->width * (size_t)a->height * (size_t)a->channels;
    double sum = 0;
    for (size_t i = 0; i < count; ++i) {
        double d = fabs(level_at(a, i) - level_at(b, i));
        sum += d * d;
        if (a->kind == IMAGE_FLOAT)
            found.largest_light =
                fmax(found.largest_light, fabs((double)float_at(a, i) - (double)float_at(b, i)));
        found.largest = fmax(found.largest, d);
        found.share += d > 1;
    }
    found.share /= (double)count;
    found.rmse = sqrt(sum / (double)count);
    return found;
}

static Difference compare_with_blocks(const RendererOptions *options, bool over_mesh)
{
    size_t size;
    use_raster(options, RASTER_BLOCKS);
    if (over_mesh) add_mesh();
    studio_draw(&studio);
    uint64_t fragments = studio.renderer.counts.fragments;
    Image expected = studio.image;
    expected.pixels = studio_copy(&studio, &size);
    use(options);
    if (over_mesh) add_mesh();
    studio_draw(&studio);
    assert_int_equal(studio.renderer.options.raster, RASTER_COMPUTE);
    assert_true(studio.renderer.counts.fragments > fragments); // tiles are smaller than blocks
    Difference found = find_difference(&expected, &studio.image);
    free(expected.pixels);
    return found;
}

// Pixels differ where rounding decides which of two ribbons is the nearest, or whether any is. They
// are few.
static void pictures_are_those_of_blocks(void **state)
{
    (void)state;
    const Floor floor = {.kind = FLOOR_PLANE,
                         .middle = {0, -20, 0},
                         .whole = 2000,
                         .faded = 3000,
                         .color = {1, 1, 1}};
    const RendererOptions kinds[] = {
        {.background = {0.2f, 0.1f, 0.4f, 1}, .tone = TONE_FILMIC},
        {.background = {0, 0, 0, 1}, .samples = 4, .tone = TONE_REINHARD},
        {.samples = 2, .kind = IMAGE_16},
        {.kind = IMAGE_FLOAT},
        {.background = {1, 1, 1, 1}, .kind = IMAGE_16, .floor = floor},
        {.aov = AOV_COVERAGE},
        {.aov = AOV_DEPTH, .depth_range = {900, 1100}},
        {.aov = AOV_TANGENT, .kind = IMAGE_16},
        {.aov = AOV_STRAND}};
    // Where compute's arithmetic differs from C's, the two may leave out a contribution of 1/1024
    // in different pixels: near black sRGB has 12.92 * 255 levels.
    const double most = studio.gpu.software && !studio.gpu.ulps ? 1.01 : 1 + 12.92 * 255 / 1024;
    // Rounding to whole levels turns a difference of d levels into one level in the share d of the
    // pixels, so the RMSE is the root of the mean d: 0.06 for 0.0036. Floats differ by 0.011 (RMS).
    const double rounded = 0.06, unrounded = 0.05;
    add_hair();
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i) {
        RendererOptions options = kinds[i];
        options.width = SMALL.width, options.height = SMALL.height;
        bool nearest = options.aov > AOV_COVERAGE;
        Difference found = compare_with_blocks(&options, i % 2);
        print_message("picture %zu: RMSE %g, at most %g levels, %g %% by more than one\n", i,
                      found.rmse, found.largest, 100 * found.share);
        if (nearest)
            assert_true(found.share <= 1e-3);
        else
            assert_true(found.rmse <= (options.kind == IMAGE_8 ? rounded : unrounded) &&
                        found.largest <= most);
    }
}

// Both leave out ribbons whose visible share is below 1/1024, but in different pixels. No ribbon is
// brighter than 1.1.
static void a_thicket_differs_by_what_is_left_out(void **state)
{
    (void)state;
    RendererOptions options = SMALL;
    options.kind = IMAGE_FLOAT;
    add_zigzags(4000, 1.5f, 0.7f);
    studio.light = (Light){.direction = {0, 0, 1}, .color = {1, 1, 1}, .intensity = 0.5f};
    Difference found = compare_with_blocks(&options, false);
    print_message("thicket: at most %g of the light\n", found.largest_light);
    assert_true(found.largest_light <= 1.1 / 1024);
    assert_true(found.largest <= 1);
}

// The two leave out different points: blocks where ribbons are long, compute where colours differ.
// Each one's straight pieces are up to 0.05 px off the curve, so that the edges of a ribbon differ
// by up to 0.1 px, in the worst case in all of a pixel.
static void curves_are_straightened_alike(void **state)
{
    (void)state;
    const double opacity = 0.6;
    RendererOptions options = SMALL;
    options.kind = IMAGE_FLOAT;
    options.aov = AOV_COVERAGE;
    add_tangle(600, 0.7f, (float)opacity, NULL);
    Difference found = compare_with_blocks(&options, false);
    print_message("curves: at most %g of a pixel\n", found.largest_light);
    assert_true(found.largest_light > 1e-3); // points are left out
    assert_true(found.largest_light <= 0.1 * opacity);
}

// Zigzags of 2 to 12 points, whose strands lie one behind the other in memory, are drawn as one
// item and as several items: the images are equal, also by compute.
static void batches_are_drawn_as_one(void **state)
{
    (void)state;
    enum { SIZES = 3, EACH = 40 };
    static const uint32_t sizes[SIZES] = {2, 5, 12};
    size_t size;
    Strands all;
    RendererOptions options = SMALL;
    NEEDED(strands_create(&all, SIZES * EACH, EACH * (2 + 5 + 12), error));
    for (uint32_t s = 0, v = 0; s < SIZES * EACH; ++s)
        for (uint32_t j = 0; j < sizes[s % SIZES]; ++j, all.first[s + 1] = v) {
            float *x = all.position[v++];
            x[0] = -45 + 6.0f * (float)j + 0.3f * (float)s;
            x[1] = (float)(s * 37 % 60) - 30 + (j % 2 ? 1.0f : -1.0f);
            x[2] = 0.1f * (float)s;
        }
    studio_add(&studio, &all, 0.7f, 0.6f);
    assert_int_equal(studio.hair[0].batch_count, SIZES);
    Difference found = compare_with_blocks(&options, false);
    assert_true(found.largest <= 1.01);
    use_raster(&options, RASTER_BLOCKS);
    uint8_t *expected = draw_copy(&size);
    studio_clear(&studio);
    for (uint32_t k = 0; k < SIZES; ++k) {
        Strands some;
        NEEDED(strands_create(&some, EACH, EACH * sizes[k], error));
        for (uint32_t s = 0; s < EACH; ++s) {
            some.first[s + 1] = (s + 1) * sizes[k];
            memcpy(some.position[s * sizes[k]], all.position[all.first[s * SIZES + k]],
                   sizes[k] * sizeof *some.position);
        }
        studio_add(&studio, &some, 0.7f, 0.6f);
        strands_destroy(&some);
    }
    assert_draws_the_same(expected, size);
    free(expected);
    strands_destroy(&all);
}

// --- Lists.

typedef struct Pair {
    uint32_t depth, slot;
} Pair;

static int by_depth_and_slot(const void *a, const void *b)
{
    const Pair *x = a, *y = b;
    if (x->depth != y->depth) return x->depth < y->depth ? -1 : 1;
    return x->slot < y->slot ? -1 : x->slot > y->slot;
}

// Each list has as many ribbons as its count says, in order and each once. Returns the longest
// list's length.
static uint32_t check_lists(const ComputeBins *bins)
{
    uint32_t *counts = gpu_buffer_read(&bins->counts), *ends = gpu_buffer_read(&bins->ends),
             longest = 0;
    Pair *sorted = gpu_buffer_read(&bins->sorted);
    uint64_t all = 0;
    assert_true(counts && ends && sorted);
    for (int tile = 0; tile < bins->rows * bins->columns; ++tile) {
        if (counts[tile]) assert_true((int64_t)ends[tile] <= bins->room);
        for (uint32_t i = 1; i < counts[tile]; ++i) {
            const Pair *pair = &sorted[ends[tile] - counts[tile] + i];
            assert_true(by_depth_and_slot(pair - 1, pair) < 0);
            assert_int_not_equal(pair[-1].depth, 0); // 1/w is never infinite
        }
        all += counts[tile];
        if (counts[tile] > longest) longest = counts[tile];
    }
    assert_int_equal(all, studio.renderer.counts.fragments);
    free(counts);
    free(ends);
    free(sorted);
    return longest;
}

// --- Equal bytes.

static void lanes_of_either_form_draw_the_same_bytes(void **state)
{
    (void)state;
    const GpuSizes own = studio.gpu.limits.sizes;
    RendererOptions options = SMALL;
    add_hair();
    for (options.samples = 1; options.samples <= 4; options.samples += 3) {
        size_t size;
        studio.gpu.limits.sizes = GPU_SIZES[GPU_CPU_DRIVER];
        use(&options);
        add_mesh();
        uint8_t *expected = draw_copy(&size);
        studio.gpu.limits.sizes = GPU_SIZES[GPU_HARDWARE];
        use(&options);
        add_mesh();
        for (int run = 0; run < 2; ++run) assert_draws_the_same(expected, size);
        free(expected);
    }
    studio.gpu.limits.sizes = own;
}

static void lists_that_are_too_short_grow(void **state)
{
    (void)state;
    size_t size;
    use(&SMALL);
    add_hair();
    uint8_t *expected = draw_copy(&size);
    const RendererCounts *counts = &studio.renderer.counts;
    ComputeBins *bins = &stage_passes()->compute.bins;
    assert_int_equal(counts->redraws, 0);
    bins->room = (int64_t)counts->fragments - 1; // one less than needed
    assert_draws_the_same(expected, size);
    assert_int_equal(counts->redraws, 1);
    assert_true(bins->room >= (int64_t)counts->fragments);
    bins->room = (int64_t)counts->fragments;
    gpu_buffer_clear(&bins->pairs, 0);
    assert_draws_the_same(expected, size);
    assert_int_equal(counts->redraws, 0);
    check_lists(bins);
    // Each pair has 8 bytes, and is there twice: as it comes, and sorted.
    assert_true(counts->pool_bytes >= 2 * 8 * counts->fragments);
    free(expected);
}

static void bands_draw_the_same(void **state)
{
    (void)state;
    size_t size;
    RendererOptions options = SMALL;
    add_hair();
    options.samples = 2;
    use(&options);
    add_mesh();
    uint8_t *expected = draw_copy(&size);
    uint64_t pairs = studio.renderer.counts.fragments;
    assert_int_equal(studio.renderer.counts.bands, 1);
    options.pool_bytes = (int64_t)pairs * 16 / 2; // two lists of 8 bytes per pair
    use(&options);
    add_mesh();
    assert_draws_the_same(expected, size);
    assert_in_range(studio.renderer.counts.bands, 2, 5);
    assert_int_equal(studio.renderer.counts.fragments, pairs);
    assert_draws_the_same(expected, size);
    assert_int_equal(studio.renderer.counts.redraws, 0); // it starts with bands now
    free(expected);
}

// Draws and expects failure with this message.
static void assert_refuses(const char *message)
{
    View view;
    Error error = {{0}};
    studio_view(&view, SMALL.width, SMALL.height);
    const RenderFrame frame = {.view = &view, .head_rotation = {0, 0, 0, 1}};
    Result result =
        renderer_draw(&studio.renderer, &frame, studio.items, studio.count, &studio.image, &error);
    assert_int_equal(result, RESULT_FAILED);
    if (!strstr(error.text, message)) fail_msg("%s", error.text);
}

// The message names a rasteriser for such hair, and the next image is complete.
static void what_lists_cannot_hold_is_refused(void **state)
{
    (void)state;
    RendererOptions options = SMALL;
    size_t size;
    add_hair();
    options.pool_bytes = 64;
    use(&options);
    assert_refuses("a row of tiles has");
    assert_refuses("or --raster blocks, which has no limit");
    use(&SMALL);
    uint8_t *expected = draw_copy(&size);
    int longest = stage_passes()->compute.longest;
    stage_passes()->compute.longest = 20; // per tile
    assert_refuses("the limit of this driver's loops, or --raster blocks, which has no limit");
    stage_passes()->compute.longest = longest;
    assert_draws_the_same(expected, size);
    free(expected);
}

// --- Tiles.

// Lists as long as 1 to 9 runs of a CPU driver's lanes and several runs of a GPU's, with many equal
// entries.
static void lists_of_any_length_are_in_order(void **state)
{
    (void)state;
    static const uint32_t lengths[] = {1, 64, 65, 257, 576, 1500};
    const GpuSizes own = studio.gpu.limits.sizes;
    for (int kind = 0; kind < GPU_KINDS; ++kind) {
        studio.gpu.limits.sizes = GPU_SIZES[kind];
        use(&SMALL);
        for (size_t i = 0; i < sizeof lengths / sizeof *lengths; ++i) {
            Strands strands = crowd(lengths[i]);
            studio_add(&studio, &strands, 0.4f, 0.001f);
            studio_draw(&studio);
            assert_int_equal(check_lists(&stage_passes()->compute.bins), lengths[i]);
            strands_destroy(&strands);
            studio_clear(&studio);
        }
        add_tangle(3000, 0.7f, 0.6f, NULL);
        studio_draw(&studio);
        assert_true(check_lists(&stage_passes()->compute.bins) > 100);
        studio_clear(&studio);
    }
    studio.gpu.limits.sizes = own;
}

// Binning puts each ribbon into the list of every tile where blocks draw it. A ribbon's end is
// stored as a direction of 8 bits, up to 5 px from a pixel's middle, so coverage differs by up to
// sqrt(2) 2^-9 times that.
static void no_tile_of_a_ribbon_is_left_out(void **state)
{
    (void)state;
    for (int i = 0; i < 6; ++i) {
        float turn = 1.1f * (float)i, x = 49 * cosf(turn), y = 49 * sinf(turn);
        add_line((float[3]){-x, -y, 0}, (float[3]){x, y, 0}, 0.3f + 0.8f * (float)i, 1);
        RendererOptions options = SMALL;
        options.kind = IMAGE_FLOAT;
        Difference found = compare_with_blocks(&options, false);
        assert_true(found.largest_light <= 0.014);
        studio_clear(&studio);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        CLAIM(pictures_are_those_of_blocks),
        CLAIM(a_thicket_differs_by_what_is_left_out),
        CLAIM(batches_are_drawn_as_one),
        CLAIM(curves_are_straightened_alike),
        CLAIM(lanes_of_either_form_draw_the_same_bytes),
        CLAIM(lists_that_are_too_short_grow),
        CLAIM(bands_draw_the_same),
        CLAIM(what_lists_cannot_hold_is_refused),
        CLAIM(lists_of_any_length_are_in_order),
        CLAIM(no_tile_of_a_ribbon_is_left_out),
    };
    return stage_run_one(tests, RASTER_COMPUTE);
}
