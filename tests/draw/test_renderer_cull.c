// SPDX-License-Identifier: MIT
// Culling of invisible strands before projection, or of their ribbons before binning, does not
// change the image; the counts say how many were culled and why.
#include "base/random.h"
#include "draw/hair_paint.h"
#include "passes/passes.h"
#include "support/stage.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COUNT = 1500, VERTICES = 6, HEAD = 70 };

static Cull *cull(void)
{
    Passes *passes = stage_passes();
    return raster == RASTER_QUADS ? &passes->quads.cull : &passes->ribbons.cull;
}

// Whether strands of the next image are tested for visibility.
static bool *skips(void)
{
    Passes *passes = stage_passes();
    return raster == RASTER_QUADS ? &passes->quads.skips : &passes->ribbons.skips;
}

// A ball of 32 x 16 faces at the middle.
static Mesh make_head(float radius)
{
    enum { AROUND = 32, DOWN = 16 };
    Error error = {{0}};
    Mesh mesh;
    assert_int_equal(mesh_create(&mesh, AROUND * (DOWN + 1), 2 * AROUND * DOWN, &error), RESULT_OK);
    for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
        double turn = 2 * GLM_PI * (v % AROUND) / AROUND, tilt = GLM_PI * (v / AROUND) / DOWN;
        const double n[3] = {sin(tilt) * sin(turn), cos(tilt), sin(tilt) * cos(turn)};
        for (int k = 0; k < 3; ++k)
            mesh.position[v][k] = radius * (mesh.normal[v][k] = (float)n[k]);
    }
    for (uint32_t t = 0; t < AROUND * DOWN; ++t) {
        uint32_t a = t, b = t / AROUND * AROUND + (t + 1) % AROUND;
        memcpy(mesh.triangle[2 * t], (uint32_t[3]){a, a + AROUND, b}, sizeof(uint32_t[3]));
        memcpy(mesh.triangle[2 * t + 1], (uint32_t[3]){b, a + AROUND, b + AROUND},
               sizeof(uint32_t[3]));
    }
    return mesh;
}

// Bent strands 5 to 65 px long that start on the head and point in any direction.
static Strands make_hair(void)
{
    static float position[COUNT][VERTICES][3];
    Random random = random_create(5, 0);
    for (int s = 0; s < COUNT; ++s) {
        double x[3], way[3], turn[3], step = 1 + 12 * random_real(&random) * random_real(&random);
        random_direction(&random, x);
        random_direction(&random, way);
        random_direction(&random, turn);
        for (int k = 0; k < 3; ++k) way[k] += 1.2 * x[k], x[k] *= HEAD;
        for (int j = 0; j < VERTICES; ++j)
            for (int k = 0; k < 3; ++k) {
                position[s][j][k] = (float)x[k];
                x[k] += step * way[k];
                way[k] += 0.3 * turn[k];
            }
    }
    return studio_strands(COUNT, VERTICES, (const float(*)[3])position);
}

// Paints colours, and thickness that grows from a tenth of a pixel to four pixels or the other way.
static void paint_hair(uint32_t item, const Strands *strands)
{
    float(*color)[4] = malloc(strands->vertex_count * sizeof *color),
    *thickness = malloc(strands->vertex_count * sizeof *thickness);
    assert_true(color && thickness);
    for (uint32_t v = 0; v < strands->vertex_count; ++v) {
        float share = (float)(v % VERTICES) / (VERTICES - 1);
        if (v / VERTICES % 2) share = 1 - share;
        thickness[v] = 0.1f + 2 * share;
        memcpy(color[v], (float[4]){share, 0.5f, 1 - share, 0.9f}, sizeof color[v]);
    }
    Error error = {{0}};
    const Paint paint = {color, thickness, true, strands->vertex_count};
    assert_int_equal(
        hair_paint_upload(&studio.hair[item], strands, &paint, &studio.gpu.limits, &error),
        RESULT_OK);
    free(color);
    free(thickness);
}

// A camera `distance` px from the middle, turned by `turn` about the vertical axis, slightly above.
static View look_from(double turn, float distance, float fov_deg)
{
    View view;
    studio_view(&view, SIDE, SIDE);
    vec3 eye = {(float)sin(turn), 0.4f, (float)cos(turn)};
    glm_vec3_normalize(eye);
    glm_vec3_scale(eye, distance, view.eye);
    view.near_distance = 5;
    view.fov = glm_rad(fov_deg);
    glm_lookat(view.eye, (vec3){10, -5, 0}, (vec3){0, 1, 0}, view.view);
    glm_perspective(view.fov, 1, view.near_distance, view.far_distance, view.projection);
    return view;
}

static void leave_out(bool on)
{
    if (raster == RASTER_BLOCKS)
        stage_lanes_draw_hidden(!on);
    else
        cull()->off = !on;
}

typedef struct Left {
    uint64_t hidden, outside;
} Left;

// Draws with and without culling; the images must be equal to the byte.
static Left leaves_no_trace(const View *view)
{
    size_t size;
    const RendererCounts *counts = &studio.renderer.counts;
    if (raster != RASTER_BLOCKS) *skips() = true;
    studio_draw_view(&studio, view);
    const Left left = {counts->hidden, raster == RASTER_BLOCKS ? counts->culled : cull()->outside};
    uint8_t *expected = studio_copy(&studio, &size);
    leave_out(false);
    studio_draw_view(&studio, view);
    leave_out(true);
    assert_int_equal(studio.renderer.counts.hidden, 0);
    assert_memory_equal(studio.image.pixels, expected, size);
    free(expected);
    return left;
}

// Thin hair on black shows even the smallest difference.
static const RendererOptions DARK = {
    .width = SIDE, .height = SIDE, .background = {0, 0, 0, 1}, .kind = IMAGE_16};
static const float THIN = 0.05f; // opacity

// Views into a corner and from nearby, where strands cross the plane of the eye, then from all
// sides.
enum { VIEWS = 7, NEAR_VIEWS = 4 };

// The first `count` views.
static Left leaves_no_trace_from(int count, const char *what)
{
    const View views[VIEWS] = {look_from(1, 300, 12),   look_from(0.5, 120, 90),
                               look_from(5.2, 250, 40), look_from(0, 600, 26),
                               look_from(1.3, 600, 26), look_from(2.6, 600, 26),
                               look_from(3.9, 600, 26)};
    Left sum = {0};
    for (int i = 0; i < count; ++i) {
        Left left = leaves_no_trace(&views[i]);
        sum.hidden += left.hidden;
        sum.outside += left.outside;
        print_message("%s, view %d: %d of %d behind the head, %d outside\n", what, i,
                      (int)left.hidden, COUNT, (int)left.outside);
    }
    return sum;
}

static void use_with_head(const RendererOptions *options)
{
    Error error = {{0}};
    Mesh head = make_head(HEAD);
    use(options);
    assert_int_equal(
        renderer_set_mesh(&studio.renderer, &head, (const float[3]){0.5f, 0.4f, 0.3f}, &error),
        RESULT_OK);
    mesh_destroy(&head);
}

// In each view about 100 of 1,500 strands lie completely behind the head, as far as tiles can tell.
static void strands_behind_the_head_are_left_out_without_a_trace(void **state)
{
    (void)state;
    Strands strands = make_hair();
    RendererOptions options = DARK;
    for (options.samples = 1; options.samples <= 2; ++options.samples)
        for (int kind = 0; kind < 3; ++kind) {
            options.aov = kind == 2 ? AOV_STRAND : AOV_NONE;
            use_with_head(&options);
            uint32_t item = studio_add(&studio, &strands, kind ? 0.4f : 2, THIN);
            studio.material[item].tip_ratio = 0.5f;
            int count = options.samples == 1 && kind == 0 ? VIEWS : NEAR_VIEWS;
            Left left = leaves_no_trace_from(count, "plain");
            assert_true(left.hidden * VIEWS > (uint64_t)(COUNT / 2 * count));
            studio_clear(&studio);
        }
    strands_destroy(&strands);
}

static void painted_and_smooth_hair_is_left_out_as_well(void **state)
{
    (void)state;
    use_with_head(&DARK);
    Strands strands = make_hair();
    for (int painted = 0; painted < 2; ++painted) {
        for (int curve = 0; curve < 3; ++curve) {
            uint32_t item = studio_add(&studio, &strands, 1, THIN);
            if (painted) paint_hair(item, &strands);
            studio.material[item].smooth = curve ? 4 : 1;
            studio.material[item].curve = curve == 2 ? CURVE_BSPLINE : CURVE_CATMULL_ROM;
            int count = curve == 1 ? VIEWS : NEAR_VIEWS;
            Left left = leaves_no_trace_from(count, painted ? "painted" : "smooth");
            assert_true(left.hidden * VIEWS > (uint64_t)(COUNT / 3 * count));
            assert_true(left.outside > COUNT / 2);
            studio_clear(&studio);
        }
    }
    strands_destroy(&strands);
}

// Long segments, steep ones and sharp bends around a slanted board with a slit.
static Strands make_thicket(void)
{
    enum { STALKS = 4000, POINTS = 4 };
    static float position[STALKS][POINTS][3];
    Random random = random_create(9, 0);
    for (int s = 0; s < STALKS; ++s) {
        double middle[3], size = 4 + 60 * pow(random_real(&random), 3);
        for (int k = 0; k < 3; ++k) middle[k] = 160 * (random_real(&random) - (k < 2 ? 0.5 : 0.9));
        for (int j = 0; j < POINTS; ++j)
            for (int k = 0; k < 3; ++k)
                position[s][j][k] =
                    (float)(middle[k] + size * (k < 2 ? 1 : 3) * (random_real(&random) - 0.5));
    }
    return studio_strands(STALKS, POINTS, (const float(*)[3])position);
}

static void use_with_boards(void)
{
    Error error = {{0}};
    Mesh boards;
    assert_int_equal(mesh_create(&boards, 8, 4, &error), RESULT_OK);
    for (uint32_t v = 0; v < 8; ++v) {
        float x = v & 1 ? 70.0f : 3.0f, side = v & 4 ? -1 : 1;
        memcpy(boards.position[v], (float[3]){side * x, v & 2 ? 60 : -50, 0.5f * side * x}, 12);
        boards.normal[v][2] = 1;
    }
    const uint32_t triangles[4][3] = {{0, 1, 2}, {2, 1, 3}, {4, 5, 6}, {6, 5, 7}};
    memcpy(boards.triangle, triangles, sizeof triangles);
    use(&DARK);
    assert_int_equal(renderer_set_mesh(&studio.renderer, &boards, (const float[3]){0}, &error),
                     RESULT_OK);
    mesh_destroy(&boards);
}

static void a_thicket_about_boards_is_left_out_without_a_trace(void **state)
{
    (void)state;
    use_with_boards();
    Strands strands = make_thicket();
    View view, aside;
    studio_view(&view, SIDE, SIDE);
    studio_view(&aside, SIDE, SIDE);
    glm_translate(aside.view, (vec3){-110, 70, 0});
    for (int curve = 0; curve < 3; ++curve) {
        uint32_t item = studio_add(&studio, &strands, curve == 1 ? 3 : 0.3f, THIN);
        studio.material[item].tip_ratio = 0;
        studio.material[item].smooth = curve ? 5 : 1;
        studio.material[item].curve = curve == 2 ? CURVE_BSPLINE : CURVE_CATMULL_ROM;
        Left left = leaves_no_trace(&view), beside = leaves_no_trace(&aside);
        print_message("thicket: %d behind the boards; %d outside\n", (int)left.hidden,
                      (int)beside.outside);
        assert_true(left.hidden > 100 && beside.outside > 100);
        studio_clear(&studio);
    }
    strands_destroy(&strands);
}

// All particles lie to the left of the image, but the curve reaches 3 px into it.
static void a_curve_may_swing_into_the_picture(void **state)
{
    (void)state;
    const float bow[4][3] = {
        {-200, -60, 0}, {-6 - SIDE / 2, -40, 0}, {-6 - SIDE / 2, 40, 0}, {-200, 60, 0}};
    Strands strands = studio_strands(1, 4, bow);
    use(&DARK);
    uint32_t item = studio_add(&studio, &strands, 0.3f, 1);
    studio.material[item].smooth = 8;
    studio_draw(&studio);
    assert_true(studio.renderer.counts.segments > 0);
    assert_int_equal(studio.renderer.counts.culled, 0);
    strands_destroy(&strands);
}

// The floor hides what is below it and nothing above.
static void strands_below_a_floor_are_left_out_without_a_trace(void **state)
{
    (void)state;
    RendererOptions options = DARK;
    options.floor = (Floor){.kind = FLOOR_PLANE, .whole = 900, .faded = 1200, .color = {1, 1, 1}};
    use(&options);
    Strands strands = make_hair();
    studio_add(&studio, &strands, 0.5f, THIN);
    const View view = look_from(1, 400, 40);
    Left left = leaves_no_trace(&view);
    assert_in_range(left.hidden, COUNT / 4, COUNT / 2);
    strands_destroy(&strands);
}

// If something moves, hidden hair is determined again; if nothing moves, it is not.
static void what_is_hidden_follows_the_camera(void **state)
{
    (void)state;
    use_with_head(&DARK);
    float line[5][3];
    for (int j = 0; j < 5; ++j)
        memcpy(line[j], (float[3]){(float)(4 * j - 8), 0, -90}, sizeof line[j]);
    Strands strands = studio_strands(1, 5, (const float(*)[3])line);
    studio_add(&studio, &strands, 1, 1);
    const View front = look_from(0, 600, 26), back = look_from(GLM_PI, 600, 26);
    for (int i = 0; i < 3; ++i) {
        studio_draw_view(&studio, &front);
        assert_int_equal(studio.renderer.counts.hidden, 1);
        assert_int_equal(studio.renderer.counts.segments, 0);
        studio_draw_view(&studio, &back);
        assert_int_equal(studio.renderer.counts.hidden, 0);
        // Blocks keep points so that ribbons are short.
        assert_in_range(studio.renderer.counts.segments, 1, raster == RASTER_BLOCKS ? 4 : 1);
        studio_draw_view(&studio, &back); // nothing was culled and nothing moved
        if (raster != RASTER_BLOCKS) assert_false(cull()->tries);
    }
    strands_destroy(&strands);
}

// Lines around the image's edges, some of them wide, culled before or after projection.
static void strands_out_of_sight_are_left_out_early_without_a_trace(void **state)
{
    (void)state;
    enum { LINES = 600 };
    float position[2 * LINES][3];
    Random random = random_create(3, 0);
    for (int i = 0; i < LINES; ++i) {
        float middle[3], way[3];
        for (int k = 0; k < 3; ++k) {
            middle[k] = (float)(k < 2 ? 4 * SIDE * random_real(&random) - 2 * SIDE : 0);
            way[k] = (float)(60 * random_real(&random) - 30);
        }
        for (int k = 0; k < 3; ++k)
            position[2 * i][k] = middle[k] - way[k], position[2 * i + 1][k] = middle[k] + way[k];
    }
    Strands strands = studio_strands(LINES, 2, (const float(*)[3])position);
    size_t size;
    use(&BLACK);
    studio_add(&studio, &strands, 5, 0.4f);
    uint8_t *culled = draw_copy(&size);
    uint64_t count = studio.renderer.counts.culled;
    assert_in_range(count, LINES / 2, LINES - 10);
    if (raster != RASTER_BLOCKS) {
        assert_in_range(cull()->outside, LINES / 2, count);
        *skips() = false;
        assert_draws_the_same(culled, size);
        assert_int_equal(cull()->outside, 0);
        assert_int_equal(studio.renderer.counts.culled, count);
        assert_true(*skips()); // for the next image
    }
    free(culled);
    strands_destroy(&strands);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        CLAIM(strands_behind_the_head_are_left_out_without_a_trace),
        CLAIM(painted_and_smooth_hair_is_left_out_as_well),
        CLAIM(a_thicket_about_boards_is_left_out_without_a_trace),
        CLAIM(a_curve_may_swing_into_the_picture),
        CLAIM(strands_below_a_floor_are_left_out_without_a_trace),
        CLAIM(what_is_hidden_follows_the_camera),
        CLAIM(strands_out_of_sight_are_left_out_early_without_a_trace),
    };
    return stage_run_all(tests);
}
