// SPDX-License-Identifier: MIT
#include "draw/hair_paint.h"
#include "gen/strands_make.h"
#include "gpu/gpu_uniforms.h"
#include "strands/paint.h"
#include "support/shadow_stage.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static ShadowWay way; // the way under test

static int by_shaders(void **state)
{
    (void)state;
    way = SHADOW_BY_SHADERS;
    return 0;
}

static int by_lanes(void **state)
{
    (void)state;
    way = SHADOW_BY_LANES;
    return 0;
}

static void draw_maps(ShadowStage *stage, Shadow kind, int side, float spacing)
{
    shadow_stage_draw(stage, kind, side, spacing, way);
}

static float light_at(ShadowStage *stage, float x, float y, float z)
{
    const float point[1][4] = {{x, y, z, 1}};
    float *share = shadow_stage_light(stage, point, 1), value = *share;
    free(share);
    return value;
}

static void expect_light(ShadowStage *stage, float x, float y, float z, double expected,
                         double tolerance)
{
    shadow_assert_near((double)light_at(stage, x, y, z), expected, tolerance);
}

// Strands are much wider than a texel, so that their blurred edges lie far from the points. In each
// gap, the layers in front of the point are complete, whatever the map's own layers are. The
// tolerance covers sums of about a thousand values that are rounded to steps of 2^-16, and points
// that share a texel.
static void layers_of_hair_multiply(void **state)
{
    (void)state;
    ShadowStage stage;
    for (int lamp = 0; lamp < 2; ++lamp) {
        shadow_stage_open(&stage, shadow_stage_layers(5), 0.06f, 0.3f, NULL,
                          lamp ? &LIGHT_LAMP : &LIGHT_ABOVE);
        draw_maps(&stage, SHADOW_DOM, 256, 1);
        expect_light(&stage, 0.1f, 1, 0, 1, 1e-6);
        for (int n = 1; n <= 5; ++n) {
            float y = 0.05f - 0.1f * (float)n;
            shadow_assert_near(shadow_stage_exact(&stage, 0.1, (double)y, 0), pow(0.7, n), 1e-6);
            expect_light(&stage, 0.1f, y, 0, pow(0.7, n), 0.03);
            expect_light(&stage, 0.1f, y, 0.2f, 1, 1e-6);
        }
        expect_light(&stage, 3, -2, 0, 1, 0); // outside the map
        shadow_stage_close(&stage);
    }
}

// The approximate scheme assumes evenly spaced fibres. If they are evenly spaced, it gives the
// exact light behind n of them, within the precision of its depths.
static void approximated_layers_multiply_at_even_distances(void **state)
{
    (void)state;
    const float radius = 0.06f, distance = 0.1f;
    ShadowStage stage;
    shadow_stage_open(&stage, shadow_stage_layers(5), radius, 0.3f, NULL, &LIGHT_ABOVE);
    draw_maps(&stage, SHADOW_APPROX, 256, distance / radius);
    for (int n = 1; n <= 4; ++n) {
        float y = 0.001f - distance * (float)n;
        shadow_assert_near(shadow_stage_exact(&stage, 0.1, (double)y, 0), pow(0.7, n), 1e-6);
        expect_light(&stage, 0.1f, y, 0, pow(0.7, n), 0.01);
        expect_light(&stage, 0.1f, y, 0.2f, 1, 1e-6);
    }
    shadow_stage_close(&stage);
}

// Behind one fibre, both schemes reduce light by its opacity; in front of it, light is complete.
static void one_fibre_takes_its_opacity(void **state)
{
    (void)state;
    for (Shadow kind = SHADOW_APPROX; kind <= SHADOW_DOM; ++kind) {
        ShadowStage stage;
        shadow_stage_open(&stage, shadow_stage_layers(1), 0.06f, 0.4f, NULL, &LIGHT_ABOVE);
        draw_maps(&stage, kind, 256, 1e5f);
        expect_light(&stage, 0.1f, 0.1f, 0, 1, 1e-6);
        expect_light(&stage, 0.1f, -0.1f, 0, 0.6, 0.02);
        expect_light(&stage, 0.1f, -0.1f, 0.3f, 1, 1e-6);
        shadow_stage_close(&stage);
    }
}

static void mesh_stands_in_the_light(void **state)
{
    (void)state;
    Mesh mesh = shadow_stage_square(-0.05f, 0.3f);
    for (int lamp = 0; lamp < 2; ++lamp) {
        ShadowStage stage;
        shadow_stage_open(&stage, shadow_stage_layers(2), 0.06f, 0.3f, &mesh,
                          lamp ? &LIGHT_LAMP : &LIGHT_ABOVE);
        draw_maps(&stage, SHADOW_DOM, 256, 1);
        expect_light(&stage, 0.1f, -0.04f, 0, 0.7, 0.03); // in front of it
        expect_light(&stage, 0.1f, -0.06f, 0, 0, 1e-6);   // behind it
        expect_light(&stage, 0.1f, -0.08f, 0.25f, 0, 1e-6);
        expect_light(&stage, 0.1f, -0.08f, 0.4f, 1, 1e-6); // next to it
        shadow_stage_close(&stage);
    }
    mesh_destroy(&mesh);
}

// Slanted light lights a mesh evenly: the mesh casts no shadow on itself. The hair's shadow falls
// elsewhere.
static void a_lit_mesh_has_no_shadow_of_its_own(void **state)
{
    (void)state;
    enum { POINTS = 21 };
    for (float slope = -1.5f; slope <= 1.5f; slope += 0.75f) {
        Mesh mesh = shadow_stage_square(-0.5f, 0.5f);
        for (int v = 0; v < 4; ++v) mesh.position[v][1] += slope * mesh.position[v][2];
        ShadowStage stage;
        shadow_stage_open(&stage, shadow_stage_layers(1), 0.01f, 0.3f, &mesh, &LIGHT_ABOVE);
        draw_maps(&stage, SHADOW_DOM, 256, 1);
        float points[POINTS * POINTS][4];
        uint32_t count = 0;
        for (int i = 0; i < POINTS; ++i)
            for (int j = 0; j < POINTS; ++j) {
                float x = 0.037f * (float)(i - POINTS / 2), z = 0.037f * (float)(j - POINTS / 2);
                if (fabsf(z) < 0.1f) continue;
                memcpy(points[count++], ((float[4]){x, -0.5f + slope * z, z, 1}), 16);
            }
        float *light = shadow_stage_light(&stage, (const float(*)[4])points, count);
        for (uint32_t i = 0; i < count; ++i) shadow_assert_near((double)light[i], 1, 1e-6);
        free(light);
        shadow_stage_close(&stage);
        mesh_destroy(&mesh);
    }
}

// Integral of p (1 - p) across a shadow's edge in texels, where p is the share of light that is
// blocked, by the definition of the map's filter: 5 x 5 texels with the weights of a cone with a
// radius of 3 texels.
static double penumbra_of_cone(void)
{
    enum { STEPS = 200 };
    double sum = 0;
    for (int i = -4 * STEPS; i < 4 * STEPS; ++i) {
        double u = (i + 0.5) / STEPS, off = u - floor(u) - 0.5, gone = 0, all = 0;
        for (int y = -2; y <= 2; ++y)
            for (int x = -2; x <= 2; ++x) {
                double weight = fmax(3 - hypot(x, y - off), 0);
                all += weight;
                if (floor(u) + y < 0) gone += weight;
            }
        sum += gone / all * (1 - gone / all) / STEPS;
    }
    return sum;
}

// The filter of TressFX's maps. The point's position along the edge within a texel changes the
// result by 1 %.
static void the_edge_of_a_shadow_is_as_soft_as_its_filter(void **state)
{
    (void)state;
    enum { STEPS = 400 };
    ShadowStage stage;
    shadow_stage_open(&stage, shadow_stage_layers(1), 0.1f, 0.4f, NULL, &LIGHT_ABOVE);
    draw_maps(&stage, SHADOW_APPROX, 64, 1e5f);
    const float(*to)[4] = (const float(*)[4])shadow_stage_params(&stage)->from_world[0];
    double texels = hypot((double)to[0][2], (double)to[1][2]), sum = 0; // texels per metre along z
    float points[STEPS][4];
    for (int i = 0; i < STEPS; ++i)
        memcpy(points[i], ((float[4]){0.1f, -0.3f, 0.5f * ((float)i + 0.5f) / STEPS, 1}), 16);
    float *light = shadow_stage_light(&stage, (const float(*)[4])points, STEPS);
    for (int i = 0; i < STEPS; ++i) {
        double gone = (1 - (double)light[i]) / 0.4;
        sum += gone * (1 - gone) * 0.5 / STEPS * texels;
    }
    shadow_assert_near(sum, penumbra_of_cone(), 0.03 * penumbra_of_cone());
    free(light);
    shadow_stage_close(&stage);
}

// Thickness and opacity from a file: the first strand grows from 1 to 3 radii, and the second has
// half of the material's opacity.
static void shadows_are_as_wide_and_dark_as_the_paint(void **state)
{
    (void)state;
    enum { VERTICES = 5 };
    ShadowStage stage;
    Strands strands = shadow_stage_layers(2);
    for (int v = VERTICES; v < 2 * VERTICES; ++v) strands.position[v][2] = 0.5f;
    shadow_stage_open(&stage, strands, 0.03f, 0.4f, NULL, &LIGHT_ABOVE);
    float color[2 * VERTICES][4], thickness[2 * VERTICES];
    for (int v = 0; v < 2 * VERTICES; ++v) {
        for (int k = 0; k < 4; ++k) color[v][k] = k == 3 && v >= VERTICES ? 0.5f : 1;
        thickness[v] = v < VERTICES ? 1 + 0.5f * (float)v : 2;
    }
    const Paint paint = {.color = color, .thickness = thickness, .vertex_count = 2 * VERTICES};
    NEEDED(hair_paint_upload(&stage.hair, &strands, &paint, &fixture_gpu()->limits, error));
    stage.item.paint = &paint;
    shadow_reference_destroy(&stage.reference);
    NEEDED(shadow_reference_create(&stage.reference, &stage.reference_scene, &LIGHT_ABOVE,
                                   (const float[3]){0}, error));
    for (Shadow kind = SHADOW_APPROX; kind <= SHADOW_DOM; ++kind) {
        draw_maps(&stage, kind, 256, 1e5f);
        const float places[][2] = {{-0.4f, 0.015f}, {-0.4f, 0.06f}, {0.4f, 0.06f},
                                   {0.4f, 0.12f},   {0, 0.48f},     {0, 0.6f}};
        for (size_t i = 0; i < 6; ++i) {
            float x = places[i][0], z = places[i][1];
            if (kind == SHADOW_APPROX && z > 0.4f) continue; // knows the mean opacity only
            expect_light(&stage, x, -0.3f, z,
                         shadow_stage_exact(&stage, (double)x, -0.3, (double)z), 0.02);
        }
    }
    shadow_assert_near(shadow_stage_exact(&stage, 0, -0.3, 0.48), 0.8, 1e-6); // 1 - 0.5 * 0.4
    shadow_stage_close(&stage);
}

// A bent strand of three particles as a B-spline, which reaches only two thirds of the way to its
// corner.
static void smooth_strands_cast_the_shadow_of_their_curve(void **state)
{
    (void)state;
    ShadowStage stage;
    Strands strands;
    NEEDED(strands_create(&strands, 1, 3, error));
    strands.first[1] = 3;
    const float corners[3][3] = {{-0.5f, 0, 0}, {0, 0, 0.5f}, {0.5f, 0, 0}};
    memcpy(strands.position, corners, sizeof corners);
    shadow_stage_open(&stage, strands, 0.03f, 0.4f, NULL, &LIGHT_ABOVE);
    Look *look = &stage.looks[0];
    for (Shadow kind = SHADOW_APPROX; kind <= SHADOW_DOM; ++kind)
        for (uint parts = 1; parts <= 20; parts += 19) {
            look->material.smooth_parts = parts;
            look->material.smooth_curve = CURVE_BSPLINE;
            look->features = parts > 1 ? LOOK_SMOOTH : 0;
            draw_maps(&stage, kind, 256, 1e5f);
            expect_light(&stage, 0, -0.1f, 1 / 3.0f, parts > 1 ? 0.6 : 1, 0.02);
            expect_light(&stage, -0.1f, -0.1f, 0.4f, parts > 1 ? 1 : 0.6, 0.02);
        }
    shadow_stage_close(&stage);
}

// Three eighths of four parallel strands: one and a half strands, wider by the inverse of the
// share.
static void strands_left_out_cast_no_shadow(void **state)
{
    (void)state;
    ShadowStage stage;
    Strands strands = shadow_stage_layers(4);
    for (uint32_t v = 0; v < strands.vertex_count; ++v) {
        strands.position[v][2] = -2 * strands.position[v][1];
        strands.position[v][1] = 0;
    }
    shadow_stage_open(&stage, strands, 0.02f, 0.4f, NULL, &LIGHT_ABOVE);
    Look *look = &stage.looks[0];
    look->share = 0.375f; // one and a half strands
    look->material.radius /= look->share;
    for (Shadow kind = SHADOW_APPROX; kind <= SHADOW_DOM; ++kind) {
        draw_maps(&stage, kind, 256, 1e5f);
        expect_light(&stage, 0, -0.1f, 0.04f, 0.6, 0.02);         // half-width 0.053
        expect_light(&stage, 0, -0.1f, 0.015f + 0.2f, 0.6, 0.02); // half-width 0.027
        expect_light(&stage, 0, -0.1f, 0.04f + 0.2f, 1, 0.02);
        expect_light(&stage, 0, -0.1f, 0.4f, 1, 0);
    }
    for (uint32_t pass = 0; pass < 2; ++pass) { // a changed share requires new maps
        assert_int_equal(shadow_stage_again(&stage), pass);
        look->share = 0.5f;
    }
    shadow_stage_close(&stage);
}

// A mesh's maps are kept if only hair moves: the test erases them, so that one can see whether they
// are drawn again.
static void the_meshs_maps_are_kept_while_it_stands(void **state)
{
    (void)state;
    ShadowStage stage;
    Mesh square = shadow_stage_square(0.2f, 0.3f);
    const struct {
        float shift;
        bool forget, drawn;
    } pictures[] = {{0, false, false},   {0.05f, false, true},   {0.05f, false, false},
                    {0.05f, true, true}, {0.0501f, false, true}, {0, false, true}};
    shadow_stage_open(&stage, shadow_stage_layers(1), 0.01f, 0.3f, &square, &LIGHT_ABOVE);
    draw_maps(&stage, SHADOW_DOM, 64, 1);
    expect_light(&stage, 0.2f, -0.5f, 0.2f, 0, 0);
    for (size_t i = 0; i < sizeof pictures / sizeof *pictures; ++i) {
        DrawParams draw = {.head_rotation = {0, 0, 0, 1},
                           .head_translation = {pictures[i].shift, 0, 0}};
        gpu_uniforms_set(BIND_DRAW, &draw, sizeof draw);
        stage.scene.mesh.translation[0] = pictures[i].shift;
        ++stage.scene.revision;
        if (pictures[i].forget) shadow_stage_forget_mesh(&stage);
        shadow_stage_wipe_mesh(&stage);
        assert_int_equal(shadow_stage_again(&stage), 1);
        expect_light(&stage, 0.2f, -0.5f, 0.2f, pictures[i].drawn ? 0 : 1, 0);
    }
    shadow_stage_close(&stage);
    mesh_destroy(&square);
}

static void maps_are_kept_while_nothing_changes(void **state)
{
    (void)state;
    ShadowStage stage;
    shadow_stage_open(&stage, shadow_stage_layers(2), 0.06f, 0.3f, NULL, &LIGHT_ABOVE);
    draw_maps(&stage, SHADOW_DOM, 64, 1);
    const struct {
        uint64_t revision;
        float way;
        uint32_t drawn;
    } pictures[] = {{1, 0, 0},    {2, 0, 1},    {2, 0, 0},   {2, 0.5f, 1},
                    {2, 0.5f, 0}, {0, 0.5f, 1}, {0, 0.5f, 1}};
    for (size_t i = 0; i < sizeof pictures / sizeof *pictures; ++i) {
        stage.scene.revision = pictures[i].revision;
        stage.light.direction[0] = pictures[i].way;
        assert_int_equal(shadow_stage_again(&stage), pictures[i].drawn);
    }
    stage.light.shadow = false;
    assert_int_equal(shadow_stage_again(&stage), 0);
    expect_light(&stage, 0.1f, -0.5f, 0, 1, 0);
    shadow_stage_close(&stage);
}

static void broken_positions_leave_the_rest_its_shadow(void **state)
{
    (void)state;
    const float values[] = {NAN, INFINITY, -1e30f, 1e7f};
    for (size_t i = 0; i < sizeof values / sizeof *values; ++i) {
        ShadowStage stage;
        Strands strands = shadow_stage_layers(2);
        strands.position[7][i % 3] = values[i];
        shadow_stage_open(&stage, strands, 0.06f, 0.4f, NULL, &LIGHT_ABOVE);
        draw_maps(&stage, SHADOW_DOM, 256, 1);
        expect_light(&stage, 0.1f, -0.05f, 0, 0.6, 0.02);
        shadow_stage_close(&stage);
    }
}

typedef struct Fit {
    double rms, bias;
} Fit;

// Every 29th vertex: thousands of each set, and all positions along a strand alike.
enum { JUDGED = 29 };

// The exact light at these vertices, in order; release with free().
static double *find_exact(const ShadowStage *stage)
{
    const Strands *strands = &stage->strands;
    double *exact = malloc((strands->vertex_count / JUDGED + 1) * sizeof *exact);
    assert_non_null(exact);
    for (uint32_t v = 0; v < strands->vertex_count; v += JUDGED) {
        const float *x = strands->position[v];
        exact[v / JUDGED] = shadow_reference_light(
            &stage->reference, (const double[3]){(double)x[0], (double)x[1], (double)x[2]},
            (double)stage->item.radius);
    }
    return exact;
}

// Compares with the exact light. Most of the difference is noise of the exact light, which jumps by
// the opacity at every fibre's edge, while maps average over texels.
static Fit judge(ShadowStage *stage, const double *exact)
{
    const Strands *strands = &stage->strands;
    uint32_t count = 0;
    float(*points)[4] = malloc((strands->vertex_count / JUDGED + 1) * sizeof *points);
    assert_non_null(points);
    for (uint32_t v = 0; v < strands->vertex_count; v += JUDGED, ++count)
        memcpy(points[count], strands->position[v], 12);
    stage->on_fibre = true;
    float *shares = shadow_stage_light(stage, (const float(*)[4])points, count);
    Fit fit = {0};
    for (uint32_t i = 0; i < count; ++i) {
        double off = (double)shares[i] - exact[i];
        fit.rms += off * off / count;
        fit.bias += off / count;
    }
    fit.rms = sqrt(fit.rms);
    free(points);
    free(shares);
    return fit;
}

// The bounds are slightly above the measured values (docs/light.md).
static void deep_maps_are_near_the_exact_light(void **state)
{
    (void)state;
    const struct {
        StrandsStyle style;
        uint32_t count, vertices;
        double rms;
    } sets[] = {{STRANDS_STYLE_STRAIGHT, 10000, 32, 0.16},
                {STRANDS_STYLE_CURLS, 10000, 32, 0.15},
                {STRANDS_STYLE_FUR, 37747, 8, 0.16}};
    Light light = LIGHT_ABOVE;
    memcpy(light.direction, (float[3]){0.36f, 0.8f, 0.48f}, sizeof light.direction);
    for (size_t i = 0; i < sizeof sets / sizeof *sets; ++i) {
        StrandsRecipe recipe = strands_make_recipe(sets[i].style);
        Strands strands;
        ShadowStage stage;
        recipe.count = sets[i].count, recipe.vertices = sets[i].vertices;
        NEEDED(strands_make(&strands, &recipe, error));
        shadow_stage_open(&stage, strands, paint_auto_radius(&strands, 0), 0.33f, NULL, &light);
        double *exact = find_exact(&stage);
        for (way = SHADOW_BY_SHADERS; way <= SHADOW_BY_LANES; ++way) {
            draw_maps(&stage, SHADOW_DOM, 256, 200);
            Fit deep = judge(&stage, exact);
            draw_maps(&stage, SHADOW_APPROX, 256, 200);
            Fit approximated = judge(&stage, exact);
            print_message("%u x %u, by %s: off by %.3f (mean %+.3f) dom, %.3f (%+.3f) approx\n",
                          recipe.count, recipe.vertices,
                          way == SHADOW_BY_LANES ? "lanes" : "shaders", deep.rms, deep.bias,
                          approximated.rms, approximated.bias);
            assert_true(deep.rms < sets[i].rms && fabs(deep.bias) < 0.02);
            assert_true(deep.rms < approximated.rms);
        }
        free(exact);
        shadow_stage_close(&stage);
    }
}

int main(void)
{
    const struct CMUnitTest maps[] = {
        cmocka_unit_test(layers_of_hair_multiply),
        cmocka_unit_test(approximated_layers_multiply_at_even_distances),
        cmocka_unit_test(one_fibre_takes_its_opacity),
        cmocka_unit_test(mesh_stands_in_the_light),
        cmocka_unit_test(a_lit_mesh_has_no_shadow_of_its_own),
        cmocka_unit_test(the_edge_of_a_shadow_is_as_soft_as_its_filter),
        cmocka_unit_test(shadows_are_as_wide_and_dark_as_the_paint),
        cmocka_unit_test(smooth_strands_cast_the_shadow_of_their_curve),
        cmocka_unit_test(strands_left_out_cast_no_shadow),
        cmocka_unit_test(maps_are_kept_while_nothing_changes),
        cmocka_unit_test(the_meshs_maps_are_kept_while_it_stands),
        cmocka_unit_test(broken_positions_leave_the_rest_its_shadow),
    };
    // Growing the hair and finding the exact light take longer than both ways' maps.
    const struct CMUnitTest shared[] = {cmocka_unit_test(deep_maps_are_near_the_exact_light)};
    int failed = cmocka_run_group_tests_name("by shaders", maps, by_shaders, NULL);
    failed += cmocka_run_group_tests_name("by lanes", maps, by_lanes, NULL);
    return failed + cmocka_run_group_tests_name("by both", shared, NULL, NULL);
}
