// SPDX-License-Identifier: MIT
// The share of the sky that points of a mesh see. The scenes are two metres wide, cells are a
// thirtieth of that and directions 30 degrees apart: shares are accurate to about 0.1.
#include "draw/openness.h"
#include "support/needed.h"
#include "support/studio.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { SIDE = 21, PLANE = SIDE * SIDE }; // vertices

// Appends a square of 2 m by 2 m at vertex `first`, from `corner` along two axes.
static void put_plane(Mesh *mesh, uint32_t first, uint32_t first_triangle, const float corner[3],
                      int across, int along, const float normal[3])
{
    for (uint32_t i = 0; i < PLANE; ++i) {
        float *x = mesh->position[first + i];
        memcpy(x, corner, sizeof(float[3]));
        x[across] += 0.1f * (float)(i % SIDE);
        x[along] += 0.1f * (float)(i / SIDE);
        memcpy(mesh->normal[first + i], normal, sizeof(float[3]));
    }
    for (uint32_t y = 0; y + 1 < SIDE; ++y)
        for (uint32_t x = 0; x + 1 < SIDE; ++x) {
            uint32_t a = first + y * SIDE + x, *t = mesh->triangle[first_triangle];
            memcpy(t, (uint32_t[3]){a, a + 1, a + SIDE}, sizeof(uint32_t[3]));
            memcpy(t + 3, (uint32_t[3]){a + 1, a + SIDE + 1, a + SIDE}, sizeof(uint32_t[3]));
            first_triangle += 2;
        }
}

// A floor, and if `walls` is 2 also a wall at its edge x = -1.
static Mesh make_walls(uint32_t walls)
{
    const uint32_t triangles = 2 * (SIDE - 1) * (SIDE - 1);
    Mesh mesh;
    NEEDED(mesh_create(&mesh, walls * PLANE, walls * triangles, error));
    put_plane(&mesh, 0, 0, (const float[3]){-1, 0, -1}, 0, 2, (const float[3]){0, 1, 0});
    if (walls > 1)
        put_plane(&mesh, PLANE, triangles, (const float[3]){-1, 0, -1}, 1, 2,
                  (const float[3]){1, 0, 0});
    return mesh;
}

// The share at the vertex in this column of the floor's middle row. The share past the mesh alone
// is that without hair.
static float open_at(const Mesh *mesh, const OpennessHair *hair, int column)
{
    float(*open)[2] = malloc(mesh->vertex_count * sizeof *open);
    float(*bare)[2] = malloc(mesh->vertex_count * sizeof *bare);
    assert_true(open && bare);
    NEEDED(openness_find(open, mesh, hair, hair != NULL, error));
    NEEDED(openness_find(bare, mesh, NULL, 0, error));
    for (uint32_t v = 0; v < mesh->vertex_count; ++v) {
        assert_true(open[v][0] >= 0 && open[v][0] <= open[v][1] && open[v][1] <= 1);
        assert_true(open[v][1] == bare[v][1] && bare[v][0] == bare[v][1]);
    }
    float found = open[SIDE / 2 * SIDE + column][0];
    free(bare);
    free(open);
    return found;
}

static void a_floor_sees_all_of_the_sky(void **state)
{
    (void)state;
    Mesh floor = make_walls(1);
    for (int column = 0; column < SIDE; column += 5)
        assert_true(open_at(&floor, NULL, column) > 0.98f);
    mesh_destroy(&floor);
}

// At the foot of the wall, half of the sky is hidden, or slightly less because the wall is 2 m
// high. One metre away it is 1/2 (1 - 1 / sqrt(5)), or less because the wall is 2 m wide.
static void a_wall_hides_its_side_of_the_sky(void **state)
{
    (void)state;
    Mesh walls = make_walls(2);
    float foot = open_at(&walls, NULL, 1), middle = open_at(&walls, NULL, SIDE / 2),
          far = open_at(&walls, NULL, SIDE - 1);
    assert_true(foot > 0.45f && foot < 0.7f);
    assert_true(middle > 0.72f && middle < 0.95f);
    assert_true(far > 0.85f && foot < middle && middle < far);
    mesh_destroy(&walls);
}

// A dense mat of hair above half of the floor, with optical depth 2 r length / area = 2 at right
// angles: under it the share is about exp(-2), or more because light comes in from the side.
static void hair_hides_the_sky_by_its_density(void **state)
{
    (void)state;
    enum { STRANDS = 100 };
    float x[2 * STRANDS][3], open[3];
    for (int s = 0; s < STRANDS; ++s)
        for (int end = 0; end < 2; ++end) {
            x[2 * s + end][0] = 0.01f * (float)s;
            x[2 * s + end][1] = 0.15f;
            x[2 * s + end][2] = end ? 1.0f : -1.0f;
        }
    Strands strands = studio_strands(STRANDS, 2, (const float(*)[3])x);
    Mesh floor = make_walls(1);
    for (int i = 0; i < 3; ++i) {
        const OpennessHair hair = {&strands, i == 2 ? 0.005f : 0.01f,
                                   i == 0   ? 0.5f
                                   : i == 1 ? 1
                                            : 2};
        open[i] = open_at(&floor, &hair, 3 * SIDE / 4);
        assert_true(open_at(&floor, &hair, SIDE / 4) > 0.8f); // beside it
    }
    assert_true(open[1] < 0.3f && open[0] > open[1] + 0.1f && open[0] < 0.6f);
    assert_true(fabsf(open[2] - open[1]) < 1e-3f); // half as wide and twice as many strands
    strands_destroy(&strands);
    mesh_destroy(&floor);
}

// The share of the sky that a flat surface sees under a layer of this optical depth: the mean of
// exp(-depth / cosine), weighted by cosine.
static double under_layer(double depth)
{
    enum { STEPS = 2000 };
    double sum = 0;
    for (int i = 0; i < STEPS; ++i) {
        double cosine = (i + 0.5) / STEPS;
        sum += 2 * cosine * exp(-depth / cosine) / STEPS;
    }
    return sum;
}

// Hair so low that the surface lies in the middle of the hair's cells: half of the hair is above
// it. A sixteenth of the share is looked up in the cells below, above which all of the hair lies:
// measured 0.023 darker.
static void hair_around_a_point_hides_by_half(void **state)
{
    (void)state;
    enum { STRANDS = 100 };
    float x[2 * STRANDS][3];
    for (int s = 0; s < STRANDS; ++s)
        for (int end = 0; end < 2; ++end) {
            x[2 * s + end][0] = 0.01f * (float)s;
            x[2 * s + end][1] = 0.075f;
            x[2 * s + end][2] = end ? 1.0f : -1.0f;
        }
    Strands strands = studio_strands(STRANDS, 2, (const float(*)[3])x);
    Mesh floor = make_walls(1);
    for (int i = 1; i <= 4; ++i) {
        const double depth = 0.4 * i; // 2 r over the strands' distance; strands in all directions
        const OpennessHair hair = {&strands, (float)(depth * 0.01 / (2 * 0.7854)), 1};
        double open = (double)open_at(&floor, &hair, 3 * SIDE / 4), exact = under_layer(depth / 2);
        if (!(fabs(open - exact) < 0.03))
            fail_msg("depth %g: sees %.3g of the sky, not %.3g", depth, open, exact);
    }
    strands_destroy(&strands);
    mesh_destroy(&floor);
}

// A floor that ends at the side of a solid cube. Cells inside the cube do not count, so that the
// foot sees at least half of the sky, and slightly more because vertices take means of their
// neighbours.
static void the_inside_of_a_mesh_is_not_dark(void **state)
{
    (void)state;
    const uint32_t triangles = 2 * (SIDE - 1) * (SIDE - 1);
    Mesh mesh;
    NEEDED(mesh_create(&mesh, 7 * PLANE, 7 * triangles, error));
    put_plane(&mesh, 0, 0, (const float[3]){-1, 0, -1}, 0, 2, (const float[3]){0, 1, 0});
    for (uint32_t side = 0; side < 6; ++side) {
        uint32_t axis = side / 2, first = side + 1;
        float corner[3] = {-3, -1, -1}, normal[3] = {0};
        corner[axis] += side % 2 ? 2 : 0, normal[axis] = side % 2 ? 1 : -1;
        put_plane(&mesh, first * PLANE, first * triangles, corner, (int)((axis + 1) % 3),
                  (int)((axis + 2) % 3), normal);
    }
    float foot = open_at(&mesh, NULL, 0);
    assert_true(foot > 0.5f && foot < 0.6f);
    mesh_destroy(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_floor_sees_all_of_the_sky),
        cmocka_unit_test(a_wall_hides_its_side_of_the_sky),
        cmocka_unit_test(hair_hides_the_sky_by_its_density),
        cmocka_unit_test(hair_around_a_point_hides_by_half),
        cmocka_unit_test(the_inside_of_a_mesh_is_not_dark),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
