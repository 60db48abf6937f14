// SPDX-License-Identifier: MIT
// Hair with a mesh and lights.
#include "support/needed.h"
#include "support/stage.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void mesh_hides_the_hair_behind_it_only(void **state)
{
    (void)state;
    Error error = {{0}};
    Mesh mesh = make_square(50);
    use(&BLACK);
    const float green[3] = {0, 1, 0};
    assert_int_equal(renderer_set_mesh(&studio.renderer, &mesh, green, &error), RESULT_OK);
    mesh_destroy(&mesh);
    add_line((float[3]){-90, 20, 10}, (float[3]){90, 20, 10}, 3, 1);     // in front of the mesh
    add_line((float[3]){-90, -20, -10}, (float[3]){90, -20, -10}, 3, 1); // behind it
    studio_draw(&studio);
    assert_int_equal(studio_pixel(&studio, SIDE / 2, SIDE / 2 - 20)[0], 255);
    assert_int_equal(studio_pixel(&studio, SIDE / 2, SIDE / 2 + 20)[0], 0);
    assert_true(studio_pixel(&studio, SIDE / 2, SIDE / 2 + 20)[1] > 50); // lit by ambient light
    assert_int_equal(studio_pixel(&studio, SIDE / 2 + 70, SIDE / 2 + 20)[0], 255);
    assert_int_equal(studio_pixel(&studio, 5, 5)[1], 0);
}

// A slanted grey square in front of a white strand that fills its surroundings: no pixel along the
// edges is darkened by the black background, with either number of samples.
static void no_background_shows_between_a_silhouette_and_hair(void **state)
{
    (void)state;
    Error error = {{0}};
    RendererOptions options = BLACK;
    Mesh mesh = make_square(30);
    for (int v = 0; v < 4; ++v) mesh.position[v][0] += 0.3f * mesh.position[v][1];
    for (options.samples = 1; options.samples <= 2; ++options.samples) {
        use(&options);
        assert_int_equal(renderer_set_mesh(&studio.renderer, &mesh, (float[3]){1, 1, 1}, &error),
                         RESULT_OK);
        add_line((float[3]){-90, 0, -10}, (float[3]){90, 0, -10}, 60, 1);
        studio_draw(&studio);
        int grey = studio_pixel(&studio, SIDE / 2, SIDE / 2)[0];
        assert_true(grey > 50 && grey < 200); // the mesh
        for (int y = SIDE / 2 - 45; y < SIDE / 2 + 45; ++y)
            for (int x = SIDE / 2 - 45; x < SIDE / 2 + 45; ++x)
                if (studio_pixel(&studio, x, y)[0] < grey - 1)
                    fail_msg("%d, %d: %d, and the mesh is %d", x, y, studio_pixel(&studio, x, y)[0],
                             grey);
    }
    mesh_destroy(&mesh);
}

// Hundreds of strands, some wide, on both sides of a mesh that fills part of the image: the mesh
// hides all hair behind it, and beside it the image is as without the mesh.
static void a_mesh_hides_all_of_many_strands(void **state)
{
    (void)state;
    Error error = {{0}};
    Mesh mesh = make_square(50);
    size_t size;
    for (int wide = 0; wide < 2; ++wide) {
        use(&BLACK);
        add_tangle(200, wide ? 9 : 0.7f, 0.5f, NULL);
        uint8_t *without = draw_copy(&size);
        for (int v = 0; v < 4; ++v) mesh.position[v][2] = 300; // in front of all strands
        assert_int_equal(renderer_set_mesh(&studio.renderer, &mesh, (float[3]){0}, &error),
                         RESULT_OK);
        studio_draw(&studio);
        const int edge = (int)(50 * 1000 / 700.0); // px from the middle
        for (int y = 0; y < SIDE; ++y)
            for (int x = 0; x < SIDE; ++x) {
                int far =
                    abs(x - SIDE / 2) > abs(y - SIDE / 2) ? abs(x - SIDE / 2) : abs(y - SIDE / 2);
                const uint8_t *pixel = studio_pixel(&studio, x, y);
                const uint8_t black[3] = {0};
                if (far < edge - 2) assert_memory_equal(pixel, black, 3);
                if (far > edge + 2) assert_memory_equal(pixel, without + 3 * (y * SIDE + x), 3);
            }
        free(without);
        studio_clear(&studio);
    }
    mesh_destroy(&mesh);
}

// Two strands 2 px in front of and behind a mesh that slopes away from the eye by 1 px per pixel:
// depths must be right in every pixel, not just on average.
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

// Draws a white strand along x that is lit by this light alone; returns the brightness of its
// middle, 0..1.
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
    light.position[0] = 1e6f; // far away in the strand's direction
    assert_true(light_strand(&light) < 0.001);
}

// A lamp inside the hair is at most a million times as bright as at its reference distance; the
// squared distance would give four million. A block shows its middle, which is up to 2 px away: a
// fifteenth is allowed.
static void a_lamp_that_touches_hair_stays_finite(void **state)
{
    (void)state;
    use(&BLACK);
    const Light lamp = {.kind = LIGHT_POINT,
                        .color = {1, 1, 1},
                        .intensity = 0.4e-6f,
                        .position = {0, 0.5f, 0},
                        .distance = 1000};
    assert_true(fabs(light_strand(&lamp) - 0.4) < 0.01 + 0.4 / 15);
}

// Full brightness up to the inner angle, a quarter half-way between the cosines, none beyond the
// outer angle. The next vertices, 30 px away, are darker, and a block shows its middle, which is up
// to 2 px away: a fifteenth is allowed.
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

// The strand is 60 px in front of the square, and the light comes from 37 degrees to the right, so
// that its shadow lies 45 px to its left. There the light is reduced by the strand's opacity.
static void a_strand_throws_its_shadow_on_the_mesh(void **state)
{
    (void)state;
    RendererOptions options = BLACK;
    options.shadow = (ShadowOptions){.kind = SHADOW_DOM, .side = 256, .spacing = 200};
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

// A mesh that covers 0.4 of a pixel, with two of its four samples but not its middle, is visible by
// half. So is hair behind it; hair before it is whole.
static void an_edge_of_the_mesh_shows_by_its_samples(void **state)
{
    (void)state;
    static const struct {
        float opacity, z; // of the strand
        double edge;      // light
    } hair[] = {{1, -10, 0.5 * 0.15 + 0.5},
                {0.4f, -10, 0.5 * 0.15 + 0.5 * 0.4},
                {1, 10, 1},
                {0.4f, 10, 0.4 + 0.6 * 0.5 * 0.15}};
    Error error = {{0}};
    Mesh mesh = make_square(50.4f);
    use(&BLACK);
    assert_int_equal(renderer_set_mesh(&studio.renderer, &mesh, (const float[3]){1, 1, 1}, &error),
                     RESULT_OK);
    mesh_destroy(&mesh);
    studio.light = (Light){0};
    studio_draw(&studio);
    int whole = studio_pixel(&studio, SIDE / 2 + 49, SIDE / 2)[0],
        edge = studio_pixel(&studio, SIDE / 2 + 50, SIDE / 2)[0];
    assert_true(fabs(whole - srgb(0.15)) <= 1 && fabs(edge - srgb(0.15 / 2)) <= 1);
    assert_int_equal(studio_pixel(&studio, SIDE / 2 + 51, SIDE / 2)[0], 0);
    for (size_t i = 0; i < sizeof hair / sizeof *hair; ++i) {
        add_line((float[3]){0, 0, hair[i].z}, (float[3]){90, 0, hair[i].z}, 9, hair[i].opacity);
        studio_draw(&studio);
        edge = studio_pixel(&studio, SIDE / 2 + 50, SIDE / 2)[0];
        if (fabs(edge - srgb(hair[i].edge)) > studio_rounding(&studio))
            fail_msg("%zu: %d instead of %g", i, edge, srgb(hair[i].edge));
        studio_clear(&studio);
    }
    // Through one strand before it and past one behind it
    add_line((float[3]){0, 0, 10}, (float[3]){90, 0, 10}, 9, 0.4f);
    add_line((float[3]){0, 0, -10}, (float[3]){90, 0, -10}, 9, 0.4f);
    studio_draw(&studio);
    edge = studio_pixel(&studio, SIDE / 2 + 50, SIDE / 2)[0];
    double both = 0.4 + 0.6 * (0.5 * 0.15 + 0.5 * 0.4);
    if (fabs(edge - srgb(both)) > studio_rounding(&studio))
        fail_msg("both: %d instead of %g", edge, srgb(both));
}

// The brightness of a square's middle due to a light at `a` degrees, without the ambient part.
static double light_on_square(double a)
{
    const double turn = a * 3.14159265358979 / 180;
    double shown[2];
    for (int lit = 0; lit < 2; ++lit) {
        studio.light = (Light){.direction = {(float)sin(turn), 0, (float)cos(turn)},
                               .color = {1, 1, 1},
                               .intensity = (float)lit};
        studio_draw(&studio);
        shown[lit] = (double)*(const float *)(const void *)(studio.image.pixels +
                                                            ((size_t)(SIDE / 2) * SIDE + SIDE / 2) *
                                                                3 * sizeof(float));
    }
    return shown[1] - shown[0];
}

// Skin seen at right angles against the formulas that kernel/skin.h cites, in double precision; a
// black mesh shows the highlight alone. The mesh's pixels are half floats: a step is 2^-11.
static void skin_has_a_soft_edge_and_a_highlight(void **state)
{
    (void)state;
    const double wrap = 0.25, reflectance = 0.028, square = 0.28 * 0.28,
                 rounding = studio_rounding(&studio);
    RendererOptions options = BLACK;
    options.kind = IMAGE_FLOAT;
    options.mesh_shading = MESH_SKIN;
    Mesh mesh = make_square(100);
    for (int a = 0; a <= 110; a += 5) {
        double shown[2], c = cos(a * 3.14159265358979 / 180), light = fmax(c, 0),
                         half = sqrt(0.5 * (1 + c)), spread = half * half * (square - 1) + 1,
                         masking = 0.5 / (light * sqrt(1 * (1 - square) + square) +
                                          sqrt(light * light * (1 - square) + square)),
                         fresnel = reflectance + (1 - reflectance) * pow(1 - half, 5),
                         highlight = light * square / (spread * spread) * masking * fresnel,
                         diffuse = pow(fmax((c + wrap) / (1 + wrap), 0), 1 + 2 * wrap);
        for (int white = 0; white < 2; ++white) {
            const float color[3] = {(float)white, (float)white, (float)white};
            use(&options);
            NEEDED(renderer_set_mesh(&studio.renderer, &mesh, color, error));
            shown[white] = light_on_square(a);
        }
        double off[2] = {shown[0] - highlight, shown[1] - shown[0] - diffuse};
        if (!(fabs(off[0]) < rounding / 1024 && fabs(off[1]) < 2 * rounding / 1024))
            fail_msg("%d degrees: highlight %g, off by %g; diffuse %g, off by %g", a, highlight,
                     off[0], diffuse, off[1]);
    }
    mesh_destroy(&mesh);
}

// The brightness of a grey square of skin that sees the share `open` of the sky.
static double sky_on_square(const Mesh *mesh, float grey, float open)
{
    const float color[3] = {grey, grey, grey},
                shares[4][2] = {{open, open}, {open, open}, {open, open}, {open, open}};
    RendererOptions options = BLACK;
    options.kind = IMAGE_FLOAT;
    options.mesh_shading = MESH_SKIN;
    use(&options);
    NEEDED(renderer_set_mesh(&studio.renderer, mesh, color, error));
    NEEDED(renderer_set_openness(&studio.renderer, shares, error));
    studio_draw(&studio);
    return (double)*(const float *)(const void *)(studio.image.pixels +
                                                  ((size_t)(SIDE / 2) * SIDE + SIDE / 2) * 3 *
                                                      sizeof(float));
}

// A surface of colour c that sees the share o of the sky, and in other directions surfaces like
// itself, has the light o / (1 - c (1 - o)): white surfaces are fully lit, however little of the
// sky they see. The mesh's pixels are half floats.
static void surfaces_that_hide_the_sky_reflect_its_light(void **state)
{
    (void)state;
    static const float greys[] = {0.2f, 0.5f, 0.8f, 1}, opens[] = {0.9f, 0.4f, 0.1f};
    Mesh mesh = make_square(100);
    for (int g = 0; g < 4; ++g) {
        double whole = sky_on_square(&mesh, greys[g], 1),
               c = image_linear_from_srgb((double)greys[g]); // colours of meshes are in sRGB
        assert_true(whole > 0.1 * c);
        for (int i = 0; i < 3; ++i) {
            double o = (double)opens[i], shown = sky_on_square(&mesh, greys[g], opens[i]) / whole;
            // where the colour rounds down, by up to 2^-11, its reflections add up
            double lost = (studio_rounding(&studio) - 1) * 0x1p-11 * (1 - o) / (1 - c * (1 - o));
            if (!(fabs(shown / (o / (1 - c * (1 - o))) - 1) < 0x1p-9 + lost))
                fail_msg("grey %g, open %g: %g of the light", c, o, shown);
        }
        assert_true(sky_on_square(&mesh, greys[g], 0) < 1e-6 * whole); // no light, not NaN
    }
    mesh_destroy(&mesh);
}

static void put_square(void)
{
    Error error = {{0}};
    Mesh mesh = make_square(50);
    assert_int_equal(
        renderer_set_mesh(&studio.renderer, &mesh, (const float[3]){1, 0.5f, 0}, &error),
        RESULT_OK);
    mesh_destroy(&mesh);
}

// Hair moves in front of a still mesh (a studio has new hair in every image), and the light and the
// eye move: the images equal those of a renderer that has not drawn before.
static void a_mesh_is_drawn_again_where_it_looks_different(void **state)
{
    (void)state;
    RendererOptions options = BLACK;
    size_t size;
    View view, turned;
    studio_view(&view, options.width, options.height);
    turned = view;
    turned.view[3][0] += 20;
    turned.eye[0] -= 20;
    add_line((float[3]){20, -60, 60}, (float[3]){20, 60, 60}, 6, 0.8f);
    const Light front = {.direction = {0, 0, 1}, .color = {1, 1, 1}, .intensity = 0.5f},
                side = {.direction = {0.6f, 0, 0.8f}, .color = {1, 1, 1}, .intensity = 0.5f};
    const struct {
        Light light;
        const View *view;
        bool again;
    } pictures[] = {
        {front, &view, true}, {front, &view, false}, {side, &view, true}, {side, &turned, true}};
    for (int shadow = 0; shadow < 2; ++shadow) {
        options.shadow =
            (ShadowOptions){.kind = shadow ? SHADOW_DOM : SHADOW_NONE, .side = 64, .spacing = 200};
        uint8_t *seen[4];
        use(&options);
        put_square();
        for (int i = 0; i < 4; ++i) {
            uint64_t version = stage_base_version();
            studio.light = pictures[i].light;
            studio.light.shadow = shadow;
            studio_draw_view(&studio, pictures[i].view);
            seen[i] = studio_copy(&studio, &size);
            assert_int_equal(stage_base_version() - version, pictures[i].again || shadow);
        }
        for (int i = 0; i < 4; ++i) {
            use(&options);
            put_square();
            studio.light = pictures[i].light;
            studio.light.shadow = shadow;
            studio_draw_view(&studio, pictures[i].view);
            uint8_t *fresh = studio_copy(&studio, &size);
            assert_memory_equal(seen[i], fresh, size);
            free(fresh);
            free(seen[i]);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        CLAIM(mesh_hides_the_hair_behind_it_only),
        CLAIM(no_background_shows_between_a_silhouette_and_hair),
        CLAIM(a_mesh_hides_all_of_many_strands),
        CLAIM(hair_close_to_a_sloping_mesh_is_all_seen_or_all_hidden),
        CLAIM(light_falls_off_by_the_square_of_the_distance),
        CLAIM(a_lamp_that_touches_hair_stays_finite),
        CLAIM(a_spot_shines_into_its_cone),
        CLAIM(a_strand_throws_its_shadow_on_the_mesh),
        CLAIM(an_edge_of_the_mesh_shows_by_its_samples),
        CLAIM(skin_has_a_soft_edge_and_a_highlight),
        CLAIM(surfaces_that_hide_the_sky_reflect_its_light),
        CLAIM(a_mesh_is_drawn_again_where_it_looks_different),
    };
    const struct CMUnitTest edges[] = {CLAIM(an_edge_of_the_mesh_shows_by_its_samples)};
    return stage_run(tests) + stage_run_one(edges, RASTER_COMPUTE);
}
