// SPDX-License-Identifier: MIT
#include "lanes/shadow_map.h"

#include "base/random.h"
#include "gen/strands_make.h"
#include "lanes/shadow_points.h"
#include "lanes/shadow_tile.h"
#include "strands/paint.h"
#include "support/shadow_stage.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// The same light but for rounding. A point that is rounded to another texel takes a quarter (the
// middle of 1 2 1 each way) of the optical depth of two texels of fibre, 0.4 each, with it: 0.2 at
// most. One that is read in the next layer lacks no more of its own, half of 0.4. Places of 128
// texels are known to 1e-5 texels, so that one point of 1e5 is, and their depths to 1e-5 of
// all, which is more of a layer near the first one, where layers begin with the root of the depth:
// no more of the sum than five times that.
static void expect_same_light(const float *a, const float *b, uint32_t count)
{
    double most = 0, sum = 0;
    for (uint32_t i = 0; i < count; ++i) {
        double off = fabs((double)a[i] - (double)b[i]);
        most = fmax(most, off), sum += off / count;
    }
    if (!(most < 0.2 && sum < 5e-5)) fail_msg("off by %g, in the mean %g", most, sum);
}

// What C has found at each vertex, which curves pass, too; the caller frees it.
static float *light_found(const ShadowStage *stage)
{
    const HairBatch *batch = &stage->hair.batches[0];
    const Look *look = &stage->casters[0].look;
    const ParticleLight *lights;
    HairBatch points = {.vertex_count = look_points(look, batch)};
    uint32_t count, n = batch->vertex_count, parts = look->material.smooth_parts;
    assert_true(hair_shadow_lights(&stage->shadow.hair, &lights, &count));
    assert_int_equal(count, 1);
    float *left = malloc((size_t)lights->left.size), *shares = malloc((size_t)lights->left.size);
    assert_true(left && shares);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, lights->left.buffer);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)lights->left.size, left);
    for (uint32_t s = 0; s < batch->strand_count; ++s)
        for (uint32_t j = 0; j < n; ++j)
            shares[stage->strands.first[batch->strand[s]] + j] =
                left[hair_address(&points, s, j * parts)];
    free(left);
    return shares;
}

// C and shaders make the same maps of fur and curls, finer and wider than texels, of straight
// segments and of either curve, and find the same light by them. (B-splines pass no vertex.)
static void c_and_shaders_are_alike(void **state)
{
    (void)state;
    const Light lights[] = {LIGHT_ABOVE, LIGHT_LAMP};
    const uint parts[] = {1, 3, 4};
    for (int i = 0; i < 24; ++i) {
        StrandsRecipe recipe = strands_make_recipe(i & 1 ? STRANDS_STYLE_CURLS : STRANDS_STYLE_FUR);
        Strands strands;
        ShadowStage stage;
        recipe.count = 1001, recipe.vertices = 16; // the last tile is not full
        NEEDED(strands_make(&strands, &recipe, error));
        float radius = (i & 2 ? 8 : 1) * paint_auto_radius(&strands, 0);
        shadow_stage_open(&stage, strands, radius, 0.33f, NULL, &lights[i / 4 % 2]);
        Look *look = &stage.casters[0].look;
        look->material.smooth_parts = parts[i / 8];
        look->material.smooth_curve = i / 8 == 2 ? CURVE_BSPLINE : CURVE_CATMULL_ROM;
        look->features = i < 8 ? 0 : LOOK_SMOOTH;
        stage.on_fibre = true;
        stage.copies = i % 3 == 0;
        uint32_t count = strands.vertex_count;
        float(*points)[4] = malloc(count * sizeof *points);
        assert_non_null(points);
        for (uint32_t v = 0; v < count; ++v) memcpy(points[v], strands.position[v], 12);
        for (Shadow kind = SHADOW_APPROX; kind <= SHADOW_DOM; ++kind) {
            float *shares[3];
            for (int way = 0; way < 2; ++way) {
                shadow_stage_draw(&stage, kind, 128, 200, way);
                shares[way] = shadow_stage_light(&stage, (const float(*)[4])points, count);
            }
            expect_same_light(shares[0], shares[1], count);
            shares[2] = kind == SHADOW_DOM && i < 16 ? light_found(&stage) : NULL;
            if (shares[2]) expect_same_light(shares[1], shares[2], count);
            for (int k = 0; k < 3; ++k) free(shares[k]);
        }
        free(points);
        shadow_stage_close(&stage);
    }
}

// Sums are integers, and the least of some depths is the same in any order.
static void c_makes_the_same_maps_with_any_thread_count(void **state)
{
    (void)state;
    enum { SIDE = 64, TEXELS = SIDE * SIDE, STRANDS = 10 * STRAND_TILE, N = 6 };
    static float position[STRANDS * N][4], depths[2][TEXELS];
    static uint32_t layers[2][TEXELS * SHADOW_LAYERS];
    Random random = random_create(7, 0);
    for (int i = 0; i < STRANDS * N; ++i) {
        for (int k = 0; k < 3; ++k) position[i][k] = (float)random_real(&random);
        position[i][3] = 1;
    }
    const MappedCaster caster = {.position = (const float(*)[4])position,
                                 .material = {.radius = 0.005f,
                                              .tip_ratio = 0.5f,
                                              .shadow_opacity = 0.5f,
                                              .vertex_count = N,
                                              .smooth_parts = 1,
                                              .drawn_strands = STRANDS - 3,
                                              .last_strand = STRANDS - 4,
                                              .last_share = 0.4f}};
    const CastParams params = {
        .side = SIDE,
        .unit = 1000,
        .texels = SIDE,
        .from_world = {{SIDE, 0, 0, 0}, {0, SIDE, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    ShadowMap shadow;
    NEEDED(shadow_map_create(&shadow, SIDE, true, error));
    for (int parts = shadow.parts; parts >= 1; --parts) {
        int at = parts == shadow.parts ? 0 : 1;
        ShadowMap some = shadow;
        some.parts = parts;
        shadow_map_draw_deep(&some, &params, (MappedCasters){&caster, 1}, depths[at], layers[at]);
        assert_memory_equal(depths[at], depths[0], sizeof depths[0]);
        assert_memory_equal(layers[at], layers[0], sizeof layers[0]);
    }
    const int middle = TEXELS / 2 + SIDE / 2; // where there is hair
    assert_true(depths[0][middle] < 1 && layers[0][TEXELS * (SHADOW_LAYERS - 1) + middle] != 0);
    shadow_map_destroy(&shadow);
}

// Points that were found once are those that each pass finds, of straight and of smooth hair.
static void points_are_found_once(void **state)
{
    (void)state;
    enum { STRANDS = 3 * STRAND_TILE, N = 6, MOST_PARTS = 3 };
    static float position[STRANDS * N][4];
    Random random = random_create(9, 0);
    for (int i = 0; i < STRANDS * N; ++i)
        for (int k = 0; k < 3; ++k) position[i][k] = (float)random_real(&random);
    for (int i = 0; i < 2 * MOST_PARTS; ++i) {
        MappedCaster caster = {.position = (const float(*)[4])position,
                               .material = {.vertex_count = N,
                                            .smooth_parts = (uint)(1 + i % MOST_PARTS),
                                            .smooth_curve = (uint)(i / MOST_PARTS),
                                            .drawn_strands = STRANDS - 3}};
        MappedCaster before = caster;
        ShadowPoints points = {0};
        shadow_points_find(&points, &caster, 1, 2);
        assert_non_null(caster.points);
        for (int t = 0; t < STRANDS / STRAND_TILE; ++t)
            for (int j = 0; j < mapped_caster_points(&caster); ++j) {
                float own[3][STRAND_TILE];
                Tile tile = {.caster = &before, .number = (size_t)t},
                     found = {.caster = &caster, .number = (size_t)t};
                assert_memory_equal(find_points(&found, j, NULL), find_points(&tile, j, own),
                                    sizeof own);
            }
        shadow_points_destroy(&points);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(c_and_shaders_are_alike),
        cmocka_unit_test(c_makes_the_same_maps_with_any_thread_count),
        cmocka_unit_test(points_are_found_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
