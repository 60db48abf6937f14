// SPDX-License-Identifier: MIT
#include "hair_fixture.h"
#include "random.h"
#include "render_uniforms.h"
#include "studio.h"

#include <dirent.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { SIDE = 256 };

static const RendererOptions TRANSPARENT = {.width = SIDE, .height = SIDE};
static const RendererOptions BLACK = {.width = SIDE, .height = SIDE, .background = {0, 0, 0, 1}};

static Raster raster; // every claim is made of each
static Studio studio; // one context for all tests; each leaves it without hair

static void open_with(const RendererOptions *options)
{
    RendererOptions mine = *options;
    mine.raster = raster;
    studio_open(&studio, &mine);
}

static int open_studio(void **state)
{
    (void)state;
    open_with(&TRANSPARENT);
    print_message("drawing %s with %s\n", raster == RASTER_QUADS ? "quads" : "blocks",
                  studio.gpu.renderer);
    return 0;
}

static int close_studio(void **state)
{
    (void)state;
    studio_close(&studio);
    return 0;
}

static int clear_studio(void **state)
{
    (void)state;
    studio_clear(&studio);
    studio.light = (Light){0};
    return 0;
}

static void use(const RendererOptions *options)
{
    RendererOptions mine = *options;
    mine.raster = raster;
    studio_set_options(&studio, &mine);
}

static uint32_t add_line(const float from[3], const float to[3], float radius, float opacity)
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

// Curved strands all over the picture and up to `depth` before and behind its plane. `order` gives
// the place of each strand, NULL: as they are made.
static void add_tangle(uint32_t count, float radius, float opacity, const uint32_t *order)
{
    enum { VERTICES = 12 };
    float(*position)[3] = malloc(count * VERTICES * sizeof *position);
    assert_non_null(position);
    Random random = random_create(7, 0);
    for (uint32_t s = 0; s < count; ++s) {
        double x[3], d[3], turn[3];
        for (int k = 0; k < 3; ++k) x[k] = (random_real(&random) - 0.5) * SIDE;
        random_direction(&random, d);
        random_direction(&random, turn);
        for (uint32_t j = 0; j < VERTICES; ++j)
            for (int k = 0; k < 3; ++k) {
                position[(order ? order[s] : s) * VERTICES + j][k] = (float)x[k];
                x[k] += 8 * d[k];
                d[k] += 0.2 * turn[k];
            }
    }
    Strands strands = studio_strands(count, VERTICES, (const float(*)[3])position);
    uint32_t item = studio_add(&studio, &strands, radius, opacity);
    studio.material[item].diffuse = 1; // colours that differ along every strand
    studio.material[item].ambient = 0.1f;
    studio.light = (Light){.direction = {0.6f, 0.8f, 0}, .color = {1, 0.8f, 0.5f}, .intensity = 1};
    strands_destroy(&strands);
    free(position);
}

static uint8_t *draw_copy(size_t *size)
{
    studio_draw(&studio);
    return studio_copy(&studio, size);
}

static void assert_draws_the_same(const uint8_t *expected, size_t size)
{
    studio_draw(&studio);
    assert_memory_equal(studio.image.pixels, expected, size);
}

static double alpha_sum(void)
{
    double sum = 0;
    for (int y = 0; y < SIDE; ++y)
        for (int x = 0; x < SIDE; ++x) sum += studio_pixel(&studio, x, y)[3] / 255.0;
    return sum;
}

// Rounding to 8 bits errs by up to 1/510 in each of the (width + 1.5) (length + 1) pixels that a
// strand touches, all alike where it runs along the rows. At its ends the pixels' middles decide,
// which can make it a pixel longer or shorter. At most angles both average out.
static void coverage_of_a_strand_is_its_area(void **state)
{
    (void)state;
    const float widths[] = {0.05f, 0.2f, 0.5f, 1, 2.3f, 5}, length = 180;
    use(&TRANSPARENT);
    for (size_t w = 0; w < sizeof widths / sizeof *widths; ++w) {
        double mean = 0, area = widths[w] * length,
               bound = (widths[w] + 1.5) * (length + 1) / 510 + widths[w];
        int angles = 0;
        for (float deg = 0; deg < 180; deg += 7.5f, ++angles) {
            float x = 0.5f * length * cosf(glm_rad(deg)), y = 0.5f * length * sinf(glm_rad(deg));
            float shift = 0.1f * (float)angles;
            add_line((float[3]){shift - x, -y, 0}, (float[3]){shift + x, y, 0}, widths[w] / 2, 1);
            studio_draw(&studio);
            double off = alpha_sum() - area;
            if (fabs(off) > bound)
                fail_msg("width %g px at %g degrees: area off by %g, bound %g", widths[w], deg, off,
                         bound);
            mean += off;
            studio_clear(&studio);
        }
        if (fabs(mean / angles) > 0.3 * bound)
            fail_msg("width %g px: area off by %g on average", widths[w], mean / angles);
    }
}

static double line_area(double deg, float distance, float radius, float length)
{
    float angle = glm_rad((float)deg), z = 1000 - distance;
    float x = 0.5f * length * cosf(angle), y = 0.5f * length * sinf(angle);
    add_line((float[3]){-x, -y, z}, (float[3]){x, y, z}, radius, 1);
    studio_draw(&studio);
    double sum = alpha_sum();
    studio_clear(&studio);
    return sum;
}

// What flickers in a slow turntable is coverage that depends on where the pixels lie. A strand of
// 90 px^2 in some 450 pixels, each rounded by 1/510 at most and by half of that on average, if to
// either side: 0.3 px^2 is more than ten standard deviations. Its ends add what their ramps of a
// pixel's length differ from its diagonal's: 2 ends x 0.5 px wide x 0.1.
static void coverage_is_steady_in_a_slow_turn(void **state)
{
    (void)state;
    use(&TRANSPARENT);
    double low = 1e9, high = 0;
    for (int i = 0; i <= 20; ++i) {
        double area = line_area(29.5 + 0.05 * i, 1000, 0.25f, 180);
        low = fmin(low, area);
        high = fmax(high, area);
    }
    assert_true(fabs(low - 90) < 0.4 && fabs(high - 90) < 0.4);
}

// The same strand from farther and farther off, down to 0.12 px: its area falls by the square of
// the distance. Every pixel is rounded to 1/255; to 0.12 of it that is 2 % at most, which evens
// out over the many pixels.
static void coverage_does_not_change_below_a_pixel(void **state)
{
    (void)state;
    use(&TRANSPARENT);
    for (double zoom = 1; zoom < 10; zoom *= 1.25) {
        double area = line_area(33, (float)(1000 * zoom), 0.5f, 220) * zoom * zoom;
        if (fabs(area - 220) > 0.015 * 220)
            fail_msg("%g times as far off: %g of 220 px^2", zoom, area);
    }
}

static void joints_are_covered_once(void **state)
{
    (void)state;
    enum { VERTICES = 17 };
    float position[VERTICES][3] = {{-90, 0, 0}}, angle = 0;
    for (int j = 1; j < VERTICES; ++j) { // bends of up to 60 degrees, to and fro
        angle += glm_rad(15) * (float)(j % 5) * (j % 2 ? 1 : -1);
        position[j][0] = position[j - 1][0] + 12 * cosf(angle);
        position[j][1] = position[j - 1][1] + 12 * sinf(angle);
    }
    use(&TRANSPARENT);
    Strands strands = studio_strands(1, VERTICES, (const float(*)[3])position);
    studio_add(&studio, &strands, 2.5f, 0.5f);
    strands_destroy(&strands);
    studio_draw(&studio);
    for (int y = 0; y < SIDE; ++y)
        for (int x = 0; x < SIDE; ++x) assert_true(studio_pixel(&studio, x, y)[3] <= 128);
    for (int j = 1; j < VERTICES; ++j)
        for (int i = 0; i <= 24; ++i) { // along the middle, at steps of half a pixel
            float t = (float)i / 24;
            if ((j == 1 && i < 4) || (j == VERTICES - 1 && i > 20)) continue; // ends
            float x = position[j - 1][0] * (1 - t) + position[j][0] * t + SIDE / 2;
            float y = SIDE / 2 - (position[j - 1][1] * (1 - t) + position[j][1] * t);
            assert_true(studio_pixel(&studio, (int)x, (int)y)[3] >= 127);
        }
}

static void layers_of_equal_opacity_multiply(void **state)
{
    (void)state;
    enum { MOST = 8 };
    use(&TRANSPARENT);
    for (int n = 1; n <= MOST; ++n) {
        float position[MOST][2][3];
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < 2; ++j)
                memcpy(position[i][j], (float[3]){j ? 60 : -60, 0, (float)i}, sizeof(float[3]));
        Strands strands = studio_strands((uint32_t)n, 2, (const float(*)[3])position);
        studio_add(&studio, &strands, 6, 0.3f);
        strands_destroy(&strands);
        studio_draw(&studio);
        double expected = 255 * (1 - pow(0.7, n));
        assert_true(fabs(studio_pixel(&studio, SIDE / 2, SIDE / 2)[3] - expected) <= 0.6);
        studio_clear(&studio);
    }
}

// 30 layers: 8 in order, the rest in sums whose steps are far below one of 255.
static void many_layers_still_multiply(void **state)
{
    (void)state;
    enum { COUNT = 30 };
    float position[COUNT][2][3];
    for (int i = 0; i < COUNT; ++i)
        for (int j = 0; j < 2; ++j)
            memcpy(position[i][j], (float[3]){j ? 60 : -60, 0, (float)i}, sizeof(float[3]));
    use(&TRANSPARENT);
    Strands strands = studio_strands(COUNT, 2, (const float(*)[3])position);
    studio_add(&studio, &strands, 6, 0.05f);
    strands_destroy(&strands);
    studio_draw(&studio);
    assert_true(fabs(studio_pixel(&studio, SIDE / 2, SIDE / 2)[3] - 255 * (1 - pow(0.95, COUNT))) <=
                1.0);
}

static double srgb(double linear)
{
    return 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055);
}

static void add_band(float z, float red, float green)
{
    uint32_t i = add_line((float[3]){-60, 0, z}, (float[3]){60, 0, z}, 6, 0.6f);
    memcpy(studio.material[i].color, (float[3]){red, green, 0}, sizeof(float[3]));
}

static void the_nearer_strand_is_in_front(void **state)
{
    (void)state;
    use(&BLACK);
    for (int order = 0; order < 4; ++order) { // which is added first, which is nearer
        bool red_first = order & 1, red_near = order & 2;
        float red_z = red_near ? 1 : -1;
        add_band(red_first ? red_z : -red_z, red_first, !red_first);
        add_band(red_first ? -red_z : red_z, !red_first, red_first);
        studio_draw(&studio);
        const uint8_t *pixel = studio_pixel(&studio, SIDE / 2, SIDE / 2);
        assert_true(fabs(pixel[red_near ? 0 : 1] - srgb(0.6)) <= 1);
        assert_true(fabs(pixel[red_near ? 1 : 0] - srgb(0.4 * 0.6)) <= 1);
        assert_int_equal(pixel[2], 0);
        studio_clear(&studio);
    }
}

static void order_of_strands_does_not_matter(void **state)
{
    (void)state;
    enum { COUNT = 1500 }; // up to 40 layers
    uint32_t order[COUNT];
    size_t size;
    Random random = random_create(3, 1);
    random_permutation(&random, order, COUNT);
    use(&BLACK);
    add_tangle(COUNT, 2, 0.4f, NULL);
    uint8_t *expected = draw_copy(&size);
    assert_draws_the_same(expected, size);
    studio_clear(&studio);
    add_tangle(COUNT, 2, 0.4f, order);
    assert_draws_the_same(expected, size);
    free(expected);
}

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
    small.pool_bytes = 1 << 17;
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
    small.pool_bytes = 1 << 17;
    size_t size;
    use(&small);
    add_tangle(1500, 2, 0.4f, NULL);
    uint8_t *first = draw_copy(&size);
    assert_draws_the_same(first, size);
    free(first);
    const RendererCounts *counts = &studio.renderer.counts;
    uint64_t node_bytes = raster == RASTER_QUADS ? 16 : 8;
    uint64_t least = counts->fragments * node_bytes / (uint64_t)small.pool_bytes + 1;
    assert_in_range(counts->bands, least, 3 * least);
    assert_int_equal(counts->pool_bytes, small.pool_bytes);
}

// Its pixels are all of one 8x8 block, so of one shard.
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
    if (raster == RASTER_QUADS) assert_true(studio.renderer.counts.fragments > 4096);
    assert_int_equal(studio.renderer.counts.bands, 1);
}

// 60,000 glaring strands in one pixel: sums over them do not fit 32 bits.
static void thousands_of_layers_are_still_white(void **state)
{
    (void)state;
    enum { COUNT = 60000 };
    RendererOptions pixel = BLACK;
    pixel.width = pixel.height = 1;
    use(&pixel);
    float(*position)[3] = malloc(COUNT * 2 * sizeof *position);
    assert_non_null(position);
    for (int i = 0; i < 2 * COUNT; ++i)
        for (int k = 0; k < 3; ++k) position[i][k] = k ? 0 : i % 2 ? 4 : -4;
    Strands strands = studio_strands(COUNT, 2, (const float(*)[3])position);
    uint32_t item = studio_add(&studio, &strands, 4, 1);
    studio.material[item].ambient = 8;
    studio_draw(&studio);
    assert_int_equal(studio.renderer.counts.fragments, COUNT);
    for (int k = 0; k < 3; ++k) assert_int_equal(studio.image.pixels[k], 255);
    strands_destroy(&strands);
    free(position);
}

// CPU drivers end loops silently after 65,535 turns: no picture is made without a word.
static void more_layers_than_a_loop_can_visit_are_an_error(void **state)
{
    (void)state;
    enum { COUNT = 66000 };
    if (!studio.gpu.software) skip();
    RendererOptions pixel = BLACK;
    pixel.width = pixel.height = 1;
    use(&pixel);
    float(*position)[3] = malloc(COUNT * 2 * sizeof *position);
    assert_non_null(position);
    for (int i = 0; i < 2 * COUNT; ++i)
        for (int k = 0; k < 3; ++k) position[i][k] = k ? 0 : i % 2 ? 4 : -4;
    Strands strands = studio_strands(COUNT, 2, (const float(*)[3])position);
    studio_add(&studio, &strands, 0.4f, 0.001f); // nothing that blocks could leave out
    View view;
    Error error = {{0}};
    studio_view(&view, 1, 1);
    RenderFrame frame = {.view = &view, .head_rotation = {0, 0, 0, 1}};
    assert_int_equal(
        renderer_draw(&studio.renderer, &frame, studio.items, studio.count, &studio.image, &error),
        RESULT_FAILED);
    assert_non_null(strstr(error.text, "a pixel has more than"));
    strands_destroy(&strands);
    free(position);
}

// Seen from far off hundreds of particles share a pixel.
static void hair_smaller_than_a_pixel_leaves_no_holes(void **state)
{
    (void)state;
    RendererOptions options = BLACK;
    options.width = options.height = 2;
    for (int k = 0; k < 3; ++k) options.background[k] = 1;
    use(&options);
    float(*position)[3] = malloc(2000 * 32 * sizeof *position);
    assert_non_null(position);
    Random random = random_create(3, 0);
    for (int i = 0; i < 2000 * 32; ++i) {
        double d[3];
        random_direction(&random, d);
        for (int k = 0; k < 3; ++k)
            position[i][k] = (float)(1.5 * d[k]) + (i % 32 ? position[i - 1][k] / 2 : 0);
    }
    Strands strands = studio_strands(2000, 32, (const float(*)[3])position);
    uint32_t item = studio_add(&studio, &strands, 0.2f, 1);
    studio.material[item].opacity = 0; // so that only what is wrong is seen
    studio_draw(&studio);
    assert_int_equal(studio.renderer.counts.fragments, 0);
    for (int i = 0; i < 2 * 2 * 3; ++i) assert_int_equal(studio.image.pixels[i], 255);
    strands_destroy(&strands);
    free(position);
}

static void a_row_that_no_pool_holds_is_an_error(void **state)
{
    (void)state;
    RendererOptions tiny = BLACK;
    tiny.pool_bytes = 1; // the least there can be
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

// In the plane z = 0, `half` px to each side.
static Mesh make_square(float half)
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

static void mesh_hides_the_hair_behind_it_only(void **state)
{
    (void)state;
    Error error = {{0}};
    Mesh mesh = make_square(50);
    use(&BLACK);
    const float green[3] = {0, 1, 0};
    assert_int_equal(renderer_set_mesh(&studio.renderer, &mesh, green, &error), RESULT_OK);
    mesh_destroy(&mesh);
    add_line((float[3]){-90, 20, 10}, (float[3]){90, 20, 10}, 3, 1);     // before it
    add_line((float[3]){-90, -20, -10}, (float[3]){90, -20, -10}, 3, 1); // behind it
    studio_draw(&studio);
    assert_int_equal(studio_pixel(&studio, SIDE / 2, SIDE / 2 - 20)[0], 255);
    assert_int_equal(studio_pixel(&studio, SIDE / 2, SIDE / 2 + 20)[0], 0);
    assert_true(studio_pixel(&studio, SIDE / 2, SIDE / 2 + 20)[1] > 50); // lit by what is ambient
    assert_int_equal(studio_pixel(&studio, SIDE / 2 + 70, SIDE / 2 + 20)[0], 255);
    assert_int_equal(studio_pixel(&studio, 5, 5)[1], 0);
}

// Two strands 2 px before and behind a mesh that slopes away from the eye, by 1 px a pixel: depths
// must be right in every pixel, not on the average of some.
static void hair_close_to_a_sloping_mesh_is_all_seen_or_all_hidden(void **state)
{
    (void)state;
    Error error = {{0}};
    Mesh mesh = make_square(50);
    for (int v = 0; v < 4; ++v) mesh.position[v][2] = mesh.position[v][0];
    use(&BLACK);
    const float green[3] = {0, 1, 0};
    assert_int_equal(renderer_set_mesh(&studio.renderer, &mesh, green, &error), RESULT_OK);
    mesh_destroy(&mesh);
    add_line((float[3]){-40, 20, -38}, (float[3]){40, 20, 42}, 3, 1);
    add_line((float[3]){-40, -20, -42}, (float[3]){40, -20, 38}, 3, 1);
    studio_draw(&studio);
    for (int x = -30; x <= 30; ++x) {
        assert_int_equal(studio_pixel(&studio, SIDE / 2 + x, SIDE / 2 - 20)[0], 255);
        assert_int_equal(studio_pixel(&studio, SIDE / 2 + x, SIDE / 2 + 20)[0], 0);
    }
}

// A white strand along x that only the light shows, and what its middle looks like, 0..1.
static double light_strand(const Light *light)
{
    studio.light = *light;
    uint32_t i = add_line((float[3]){-60, 0, 0}, (float[3]){60, 0, 0}, 6, 1);
    studio.material[i].ambient = 0;
    studio.material[i].diffuse = 1;
    studio_draw(&studio);
    studio_clear(&studio);
    double level = studio_pixel(&studio, SIDE / 2, SIDE / 2)[0] / 255.0;
    return level <= 0.04045 ? level / 12.92 : pow((level + 0.055) / 1.055, 2.4);
}

// One level of 255 is up to 0.009 of the light there.
static void light_falls_off_by_the_square_of_the_distance(void **state)
{
    (void)state;
    use(&BLACK);
    Light light = {.kind = LIGHT_POINT,
                   .color = {1, 1, 1},
                   .intensity = 0.8f,
                   .position = {0, 300, 400},
                   .distance = 500};
    assert_true(fabs(light_strand(&light) - 0.8) < 0.01);
    light.distance = 250;
    assert_true(fabs(light_strand(&light) - 0.2) < 0.01);
    light.position[0] = 1e6f; // along the strand, and far away
    assert_true(light_strand(&light) < 0.001);
}

// Full up to the inner angle, half as much (squared) half-way by cosine, nothing beyond. The next
// vertices, 30 px off, are darker, and a block shows its middle, up to 2 px off: a fifteenth.
static void a_spot_shines_into_its_cone(void **state)
{
    (void)state;
    use(&BLACK);
    const double angles_deg[] = {0, 19.5, 30.5, 46},
                 half = (cos(glm_rad(20)) + cos(glm_rad(30))) / 2;
    const double expected[] = {0.8, 0.8, 0, 0, 0.2};
    for (int i = 0; i < 5; ++i) {
        double a = i < 4 ? angles_deg[i] * acos(-1) / 180 : acos(half);
        Light spot = {.kind = LIGHT_SPOT,
                      .color = {1, 1, 1},
                      .intensity = 0.8f,
                      .position = {0, 0, 100},
                      .distance = 100,
                      .direction = {0, (float)sin(a), (float)-cos(a)},
                      .inner_deg = 20,
                      .outer_deg = 30};
        assert_true(fabs(light_strand(&spot) - expected[i]) < 0.01 + expected[i] / 15);
    }
}

// The strand stands 60 px before the square, in light that comes 37 degrees from the right: its
// shadow falls 45 px to its left. What the light brings there is less by the strand's opacity.
static void a_strand_throws_its_shadow_on_the_mesh(void **state)
{
    (void)state;
    RendererOptions options = BLACK;
    options.shadow = (ShadowOptions){SHADOW_DOM, 256, 200};
    Error error = {{0}};
    const float white[3] = {1, 1, 1};
    Mesh mesh = make_square(100);
    use(&options);
    assert_int_equal(renderer_set_mesh(&studio.renderer, &mesh, white, &error), RESULT_OK);
    mesh_destroy(&mesh);
    uint32_t item = add_line((float[3]){20, -60, 60}, (float[3]){20, 60, 60}, 6, 1);
    studio.material[item].shadow_opacity = 0.8f;
    studio.light = (Light){.direction = {0.6f, 0, 0.8f}, .color = {1, 1, 1}, .intensity = 0.5f};
    const double ambient = 0.15, light = 0.5 * 0.8; // as in renderer.c; times the cosine
    for (int shadow = 0; shadow < 2; ++shadow) {
        studio.light.shadow = shadow;
        studio_draw(&studio);
        double there = ambient + light * (shadow ? 0.2 : 1);
        assert_int_equal(studio.renderer.counts.shadow_maps, shadow);
        assert_true(fabs(studio_pixel(&studio, SIDE / 2 - 25, SIDE / 2)[0] - srgb(there)) <= 4);
        assert_true(
            fabs(studio_pixel(&studio, SIDE / 2 - 50, SIDE / 2)[0] - srgb(ambient + light)) <= 1);
    }
}

// Options by which the studio's hair, 1000 from the eye, is drawn by this share of its strands.
static void use_share(const RendererOptions *options, float share)
{
    RendererOptions mine = *options;
    mine.lod = (LodOptions){.end = 2000, .least = 2 * share - 1};
    use(&mine);
}

// Strands much thinner than a pixel seldom overlap: what they cover adds up. The sum over n random
// strands of different lengths in the picture varies by about 1/sqrt(n) of itself.
static void fewer_strands_cover_as_much(void **state)
{
    (void)state;
    enum { COUNT = 4000 };
    double all = 0;
    add_tangle(COUNT, 0.05f, 0.2f, NULL);
    for (float share = 1; share > 0.51f; share -= 0.08f) {
        use_share(&TRANSPARENT, share);
        studio_draw(&studio);
        double sum = alpha_sum();
        if (share == 1) all = sum;
        if (fabs(sum / all - 1) > 0.02) fail_msg("share %g: %g, of all %g", share, sum, all);
        double left_out = COUNT * (1 - (double)share);
        assert_true(fabs((double)studio.renderer.counts.thinned - left_out) <=
                    0.01 * COUNT); // by where their middle is
    }
}

// From share to share a strand's width changes by a tenth of it, and so does no pixel by more than
// a tenth of an opaque one, and some for the others' widths. Strands that came or went at once
// would change pixels by six tenths.
static void strands_neither_come_nor_go_at_once(void **state)
{
    (void)state;
    enum { COUNT = 50 };
    add_tangle(COUNT, 0.4f, 0.6f, NULL);
    uint8_t *before = NULL;
    size_t size;
    for (int i = 0; i <= 40; ++i) {
        use_share(&TRANSPARENT, 1 - 0.1f * (float)i / COUNT);
        uint8_t *now = draw_copy(&size);
        for (size_t k = 3; before && k < size; k += 4)
            assert_true(abs(now[k] - before[k]) <= 0.15 * 255);
        free(before);
        before = now;
    }
    free(before);
}

// Narrower fibres are so many fewer that they are as wide as was asked for.
static void fibres_are_as_wide_as_asked_for(void **state)
{
    (void)state;
    RendererOptions options = TRANSPARENT;
    options.lod = (LodOptions){.width = 0.5f, .least = 0.01f};
    use(&options);
    add_tangle(1000, 0.1f, 0.2f, NULL); // 0.2 px wide
    studio_draw(&studio);
    assert_in_range(studio.renderer.counts.thinned, 590,
                    610); // their middle is not quite 1000 away
}

// The definitions, by other ways than the shader's: Barry's and Goldman's pyramid of the
// centripetal Catmull-Rom spline, and de Boor's of the uniform cubic B-spline, whose knots are 1
// apart.
static double interpolate(double a, double b, double from, double to, double t)
{
    return ((to - t) * a + (t - from) * b) / (to - from);
}

static void curve_at(CurveKind kind, const double p[4][3], double share, float point[3])
{
    double knot[6] = {0};
    for (int i = 1; i < 4; ++i) {
        double square = 0;
        for (int k = 0; k < 3; ++k) square += pow(p[i][k] - p[i - 1][k], 2);
        knot[i] = knot[i - 1] + pow(square, 0.25);
    }
    for (int k = 0; k < 3; ++k) {
        double x[4] = {p[0][k], p[1][k], p[2][k], p[3][k]};
        if (kind == CURVE_CATMULL_ROM) {
            double t = knot[1] + share * (knot[2] - knot[1]);
            for (int i = 0; i < 3; ++i) x[i] = interpolate(x[i], x[i + 1], knot[i], knot[i + 1], t);
            for (int i = 0; i < 2; ++i) x[i] = interpolate(x[i], x[i + 1], knot[i], knot[i + 2], t);
            point[k] = (float)interpolate(x[0], x[1], knot[1], knot[2], t);
        } else {
            double t = 2 + share; // of the knots 0 .. 5 that the four points have
            for (int level = 1; level < 4; ++level)
                for (int i = 0; i < 4 - level; ++i)
                    x[i] = interpolate(x[i], x[i + 1], i + level - 1, i + 3, t);
            point[k] = (float)x[0];
        }
    }
}

static Strands make_curve(CurveKind kind, const Strands *from, uint32_t parts)
{
    uint32_t n = strands_size(from, 0), many = (n - 1) * parts + 1;
    float(*position)[3] = malloc((size_t)from->strand_count * many * sizeof *position);
    assert_non_null(position);
    for (uint32_t s = 0; s < from->strand_count; ++s)
        for (uint32_t i = 0; i < many; ++i) {
            uint32_t j = i / parts < n - 1 ? i / parts : n - 2;
            double p[4][3];
            for (int k = 0; k < 3; ++k) {
                for (int at = 0; at < 4; ++at) {
                    int64_t which = (int64_t)j - 1 + at;
                    if (which < 0 || which >= n) continue;
                    p[at][k] = (double)from->position[s * n + (uint32_t)which][k];
                }
                if (j == 0) p[0][k] = 2 * p[1][k] - p[2][k];
                if (j == n - 2) p[3][k] = 2 * p[2][k] - p[1][k];
            }
            curve_at(kind, (const double(*)[3])p, (double)(i - j * parts) / parts,
                     position[s * many + i]);
        }
    Strands strands = studio_strands(from->strand_count, many, (const float(*)[3])position);
    free(position);
    return strands;
}

// A curve found in floats lies within 1e-4 px of that found in doubles, so that the pictures are
// alike but for rounding and for the particles that are left out where it is nearly straight, which
// differ where that hangs by a hair: those lie within 0.05 px.
static void smooth_strands_are_curves(void **state)
{
    (void)state;
    enum { COUNT = 20, VERTICES = 7, PARTS = 5 };
    float position[COUNT * VERTICES][3];
    Random random = random_create(11, 0);
    for (int s = 0; s < COUNT; ++s)
        for (int j = 0; j < VERTICES; ++j)
            for (int k = 0; k < 3; ++k)
                position[s * VERTICES + j][k] =
                    (float)((random_real(&random) - 0.5) * (k < 2 ? 200 : 20));
    Strands strands = studio_strands(COUNT, VERTICES, (const float(*)[3])position);
    use(&TRANSPARENT);
    for (CurveKind kind = CURVE_CATMULL_ROM; kind <= CURVE_BSPLINE; ++kind) {
        Strands curves = make_curve(kind, &strands, PARTS);
        size_t size;
        uint32_t item = studio_add(&studio, &curves, 1.5f, 0.5f);
        studio.material[item].tip_ratio = 0.2f;
        uint8_t *expected = draw_copy(&size);
        studio_clear(&studio);
        item = studio_add(&studio, &strands, 1.5f, 0.5f);
        studio.material[item].tip_ratio = 0.2f;
        studio.material[item].curve = kind;
        studio_draw(&studio);
        double straight = 0, off = 0;
        for (size_t i = 3; i < size; i += 4)
            straight += pow((double)studio.image.pixels[i] - expected[i], 2);
        studio.material[item].smooth = PARTS;
        studio_draw(&studio);
        for (size_t i = 3; i < size; i += 4) {
            if (abs(studio.image.pixels[i] - expected[i]) > 12)
                print_message("%d %d\n", studio.image.pixels[i], expected[i]);
            off += pow((double)studio.image.pixels[i] - expected[i], 2);
        }
        assert_true(off < 1e-3 * straight);
        studio_clear(&studio);
        free(expected);
        strands_destroy(&curves);
    }
    strands_destroy(&strands);
}

static void no_hair_is_background(void **state)
{
    (void)state;
    const RendererOptions colored = {
        .width = 40, .height = 30, .background = {32 / 255.0f, 100 / 255.0f, 200 / 255.0f, 1}};
    use(&colored);
    studio_draw(&studio);
    for (int i = 0; i < 40 * 30; ++i) {
        const uint8_t expected[3] = {32, 100, 200};
        assert_memory_equal(&studio.image.pixels[3 * i], expected, 3);
    }
}

// Where hair's box begins must not be seen: the background comes out of the resolve as it went in.
static void background_is_exact_beside_hair(void **state)
{
    (void)state;
    for (int level = 0; level < 256; ++level) {
        float value = (float)level / 255;
        const RendererOptions grey = {
            .width = 32, .height = 32, .background = {value, value, value, 1}};
        use(&grey);
        add_line((float[3]){-10, -10, 0}, (float[3]){10, 10, 0}, 0.5f, 1);
        studio_draw(&studio);
        assert_int_equal(studio_pixel(&studio, 9, 9)[1], level);
        studio_clear(&studio);
    }
}

static void a_strand_towards_the_eye_is_harmless(void **state)
{
    (void)state;
    use(&TRANSPARENT);
    add_line((float[3]){0, 0, -100}, (float[3]){0, 0, 100}, 3, 1);
    add_line((float[3]){40, 40, 0}, (float[3]){40, 40, 0}, 3, 1); // no length at all
    studio_draw(&studio);
    for (int y = 0; y < SIDE; ++y)
        for (int x = 0; x < SIDE; ++x)
            if (abs(x - SIDE / 2) > 5 || abs(y - SIDE / 2) > 5)
                assert_int_equal(studio_pixel(&studio, x, y)[3], 0);
}

// Solvers promise finite positions; if one breaks its word, the rest of the picture stands.
static void broken_positions_harm_no_other_strand(void **state)
{
    (void)state;
    const float values[] = {NAN, INFINITY, -INFINITY, 1e30f, -3e38f};
    use(&TRANSPARENT);
    for (size_t i = 0; i < sizeof values / sizeof *values; ++i)
        for (int axis = 0; axis < 3; ++axis) {
            float position[2][4][3] = {0};
            for (int j = 0; j < 4; ++j) {
                position[0][j][0] = position[1][j][0] = (float)(30 * j - 45);
                position[1][j][1] = 40;
            }
            position[0][2][axis] = values[i];
            Strands strands = studio_strands(2, 4, (const float(*)[3])position);
            studio_add(&studio, &strands, 3, 1);
            strands_destroy(&strands);
            studio_draw(&studio);
            assert_int_equal(studio_pixel(&studio, SIDE / 2, SIDE / 2 - 40)[3], 255);
            studio_clear(&studio);
        }
}

static void a_strand_past_the_eye_is_drawn_up_to_it(void **state)
{
    (void)state;
    use(&TRANSPARENT);
    add_line((float[3]){20, 0, 0}, (float[3]){20, 0, 3000}, 3, 1);
    add_line((float[3]){-20, 0, 3000}, (float[3]){-20, 0, 0}, 3, 1);    // the other way round
    add_line((float[3]){0, -30, 1500}, (float[3]){0, -30, 3000}, 3, 1); // behind the eye
    studio_draw(&studio);
    for (int x = 22; x < SIDE / 2; ++x) {
        assert_true(studio_pixel(&studio, SIDE / 2 + x, SIDE / 2)[3] >= 250);
        assert_true(studio_pixel(&studio, SIDE / 2 - x, SIDE / 2)[3] >= 250);
    }
    for (int x = -15; x < 15; ++x)
        for (int y = 0; y < SIDE; ++y)
            assert_int_equal(studio_pixel(&studio, SIDE / 2 + x, y)[3], 0);
}

static void transparent_pictures_have_straight_alpha(void **state)
{
    (void)state;
    use(&TRANSPARENT);
    uint32_t i = add_line((float[3]){-60, 0, 0}, (float[3]){60, 0, 0}, 4, 0.5f);
    memcpy(studio.material[i].color, (float[3]){1, 0.5f, 0}, sizeof(float[3]));
    studio_draw(&studio);
    const uint8_t *inside = studio_pixel(&studio, SIDE / 2, SIDE / 2),
                  *edge = studio_pixel(&studio, SIDE / 2, SIDE / 2 + 4),
                  *outside = studio_pixel(&studio, SIDE / 2, 10);
    assert_int_equal(inside[3], 128);
    assert_true(edge[3] < 30 && outside[3] == 0);
    assert_int_equal(inside[0], 255);
    assert_true(abs(inside[1] - 128) <= 1);
}

static void hair_outside_the_picture_costs_nothing(void **state)
{
    (void)state;
    use(&TRANSPARENT);
    add_line((float[3]){-60, 900, 0}, (float[3]){60, 900, 0}, 4, 0.5f);
    studio_draw(&studio);
    assert_int_equal(studio.renderer.counts.fragments, 0);
    assert_int_equal(studio.renderer.counts.culled, 1);
    assert_int_equal(studio.renderer.counts.segments, 0);
}

static int count_driver_threads(void)
{
    int count = 0;
    DIR *tasks = opendir("/proc/self/task");
    for (struct dirent *task; tasks && (task = readdir(tasks));) {
        char path[300], name[64] = "";
        snprintf(path, sizeof path, "/proc/self/task/%s/comm", task->d_name);
        FILE *file = fopen(path, "r");
        if (!file) continue;
        if (fgets(name, sizeof name, file) && strncmp(name, "llvmpipe", 8) == 0) ++count;
        fclose(file);
    }
    if (tasks) closedir(tasks);
    return count;
}

static void bytes_do_not_depend_on_driver_threads(void **state)
{
    (void)state;
    const char *counts[] = {"0", "1", "2"};
    uint8_t *expected = NULL;
    size_t size;
    if (!studio.gpu.software) print_message("not a CPU driver: compares three runs only\n");
    studio_close(&studio);
    for (int i = 0; i < 3; ++i) {
        setenv("LP_NUM_THREADS", counts[i], 1);
        open_with(&BLACK);
        add_tangle(1500, 2, 0.4f, NULL);
        studio_draw(&studio);
        if (strstr(studio.gpu.renderer, "llvmpipe")) // rasteriser's, and compute's beside them
            assert_true(count_driver_threads() >= i && (i > 0 || count_driver_threads() == 0));
        if (expected) assert_memory_equal(studio.image.pixels, expected, size);
        if (!expected) expected = studio_copy(&studio, &size);
        studio_close(&studio);
    }
    unsetenv("LP_NUM_THREADS");
    free(expected);
    open_with(&TRANSPARENT);
}

static void blocks_lie_alike_in_c_and_glsl(void **state)
{
    (void)state;
    Error error = {{0}};
    LookPrograms *programs =
        raster == RASTER_QUADS ? &studio.renderer.hair.project : &studio.renderer.blocks.project;
    unsigned all = LOOK_SHADED - 1; // every member is in use
    assert_int_equal(look_programs_build(programs, all, &error), RESULT_OK);
    GLuint program = programs->program[all];
#define DRAW(field)                                                                                \
    fixture_assert_offset(program, "DrawParams." #field, offsetof(DrawParams, field))
#define DRAW_ARRAY(field)                                                                          \
    fixture_assert_offset(program, "DrawParams." #field "[0]", offsetof(DrawParams, field))
#define MATERIAL(field)                                                                            \
    fixture_assert_offset(program, "MaterialParams." #field, offsetof(MaterialParams, field))
    DRAW(clip_from_world), DRAW(eye), DRAW_ARRAY(light_place), DRAW_ARRAY(light_color);
    DRAW_ARRAY(light_axis), DRAW_ARRAY(light_cone), DRAW(sky), DRAW(ground);
    DRAW(background), DRAW(head_rotation), DRAW(head_translation), DRAW(mesh_color);
    DRAW(width), DRAW(height), DRAW(focal), DRAW(near_distance), DRAW(depth), DRAW(depth_range);
    DRAW(band);
    DRAW(light_count), DRAW(seed), DRAW(shards);
    MATERIAL(color), MATERIAL(color_variation), MATERIAL(warmth_variation), MATERIAL(radius),
        MATERIAL(tip_ratio);
    MATERIAL(opacity), MATERIAL(shadow_opacity), MATERIAL(ambient), MATERIAL(diffuse),
        MATERIAL(specular1);
    MATERIAL(exponent1), MATERIAL(specular2), MATERIAL(exponent2), MATERIAL(shift1_cos);
    MATERIAL(shift1_sin), MATERIAL(shift2_cos), MATERIAL(shift2_sin);
    MATERIAL(lobe_sharpness), MATERIAL(lobe_scale), MATERIAL(lobe_tilt_cos);
    MATERIAL(lobe_tilt_sin), MATERIAL(vertex_count), MATERIAL(first_strand), MATERIAL(smooth_parts),
        MATERIAL(smooth_curve), MATERIAL(last_strand), MATERIAL(last_share),
        MATERIAL(drawn_strands);
}

static void a_picture_beyond_the_driver_is_refused(void **state)
{
    (void)state;
    Error error = {{0}};
    Renderer renderer;
    RendererOptions huge = {.width = studio.gpu.limits.framebuffer_side_px + 1, .height = 16};
    assert_int_equal(renderer_create(&renderer, &studio.gpu, &studio.timer, &huge, &error),
                     RESULT_FAILED);
    assert_non_null(strstr(error.text, "at most"));
    renderer_destroy(&renderer);
}

int main(void)
{
#define CLAIM(name) cmocka_unit_test_teardown(name, clear_studio)
    const struct CMUnitTest tests[] = {
        CLAIM(coverage_of_a_strand_is_its_area),
        CLAIM(coverage_is_steady_in_a_slow_turn),
        CLAIM(coverage_does_not_change_below_a_pixel),
        CLAIM(joints_are_covered_once),
        CLAIM(layers_of_equal_opacity_multiply),
        CLAIM(many_layers_still_multiply),
        CLAIM(the_nearer_strand_is_in_front),
        CLAIM(order_of_strands_does_not_matter),
        CLAIM(a_pool_that_is_too_small_grows),
        CLAIM(bands_give_the_same_picture),
        CLAIM(bands_are_no_more_than_the_pool_asks_for),
        CLAIM(a_small_picture_uses_the_whole_pool),
        CLAIM(thousands_of_layers_are_still_white),
        CLAIM(more_layers_than_a_loop_can_visit_are_an_error),
        CLAIM(hair_smaller_than_a_pixel_leaves_no_holes),
        CLAIM(a_row_that_no_pool_holds_is_an_error),
        CLAIM(mesh_hides_the_hair_behind_it_only),
        CLAIM(hair_close_to_a_sloping_mesh_is_all_seen_or_all_hidden),
        CLAIM(light_falls_off_by_the_square_of_the_distance),
        CLAIM(a_spot_shines_into_its_cone),
        CLAIM(a_strand_throws_its_shadow_on_the_mesh),
        CLAIM(fewer_strands_cover_as_much),
        CLAIM(strands_neither_come_nor_go_at_once),
        CLAIM(fibres_are_as_wide_as_asked_for),
        CLAIM(smooth_strands_are_curves),
        CLAIM(no_hair_is_background),
        CLAIM(background_is_exact_beside_hair),
        CLAIM(a_strand_towards_the_eye_is_harmless),
        CLAIM(broken_positions_harm_no_other_strand),
        CLAIM(a_strand_past_the_eye_is_drawn_up_to_it),
        CLAIM(transparent_pictures_have_straight_alpha),
        CLAIM(hair_outside_the_picture_costs_nothing),
        CLAIM(bytes_do_not_depend_on_driver_threads),
        CLAIM(blocks_lie_alike_in_c_and_glsl),
        CLAIM(a_picture_beyond_the_driver_is_refused),
    };
    int failed = 0;
    for (raster = RASTER_QUADS; raster <= RASTER_BLOCKS; ++raster)
        failed += cmocka_run_group_tests(tests, open_studio, close_studio);
    return failed;
}
