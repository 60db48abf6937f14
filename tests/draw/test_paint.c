// SPDX-License-Identifier: MIT
// Colours and thickness that vary over a section.
#include "base/colors.h"
#include "draw/hair_paint.h"
#include "image/image.h"
#include "image/png.h"
#include "support/plain.h"
#include "support/studio.h"
#include "support/temporary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define NEEDED(call)                                                                               \
    do {                                                                                           \
        Error error_ = {{0}}, *error = &error_;                                                    \
        if ((call) != RESULT_OK) fail_msg("%s", error_.text);                                      \
    } while (0)

enum { STRANDS = 4, SIZE = 5 };

// Four parallel strands, 40 long, of five vertices each.
static Strands make_strands(void)
{
    float position[STRANDS * SIZE][3];
    for (int i = 0; i < STRANDS * SIZE; ++i) {
        position[i][0] = (float)(i / SIZE * 20 - 30);
        position[i][1] = (float)(i % SIZE * 10 - 20);
        position[i][2] = 0;
    }
    return studio_strands(STRANDS, SIZE, (const float(*)[3])position);
}

static SectionParams make_params(void)
{
    SectionParams params;
    plain_section(&params);
    studio_make_plain(&params, 1);
    return params;
}

static void nothing_to_paint_costs_nothing(void **state)
{
    (void)state;
    Strands strands = make_strands();
    SectionParams params = make_params();
    Paint paint;
    NEEDED(paint_create(&paint, &strands, &params, error));
    assert_null(paint.color);
    assert_null(paint.thickness);
    params_destroy_section(&params);
    strands_destroy(&strands);
}

static void tips_have_their_color(void **state)
{
    (void)state;
    Strands strands = make_strands();
    SectionParams params = make_params();
    Paint paint;
    params.tip_length = 0.5f;
    memcpy(params.tip_color, (float[3]){0, 1, 0}, sizeof params.tip_color);
    NEEDED(paint_create(&paint, &strands, &params, error));
    const float red[SIZE] = {1, 1, 1, 0.5f, 0};
    for (int j = 0; j < SIZE; ++j) {
        assert_true(fabsf(paint.color[SIZE + j][0] - red[j]) < 1e-6f);
        assert_true(paint.color[SIZE + j][1] == 1 && paint.color[SIZE + j][3] == 1);
    }
    paint_destroy(&paint);
    params_destroy_section(&params);
    strands_destroy(&strands);
}

static void what_the_file_has_is_used_unless_refused(void **state)
{
    (void)state;
    Strands strands = make_strands();
    SectionParams params = make_params();
    Paint paint;
    strands.color = calloc(strands.vertex_count, sizeof *strands.color);
    strands.strand_thickness = calloc(STRANDS, sizeof *strands.strand_thickness);
    assert_true(strands.color && strands.strand_thickness);
    for (int v = 0; v < STRANDS * SIZE; ++v) {
        strands.color[v][2] = (float)v / (STRANDS * SIZE);
        strands.color[v][3] = v % SIZE ? 0.5f : 1;
        strands.strand_thickness[v / SIZE] = (float)(v / SIZE + 1); // mean 2.5
    }
    params.tip_ratio = 0.5f;
    NEEDED(paint_create(&paint, &strands, &params, error));
    assert_true(paint.colors_from_file && paint.color[7][2] == 7.0f / (STRANDS * SIZE));
    assert_true(fabsf(paint.color[7][3] - 0.6f) < 1e-6f); // the mean of the strand
    assert_true(fabsf(paint.thickness[3 * SIZE] - 1.6f) < 1e-6f);
    assert_true(fabsf(paint.thickness[4 * SIZE - 1] - 0.8f) < 1e-6f); // the tip's ratio
    paint_destroy(&paint);
    params.file_colors = false;
    NEEDED(paint_create(&paint, &strands, &params, error));
    assert_true(!paint.colors_from_file && paint.color[7][2] == 1);
    assert_true(fabsf(paint.color[7][3] - 0.6f) < 1e-6f);
    paint_destroy(&paint);
    params.file_opacity = false;
    NEEDED(paint_create(&paint, &strands, &params, error));
    assert_true(paint.color[7][2] == 1 && paint.color[7][3] == 1);
    paint_destroy(&paint);
    params.file_thickness = false;
    NEEDED(paint_create(&paint, &strands, &params, error));
    assert_null(paint.color);
    params_destroy_section(&params);
    strands_destroy(&strands);
}

// If colours are refused, no paint is made, which would keep the section's initial colour; paint
// remains only for opacities.
static void refused_colors_paint_nothing(void **state)
{
    (void)state;
    Strands strands = make_strands();
    SectionParams params = make_params();
    Paint paint;
    strands.color = calloc(strands.vertex_count, sizeof *strands.color);
    assert_non_null(strands.color);
    for (uint32_t v = 0; v < strands.vertex_count; ++v) strands.color[v][3] = 1;
    params.file_colors = false;
    NEEDED(paint_create(&paint, &strands, &params, error));
    assert_null(paint.color);
    strands.color[0][3] = 0.5f;
    NEEDED(paint_create(&paint, &strands, &params, error));
    assert_non_null(paint.color);
    paint_destroy(&paint);
    params_destroy_section(&params);
    strands_destroy(&strands);
}

// From the top left: black, red / green, white. At the middles of texels nothing is interpolated.
static void a_picture_colors_strands_by_their_roots(void **state)
{
    Strands strands = make_strands();
    SectionParams params = make_params();
    Paint paint;
    Image map;
    Error why = {{0}};
    NEEDED(image_create(&map, 2, 2, 3, error));
    memcpy(map.pixels, (uint8_t[12]){0, 0, 0, 188, 0, 0, 0, 255, 0, 255, 255, 255}, 12);
    NEEDED(png_write(temporary_path(state, "map.png"), &map, error));
    image_destroy(&map);
    free(params.color_map);
    params.color_map = strdup(temporary_path(state, "map.png"));
    assert_int_equal(paint_create(&paint, &strands, &params, &why), RESULT_USAGE);
    assert_non_null(strstr(why.text, "no texture coordinates"));
    strands.strand_uv = calloc(STRANDS, sizeof *strands.strand_uv);
    assert_non_null(strands.strand_uv);
    const float uv[STRANDS][2] = {{0.25f, 0.75f}, {0.75f, 0.75f}, {-0.75f, 1.25f}, {0.5f, 0.25f}};
    memcpy(strands.strand_uv, uv, sizeof uv);
    NEEDED(paint_create(&paint, &strands, &params, error));
    const double expected[STRANDS][3] = {{0, 0, 0}, {0.5029, 0, 0}, {0, 1, 0}, {0.5, 1, 0.5}};
    for (int s = 0; s < STRANDS; ++s)
        for (int k = 0; k < 3; ++k)
            assert_true(fabs((double)paint.color[s * SIZE][k] - expected[s][k]) < 1e-4);
    paint_destroy(&paint);
    free(params.color_map);
    params.color_map = strdup("missing.png");
    assert_int_equal(paint_create(&paint, &strands, &params, &why), RESULT_BAD_INPUT);
    params_destroy_section(&params);
    strands_destroy(&strands);
}

static void melanin_gives_the_colors_of_hair(void **state)
{
    (void)state;
    SectionParams params = make_params();
    float color[3];
    paint_color(&params, color);
    assert_true(color[0] == 1);
    params.melanin = (AutoFloat){.value = 1.3f}; // dark brown; exp(-2 * 1.3 * 0.419) and so on
    paint_color(&params, color);
    assert_true(fabsf(color[0] - 0.3364f) < 1e-4f && fabsf(color[2] - 0.02838f) < 1e-4f);
    params.melanin.value = 0;
    paint_color(&params, color);
    assert_true(color[0] == 1 && color[2] == 1);
    params.melanin.value = 0.5f;
    params.melanin_redness = 1;
    paint_color(&params, color);
    assert_true(fabsf(color[1] - expf(-0.4f)) < 1e-6f);
    params_destroy_section(&params);
}

// Transmission and melanin are converted to the color that the fibres show; setting that color
// gives the same fibres again.
static void what_fibres_let_through_has_a_color(void **state)
{
    (void)state;
    static const struct {
        float transmission[3], melanin; // sRGB; < 0: none
        Shading shading;
        float roughness;
    } CASES[] = {
        {{0}, 1.3f, SHADING_MARSCHNER, 12},        {{0}, 0, SHADING_MARSCHNER, 12},
        {{0}, 0.2f, SHADING_MARSCHNER, 30},        {{1, 0.7f, 0.4f}, -1, SHADING_MARSCHNER, 12},
        {{1, 0.7f, 0.4f}, -1, SHADING_KAJIYA, 12}, {{0}, 0.6f, SHADING_KAJIYA, 12}};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; ++i) {
        SectionParams params = make_params();
        float wanted[3], got[3];
        params.shading = CASES[i].shading;
        params.azimuthal_roughness = CASES[i].roughness;
        if (CASES[i].melanin >= 0)
            params.melanin = (AutoFloat){.value = CASES[i].melanin};
        else
            memcpy(params.transmission.value, CASES[i].transmission, sizeof wanted),
                params.transmission.automatic = false;
        paint_color(&params, wanted);
        SectionParams seen = paint_as_seen(&params);
        assert_true(seen.transmission.automatic && seen.melanin.automatic);
        paint_color(&seen, got);
        if (i == 0) { // 0.0095 + 0.435 exp(-3.35 (1.3 * 0.419)^0.59) and so on
            const float shown[3] = {0.0514f, 0.0279f, 0.0134f};
            for (int k = 0; k < 3; ++k) assert_true(fabsf(got[k] - shown[k]) < 1e-4f);
        }
        seen.shading = params.shading;
        paint_color(&seen, got);
        for (int k = 0; k < 3; ++k) assert_true(fabsf(got[k] - wanted[k]) < 1e-4f);
        params_destroy_section(&params);
    }
}

// Every named hair colour lies in the range that fibres can show: all are reproduced to one level
// of 255.
static void fibres_can_show_what_has_a_name(void **state)
{
    (void)state;
    int count = 0;
    for (size_t i = 0; i < COLOR_NAME_COUNT; ++i) {
        if (!COLOR_NAMES[i].hair) continue;
        SectionParams params = make_params();
        Error error = {""};
        float through[3];
        assert_int_equal(params_parse(params_find("color"), &params, COLOR_NAMES[i].name, &error),
                         RESULT_OK);
        params.shading = SHADING_MARSCHNER;
        paint_color(&params, through);
        params.transmission.automatic = false;
        for (int k = 0; k < 3; ++k)
            params.transmission.value[k] = (float)image_srgb_from_linear((double)through[k]);
        SectionParams seen = paint_as_seen(&params);
        for (int k = 0; k < 3; ++k)
            if (fabsf(seen.color[k] - params.color[k]) > 1 / 255.0f)
                fail_msg("%s: channel %d is %.1f, not %.1f", COLOR_NAMES[i].name, k,
                         (double)(255 * seen.color[k]), (double)(255 * params.color[k]));
        ++count;
        params_destroy_section(&params);
    }
    assert_true(count > 10);
}

// Strands painted red, green and half transparent, and twice as thick, by both rasterisers.
static void hair_shows_its_paint(void **state)
{
    (void)state;
    const RendererOptions options = {.width = 128, .height = 128, .background = {0, 0, 0, 1}};
    for (Raster raster = RASTER_QUADS; raster <= RASTER_BLOCKS; ++raster) {
        Studio studio;
        RendererOptions mine = options;
        mine.raster = raster;
        studio_open(&studio, &mine);
        Strands strands = make_strands();
        float color[STRANDS * SIZE][4], thickness[STRANDS * SIZE];
        for (int v = 0; v < STRANDS * SIZE; ++v) {
            const float looks[STRANDS][5] = {
                {1, 0, 0, 1, 1}, {0, 1, 0, 1, 1}, {1, 1, 1, 0.5f, 1}, {1, 1, 1, 1, 2}};
            memcpy(color[v], looks[v / SIZE], sizeof color[v]);
            thickness[v] = looks[v / SIZE][4];
        }
        const Paint paint = {
            .color = color, .thickness = thickness, .vertex_count = STRANDS * SIZE};
        studio_add(&studio, &strands, 2, 1);
        NEEDED(hair_paint_upload(&studio.hair[0], &strands, &paint, &studio.gpu.limits, error));
        studio_draw(&studio);
        assert_int_equal(studio_pixel(&studio, 64 - 30, 64)[0], 255);
        assert_int_equal(studio_pixel(&studio, 64 - 30, 64)[1], 0);
        assert_int_equal(studio_pixel(&studio, 64 - 10, 64)[1], 255);
        // half of the light
        assert_true(abs(studio_pixel(&studio, 64 + 10, 64)[2] - 188) < studio_rounding(&studio));
        assert_int_equal(studio_pixel(&studio, 64 + 10 + 3, 64)[2], 0);
        assert_int_equal(studio_pixel(&studio, 64 + 30 + 3, 64)[2], 255);
        strands_destroy(&strands);
        studio_close(&studio);
    }
}

// Between two vertices, a smooth strand's half-width changes evenly from 4 to 12 px: 6 px after a
// quarter, 8 px half-way.
static void smooth_hair_is_as_thick_as_between_its_vertices(void **state)
{
    (void)state;
    enum { N = 3, PARTS = 4, LONG = 40 };
    const float position[N][3] = {{0, -LONG, 0}, {0, 0, 0}, {0, LONG, 0}};
    float color[N][4], thickness[N] = {1, 3, 1};
    for (int v = 0; v < N; ++v)
        for (int k = 0; k < 4; ++k) color[v][k] = 1;
    const Paint paint = {.color = color, .thickness = thickness, .vertex_count = N};
    for (Raster raster = RASTER_QUADS; raster <= RASTER_BLOCKS; ++raster) {
        Studio studio;
        studio_open(&studio, &(RendererOptions){.raster = raster, .width = 128, .height = 128});
        Strands strands = studio_strands(1, N, position);
        studio_add(&studio, &strands, 4, 1);
        studio.material[0].smooth = PARTS;
        studio.material[0].curve = CURVE_CATMULL_ROM;
        NEEDED(hair_paint_upload(&studio.hair[0], &strands, &paint, &studio.gpu.limits, error));
        studio_draw(&studio);
        for (int down = -3; down <= 3; ++down) { // quarters of the way
            int half = 4 + 2 * (4 - abs(down)), y = 64 + down * LONG / 4;
            assert_int_equal(studio_pixel(&studio, 64 + half - 2, y)[3], 255);
            assert_int_equal(studio_pixel(&studio, 64 + half + 1, y)[3], 0);
        }
        strands_destroy(&strands);
        studio_close(&studio);
    }
}

// White paint changes nothing, not even in the shadow of the strand on the right, which is dark.
static void painted_hair_lies_in_shadow(void **state)
{
    (void)state;
    for (Raster raster = RASTER_QUADS; raster <= RASTER_BLOCKS; ++raster) {
        Studio studio;
        studio_open(&studio,
                    &(RendererOptions){.raster = raster,
                                       .width = 128,
                                       .height = 128,
                                       .background = {0, 0, 0, 1},
                                       .shadow = {.kind = SHADOW_DOM, .side = 64, .spacing = 200}});
        Strands strands = make_strands();
        float color[STRANDS * SIZE][4], thickness[STRANDS * SIZE];
        for (int v = 0; v < STRANDS * SIZE; ++v) {
            for (int k = 0; k < 4; ++k) color[v][k] = 1;
            thickness[v] = 1;
        }
        const Paint paint = {
            .color = color, .thickness = thickness, .vertex_count = STRANDS * SIZE};
        studio.light =
            (Light){.direction = {1, 0, 0}, .color = {1, 1, 1}, .intensity = 1, .shadow = true};
        studio_add(&studio, &strands, 2, 1);
        studio.material[0].ambient = 0;
        studio.material[0].diffuse = 1;
        studio.material[0].shadow_opacity = 0.9f;
        studio_draw(&studio);
        size_t size;
        uint8_t *plain = studio_copy(&studio, &size);
        assert_true(studio_pixel(&studio, 64 + 30, 64)[0] > 250);
        assert_true(studio_pixel(&studio, 64 - 10, 64)[0] <
                    180); // exp(-0.9): half of white in sRGB
        NEEDED(hair_paint_upload(&studio.hair[0], &strands, &paint, &studio.gpu.limits, error));
        studio_draw(&studio);
        assert_memory_equal(plain, studio.image.pixels, size);
        free(plain);
        strands_destroy(&strands);
        studio_close(&studio);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_to_paint_costs_nothing),
        cmocka_unit_test(tips_have_their_color),
        cmocka_unit_test(what_the_file_has_is_used_unless_refused),
        cmocka_unit_test(refused_colors_paint_nothing),
        cmocka_unit_test_setup_teardown(a_picture_colors_strands_by_their_roots, temporary_create,
                                        temporary_destroy),
        cmocka_unit_test(melanin_gives_the_colors_of_hair),
        cmocka_unit_test(what_fibres_let_through_has_a_color),
        cmocka_unit_test(fibres_can_show_what_has_a_name),
        cmocka_unit_test(hair_shows_its_paint),
        cmocka_unit_test(smooth_hair_is_as_thick_as_between_its_vertices),
        cmocka_unit_test(painted_hair_lies_in_shadow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
