// SPDX-License-Identifier: MIT
// Kinds of output: bit depths, samples, auxiliary images.
#include "support/stage.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const RendererOptions SMALL = {
    .width = 101, .height = 67, .background = {0.2f, 0.1f, 0.4f, 1}}; // px: no multiples of blocks

// Sets these options and a mesh that slopes through the hair.
static void use_with_mesh(const RendererOptions *options)
{
    const float green[3] = {0, 1, 0};
    Error error = {{0}};
    Mesh mesh = make_square(30);
    for (int v = 0; v < 4; ++v) {
        mesh.position[v][2] = 0.3f * mesh.position[v][0];
        mesh.position[v][0] += 0.2f * mesh.position[v][1];
    }
    use(options);
    assert_int_equal(renderer_set_mesh(&studio.renderer, &mesh, green, &error), RESULT_OK);
    mesh_destroy(&mesh);
}

// Curved strands, and a wide strand through the mesh.
static void add_hair(void)
{
    add_tangle(300, 0.7f, 0.6f, NULL);
    add_line((float[3]){-50, -35, -12}, (float[3]){50, 20, 12}, 7, 0.5f);
}

static Image take_image(void)
{
    size_t size;
    Image image = studio.image;
    image.pixels = studio_copy(&studio, &size);
    return image;
}

static size_t count_values(const Image *image)
{
    return (size_t)image->width * (size_t)image->height * (size_t)image->channels;
}

// Allows half a level for rounding and 0.012 for srgb_from_linear, on a GPU twice as much (an H200
// is 0.56 off).
static void every_kind_shows_the_same_picture(void **state)
{
    (void)state;
    add_hair();
    for (int samples = 1; samples <= 4; samples *= 2) {
        RendererOptions options = SMALL;
        options.samples = samples;
        use_with_mesh(&options);
        studio_draw(&studio);
        Image expected = take_image();
        for (options.kind = IMAGE_16; options.kind <= IMAGE_FLOAT; ++options.kind) {
            use_with_mesh(&options);
            studio_draw(&studio);
            for (size_t i = 0; i < count_values(&expected); ++i) {
                double shown = level_at(&studio.image, i);
                if (!(fabs(shown - expected.pixels[i]) <= 0.52 * studio_rounding(&studio)))
                    fail_msg("kind %d shows level %g instead of %d", (int)options.kind, shown,
                             expected.pixels[i]);
            }
        }
        image_destroy(&expected);
    }
}

// An image with s x s samples per pixel equals one of s times the size that is averaged in linear
// light. Blocks sum in 32-bit floats; quads' fragments have the same half floats in both.
static void check_samples(int side)
{
    View view;
    RendererOptions options = SMALL;
    options.kind = IMAGE_FLOAT;
    options.background[3] = 0.25f;
    studio_view(&view, options.width, options.height);
    options.samples = side;
    use_with_mesh(&options);
    studio_draw(&studio);
    Image mean = take_image();
    options.samples = 1;
    options.width *= side;
    options.height *= side;
    use_with_mesh(&options);
    studio_draw_view(&studio, &view);
    for (size_t i = 0; i < count_values(&mean); ++i) {
        size_t s = (size_t)side, channel = i % 4, x = i / 4 % (size_t)mean.width,
               y = i / 4 / (size_t)mean.width, row = 4 * s * (size_t)mean.width;
        double sum = 0;
        for (size_t k = 0; k < s * s; ++k)
            sum += (double)float_at(&studio.image,
                                    (y * s + k / s) * row + 4 * (x * s + k % s) + channel);
        assert_true(fabs((double)float_at(&mean, i) - sum / (double)(s * s)) <= 1e-6);
    }
    image_destroy(&mean);
}

static void samples_are_the_pixels_of_a_larger_picture(void **state)
{
    (void)state;
    add_hair();
    check_samples(2);
    check_samples(4);
}

static double linear_at(const Image *image, size_t i)
{
    return image_linear_from_srgb(level_at(image, i) / 255);
}

// Lays the transparent picture over an sRGB color, in linear light, and compares the result with
// the opaque picture. Both have 16 bits. Each of the picture's numbers is rounded by half a level
// and srgb_from_linear is off by 0.012 of 255 levels, which light takes up to 2.3 times; on a GPU
// twice as much.
static void compare_over(const Image *clear, const float color[3], const Image *opaque,
                         const char *name)
{
    const double rounding = studio_rounding(&studio) * (0.5 / 65535 + 0.012 / 255),
                 error = (2.3 + 1) * rounding;
    size_t pixels = (size_t)clear->width * (size_t)clear->height;
    int partial = 0;
    for (size_t i = 0; i < pixels; ++i) {
        double alpha = level_at(clear, 4 * i + 3) / 255;
        partial += alpha > 0.1 && alpha < 0.9;
        for (size_t k = 0; k < 3; ++k) {
            double over = alpha * linear_at(clear, 4 * i + k) +
                          (1 - alpha) * image_linear_from_srgb((double)color[k]),
                   least = image_srgb_from_linear(fmax(over - error, 0)) - rounding,
                   most = image_srgb_from_linear(fmin(over + error, 1)) + rounding,
                   shown = level_at(opaque, 3 * i + k) / 255;
            if (!(shown >= least && shown <= most))
                fail_msg("%s, pixel %zu, channel %zu: %g, expected %g to %g", name, i, k,
                         255 * shown, 255 * least, 255 * most);
        }
    }
    assert_true(partial > 500);
}

// A plain background lies behind what a transparent picture shows: hair, the edges of the mesh, a
// floor that fades out, and its shadow. The light is so strong that some hair is clipped at white.
static void a_plain_background_is_laid_under_the_transparent_picture(void **state)
{
    (void)state;
    static const float colors[][4] = {{1, 1, 1, 1}, {0.2f, 0.1f, 0.4f, 1}, {0, 0, 0, 1}};
    add_hair();
    studio.light.shadow = true;
    for (int i = 0; i < 4; ++i) {
        char name[64];
        RendererOptions options = SMALL;
        options.kind = IMAGE_16;
        options.tone = i % 2 ? TONE_FILMIC : TONE_REINHARD;
        options.samples = i < 3 ? 1 : 2;
        options.exposure = 3;
        options.floor = (Floor){.kind = (FloorKind)(i % 3),
                                .middle = {0, -20, 0},
                                .whole = 20,
                                .faded = 900,
                                .color = {1, 0.5f, 0.2f}};
        options.shadow = (ShadowOptions){.kind = SHADOW_DOM, .side = 64, .spacing = 200};
        memset(options.background, 0, sizeof options.background);
        use_with_mesh(&options);
        studio_draw(&studio);
        Image clear = take_image();
        memcpy(options.background, colors[i % 3], sizeof options.background);
        use_with_mesh(&options);
        studio_draw(&studio);
        snprintf(name, sizeof name, "tone %d, floor %d, %d samples", (int)options.tone,
                 (int)options.floor.kind, options.samples);
        compare_over(&clear, options.background, &studio.image, name);
        image_destroy(&clear);
    }
}

static void three_samples_are_refused(void **state)
{
    (void)state;
    Error error = {{0}};
    Renderer renderer;
    RendererOptions options = SMALL;
    options.raster = raster;
    options.samples = 3;
    assert_int_equal(renderer_create(&renderer, &studio.gpu, &studio.timer, &options, &error),
                     RESULT_USAGE);
    assert_non_null(strstr(error.text, "expected 1, 2 or 4"));
}

// Level of detail depends on the strand's size in the image, not on the number of samples.
static void samples_leave_the_number_of_strands(void **state)
{
    (void)state;
    uint64_t thinned[2];
    add_tangle(1000, 0.1f, 0.2f, NULL);
    for (int i = 0; i < 2; ++i) {
        RendererOptions options = SMALL;
        options.samples = i + 1;
        options.lod = (LodOptions){.width = 0.5f, .least = 0.01f};
        use(&options);
        studio_draw(&studio);
        thinned[i] = studio.renderer.counts.thinned;
    }
    assert_int_equal(thinned[0], thinned[1]);
    assert_true(thinned[0] > 0);
}

static void what_is_nearest_has_one_sample(void **state)
{
    (void)state;
    size_t size;
    add_hair();
    for (Aov aov = AOV_DEPTH; aov <= AOV_STRAND; ++aov) {
        RendererOptions options = SMALL;
        options.aov = aov;
        options.depth_range[0] = 900;
        options.depth_range[1] = 1100;
        use_with_mesh(&options);
        uint8_t *expected = draw_copy(&size);
        options.samples = 2;
        use_with_mesh(&options);
        assert_draws_the_same(expected, size);
        free(expected);
    }
}

// A square that faces the eye, 10 nearer than the middle, with one strand behind it and one next to
// it.
static void a_mesh_has_a_depth(void **state)
{
    (void)state;
    const float green[3] = {0, 1, 0};
    Error error = {{0}};
    RendererOptions options = SMALL;
    Mesh mesh = make_square(20);
    for (int v = 0; v < 4; ++v) mesh.position[v][2] = 10;
    options.aov = AOV_DEPTH;
    options.kind = IMAGE_FLOAT;
    add_line((float[3]){-40, 5, -30}, (float[3]){40, 5, -30}, 4, 1);
    use(&options);
    assert_int_equal(renderer_set_mesh(&studio.renderer, &mesh, green, &error), RESULT_OK);
    mesh_destroy(&mesh);
    studio_draw(&studio);
    const size_t row = (size_t)studio.image.width * (size_t)studio.image.channels,
                 middle = row * 33 + 50 * (size_t)studio.image.channels;
    assert_true(fabs(float_at(&studio.image, middle) - 990) < 0.5);
    assert_true(fabs(float_at(&studio.image, middle - 5 * row) - 990) < 0.5);
    assert_true(
        fabs(float_at(&studio.image, middle - 5 * row - 30 * (size_t)studio.image.channels) -
             1030) < 0.5);
    assert_true(float_at(&studio.image, middle - 25 * row) == 0);
}

// Draws by two rasterisers: the one under test, and blocks (or quads if it is blocks). Returns the
// share of values that differ by more than `tolerance`, among those that are not 0 in both.
static double share_that_differs(const RendererOptions *options, double tolerance)
{
    size_t touched = 0, different = 0;
    Raster first_raster = raster;
    use_with_mesh(options);
    studio_draw(&studio);
    Image first = take_image();
    raster = raster == RASTER_QUADS ? RASTER_BLOCKS : RASTER_QUADS;
    use_with_mesh(options);
    studio_draw(&studio);
    raster = first_raster;
    assert_int_not_equal(studio.renderer.options.raster, raster);
    for (size_t i = 0; i < count_values(&first); ++i) {
        bool floats = first.kind == IMAGE_FLOAT;
        double a = floats ? float_at(&first, i) : level_at(&first, i),
               b = floats ? float_at(&studio.image, i) : level_at(&studio.image, i);
        touched += a != 0 || b != 0;
        different += fabs(a - b) > tolerance;
    }
    image_destroy(&first);
    assert_true(touched > 1000);
    return (double)different / (double)touched;
}

// In a few pixels, rounding decides which strand covers a 512th of the pixel. All other pixels are
// equal: a hash to the byte, a tangent to one level, a depth to a thousandth, since straight pieces
// replace curves.
static void rasterisers_agree_on_what_is_nearest(void **state)
{
    (void)state;
    static const struct {
        Aov aov;
        ImageKind kind;
        double tolerance;
    } cases[] = {{AOV_STRAND, IMAGE_8, 0},
                 {AOV_STRAND, IMAGE_16, 0},
                 {AOV_TANGENT, IMAGE_8, 1},
                 {AOV_DEPTH, IMAGE_FLOAT, 1}};
    add_hair();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        RendererOptions options = SMALL;
        options.aov = cases[i].aov;
        options.kind = cases[i].kind;
        double share = share_that_differs(&options, cases[i].tolerance);
        print_message("aov %d: %.2f%% differ\n", (int)cases[i].aov, 100 * share);
        assert_true(share < 0.02);
    }
}

// Quads store half floats (11 bits) and sum the remaining layers in steps: one level, and half a
// level for rounding. Strands are straight, because each rasteriser may leave out other points of
// curves.
static void rasterisers_agree_on_coverage(void **state)
{
    (void)state;
    Strands strands = studio_tangle(7, SIDE, 300, 2, 90, 0, NULL);
    studio_add(&studio, &strands, 0.7f, 0.6f);
    strands_destroy(&strands);
    for (int samples = 1; samples <= 2; ++samples) {
        RendererOptions options = SMALL;
        options.aov = AOV_COVERAGE;
        options.samples = samples;
        double share = share_that_differs(&options, 1.5);
        print_message("%d samples: %.2f%% differ\n", samples, 100 * share);
        assert_true(share < 0.02);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        CLAIM(a_plain_background_is_laid_under_the_transparent_picture),
        CLAIM(every_kind_shows_the_same_picture),
        CLAIM(samples_are_the_pixels_of_a_larger_picture),
        CLAIM(three_samples_are_refused),
        CLAIM(samples_leave_the_number_of_strands),
        CLAIM(what_is_nearest_has_one_sample),
        CLAIM(rasterisers_agree_on_what_is_nearest),
        CLAIM(rasterisers_agree_on_coverage),
        CLAIM(a_mesh_has_a_depth),
    };
    return stage_run_all(tests);
}
