// SPDX-License-Identifier: MIT
// The colour that roots give to the skin between them: a flat square of skin of 0.2 m with hair on
// its left half.
#include "draw/scalp_tint.h"
#include "support/needed.h"
#include "support/studio.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { SIDE = 41, ROWS = 40, STRANDS = ROWS * ROWS / 2 };

static const float EDGE = 0.005f, SPACING = 0.005f, LENGTH = 0.1f; // m
static const float SKIN[3] = {0.4f, 0.2f, 0.1f}, HAIR[3] = {0.02f, 0.1f, 0.3f};
static const Paint UNPAINTED;

static Mesh make_skin(void)
{
    Mesh mesh;
    uint32_t triangles = 2 * (SIDE - 1) * (SIDE - 1), at = 0;
    NEEDED(mesh_create(&mesh, SIDE * SIDE, triangles, error));
    for (uint32_t v = 0; v < SIDE * SIDE; ++v) {
        mesh.position[v][0] = EDGE * ((float)(v % SIDE) - SIDE / 2);
        mesh.position[v][2] = EDGE * ((float)(v / SIDE) - SIDE / 2);
        mesh.normal[v][1] = 1;
    }
    for (uint32_t y = 0; y + 1 < SIDE; ++y)
        for (uint32_t x = 0; x + 1 < SIDE; ++x) {
            uint32_t a = y * SIDE + x, *t = mesh.triangle[at];
            memcpy(t, (uint32_t[6]){a, a + 1, a + SIDE, a + 1, a + SIDE + 1, a + SIDE},
                   6 * sizeof *t);
            at += 2;
        }
    return mesh;
}

// Upright strands, a grid of them on x < 0.
static Strands make_hair(void)
{
    static float x[2 * STRANDS][3];
    for (int s = 0; s < STRANDS; ++s)
        for (int end = 0; end < 2; ++end) {
            x[2 * s + end][0] = -SPACING * ((float)(s % (ROWS / 2)) + 0.5f);
            x[2 * s + end][1] = end ? LENGTH : 0;
            x[2 * s + end][2] = SPACING * ((float)(s / (ROWS / 2)) - ROWS / 2 + 0.5f);
        }
    return studio_strands(STRANDS, 2, (const float(*)[3])x);
}

// The tint of the vertices in the middle row, by column.
static void find_row(const ScalpHair *hair, uint32_t count, float most, float row[SIDE][3])
{
    Mesh skin = make_skin();
    float(*tint)[3] = malloc(SIDE * SIDE * sizeof *tint);
    assert_non_null(tint);
    NEEDED(scalp_tint_find(tint, &skin, SKIN, most, hair, count, error));
    memcpy(row, tint[SIDE / 2 * SIDE], SIDE * sizeof *row);
    free(tint);
    mesh_destroy(&skin);
}

// The weight of the hair that a tint shows.
static float weight_of(const float tint[3], const float color[3])
{
    float weight = (tint[0] - 1) / (color[0] / SKIN[0] - 1);
    for (int k = 1; k < 3; ++k)
        assert_true(fabsf(tint[k] - 1 - weight * (color[k] / SKIN[k] - 1)) < 1e-5f);
    return weight;
}

// What the header says, of an even grid. (A root reaches 2.3 spacings; the sum over the 16 roots
// around a vertex differs from the integral by 0.8 %.)
static float documented(float radius, float each, float most)
{
    float cover = each * 2 * radius * SCALP_TINT_ROOT * LENGTH / (SPACING * SPACING);
    return most * (1 - expf(-cover));
}

static void dense_skin_goes_to_the_hair_by_the_documented_share(void **state)
{
    (void)state;
    const struct {
        float radius, each, most;
    } cases[] = {{2e-4f, 1, 1}, {2e-4f, 4, 1}, {1e-3f, 1, 0.8f}, {5e-2f, 1, 0.8f}};
    Strands strands = make_hair();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        ScalpHair hair = {&strands, &UNPAINTED, {0}, cases[i].radius, cases[i].each};
        memcpy(hair.color, HAIR, sizeof HAIR);
        float row[SIDE][3], expected = documented(cases[i].radius, cases[i].each, cases[i].most);
        find_row(&hair, 1, cases[i].most, row);
        for (int column = 8; column < SIDE / 2 - 6; ++column)
            assert_true(fabsf(weight_of(row[column], HAIR) - expected) < 0.015f * expected);
    }
    strands_destroy(&strands);
}

// On the hairline half of the kernel has roots; beyond, the weight falls to nothing within the
// reach of a root, and stays there.
static void the_hairline_is_soft_and_far_skin_keeps_its_colour(void **state)
{
    (void)state;
    Strands strands = make_hair();
    ScalpHair hair = {&strands, &UNPAINTED, {0}, 1e-4f, 1};
    memcpy(hair.color, HAIR, sizeof HAIR);
    float row[SIDE][3], dense = documented(1e-4f, 1, 1);
    find_row(&hair, 1, 1, row);
    assert_true(fabsf(weight_of(row[SIDE / 2], HAIR) - 0.5f * dense) < 0.06f * dense);
    for (int column = SIDE / 2 - 6; column + 1 < SIDE; ++column)
        assert_true(weight_of(row[column + 1], HAIR) <= weight_of(row[column], HAIR) + 1e-6f);
    assert_true(weight_of(row[SIDE / 2 + 1], HAIR) > 0.05f * dense);
    for (int column = SIDE / 2 + 3; column < SIDE; ++column)
        for (int k = 0; k < 3; ++k) assert_true(row[column][k] == 1);
    strands_destroy(&strands);
}

static void nothing_of_it_without_hair_or_weight(void **state)
{
    (void)state;
    Strands strands = make_hair();
    ScalpHair hair = {&strands, &UNPAINTED, {0}, 1e-3f, 1};
    float row[SIDE][3];
    for (uint32_t count = 0; count < 2; ++count) {
        find_row(&hair, count, count ? 0 : 1, row);
        for (int column = 0; column < SIDE; ++column)
            for (int k = 0; k < 3; ++k) assert_true(row[column][k] == 1);
    }
    strands_destroy(&strands);
}

// Two sections in one place: the mean of their colours by cover, and more cover. One is painted:
// the colour at the root counts, not the tip's.
static void sections_mix_by_what_they_cover(void **state)
{
    (void)state;
    const float red[4] = {0.9f, 0.1f, 0.1f, 1}, tip[4] = {0, 0, 1, 1};
    Strands strands = make_hair();
    float(*color)[4] = malloc(2 * STRANDS * sizeof *color);
    assert_non_null(color);
    for (int v = 0; v < 2 * STRANDS; ++v) memcpy(color[v], v % 2 ? tip : red, sizeof red);
    const Paint paint = {.color = color, .vertex_count = 2 * STRANDS};
    ScalpHair hair[2] = {{&strands, &UNPAINTED, {0}, 1e-4f, 1}, {&strands, &paint, {0}, 3e-4f, 1}};
    memcpy(hair[0].color, HAIR, sizeof HAIR);
    float row[SIDE][3], mixed[3];
    for (int k = 0; k < 3; ++k) mixed[k] = 0.25f * HAIR[k] + 0.75f * red[k];
    find_row(hair, 2, 1, row);
    assert_true(fabsf(weight_of(row[10], mixed) - documented(4e-4f, 1, 1)) < 0.02f);
    free(color);
    strands_destroy(&strands);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dense_skin_goes_to_the_hair_by_the_documented_share),
        cmocka_unit_test(the_hairline_is_soft_and_far_skin_keeps_its_colour),
        cmocka_unit_test(nothing_of_it_without_hair_or_weight),
        cmocka_unit_test(sections_mix_by_what_they_cover),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
