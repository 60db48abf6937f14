// SPDX-License-Identifier: MIT
// A block of pixels against the same sum in double precision, pixel by pixel.
#include "base/random.h"
#include "lanes/block_composite.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MOST = 1000, BLOCK_X = 128, BLOCK_Y = 64 };

static RibbonRecord records[MOST];
static uint64_t order[MOST];
static Cell cells[BLOCK_CELLS];
static float hidden[BLOCK_CELLS][CELL_PIXELS];
static const Block BLOCK = {cells, hidden, BLOCK_X, BLOCK_Y};

typedef struct Pixel {
    double color[3], through, hidden;
} Pixel;

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

// --- Records as block.glsl packs them; of numbers that packing leaves as they are.

static const uint32_t LEAST_LEVEL = (127u - 40u) << 23;

static float level(double value)
{
    uint32_t bits = (bits_of((float)value) - LEAST_LEVEL) >> 13 << 13;
    float rounded;
    bits += LEAST_LEVEL;
    memcpy(&rounded, &bits, sizeof rounded);
    return rounded;
}

static uint32_t pack_levels(float a, float b)
{
    return (bits_of(a) - LEAST_LEVEL) >> 13 | (bits_of(b) - LEAST_LEVEL) >> 13 << 16;
}

static float cut(double value, uint32_t mask)
{
    uint32_t bits = bits_of((float)value) & mask;
    float rounded;
    memcpy(&rounded, &bits, sizeof rounded);
    return rounded;
}

// A ribbon before it is packed. Both ends are free: their bounds are the direction.
typedef struct Ribbon {
    float a[2], b[2], half_width[2], bound[2], color[2][3];
    float opacity, near, change; // 1/w in the middle, and its change as a share of that
} Ribbon;

static Ribbon ribbons[MOST];

static void pack(const Ribbon *r, RibbonRecord *record)
{
    uint32_t bound = bits_of(r->bound[0]) >> 16 | bits_of(r->bound[1]);
    double dx = (double)r->b[0] - (double)r->a[0], dy = (double)r->b[1] - (double)r->a[1],
           length = hypot(dx, dy), slope = dx / dy,
           reach = fmax((double)r->half_width[0], (double)r->half_width[1]) + 2;
    *record = (RibbonRecord){.a = {r->a[0], r->a[1]}, .b = {r->b[0], r->b[1]}};
    record->shape[0] = pack_levels(r->half_width[0], r->half_width[1]);
    record->shape[1] = record->shape[2] = bound;
    record->shape[3] = (uint32_t)lrintf(r->opacity * 4095) | bits_of(r->change);
    record->tint[0] = pack_levels(r->color[0][0], r->color[0][1]);
    record->tint[1] = pack_levels(r->color[0][2], r->color[1][0]);
    record->tint[2] = pack_levels(r->color[1][1], r->color[1][2]);
    record->tint[3] = bits_of(r->near);
    record->slope = (float)slope;
    record->reach = (float)(reach * length / fabs(dy));
    uint32_t box[4];
    for (int k = 0; k < 2; ++k) {
        double low = fmin((double)r->a[k], (double)r->b[k]) - reach,
               high = fmax((double)r->a[k], (double)r->b[k]) + reach;
        box[k] = (uint32_t)fmax(low, 0);
        box[k + 2] = (uint32_t)fmax(high, 0);
    }
    record->columns = box[0] | box[2] << 16;
    record->rows = box[1] | box[3] << 16;
}

static float range(Random *random, double low, double high)
{
    return (float)(low + (high - low) * random_real(random));
}

// Ribbons in and around the block, in random order of depth.
static void make_ribbons(uint64_t seed, int count, double width, double opacity)
{
    Random random = random_create(seed, 0);
    for (int i = 0; i < count; ++i) {
        Ribbon *r = &ribbons[i];
        double angle = 6.283185307 * random_real(&random), length = 1 + 30 * random_real(&random);
        r->a[0] = range(&random, BLOCK_X - 20, BLOCK_X + BLOCK_WIDTH + 20);
        r->a[1] = range(&random, BLOCK_Y - 20, BLOCK_Y + BLOCK_HEIGHT + 20);
        r->b[0] = r->a[0] + (float)(length * cos(angle));
        r->b[1] = r->a[1] + (float)(length * sin(angle));
        r->bound[0] = cut(cos(angle), 0xffff0000u);
        r->bound[1] = cut(sin(angle), 0xffff0000u);
        for (int k = 0; k < 2; ++k) r->half_width[k] = level(width * (0.2 + random_real(&random)));
        for (int k = 0; k < 6; ++k) r->color[k / 3][k % 3] = level(0.01 + random_real(&random));
        r->opacity = (float)lrint(opacity * 4095) / 4095;
        r->near = range(&random, 0.5, 2);
        r->change = cut(range(&random, -0.1, 0.1), 0xfffff000u);
        pack(r, &records[i]);
        order[i] = (uint64_t)i;
    }
}

static void clear_block(float share_hidden)
{
    Random random = random_create(5, 5);
    memset(cells, 0, sizeof cells);
    for (int c = 0; c < BLOCK_CELLS; ++c)
        for (int k = 0; k < CELL_PIXELS; ++k) {
            cells[c].through[k] = 1;
            hidden[c][k] = random_real(&random) < (double)share_hidden ? range(&random, 0.5, 2) : 0;
        }
}

// --- The same in double precision.

static double area(double t, double a, double b)
{
    double m = fmin(t, 0.5 * (a + b)), u = fmax(m - 0.5 * (a - b), 0);
    return (m - u * u / (2 * b)) / a;
}

static double clamp(double x)
{
    return fmin(fmax(x, 0), 1);
}

// Opacity included; where along the ribbon the pixel lies goes to *along.
static double cover(const Ribbon *r, double x, double y, double *along)
{
    double dx = (double)r->b[0] - (double)r->a[0], dy = (double)r->b[1] - (double)r->a[1],
           length = hypot(dx, dy), ax = x - (double)r->a[0], ay = y - (double)r->a[1],
           bx = x - (double)r->b[0], by = y - (double)r->b[1];
    dx /= length, dy /= length;
    *along = clamp((ax * dx + ay * dy) / length);
    double across = fabs(ay * dx - ax * dy),
           half = (double)r->half_width[0] +
                  *along * ((double)r->half_width[1] - (double)r->half_width[0]),
           a = fmax(fabs(dx), fabs(dy)), b = fmax(fmin(fabs(dx), fabs(dy)), 1e-3),
           before = area(fabs(across - half), a, b),
           covered = area(across + half, a, b) - (across < half ? -before : before),
           first = ax * (double)r->bound[0] + ay * (double)r->bound[1] + 0.5,
           last = 0.5 - bx * (double)r->bound[0] - by * (double)r->bound[1];
    return (double)r->opacity * covered * clamp(fmin(first, last));
}

static Pixel expected_pixel(int count, BlockForm form, double x, double y, double hides)
{
    Pixel p = {{0}, 1, hides};
    for (int i = 0; i < count; ++i) {
        const Ribbon *r = &ribbons[i];
        double along, alpha = cover(r, x, y, &along),
                      near = (double)r->near * (1 + (double)r->change * (along - 0.5));
        if (form == BLOCK_NEAREST) {
            if (alpha / (double)r->opacity < 1.0 / 16 || near <= p.hidden) continue;
            p.hidden = near;
            p.through = 1, alpha = 1;
            memset(p.color, 0, sizeof p.color);
        }
        if (form == BLOCK_OVER_MESH && near < p.hidden) continue;
        for (int k = 0; k < 3; ++k)
            p.color[k] += p.through * alpha *
                          ((1 - along) * (double)r->color[0][k] + along * (double)r->color[1][k]);
        p.through *= 1 - alpha;
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

// The largest difference of any pixel but of `spared` of them: where a pixel's coverage is as good
// as LEAST_COVERAGE, or two ribbons are as good as equally near, rounding decides.
static double compare(int count, BlockForm form, int spared)
{
    static float before[BLOCK_CELLS][CELL_PIXELS];
    double largest = 0;
    memcpy(before, hidden, sizeof before);
    block_composite(&BLOCK, form, records, order, (size_t)count);
    for (int c = 0; c < BLOCK_CELLS; ++c)
        for (int k = 0; k < CELL_PIXELS; ++k) {
            double x = BLOCK_X + c % BLOCK_CELLS_ACROSS * CELL_WIDTH + k % CELL_WIDTH + 0.5,
                   y = BLOCK_Y + c / BLOCK_CELLS_ACROSS * CELL_HEIGHT + k / CELL_WIDTH + 0.5;
            Pixel p = expected_pixel(count, form, x, y, (double)before[c][k]);
            double off = difference(&cells[c], k, &p);
            if (off > 1e-3 && spared-- > 0) continue;
            largest = fmax(largest, off);
        }
    return largest;
}

// Distances across are rounded at 90 px, by 4e-6 px, of which a pixel's coverage changes by as
// much, a hundred layers on end by ten times that at most.
static void ribbons_are_laid_under_each_other(void **state)
{
    (void)state;
    const double widths[] = {0.3, 1, 5};
    for (int i = 0; i < 3; ++i) {
        make_ribbons(1, 300, widths[i], 0.3);
        clear_block(0);
        assert_true(compare(300, BLOCK_OPEN, 0) < 4e-5);
    }
}

// 1/1024 may be missing, not more.
static void what_is_left_out_hardly_shows(void **state)
{
    (void)state;
    make_ribbons(2, MOST, 5, 0.9);
    clear_block(0);
    double off = compare(MOST, BLOCK_OPEN, 0);
    assert_true(off < 1.0 / 1024 + 4e-5);
    assert_true(off > 4e-5); // something was
}

static void what_lies_behind_the_mesh_is_hidden(void **state)
{
    (void)state;
    make_ribbons(3, 300, 1, 0.5);
    clear_block(0.5f);
    assert_true(compare(300, BLOCK_OVER_MESH, 2) < 4e-5);
}

static void the_nearest_hides_all_behind_it(void **state)
{
    (void)state;
    make_ribbons(4, 300, 1, 0.5);
    clear_block(0.3f);
    assert_true(compare(300, BLOCK_NEAREST, 4) < 4e-5);
}

static void every_processor_gives_the_same_bits(void **state)
{
    (void)state;
    static Cell expected[BLOCK_CELLS];
    make_ribbons(6, MOST, 1, 0.5);
    for (int form = 0; form < BLOCK_FORMS; ++form)
        for (int p = 0; p <= (int)simd_level(); ++p) {
            clear_block(form == BLOCK_OPEN ? 0 : 0.5f);
            block_composite_on((SimdLevel)p, &BLOCK, (BlockForm)form, records, order, MOST);
            if (p == 0) memcpy(expected, cells, sizeof cells);
            assert_memory_equal(cells, expected, sizeof cells);
        }
}

// Strips that say they are anywhere: nothing outside the block is touched.
static void wild_spans_harm_nobody(void **state)
{
    (void)state;
    const float wild[] = {1e30f, -1e30f, 1e9f, -1e9f, 0, 1e-30f, INFINITY, NAN};
    enum { WILD = sizeof wild / sizeof *wild };
    make_ribbons(7, WILD * WILD, 1, 0.5);
    for (int i = 0; i < WILD * WILD; ++i) {
        records[i].slope = wild[i / WILD];
        records[i].reach = wild[i % WILD];
        records[i].rows = records[i].columns = 0xffffu << 16;
    }
    clear_block(0);
    static struct {
        Cell before, cells[BLOCK_CELLS], after;
    } guarded;
    memset(&guarded, 0x55, sizeof guarded);
    memcpy(guarded.cells, cells, sizeof cells);
    const Block block = {guarded.cells, hidden, BLOCK_X, BLOCK_Y};
    block_composite(&block, BLOCK_OPEN, records, order, WILD * WILD);
    for (size_t i = 0; i < sizeof(Cell); ++i) {
        assert_int_equal(((const uint8_t *)&guarded.before)[i], 0x55);
        assert_int_equal(((const uint8_t *)&guarded.after)[i], 0x55);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ribbons_are_laid_under_each_other),
        cmocka_unit_test(what_is_left_out_hardly_shows),
        cmocka_unit_test(what_lies_behind_the_mesh_is_hidden),
        cmocka_unit_test(the_nearest_hides_all_behind_it),
        cmocka_unit_test(every_processor_gives_the_same_bits),
        cmocka_unit_test(wild_spans_harm_nobody),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
