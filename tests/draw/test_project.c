// SPDX-License-Identifier: MIT
// Strands on the screen against their projection in double precision: points, which points are
// kept, and ribbons.
#include "lanes/project.h"

#include "base/random.h"
#include "support/needed.h"

#include "glsl/common/shared_math.h"
#include "glsl/kernel/ribbon.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 640, HEIGHT = 480 };
static const double FOCAL = 500, EYE = 1000, NEAR = 30; // the eye looks along -z
static const float RADIUS = 0.8f, TIP = 0.25f;

static DrawParams make_draw(void)
{
    DrawParams draw = {.width = WIDTH,
                       .height = HEIGHT,
                       .focal = (float)FOCAL,
                       .near_distance = (float)NEAR,
                       .axis = {WIDTH / 2, HEIGHT / 2}};
    draw.clip_from_world[0][0] = (float)(2 * FOCAL / WIDTH);
    draw.clip_from_world[1][1] = (float)(-2 * FOCAL / HEIGHT);
    draw.clip_from_world[2][3] = -1;
    draw.clip_from_world[3][3] = (float)EYE;
    return draw;
}

// --- Hair.

typedef struct Batch {
    LaneHair hair;
    uint32_t strands;
    float (*position)[4];
} Batch;

static float *place_of(const Batch *batch, uint32_t s, uint32_t j)
{
    return batch
        ->position[(s / STRAND_TILE * batch->hair.points + j) * STRAND_TILE + s % STRAND_TILE];
}

static Batch open_batch(uint32_t strands, uint32_t points)
{
    Batch batch = {.strands = strands};
    batch.hair = (LaneHair){.points = points, .tiles = (strands + STRAND_TILE - 1) / STRAND_TILE};
    batch.position = calloc(batch.hair.tiles * STRAND_TILE * points, sizeof *batch.position);
    assert_non_null(batch.position);
    batch.hair.caster = (MappedCaster){.position = (const float(*)[4])batch.position,
                                       .material = {.radius = RADIUS,
                                                    .tip_ratio = TIP,
                                                    .opacity = 1,
                                                    .vertex_count = points,
                                                    .smooth_parts = 1,
                                                    .drawn_strands = strands,
                                                    .last_strand = strands - 1,
                                                    .last_share = 1}};
    return batch;
}

// Curves of all sizes, which turn by up to a full circle from root to tip.
static void bend_strands(Batch *batch, uint64_t seed)
{
    Random random = random_create(seed, 0);
    for (uint32_t s = 0; s < batch->hair.tiles * STRAND_TILE; ++s) {
        double x[3], way[3], turn[3], step = 1 + 9 * random_real(&random);
        random_direction(&random, way);
        random_direction(&random, turn);
        for (int k = 0; k < 3; ++k) x[k] = 500 * (random_real(&random) - 0.5);
        for (uint32_t j = 0; j < batch->hair.points; ++j)
            for (int k = 0; k < 3; ++k) {
                place_of(batch, s, j)[k] = (float)x[k];
                x[k] += step * way[k];
                way[k] += turn[k] * random_real(&random) / batch->hair.points * 6;
            }
    }
}

typedef struct Screen {
    Projection projection;
    LaneHair list[3];
    LaneHairs hairs;
} Screen;

static void project(Screen *screen, const Batch *batches, uint32_t count, float far)
{
    const DrawParams draw = make_draw();
    *screen = (Screen){.hairs = {.list = screen->list, .count = count}};
    LaneHairs *hairs = &screen->hairs;
    for (uint32_t i = 0; i < count; ++i) {
        screen->list[i] = batches[i].hair;
        screen->list[i].first_tile = hairs->tiles;
        screen->list[i].first_point = hairs->points;
        hairs->tiles += batches[i].hair.tiles;
        hairs->points += batches[i].hair.tiles * STRAND_TILE * batches[i].hair.points;
    }
    NEEDED(
        projection_find(&screen->projection, hairs, &draw, NULL, far, parallel_threads(), error));
}

static size_t count_items(const Projection *projection)
{
    size_t count = 0;
    for (int part = 0; part < projection->parts; ++part) count += projection->item_count[part];
    return count;
}

// --- Reference in double precision, for the visible part.

typedef struct Spot {
    double x, y, inverse_w, half_width;
} Spot;

static Spot spot_of(const Batch *batch, uint32_t s, uint32_t j)
{
    const float *x = place_of(batch, s, j);
    double w = EYE - (double)x[2], share = j / (batch->hair.points - 1.0);
    return (Spot){WIDTH / 2 + FOCAL * (double)x[0] / w, HEIGHT / 2 - FOCAL * (double)x[1] / w,
                  1 / w, FOCAL * (double)RADIUS * (1 - share * (1 - (double)TIP)) / w};
}

static void unit_way(const ScreenPoint *a, const ScreenPoint *b, double way[2])
{
    double x = (double)b->x - (double)a->x, y = (double)b->y - (double)a->y, length = hypot(x, y);
    way[0] = x / length, way[1] = y / length;
}

// As wide as the outline of a cylinder off the view axis. Levels have 11 bits.
static void expect_width(const ScreenPoint *p, bool first, bool last, double half_width)
{
    double before[2] = {0}, after[2] = {0}, way[2],
           off[2] = {(double)p->x - WIDTH / 2.0, (double)p->y - HEIGHT / 2.0};
    if (!first) unit_way(p - 1, p, before);
    if (!last) unit_way(p, p + 1, after);
    way[0] = before[0] + after[0], way[1] = before[1] + after[1];
    double q = (way[0] * off[1] - way[1] * off[0]) / hypot(way[0], way[1]) / FOCAL,
           expected = half_width * sqrt(1 + q * q), got = (double)low_level(p->place);
    if (!(fabs(got - expected) <= expected / 1024))
        fail_msg("half-width %g, expected %g", got, expected);
}

// The straight piece that replaces left-out points is at most 0.05 px or 1/1000 of its distance off
// them, at most `far` long, and beyond 1 px at most a sixteenth of the strand.
static void expect_straight(const Batch *batch, uint32_t s, uint32_t from, uint32_t to, double far)
{
    const Spot a = spot_of(batch, s, from), b = spot_of(batch, s, to);
    double x = b.x - a.x, y = b.y - a.y;
    uint32_t most = batch->hair.points / 16;
    if (to > from + 1)
        assert_true(hypot(x, y) <= (to - from > (most > 1 ? most : 1) ? fmin(far, 1) : far) + 1e-3);
    for (uint32_t j = from + 1; j < to; ++j) {
        const Spot p = spot_of(batch, s, j);
        double share = fmin(fmax(((p.x - a.x) * x + (p.y - a.y) * y) / (x * x + y * y), 0), 1);
        assert_true(fabs(p.x - a.x - share * x) <= (double)RIBBON_STRAIGHT + 1e-3);
        assert_true(fabs(p.y - a.y - share * y) <= (double)RIBBON_STRAIGHT + 1e-3);
        assert_true(fabs(p.inverse_w - a.inverse_w - share * (b.inverse_w - a.inverse_w)) <=
                    1.1e-3 * p.inverse_w);
    }
}

// Returns how many points are kept.
static uint32_t check_strand(const Batch *batch, const ScreenPoint *points, uint32_t s, double far)
{
    uint32_t k = 0, before = 0;
    for (bool last = false; !last; ++k) {
        const ScreenPoint *p = &points[k];
        uint32_t number = p->place >> 16;
        const Spot spot = spot_of(batch, s, number);
        last = BITS_OF_FLOAT(p->inverse_w) >> 31;
        assert_true(k == 0 ? number == 0 : number > before);
        if (last) assert_int_equal(number, batch->hair.points - 1);
        assert_true(hypot((double)p->x - spot.x, (double)p->y - spot.y) < 1e-3);
        assert_true(fabs(fabs((double)p->inverse_w) / spot.inverse_w - 1) < 1e-5);
        expect_width(p, k == 0, last, spot.half_width);
        if (k > 0) expect_straight(batch, s, before, number, far);
        before = number;
    }
    return k;
}

// --- Tests.

// Two batches whose last tiles are not full.
static void strands_go_by_the_points_that_are_kept(void **state)
{
    (void)state;
    const double fars[] = {8, 1e9};
    Batch batches[2] = {open_batch(501, 40), open_batch(37, 9)};
    size_t kept[2] = {0}, all = 501 * 40 + 37 * 9;
    bend_strands(&batches[0], 1);
    bend_strands(&batches[1], 2);
    for (int f = 0; f < 2; ++f) {
        Screen screen;
        project(&screen, batches, 2, (float)fars[f]);
        for (uint32_t b = 0; b < 2; ++b)
            for (uint32_t s = 0; s < batches[b].strands; ++s)
                kept[f] += check_strand(&batches[b],
                                        screen.projection.points + screen.list[b].first_point +
                                            (size_t)s * batches[b].hair.points,
                                        s, fars[f]);
        projection_destroy(&screen.projection);
    }
    assert_true(kept[0] < all && kept[1] < kept[0] - all / 50);
    for (int b = 0; b < 2; ++b) free(batches[b].position);
}

// Ribbons are listed by ascending slots. Listed are all that reach into the image, widened by their
// half-width plus half a pixel; short ones between the middles of pixels may be missing. Their
// blocks contain all pixels whose middles lie along the ribbon.
static void ribbons_in_the_picture_are_listed(void **state)
{
    (void)state;
    Batch batch = open_batch(501, 40);
    Screen screen;
    bend_strands(&batch, 3);
    project(&screen, &batch, 1, 8);
    const Projection *to = &screen.projection;
    int part = 0, listed = 0;
    size_t at = 0, all = 0;
    for (uint32_t slot = 0; slot < batch.strands * batch.hair.points; ++slot) {
        const ScreenPoint *a = &to->points[slot], *b = a + 1;
        if (slot % batch.hair.points == 0) all = 1; // a strand has ribbons up to its last point
        if (!all || BITS_OF_FLOAT(a->inverse_w) >> 31) {
            all = 0;
            continue;
        }
        while (part < to->parts && at == to->item_count[part]) ++part, at = 0;
        const RibbonItem *item = part < to->parts ? &to->items[part][at] : NULL;
        double wide = 0.5 + fmax((double)low_level(a->place), (double)low_level(b->place));
        bool inside = fmin((double)a->x, (double)b->x) < WIDTH + wide &&
                      fmax((double)a->x, (double)b->x) > -wide &&
                      fmin((double)a->y, (double)b->y) < HEIGHT + wide &&
                      fmax((double)a->y, (double)b->y) > -wide;
        bool whole =
            fmin((double)a->x, (double)b->x) > 1 && fmax((double)a->x, (double)b->x) < 639 &&
            fmin((double)a->y, (double)b->y) > 1 && fmax((double)a->y, (double)b->y) < 479 &&
            hypot((double)b->x - (double)a->x, (double)b->y - (double)a->y) > 2;
        bool is_listed = item && item->slot == slot;
        if (whole) assert_true(is_listed);
        if (!inside) assert_false(is_listed);
        if (!is_listed) continue;
        double depth = 0.5 * ((double)a->inverse_w + fabs((double)b->inverse_w));
        assert_true(fabs((double)FLOAT_OF_BITS(item->depth) - depth) < 1e-6 * depth);
        assert_true(item->left <= (int)fmax((double)fminf(a->x, b->x) + 0.5, 0) / BLOCK_WIDTH);
        assert_true(item->right >= (int)fmin((double)fmaxf(a->x, b->x) - 0.5, 639) / BLOCK_WIDTH);
        assert_true(item->top <= (int)fmax((double)fminf(a->y, b->y) + 0.5, 0) / BLOCK_HEIGHT);
        assert_true(item->bottom >= (int)fmin((double)fmaxf(a->y, b->y) - 0.5, 479) / BLOCK_HEIGHT);
        ++at, ++listed;
    }
    assert_int_equal(listed, count_items(to));
    assert_true(listed > 1000);
    projection_destroy(&screen.projection);
    free(batch.position);
}

// The points are 100, 60, 10 and -20 m in front of the eye. The third is moved back towards the
// second, to the near plane at 30 m, and the last is invisible; also in the reverse order.
static void strands_end_at_the_near_plane(void **state)
{
    (void)state;
    const double distance[5] = {100, 60, 10, -20, -50}, across[5] = {8, 6, -9, -4, -9};
    double share = (60 - NEAR) / (60 - 10), x = 6 + share * (-9 - 6);
    for (int way = 0; way < 2; ++way) {
        Batch batch = open_batch(1, 5);
        Screen screen;
        for (uint32_t j = 0; j < 5; ++j) {
            uint32_t at = way ? 4 - j : j;
            place_of(&batch, 0, j)[0] = (float)across[at];
            place_of(&batch, 0, j)[2] = (float)(EYE - distance[at]);
        }
        project(&screen, &batch, 1, 8);
        int found = 0;
        for (int k = 0; k < 5; ++k) {
            const ScreenPoint *p = &screen.projection.points[k];
            uint32_t number = p->place >> 16, at = way ? 4 - number : number;
            double inverse = fabs((double)p->inverse_w);
            if (at > 2) assert_true(inverse == 0);
            if (at == 2) {
                ++found;
                assert_true(fabs(inverse * NEAR - 1) < 1e-5);
                assert_true(fabs((double)p->x - WIDTH / 2 - FOCAL * x / NEAR) < 1e-2);
            }
            if (BITS_OF_FLOAT(p->inverse_w) >> 31) break;
        }
        assert_int_equal(found, 1);
        assert_int_equal(count_items(&screen.projection), 2);
        projection_destroy(&screen.projection);
        free(batch.position);
    }
}

// The most that 16 bits can count, all of them kept.
static void strands_may_have_65000_points(void **state)
{
    (void)state;
    enum { POINTS = 65000 };
    Batch batch = open_batch(2, POINTS);
    Screen screen;
    for (uint32_t s = 0; s < 2; ++s)
        for (uint32_t j = 0; j < POINTS; ++j) {
            float *x = place_of(&batch, s, j);
            x[0] = (float)(j % 500) - 250 + (float)s;
            x[1] = (float)(j / 500) + (float)(j % 2);
        }
    project(&screen, &batch, 1, 8);
    for (uint32_t s = 0; s < 2; ++s)
        assert_int_equal(check_strand(&batch, screen.projection.points + s * POINTS, s, 8), POINTS);
    assert_int_equal(count_items(&screen.projection), 2 * (POINTS - 1));
    projection_destroy(&screen.projection);
    free(batch.position);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strands_go_by_the_points_that_are_kept),
        cmocka_unit_test(ribbons_in_the_picture_are_listed),
        cmocka_unit_test(strands_end_at_the_near_plane),
        cmocka_unit_test(strands_may_have_65000_points),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
