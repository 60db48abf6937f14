// SPDX-License-Identifier: MIT
// Neighbours in a row of strands with a known spacing: which strands are neighbours, and when they
// cease to be.
#include "bench/groom_locks.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

// Straight strands 1 cm apart with four vertices each, so that each height has one vertex of each
// strand.
enum { STRANDS = 40, VERTICES = 4, POINTS = STRANDS * VERTICES };
static const float APART = 0.01f;

typedef struct Row {
    float point[POINTS][3];
    uint32_t first[STRANDS + 1];
    GroomLocks locks;
} Row;

static void create(Row *row)
{
    Error error;
    for (int v = 0; v < POINTS; ++v) {
        row->point[v][0] = APART * (float)(v / VERTICES);
        row->point[v][1] = -0.1f * (float)(v % VERTICES);
        row->point[v][2] = 0;
    }
    for (uint32_t s = 0; s <= STRANDS; ++s) row->first[s] = s * VERTICES;
    assert_int_equal(
        groom_locks_create(&row->locks, (const float(*)[3])row->point, row->first, STRANDS, &error),
        RESULT_OK);
}

static double kept(const Row *row)
{
    return groom_locks_kept(&row->locks, (const float(*)[3])row->point);
}

// Except at the ends of the row, a strand's 8th neighbour is 4 cm away, so the spacing is 4 cm.
// Strands up to 3 places apart are neighbours; those 4 places apart may be, depending on rounding.
static void test_bonds(void **state)
{
    Row row;
    (void)state;
    create(&row);
    // pairs within m places, counted from both ends, at three heights: 3 * 2 * (m n - (1 + .. + m))
    assert_true(row.locks.bond_count <= 3 * 2 * (4 * STRANDS - 10));
    assert_true(row.locks.bond_count >= 3 * 2 * (3 * STRANDS - 6));
    for (uint32_t i = 0; i < row.locks.bond_count; ++i) {
        const Bond *bond = &row.locks.bond[i];
        assert_float_equal(bond->reach, 8 * APART, 1e-6);
        assert_true(bond->vertex[0] % VERTICES == bond->vertex[1] % VERTICES);
        assert_true(bond->vertex[0] % VERTICES != 0); // no roots
        assert_true(bond->vertex[0] != bond->vertex[1]);
    }
    groom_locks_destroy(&row.locks);
}

// Moving or turning the whole row, or stretching it to nearly twice its length, keeps all pairs;
// stretching it more than 8 times keeps none; a tip that moves away breaks only its own pairs.
static void test_kept(void **state)
{
    Row row;
    (void)state;
    create(&row);
    assert_true(kept(&row) == 1);
    for (int v = 0; v < POINTS; ++v) row.point[v][2] = 1.95f * row.point[v][0], row.point[v][0] = 7;
    assert_true(kept(&row) == 1);
    uint32_t tip = row.first[STRANDS / 2] + VERTICES - 1, own = 0;
    for (uint32_t i = 0; i < row.locks.bond_count; ++i)
        own += row.locks.bond[i].vertex[0] == tip || row.locks.bond[i].vertex[1] == tip;
    row.point[tip][1] -= 0.5f;
    assert_true(own > 0);
    assert_float_equal(kept(&row), 1 - own / (double)row.locks.bond_count, 1e-12);
    for (int v = 0; v < POINTS; ++v) row.point[v][2] *= 4.2f;
    assert_true(kept(&row) == 0);
    groom_locks_destroy(&row.locks);
}

static void test_no_neighbours(void **state)
{
    GroomLocks locks;
    Error error;
    const float point[2][3] = {{0}};
    const uint32_t first[] = {0, 2};
    (void)state;
    assert_int_equal(groom_locks_create(&locks, point, first, 1, &error), RESULT_OK);
    assert_true(isnan(groom_locks_kept(&locks, point)));
    groom_locks_destroy(&locks);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bonds),
        cmocka_unit_test(test_kept),
        cmocka_unit_test(test_no_neighbours),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
