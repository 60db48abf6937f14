// SPDX-License-Identifier: MIT
// Shadows on the floor.
#include "passes/passes.h"
#include "reference/shadow_reference.h"
#include "support/stage.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// The eye at z = 1000 sees the floor's point at z in the row 100 * 1000 / (1000 - z) below the
// middle.
enum { HEIGHT = -100, LAYERS = 3 };

static const double AMBIENT = 0.15, OPACITY = 0.4; // AMBIENT as in render_picture.c
static const float RADIUS = 30;

static RendererOptions with_floor(const RendererOptions *base, FloorKind kind)
{
    RendererOptions options = *base;
    options.shadow = (ShadowOptions){.kind = SHADOW_DOM, .side = 96, .spacing = 200};
    options.floor = (Floor){
        .kind = kind, .middle = {0, HEIGHT, 0}, .whole = 2000, .faded = 3000, .color = {1, 1, 1}};
    return options;
}

static void find_floor_point(int column, int row, double point[3])
{
    double across = column + 0.5 - SIDE / 2.0, down = row + 0.5 - SIDE / 2.0,
           distance = 1000.0 * -HEIGHT / down;
    point[0] = across * distance / 1000;
    point[1] = HEIGHT;
    point[2] = 1000 - distance;
}

// Ribbons along x, one above the other, that shade the floor from -30 to 30 in z.
static Strands make_layers(void)
{
    enum { VERTICES = 5 };
    float position[LAYERS * VERTICES][3];
    for (int v = 0; v < LAYERS * VERTICES; ++v) {
        position[v][0] = 30 * (float)(v % VERTICES) - 60;
        position[v][1] = 20 * (float)(v / VERTICES) - 10;
        position[v][2] = 0;
    }
    return studio_strands(LAYERS, VERTICES, (const float(*)[3])position);
}

static void add_layers(const Strands *layers)
{
    uint32_t item = studio_add(&studio, layers, RADIUS, 1);
    studio.material[item].shadow_opacity = (float)OPACITY;
}

// `share`: the exact share of the light that reaches the floor; `light`: the linear colour of a
// white floor that all of the light reaches.
typedef void Expect(int column, int row, double share, double light);

static void compare_with_exact(Expect *expect)
{
    const Light lights[] = {
        {.direction = {0, 1, 0}, .color = {1, 1, 1}, .intensity = 0.5f, .shadow = true},
        {.direction = {0.6f, 0.8f, 0}, .color = {1, 1, 1}, .intensity = 0.5f, .shadow = true},
        {.kind = LIGHT_POINT,
         .position = {0, 200, 0},
         .distance = 300,
         .color = {1, 1, 1},
         .intensity = 0.5f,
         .shadow = true}};
    // Places away from edges, where the map is soft within two of its texels, each 1.5 units wide;
    // and away from places where one texel has three points of a wide ribbon and its neighbours
    // have two, which increases optical depth by a fifth.
    const int places[][2] = {{SIDE / 2, SIDE / 2 + 99},       {SIDE / 2 - 15, SIDE / 2 + 99},
                             {SIDE / 2 - 50, SIDE / 2 + 99},  {SIDE / 2 - 65, SIDE / 2 + 99},
                             {SIDE / 2 - 118, SIDE / 2 + 99}, {SIDE / 2, SIDE / 2 + 112},
                             {SIDE / 2 + 20, SIDE / 2 + 85}};
    Strands layers = make_layers();
    add_layers(&layers);
    for (size_t i = 0; i < sizeof lights / sizeof *lights; ++i) {
        ShadowReference reference;
        Error error = {{0}};
        const ReferenceItem item = {
            .strands = &layers, .material = &studio.material[0], .radius = RADIUS};
        const ReferenceScene scene = {.items = &item, .item_count = 1};
        assert_int_equal(shadow_reference_create(&reference, &scene, &lights[i],
                                                 (const float[3]){0, 10, 0}, &error),
                         RESULT_OK);
        studio.light = lights[i];
        studio_draw(&studio);
        for (size_t k = 0; k < sizeof places / sizeof *places; ++k) {
            double point[3], light = 0.5 * (i == 1 ? 0.8 : 1);
            find_floor_point(places[k][0], places[k][1], point);
            double share = shadow_reference_light(&reference, point, 0), way[3], square = 0;
            for (int j = 0; j < 3; ++j) {
                way[j] = (double)lights[i].position[j] - point[j];
                square += way[j] * way[j];
            }
            if (lights[i].kind == LIGHT_POINT) light *= 300 * 300 / square * way[1] / sqrt(square);
            expect(places[k][0], places[k][1], share, light);
        }
        shadow_reference_destroy(&reference);
    }
    strands_destroy(&layers);
}

// Allows for the map's own error: test_shadow.c allows 0.03 of the light, 4 levels here.
static void expect_plane(int column, int row, double share, double light)
{
    const uint8_t *pixel = studio_pixel(&studio, column, row);
    double expected = srgb(AMBIENT + light * share);
    if (fabs(pixel[0] - expected) > 4)
        fail_msg("pixel %d, %d: %d, expected %.1f", column, row, pixel[0], expected);
}

static void hair_throws_its_shadow_on_the_floor(void **state)
{
    (void)state;
    RendererOptions options = with_floor(&BLACK, FLOOR_PLANE);
    use(&options);
    compare_with_exact(expect_plane);
    assert_int_equal(studio_pixel(&studio, 5, SIDE / 2 - 10)[0], 0); // above the horizon
}

// Lights with and without a radius have other shaders.
static void a_renderer_draws_soft_and_hard_light_in_turn(void **state)
{
    (void)state;
    RendererOptions options = with_floor(&BLACK, FLOOR_PLANE);
    Strands layers = make_layers();
    size_t size;
    options.raster = RASTER_QUADS;
    for (int wide = 0; wide < 2; ++wide) {
        use(&options);
        add_layers(&layers);
        studio.light = (Light){.direction = {0, 1, 0},
                               .color = {1, 1, 1},
                               .intensity = 0.5f,
                               .radius = wide ? 20 : 0,
                               .shadow = true};
        uint8_t *first, *again;
        studio_draw(&studio);
        first = studio_copy(&studio, &size);
        studio.light.radius = wide ? 0 : 20;
        studio_draw(&studio);
        assert_memory_not_equal(studio.image.pixels, first, size);
        studio.light.radius = wide ? 20 : 0;
        studio_draw(&studio);
        again = studio_copy(&studio, &size);
        assert_memory_equal(again, first, size);
        free(first);
        free(again);
    }
    strands_destroy(&layers);
}

static void expect_shadow(int column, int row, double share, double light)
{
    const uint8_t *pixel = studio_pixel(&studio, column, row);
    double expected = 255 * (1 - (AMBIENT + light * share) / (AMBIENT + light));
    if (fabs(pixel[3] - expected) > 6) // alpha is linear
        fail_msg("pixel %d, %d: %d, expected %.1f", column, row, pixel[3], expected);
    assert_int_equal(pixel[0], 0);
}

static void a_catcher_has_the_shadow_alone_in_its_alpha(void **state)
{
    (void)state;
    RendererOptions options = with_floor(&TRANSPARENT, FLOOR_SHADOW);
    use(&options);
    compare_with_exact(expect_shadow);
    assert_int_equal(studio_pixel(&studio, 5, SIDE / 2 + 120)[3], 0);
}

// On a white background, the shadow darkens it like a white floor in that light.
static void a_catcher_darkens_an_opaque_background(void **state)
{
    (void)state;
    RendererOptions options = with_floor(&BLACK, FLOOR_SHADOW);
    for (int k = 0; k < 3; ++k) options.background[k] = 1;
    use(&options);
    Strands layers = make_layers();
    add_layers(&layers);
    studio.light =
        (Light){.direction = {0, 1, 0}, .color = {1, 1, 1}, .intensity = 0.5f, .shadow = true};
    studio_draw(&studio);
    double share = pow(1 - OPACITY, LAYERS), expected = (AMBIENT + 0.5 * share) / (AMBIENT + 0.5);
    assert_true(fabs(studio_pixel(&studio, SIDE / 2, SIDE / 2 + 99)[1] - srgb(expected)) <= 4);
    assert_int_equal(studio_pixel(&studio, 5, SIDE / 2 + 99)[1], 255);
    strands_destroy(&layers);
}

// The mesh hovers 50 above the floor, at right angles to the light; next to it, hair alone.
static void the_mesh_throws_its_shadow_on_the_floor_too(void **state)
{
    (void)state;
    RendererOptions options = with_floor(&BLACK, FLOOR_PLANE);
    Error error = {{0}};
    Mesh mesh = make_square(20);
    for (int v = 0; v < 4; ++v) {
        mesh.position[v][2] = mesh.position[v][1];
        mesh.position[v][0] -= 30;
        mesh.position[v][1] = -50;
    }
    use(&options);
    assert_int_equal(renderer_set_mesh(&studio.renderer, &mesh, (const float[3]){1, 1, 1}, &error),
                     RESULT_OK);
    mesh_destroy(&mesh);
    Strands layers = make_layers();
    add_layers(&layers);
    studio.light =
        (Light){.direction = {0, 1, 0}, .color = {1, 1, 1}, .intensity = 0.5f, .shadow = true};
    studio_draw(&studio);
    double share = pow(1 - OPACITY, LAYERS);
    assert_true(fabs(studio_pixel(&studio, SIDE / 2 - 30, SIDE / 2 + 99)[0] - srgb(AMBIENT)) <= 1);
    assert_true(fabs(studio_pixel(&studio, SIDE / 2 + 30, SIDE / 2 + 99)[0] -
                     srgb(AMBIENT + 0.5 * share)) <= 4);
    assert_true(fabs(studio_pixel(&studio, 5, SIDE / 2 + 99)[0] - srgb(AMBIENT + 0.5)) <= 1);
    strands_destroy(&layers);
}

// A line below the floor, half-way to its edge.
static void a_plane_hides_what_is_below_it_a_catcher_does_not(void **state)
{
    (void)state;
    for (FloorKind kind = FLOOR_PLANE; kind <= FLOOR_SHADOW; ++kind) {
        RendererOptions options = with_floor(&BLACK, kind);
        options.floor.color[0] = options.floor.color[1] = options.floor.color[2] = 0;
        use(&options);
        add_line((float[3]){-60, -132, -200}, (float[3]){60, -132, -200}, 6, 1); // in row 110
        studio_draw(&studio);
        assert_int_equal(studio_pixel(&studio, SIDE / 2, SIDE / 2 + 110)[0],
                         kind == FLOOR_PLANE ? 0 : 255);
        studio_clear(&studio);
    }
}

static void without_a_floor_or_below_it_nothing_is_drawn(void **state)
{
    (void)state;
    size_t size;
    RendererOptions options = with_floor(&BLACK, FLOOR_NONE);
    use(&options);
    add_line((float[3]){-60, 20, 10}, (float[3]){60, -20, 10}, 6, 1);
    uint8_t *plain = draw_copy(&size);
    const Passes *passes = raster == RASTER_QUADS ? stage_passes() : NULL;
    if (passes) assert_int_equal(passes->target.depth, 0);
    options = with_floor(&BLACK, FLOOR_PLANE);
    options.floor.middle[1] = 100; // above the eye
    use(&options);
    assert_draws_the_same(plain, size);
    passes = raster == RASTER_QUADS ? stage_passes() : NULL;
    if (passes) assert_int_equal(passes->base.finish[0][FLOOR_PLANE], 0);
    free(plain);
}

// A light from below does not reach the floor. The floor is complete up to its radius and fades
// beyond.
static void a_floor_is_lit_from_above_and_fades_beyond_its_radius(void **state)
{
    (void)state;
    RendererOptions options = with_floor(&BLACK, FLOOR_PLANE);
    double point[3];
    find_floor_point(SIDE / 2, SIDE / 2 + 99, point);
    // The floor's radius ends just beyond that point and just before it; its z is near 0.
    for (int inside = 0; inside < 2; ++inside) {
        options.floor.middle[2] = (float)point[2] + 200;
        options.floor.whole = inside ? 205 : 100;
        options.floor.faded = inside ? 400 : 300;
        use(&options);
        studio.light = (Light){.direction = {0, -1, 0}, .color = {1, 1, 1}, .intensity = 0.5f};
        studio_draw(&studio);
        int dark = studio_pixel(&studio, SIDE / 2, SIDE / 2 + 99)[0];
        double expected = srgb((inside ? 1 : 0.5) * AMBIENT);
        if (fabs(dark - expected) > 1) fail_msg("from below: %d, expected %.1f", dark, expected);
    }
}

// Both rasterisers show the same floor where there is no hair, and drawing hair keeps it.
static void both_rasterisers_show_the_same_floor(void **state)
{
    (void)state;
    enum { FIRST = SIDE / 2 + 75, BYTES = (SIDE - FIRST) * SIDE * 3 };
    static uint8_t before[BYTES];
    RendererOptions options = with_floor(&BLACK, FLOOR_PLANE);
    use(&options);
    Strands layers = make_layers();
    add_layers(&layers);
    studio.light = (Light){
        .direction = {0.3f, 0.9f, 0.3f}, .color = {1, 1, 1}, .intensity = 0.5f, .shadow = true};
    studio_draw(&studio);
    const uint8_t *here = studio_pixel(&studio, 0, FIRST);
    for (int i = 0; raster == RASTER_BLOCKS && i < BYTES; ++i)
        if (abs(here[i] - before[i]) > 1) fail_msg("byte %d: %d and %d", i, here[i], before[i]);
    memcpy(before, here, BYTES);
    strands_destroy(&layers);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        CLAIM(hair_throws_its_shadow_on_the_floor),
        CLAIM(a_catcher_has_the_shadow_alone_in_its_alpha),
        CLAIM(a_catcher_darkens_an_opaque_background),
        CLAIM(the_mesh_throws_its_shadow_on_the_floor_too),
        CLAIM(a_plane_hides_what_is_below_it_a_catcher_does_not),
        CLAIM(without_a_floor_or_below_it_nothing_is_drawn),
        CLAIM(a_floor_is_lit_from_above_and_fades_beyond_its_radius),
        CLAIM(both_rasterisers_show_the_same_floor),
        CLAIM(a_renderer_draws_soft_and_hard_light_in_turn),
    };
    return stage_run(tests);
}
