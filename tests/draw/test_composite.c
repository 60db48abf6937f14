// SPDX-License-Identifier: MIT
// Compositing of a block of pixels against the same sum in double precision, pixel by pixel.
#include "lanes/composite.h"

#include "base/random.h"

#include "glsl/common/shared_math.h"
#include "glsl/kernel/ribbon.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// LONG: more ribbons than wait for their colours at a time.
enum { MOST = 1008, LONG = 3008, BLOCK_X = 128, BLOCK_Y = 64 };

static ScreenPoint points[2 * LONG + 1];
static uint64_t order[LONG];
static Cell cells[BLOCK_CELLS];
static float hidden[BLOCK_CELLS][CELL_PIXELS];
static BlockRims rims;
static const Block BLOCK = {cells, hidden, &rims, BLOCK_X, BLOCK_Y};
static CompositeScratch *scratch;

typedef struct Pixel {
    double color[3], through, hidden;
    double front;  // transmittance of the ribbons before the rim
    double little; // upper bound of the light of ribbons that are not shaded
} Pixel;

// --- Ribbons: strands of two points, both of them free ends, with known colours.

typedef struct Ribbon {
    float a[2], b[2], half_width[2], near[2], color[2][3];
} Ribbon;

static Ribbon ribbons[LONG];
static LaneHair hair = {.points = 2,
                        .tiles = LONG / STRAND_TILE,
                        .caster.material = {.vertex_count = 2, .smooth_parts = 1}};
static const LaneHairs HAIRS = {&hair, 1, LONG / STRAND_TILE, 2 * LONG};
static Shades shades;

static float level(double value)
{
    return low_level(pack_level((float)value));
}

static void pack(const Ribbon *r, int i)
{
    ScreenPoint *a = &points[2 * i];
    a[0] = (ScreenPoint){r->a[0], r->a[1], r->near[0], pack_level(r->half_width[0])};
    a[1] = (ScreenPoint){r->b[0], r->b[1], -r->near[1], pack_level(r->half_width[1]) | 1 << 16};
    for (int k = 0; k < 2; ++k)
        shades.points[2 * i + k] =
            (uint64_t)pack_level(r->color[k][0]) | (uint64_t)pack_level(r->color[k][1]) << 16 |
            (uint64_t)pack_level(r->color[k][2]) << 32 | (uint64_t)shades.image << 48;
}

static float range(Random *random, double low, double high)
{
    return (float)(low + (high - low) * random_real(random));
}

// Makes ribbons in and around the block, in random order of depth.
static void make_ribbons(uint64_t seed, int count, double width, double opacity)
{
    Random random = random_create(seed, 0);
    hair.caster.material.opacity = (float)opacity;
    for (int i = 0; i < count; ++i) {
        Ribbon *r = &ribbons[i];
        double angle = 6.283185307 * random_real(&random), length = 1 + 30 * random_real(&random);
        r->a[0] = range(&random, BLOCK_X - 20, BLOCK_X + BLOCK_WIDTH + 20);
        r->a[1] = range(&random, BLOCK_Y - 20, BLOCK_Y + BLOCK_HEIGHT + 20);
        r->b[0] = r->a[0] + (float)(length * cos(angle));
        r->b[1] = r->a[1] + (float)(length * sin(angle));
        r->near[0] = range(&random, 0.5, 2);
        r->near[1] = r->near[0] * range(&random, 0.9, 1.1);
        for (int k = 0; k < 2; ++k) r->half_width[k] = level(width * (0.2 + random_real(&random)));
        for (int k = 0; k < 6; ++k) r->color[k / 3][k % 3] = level(0.01 + random_real(&random));
        pack(r, i);
        order[i] = (uint64_t)(2 * i);
    }
}

static int nearer_ribbon(const void *a, const void *b)
{
    const Ribbon *p = a, *q = b;
    float x = p->near[0] + p->near[1], y = q->near[0] + q->near[1];
    return (x < y) - (x > y);
}

// Puts the ribbons in the order of depth, and makes each one's depth even.
static void sort_ribbons(int count)
{
    qsort(ribbons, (size_t)count, sizeof *ribbons, nearer_ribbon);
    for (int i = 0; i < count; ++i) {
        ribbons[i].near[0] = ribbons[i].near[1] = 0.5f * (ribbons[i].near[0] + ribbons[i].near[1]);
        pack(&ribbons[i], i);
    }
}

static void composite_on(SimdLevel simd, const Block *block, BlockForm form, int count,
                         float least_seen)
{
    const Ribbons all = {points, {&HAIRS, NULL, &shades}, least_seen};
    composite_block_on(simd, block, form, &all, order, (size_t)count, scratch);
}

static void composite(BlockForm form, int count, float least_seen)
{
    composite_on(simd_level(), &BLOCK, form, count, least_seen);
}

static void clear_block(float share_hidden)
{
    Random random = random_create(5, 5);
    memset(cells, 0, sizeof cells);
    memset(&rims, 0, sizeof rims);
    for (int c = 0; c < BLOCK_CELLS; ++c)
        for (int k = 0; k < CELL_PIXELS; ++k) {
            cells[c].through[k] = 1;
            hidden[c][k] = random_real(&random) < (double)share_hidden ? range(&random, 0.5, 2) : 0;
        }
}

// Gives every second cell rims of 0 to 4 of a pixel's four samples, before the mesh.
static void add_rims(void)
{
    Random random = random_create(6, 6);
    for (int c = 0; c < BLOCK_CELLS; c += 2) {
        rims.any[c] = 1;
        for (int k = 0; k < CELL_PIXELS; ++k) {
            rims.near[c][k] = hidden[c][k] + range(&random, 0, 1);
            rims.share[c][k] = (float)random_below(&random, 5) / 4;
            rims.front[c][k] = 1;
        }
    }
}

// --- The reference in double precision.

static double area(double t, double a, double b)
{
    double m = fmin(t, 0.5 * (a + b)), u = fmax(m - 0.5 * (a - b), 0);
    return (m - u * u / (2 * b)) / a;
}

static double clamp(double x)
{
    return fmin(fmax(x, 0), 1);
}

// Coverage times opacity; *along becomes the pixel's position along the ribbon.
static double cover(const Ribbon *r, double x, double y, double *along)
{
    double dx = (double)r->b[0] - (double)r->a[0], dy = (double)r->b[1] - (double)r->a[1],
           length = hypot(dx, dy), ax = x - (double)r->a[0], ay = y - (double)r->a[1];
    dx /= length, dy /= length;
    double on = ax * dx + ay * dy;
    *along = clamp(on / length);
    double across = fabs(ay * dx - ax * dy),
           half = (double)r->half_width[0] +
                  *along * ((double)r->half_width[1] - (double)r->half_width[0]),
           a = fmax(fabs(dx), fabs(dy)), b = fmax(fmin(fabs(dx), fabs(dy)), 1e-3),
           before = area(fabs(across - half), a, b),
           covered = area(across + half, a, b) - (across < half ? -before : before);
    return (double)hair.caster.material.opacity * covered *
           clamp(fmin(on + 0.5, length - on + 0.5));
}

// `rim`: 1/w and share of the pixel.
static Pixel expected_pixel(int count, BlockForm form, double x, double y, double hides,
                            const double rim[2], double least)
{
    Pixel p = {{0}, 1, hides, 1, 0};
    for (int i = 0; i < count; ++i) {
        const Ribbon *r = &ribbons[i];
        double along, alpha = cover(r, x, y, &along),
                      near = (double)r->near[0] + along * ((double)r->near[1] - (double)r->near[0]);
        if (form == BLOCK_NEAREST) {
            if (alpha / (double)hair.caster.material.opacity < (double)RIBBON_LEAST_COVERAGE ||
                near <= p.hidden)
                continue;
            p.hidden = near;
            p.through = 1, alpha = 1;
            memset(p.color, 0, sizeof p.color);
        }
        if (form == BLOCK_OVER_MESH && near < p.hidden) continue;
        double seen = near < rim[0] ? 1 - rim[1] : 1;
        for (int k = 0; k < 3; ++k)
            p.color[k] += seen * p.through * alpha *
                          ((1 - along) * (double)r->color[0][k] + along * (double)r->color[1][k]);
        p.little += fmin(p.through * alpha, least);
        p.through *= 1 - alpha;
        if (near >= rim[0]) p.front *= 1 - alpha;
    }
    return p;
}

static double difference(const Cell *cell, int k, const Pixel *p)
{
    double most = fabs((double)cell->through[k] - p->through);
    most = fmax(most, fabs((double)cell->red[k] - p->color[0]));
    most = fmax(most, fabs((double)cell->green[k] - p->color[1]));
    return fmax(most, fabs((double)cell->blue[k] - p->color[2]));
}

// The largest difference over all pixels except `spared` of them: rounding decides where a pixel's
// coverage almost equals RIBBON_LEAST_COVERAGE, or where two ribbons are almost equally near. With
// `least_seen`, the difference beyond what it may cause.
static double compare(int count, BlockForm form, float least_seen, int spared)
{
    static float before[BLOCK_CELLS][CELL_PIXELS];
    double largest = 0, least = (double)least_seen;
    memcpy(before, hidden, sizeof before);
    composite(form, count, least_seen);
    for (int c = 0; c < BLOCK_CELLS; ++c)
        for (int k = 0; k < CELL_PIXELS; ++k) {
            double x = BLOCK_X + c % BLOCK_CELLS_ACROSS * CELL_WIDTH + k % CELL_WIDTH + 0.5,
                   y = BLOCK_Y + c / BLOCK_CELLS_ACROSS * CELL_HEIGHT + k / CELL_WIDTH + 0.5;
            const double rim[2] = {(double)rims.near[c][k], (double)rims.share[c][k]};
            Pixel p = expected_pixel(count, form, x, y, (double)before[c][k], rim, least);
            double off = difference(&cells[c], k, &p);
            if (rims.any[c]) off = fmax(off, fabs((double)rims.front[c][k] - p.front));
            if (off > 1e-3 && spared-- > 0) continue;
            largest = fmax(largest, off - 1.01 * (p.little + 2 * least));
        }
    return largest;
}

// Distances across a ribbon are rounded at 90 px, by 4e-6 px, which changes a pixel's coverage by
// as much; a hundred layers change by at most ten times that.
static void ribbons_are_laid_under_each_other(void **state)
{
    (void)state;
    const double widths[] = {0.3, 1, 5};
    for (int i = 0; i < 3; ++i) {
        make_ribbons(1, 300, widths[i], 0.3);
        clear_block(0);
        assert_true(compare(300, BLOCK_OPEN, 0, 0) < 4e-5);
    }
}

static void colours_are_added_in_order_in_long_lists(void **state)
{
    (void)state;
    make_ribbons(12, LONG, 0.3, 0.1);
    clear_block(0);
    assert_true(compare(LONG, BLOCK_OPEN, 0, 0) < 4e-5);
    clear_block(0.3f);
    assert_true(compare(LONG, BLOCK_NEAREST, 0, 4) < 4e-5);
}

// At most 1/1024 of the light may be missing.
static void skipped_ribbons_change_a_pixel_by_at_most_a_1024th(void **state)
{
    (void)state;
    make_ribbons(2, MOST, 5, 0.9);
    clear_block(0);
    double off = compare(MOST, BLOCK_OPEN, 0, 0);
    assert_true(off < (double)RIBBON_LEAST_THROUGH + 4e-5);
    assert_true(off > 4e-5); // ribbons were left out
}

// Ribbons that are too faint to be shaded get the colours of the others, which differ by 1.01 at
// most. The error is that difference times what is visible of them, and of the background where at
// most twice as much of it is visible.
static void ribbons_that_are_hardly_seen_look_like_the_others(void **state)
{
    (void)state;
    static Cell with[BLOCK_CELLS];
    const float least[] = {1 / 1024.0f, 1 / 256.0f, 1 / 64.0f};
    for (int i = 0; i < 3; ++i) {
        make_ribbons(8, MOST, i == 1 ? 1 : 3, 0.5);
        for (int form = BLOCK_OPEN; form <= BLOCK_OVER_MESH; ++form) {
            clear_block(form == BLOCK_OPEN ? 0 : 0.2f);
            double beyond = compare(MOST, (BlockForm)form, least[i], form == BLOCK_OPEN ? 0 : 2);
            assert_true(beyond < 4e-5);
            memcpy(with, cells, sizeof cells);
            clear_block(form == BLOCK_OPEN ? 0 : 0.2f);
            composite((BlockForm)form, MOST, 0);
            assert_memory_not_equal(with, cells, sizeof cells); // some ribbons were not shaded
        }
    }
}

static double sum_light(void)
{
    double sum = 0;
    for (int c = 0; c < BLOCK_CELLS; ++c)
        for (int k = 0; k < CELL_PIXELS; ++k)
            sum += (double)cells[c].red[k] + (double)cells[c].green[k] + (double)cells[c].blue[k];
    return sum;
}

// Ribbons that are not shaded get the mean colour of the others; otherwise 1.1 % of the light would
// be lost.
static void light_of_what_is_hardly_seen_is_made_up_for(void **state)
{
    (void)state;
    double sums[2];
    make_ribbons(10, 600, 0.5, 0.05);
    for (int least = 0; least < 2; ++least) {
        clear_block(0);
        composite(BLOCK_OPEN, 600, least ? 1 / 128.0f : 0);
        sums[least] = sum_light();
    }
    if (!(fabs(sums[1] / sums[0] - 1) < 0.004)) fail_msg("%g of the light", sums[1] / sums[0]);
}

// No ribbon of this hair covers more than a hundredth of a pixel: if all that are hardly seen were
// left out, nothing would be seen.
static void fine_hair_does_not_vanish(void **state)
{
    (void)state;
    double sums[2];
    make_ribbons(11, 600, 0.02, 0.5);
    for (int least = 0; least < 2; ++least) {
        clear_block(0);
        composite(BLOCK_OPEN, 600, least ? 1 / 64.0f : 0);
        sums[least] = sum_light();
    }
    if (!(fabs(sums[1] / sums[0] - 1) < 0.01)) fail_msg("%g of the light", sums[1] / sums[0]);
}

static void what_lies_behind_the_mesh_is_hidden(void **state)
{
    (void)state;
    make_ribbons(3, 300, 1, 0.5);
    clear_block(0.5f);
    assert_true(compare(300, BLOCK_OVER_MESH, 0, 2) < 4e-5);
}

// Lists are sorted from near to far: cells without a visible pixel left are skipped, and their
// bytes stay those of the ribbons before.
static void what_is_all_behind_the_mesh_changes_nothing(void **state)
{
    (void)state;
    enum { BEFORE = 128 }; // one batch
    static Cell expected[BLOCK_CELLS];
    make_ribbons(9, MOST, 1, 0.5);
    for (int i = BEFORE; i < MOST; ++i) {
        for (int k = 0; k < 2; ++k) ribbons[i].near[k] *= 0.1f;
        pack(&ribbons[i], i);
    }
    for (int all = 0; all < 2; ++all) {
        clear_block(1);
        composite(BLOCK_OVER_MESH, all ? MOST : BEFORE, 0);
        if (!all) memcpy(expected, cells, sizeof cells);
        assert_memory_equal(cells, expected, sizeof cells);
    }
    int seen = 0;
    for (int c = 0; c < BLOCK_CELLS; ++c) seen += expected[c].through[0] < 1;
    assert_true(seen > BLOCK_CELLS / 10);
}

static void the_nearest_hides_all_behind_it(void **state)
{
    (void)state;
    make_ribbons(4, 300, 1, 0.5);
    clear_block(0.3f);
    assert_true(compare(300, BLOCK_NEAREST, 0, 4) < 4e-5);
}

// A rim that covers a share of a pixel hides this share of the ribbons behind it.
static void a_rim_hides_its_share_of_what_lies_behind_it(void **state)
{
    (void)state;
    make_ribbons(10, 300, 1, 0.5);
    sort_ribbons(300);
    for (int least = 0; least < 2; ++least) {
        clear_block(0.5f);
        add_rims();
        assert_true(compare(300, BLOCK_OVER_MESH, least ? 1 / 256.0f : 0, 4) < 4e-5);
    }
}

static void every_processor_gives_the_same_bits(void **state)
{
    (void)state;
    static Cell expected[BLOCK_CELLS];
    make_ribbons(6, MOST, 1, 0.5);
    for (int form = 0; form < BLOCK_FORMS; ++form)
        for (int least = 0; least < 2; ++least)
            for (int p = 0; p <= (int)simd_level(); ++p) {
                clear_block(form == BLOCK_OPEN ? 0 : 0.5f);
                composite_on((SimdLevel)p, &BLOCK, (BlockForm)form, MOST, least ? 1 / 256.0f : 0);
                if (p == 0) memcpy(expected, cells, sizeof cells);
                assert_memory_equal(cells, expected, sizeof cells);
            }
}

// Points as far away as projection allows: nothing outside the block is written.
static void wild_points_harm_nobody(void **state)
{
    (void)state;
    const float wild[] = {1.6e8f, -1.6e8f, 1e4f, -1e4f, 0, 1e-30f, BLOCK_X, BLOCK_Y + 30};
    enum { WILD = sizeof wild / sizeof *wild };
    make_ribbons(7, WILD * WILD, 1, 0.5);
    for (int i = 0; i < WILD * WILD; ++i) {
        Ribbon *r = &ribbons[i];
        r->a[0] = wild[i / WILD], r->a[1] = wild[i % WILD];
        r->b[0] = wild[i * 5 / WILD % WILD], r->b[1] = wild[i * 3 % WILD];
        r->half_width[0] = i % 3 ? 1 : 5e4f;
        pack(r, i);
    }
    clear_block(0);
    static struct {
        Cell before, cells[BLOCK_CELLS], after;
    } guarded;
    memset(&guarded, 0x55, sizeof guarded);
    memcpy(guarded.cells, cells, sizeof cells);
    const Block block = {guarded.cells, hidden, &rims, BLOCK_X, BLOCK_Y};
    composite_on(simd_level(), &block, BLOCK_OPEN, WILD * WILD, 0);
    for (size_t i = 0; i < sizeof(Cell); ++i) {
        assert_int_equal(((const uint8_t *)&guarded.before)[i], 0x55);
        assert_int_equal(((const uint8_t *)&guarded.after)[i], 0x55);
    }
}

static int setup(void **state)
{
    (void)state;
    Error error = {{0}};
    scratch = aligned_alloc(64, composite_scratch_size());
    return scratch && shades_begin(&shades, 2 * LONG, &error) == RESULT_OK ? 0 : 1;
}

static int teardown(void **state)
{
    (void)state;
    free(scratch);
    shades_destroy(&shades);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ribbons_are_laid_under_each_other),
        cmocka_unit_test(colours_are_added_in_order_in_long_lists),
        cmocka_unit_test(skipped_ribbons_change_a_pixel_by_at_most_a_1024th),
        cmocka_unit_test(ribbons_that_are_hardly_seen_look_like_the_others),
        cmocka_unit_test(light_of_what_is_hardly_seen_is_made_up_for),
        cmocka_unit_test(fine_hair_does_not_vanish),
        cmocka_unit_test(what_lies_behind_the_mesh_is_hidden),
        cmocka_unit_test(what_is_all_behind_the_mesh_changes_nothing),
        cmocka_unit_test(the_nearest_hides_all_behind_it),
        cmocka_unit_test(a_rim_hides_its_share_of_what_lies_behind_it),
        cmocka_unit_test(every_processor_gives_the_same_bits),
        cmocka_unit_test(wild_points_harm_nobody),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
