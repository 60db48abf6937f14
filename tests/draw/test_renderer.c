// SPDX-License-Identifier: MIT
// Invariants of all images: order of strands, memory, bounds, threads.
#include "base/random.h"
#include "draw/drawing.h"
#include "passes/passes.h"
#include "support/driver_threads.h"
#include "support/hair_fixture.h"
#include "support/stage.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void add_band(float z, float red, float green)
{
    uint32_t i = add_line((float[3]){-60, 0, z}, (float[3]){60, 0, z}, 6, 0.6f);
    memcpy(studio.material[i].color, (float[3]){red, green, 0}, sizeof(float[3]));
}

static void the_nearer_strand_is_in_front(void **state)
{
    (void)state;
    use(&BLACK);
    for (int order = 0; order < 4; ++order) { // bits: which strand is added first, which is nearer
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

// Adds a strand that leaves the image plane: `slope` px towards the eye for each px to the right.
static void add_slanted(float slope)
{
    enum { POINTS = 81 };
    float position[POINTS][3];
    for (int i = 0; i < POINTS; ++i) {
        float x = (float)(i - POINTS / 2);
        memcpy(position[i], (float[3]){x, 0, slope * x}, sizeof *position);
    }
    Strands strands = studio_strands(1, POINTS, (const float(*)[3])position);
    uint32_t item = studio_add(&studio, &strands, 3, 1);
    memcpy(studio.material[item].color, (float[3]){1, 0, 0}, sizeof(float[3]));
    strands_destroy(&strands);
}

// A straight strand of one colour passes in front of a strand near its one end and behind one near
// its other end, however steep it is and however few ribbons could draw it.
static void a_slanted_strand_passes_between_others(void **state)
{
    (void)state;
    const float slopes[] = {0.2f, 1, 5.67f};
    use(&BLACK);
    for (size_t i = 0; i < sizeof slopes / sizeof *slopes; ++i)
        for (int side = -1; side <= 1; side += 2) {
            float x = 24 * (float)side, z = slopes[i] * x, column = x * 1000 / (1000 - z),
                  across = column * (1 - z / 2000);
            add_slanted(slopes[i]);
            uint32_t post =
                add_line((float[3]){across, -40, 0.5f * z}, (float[3]){across, 40, 0.5f * z}, 3, 1);
            memcpy(studio.material[post].color, (float[3]){0, 1, 0}, sizeof(float[3]));
            studio_draw(&studio);
            const uint8_t *pixel = studio_pixel(&studio, SIDE / 2 + (int)floorf(column), SIDE / 2);
            assert_int_equal(pixel[side > 0 ? 0 : 1], 255);
            assert_int_equal(pixel[side > 0 ? 1 : 0], 0);
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

// Very bright strands in one pixel: sums of more than 60,000 of them overflow 32 bits. Blocks take
// any number.
static void thousands_of_layers_are_still_white(void **state)
{
    (void)state;
    const uint32_t count = raster == RASTER_QUADS ? 60000 : 200000;
    RendererOptions pixel = BLACK;
    pixel.width = pixel.height = 1;
    use(&pixel);
    Strands strands = crowd(count);
    uint32_t item = studio_add(&studio, &strands, 4, 1);
    studio.material[item].ambient = 8;
    studio_draw(&studio);
    assert_int_equal(studio.renderer.counts.fragments, count);
    for (int k = 0; k < 3; ++k) assert_int_equal(studio.image.pixels[k], 255);
    strands_destroy(&strands);
}

// The image before may have much more hair.
static void a_picture_does_not_depend_on_the_one_before(void **state)
{
    (void)state;
    use(&BLACK);
    add_tangle(3000, 2, 0.4f, NULL);
    size_t size;
    uint8_t *expected = draw_copy(&size);
    studio_clear(&studio);
    use(&BLACK);
    Strands strands = crowd(62000);
    studio_add(&studio, &strands, 0.4f, 0.001f);
    studio_draw(&studio);
    studio_clear(&studio);
    add_tangle(3000, 2, 0.4f, NULL);
    assert_draws_the_same(expected, size);
    free(expected);
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

// The bounding box of the hair must be invisible: the background passes through the resolve
// unchanged.
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
    add_line((float[3]){40, 40, 0}, (float[3]){40, 40, 0}, 3, 1); // zero length
    studio_draw(&studio);
    for (int y = 0; y < SIDE; ++y)
        for (int x = 0; x < SIDE; ++x)
            if (abs(x - SIDE / 2) > 5 || abs(y - SIDE / 2) > 5)
                assert_int_equal(studio_pixel(&studio, x, y)[3], 0);
}

// Solvers promise finite positions. If one fails, the other strands are still drawn.
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
    // the same in the other direction
    add_line((float[3]){-20, 0, 3000}, (float[3]){-20, 0, 0}, 3, 1);
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

// Nothing nearer than 10 px to the eye is drawn, even in front of the eye. Of a strand with
// vertices at 100, 4 and 2 px, the part from 100 to 91 px off the middle is drawn, and not the rest
// up to 50 px.
static void nothing_is_drawn_between_the_eye_and_the_near_plane(void **state)
{
    (void)state;
    const float position[3][3] = {{10, 0, 900}, {0.3f, 0, 996}, {-0.1f, 0, 998}};
    Strands strands = studio_strands(1, 3, position);
    use(&TRANSPARENT);
    studio_add(&studio, &strands, 0.05f, 1);
    strands_destroy(&strands);
    studio_draw(&studio);
    assert_true(studio_pixel(&studio, SIDE / 2 + 93, SIDE / 2)[3] > 128);
    for (int x = 0; x < SIDE / 2 + 85; ++x)
        for (int y = 0; y < SIDE; ++y) assert_int_equal(studio_pixel(&studio, x, y)[3], 0);
}

// A strand through the image's corner that comes nearer to the eye: Mesa's clipping by w once cut
// pieces off.
static void a_strand_is_whole_up_to_the_edge(void **state)
{
    (void)state;
    RendererOptions small = TRANSPARENT;
    small.width = 101;
    small.height = 67;
    use(&small);
    add_line((float[3]){50, 44, 14}, (float[3]){45, -5, 24}, 0.7f, 0.6f);
    studio_draw(&studio);
    for (int y = 0; y < 30; ++y) {
        double sum = 0;
        for (int x = 90; x < 101; ++x) sum += studio_pixel(&studio, x, y)[3] / 255.0;
        if (y > 0) assert_true(fabs(sum - 0.6 * 1.4) < 0.05);
    }
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
    assert_true(abs(inside[3] - 128) < studio_rounding(&studio));
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

static void bytes_do_not_depend_on_driver_threads(void **state)
{
    (void)state;
    assert_driver_threads_do_not_matter(raster == RASTER_QUADS ? "quads" : "blocks");
}

static int draw_tangle(const char *by)
{
    raster = strcmp(by, "quads") == 0 ? RASTER_QUADS : RASTER_BLOCKS;
    stage_open(&BLACK);
    add_tangle(1500, 2, 0.4f, NULL);
    studio_draw(&studio);
    size_t size;
    uint8_t *bytes = studio_copy(&studio, &size);
    driver_threads_tell(&studio.gpu, bytes, size);
    free(bytes);
    studio_close(&studio);
    return 0;
}

// Rows of 1000 points, all of which are kept, as one strand or as one strand per row: the
// connections between rows lie outside the image. CPU drivers' loops end before such a strand does.
static void a_strand_may_have_65000_points(void **state)
{
    (void)state;
    enum { POINTS = 65000, ROW = 1000 };
    if (raster != RASTER_BLOCKS) return;
    float(*position)[3] = malloc(POINTS * sizeof *position);
    size_t size;
    assert_non_null(position);
    for (int j = 0; j < POINTS; ++j) {
        int row = j / ROW, on = row % 2 ? ROW - 1 - j % ROW : j % ROW;
        position[j][0] = 0.4f * (float)on - 200;
        position[j][1] = 2 * (float)row - 65 + (j % 2 ? 0.2f : -0.2f);
        position[j][2] = -0.001f * (float)j;
    }
    Strands one = studio_strands(1, POINTS, (const float(*)[3])position),
            rows = studio_strands(POINTS / ROW, ROW, (const float(*)[3])position);
    use(&BLACK);
    studio_add(&studio, &rows, 0.4f, 0.2f);
    uint8_t *expected = draw_copy(&size);
    assert_true(*studio_pixel(&studio, SIDE / 2, SIDE / 2) > 0);
    studio_clear(&studio);
    studio_add(&studio, &one, 0.4f, 0.2f);
    assert_draws_the_same(expected, size);
    strands_destroy(&one);
    strands_destroy(&rows);
    free(expected);
    free(position);
}

static void blocks_lie_alike_in_c_and_glsl(void **state)
{
    (void)state;
    if (raster == RASTER_BLOCKS) return; // blocks use no GLSL
    Error error = {{0}};
    Passes *passes = stage_passes();
    LookPrograms *programs =
        raster == RASTER_QUADS ? &passes->quads.hair.project : &passes->ribbons.project;
    unsigned all = LOOK_SHADED - 1; // all members are used
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

static void a_picture_beyond_the_driver_is_tiles(void **state)
{
    (void)state;
    Error error = {{0}};
    Renderer renderer;
    RendererOptions huge = {.width = studio.gpu.limits.framebuffer_side_px + 1, .height = 16};
    assert_int_equal(renderer_create(&renderer, &studio.gpu, &studio.timer, &huge, &error),
                     RESULT_OK);
    assert_int_equal(tiles_count(&renderer.tiles), 2);
    assert_true(renderer.part.width <= studio.gpu.limits.framebuffer_side_px);
    renderer_destroy(&renderer);
}

int main(int argc, char **argv)
{
    if (argc == 2) return draw_tangle(argv[1]);
    const struct CMUnitTest tests[] = {
        CLAIM(the_nearer_strand_is_in_front),
        CLAIM(a_slanted_strand_passes_between_others),
        CLAIM(order_of_strands_does_not_matter),
        CLAIM(thousands_of_layers_are_still_white),
        CLAIM(a_picture_does_not_depend_on_the_one_before),
        CLAIM(no_hair_is_background),
        CLAIM(background_is_exact_beside_hair),
        CLAIM(a_strand_towards_the_eye_is_harmless),
        CLAIM(broken_positions_harm_no_other_strand),
        CLAIM(a_strand_past_the_eye_is_drawn_up_to_it),
        CLAIM(nothing_is_drawn_between_the_eye_and_the_near_plane),
        CLAIM(a_strand_is_whole_up_to_the_edge),
        CLAIM(transparent_pictures_have_straight_alpha),
        CLAIM(hair_outside_the_picture_costs_nothing),
        CLAIM(bytes_do_not_depend_on_driver_threads),
        CLAIM(a_strand_may_have_65000_points),
        CLAIM(blocks_lie_alike_in_c_and_glsl),
        CLAIM(a_picture_beyond_the_driver_is_tiles),
    };
    const struct CMUnitTest order[] = {CLAIM(the_nearer_strand_is_in_front),
                                       CLAIM(a_slanted_strand_passes_between_others)};
    return stage_run(tests) + stage_run_one(order, RASTER_COMPUTE);
}
