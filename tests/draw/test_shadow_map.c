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

// Equal light, except for rounding. A point that is rounded to another texel changes its optical
// depth by a quarter (the middle of 1 2 1 in both directions) of that of two fibre texels, 0.4
// each: 0.2 at most. A point that is read in the next layer misses at most half of its own 0.4.
// Positions among 128 texels are accurate to 1e-5 texels, which moves one point of 1e5 to another
// texel. Depths are accurate to 1e-5 of the whole range, which is a larger part of the first
// layers, because layers are spaced by the root of the depth: at most five times as many points
// change.
static void expect_same_light(const float *a, const float *b, uint32_t count)
{
    double most = 0, sum = 0;
    for (uint32_t i = 0; i < count; ++i) {
        double off = fabs((double)a[i] - (double)b[i]);
        most = fmax(most, off), sum += off / count;
    }
    if (!(most < 0.2 && sum < 5e-5)) fail_msg("off by %g, in the mean %g", most, sum);
}

// C and shaders make the same maps of fur and curls, thinner and wider than texels, with straight
// segments and both kinds of curve, and compute the same light from them.
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
        Look *look = &stage.looks[0];
        look->material.smooth_parts = parts[i / 8];
        look->material.smooth_curve = i / 8 == 2 ? CURVE_BSPLINE : CURVE_CATMULL_ROM;
        look->features = i < 8 ? 0 : LOOK_SMOOTH;
        stage.on_fibre = true;
        uint32_t count = strands.vertex_count;
        float(*points)[4] = malloc(count * sizeof *points);
        assert_non_null(points);
        for (uint32_t v = 0; v < count; ++v) memcpy(points[v], strands.position[v], 12);
        for (Shadow kind = SHADOW_APPROX; kind <= SHADOW_DOM; ++kind) {
            float *shares[2];
            for (int way = 0; way < 2; ++way) {
                shadow_stage_draw(&stage, kind, 128, 200, (ShadowWay)way);
                shares[way] = shadow_stage_light(&stage, (const float(*)[4])points, count);
            }
            expect_same_light(shares[0], shares[1], count);
            free(shares[0]);
            free(shares[1]);
        }
        free(points);
        shadow_stage_close(&stage);
    }
}

// Sums are integers, and the minimum of depths does not depend on their order.
static void c_makes_the_same_maps_with_any_thread_count(void **state)
{
    (void)state;
    enum { SIDE = 64, TEXELS = SIDE * SIDE, STRANDS = 10 * STRAND_TILE, N = 6 };
    static float position[STRANDS * N][4], depths[2][2 * TEXELS];
    static uint32_t layers[2][2 * TEXELS * SHADOW_LAYERS];
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
    const CastParams along = {
        .side = SIDE,
        .unit = 1000,
        .texels = SIDE,
        .from_world = {{SIDE, 0, 0, 0}, {0, SIDE, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    CastParams params[2] = {along, along}; // the second light shines along y
    for (int i = 1; i < 3; ++i) glm_vec4_zero(params[1].from_world[i]);
    params[1].from_world[1][2] = SIDE, params[1].from_world[2][1] = 1;
    MappedCaster much = caster;
    much.material.drawn_strands = 1 << 20;
    ShadowMap shadow;
    NEEDED(shadow_map_create(&shadow, SIDE, true, error));
    NEEDED(shadow_map_reserve(&shadow, 2, (MappedCasters){&much, 1}, error));
    assert_int_equal(shadow.drawers, shadow.parts);
    assert_int_equal(shadow.at_once, 2);
    for (int at_once = 2; at_once >= 1; --at_once)
        for (int parts = shadow.parts; parts >= 1; --parts) {
            int at = parts == shadow.parts && at_once == 2 ? 0 : 1;
            ShadowMap some = shadow;
            some.parts = some.drawers = parts;
            some.at_once = at_once;
            shadow_map_draw(&some, params, 2, (MappedCasters){&caster, 1}, depths[at], layers[at]);
            assert_memory_equal(depths[at], depths[0], sizeof depths[0]);
            assert_memory_equal(layers[at], layers[0], sizeof layers[0]);
        }
    assert_memory_not_equal(layers[0], layers[0] + TEXELS * SHADOW_LAYERS, sizeof layers[0] / 2);
    // Little hair: one thread draws to the sums of one map.
    NEEDED(shadow_map_reserve(&shadow, 2, (MappedCasters){&caster, 1}, error));
    assert_int_equal(shadow.drawers, 1);
    assert_int_equal(shadow.at_once, 1);
    shadow_map_draw(&shadow, params, 2, (MappedCasters){&caster, 1}, depths[1], layers[1]);
    assert_memory_equal(layers[1], layers[0], sizeof layers[0]);
    const int middle = TEXELS / 2 + SIDE / 2; // a place with hair
    assert_true(depths[0][middle] < 1 &&
                layers[0][((size_t)middle / STRAND_TILE * SHADOW_LAYERS + SHADOW_LAYERS - 1) *
                          STRAND_TILE] != 0);
    shadow_map_destroy(&shadow);
}

// Points that are computed once and kept equal those that each pass computes, for straight and
// smooth hair.
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

// From 101 strands and a minimum of 40, every second strand is taken, always the same one of each
// pair. Each is widened to stand for those left out. The last strand has half the width and counts
// as half.
static void a_sample_stands_for_all(void **state)
{
    (void)state;
    enum { STRANDS = 101, SLOTS = 112, N = 3 };
    static float position[SLOTS * N][4];
    static uint32_t paint[SLOTS * N][4];
    for (int i = 0; i < SLOTS * N; ++i) {
        int strand = i / (N * STRAND_TILE) * STRAND_TILE + i % STRAND_TILE;
        position[i][0] = (float)strand;
        position[i][1] = (float)(i / STRAND_TILE % N);
        paint[i][0] = (uint32_t)strand;
    }
    const MappedCaster all = {.position = (const float(*)[4])position,
                              .paint = (const uint32_t(*)[4])paint,
                              .material = {.vertex_count = N,
                                           .smooth_parts = 1,
                                           .drawn_strands = STRANDS,
                                           .last_strand = STRANDS - 1,
                                           .last_share = 0.5f}};
    ShadowSample sample = {0};
    MappedCasters taken;
    for (int parts = 1; parts <= 3; ++parts) {
        NEEDED(shadow_sample_take(&sample, (MappedCasters){&all, 1}, 40, parts, &taken, error));
        const MappedCaster *some = taken.list;
        static float before[SLOTS * N][4];
        int odd = 0;
        assert_int_equal(some->material.drawn_strands, 51);
        shadow_assert_near((double)some->weight, 100.5 / 51, 1e-6);
        for (int s = 0; s < 51; ++s)
            for (int j = 0; j < N; ++j) {
                size_t at = ((size_t)(s / STRAND_TILE) * N + (size_t)j) * STRAND_TILE +
                            (size_t)(s % STRAND_TILE);
                int strand = (int)some->position[at][0];
                assert_true(strand == 2 * s || strand == 2 * s + 1);
                assert_int_equal(some->position[at][1], j);
                assert_int_equal(some->paint[at][0], strand);
                odd += strand & 1;
                if (parts > 1) assert_memory_equal(before[at], some->position[at], 16);
                memcpy(before[at], some->position[at], 16);
            }
        assert_true(odd > 15 * N && odd < 35 * N);
    }
    for (int least = 0; least <= 51; least += 51) { // all of them, unchanged
        NEEDED(shadow_sample_take(&sample, (MappedCasters){&all, 1}, least, 1, &taken, error));
        assert_ptr_equal(taken.list[0].position, position);
        assert_int_equal(taken.list[0].material.drawn_strands, STRANDS);
    }
    shadow_sample_destroy(&sample);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(c_and_shaders_are_alike),
        cmocka_unit_test(c_makes_the_same_maps_with_any_thread_count),
        cmocka_unit_test(points_are_found_once),
        cmocka_unit_test(a_sample_stands_for_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
