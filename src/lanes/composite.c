// SPDX-License-Identifier: MIT
// Composites ribbons in batches. The points of a batch are unpacked to arrays, and the cells that
// each ribbon touches are listed. Then one loop runs over these touches; each lane of a vector is a
// pixel of the cell. There are two such loops: the first finds how much of each ribbon is visible,
// and closes cells that are full. When enough batches have been through it, the end points of
// visible ribbons are shaded, unless they have been before, and the second loop adds colours. One
// batch alone has too few visible points to fill the vectors of shading. The compiler vectorises
// the loops; the end of this file says for which processors.
#include "lanes/composite.h"

#include "glsl/kernel/ribbon.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum {
    BATCH = 128,                          // ribbons at a time
    TOUCHES = 2048,                       // touches that are listed before they are laid
    USUAL = 2,                            // cells that a ribbon usually touches in a row
    LAID = TOUCHES + BLOCK_CELLS + USUAL, // visible touches that can wait for colours
    WAITING = 8 * BATCH,                  // ribbons that can wait for colours
    WANTED = 2 * WAITING,
    KNOWN = 4096, // slots of a hash table of wanted points
};

// The share of a pixel's hair that may be skipped: fine hair must not vanish where each of its many
// ribbons is hardly seen.
static const float MOST_SKIPPED = 0.07f;

// Column and row of a cell's pixels.
static const float LANE_X[CELL_PIXELS] = {0, 1, 0, 1, 0, 1, 0, 1},
                   LANE_Y[CELL_PIXELS] = {0, 0, 1, 1, 2, 2, 3, 3};

// A function that is linear in the image: its value at the block's first pixel, and its change for
// each column and row.
typedef struct Linear {
    float at[BATCH], by_x[BATCH], by_y[BATCH];
} Linear;

// A batch of ribbons, as a structure of arrays.
typedef struct SIMD_ALIGNED Batch {
    float x[4][BATCH], y[4][BATCH], near_at[4][BATCH]; // previous point, both ends, next point
    float opacity[BATCH];
    uint32_t point[2][BATCH];                 // indices of the ends among all points
    Linear across;                            // distance from the middle line
    Linear along;                             // share of the ribbon's length
    Linear first_share, last_share;           // share of a pixel that each end does not cut off
    float half_width[BATCH], widening[BATCH]; // px: at the first end; change to the last end
    float inner[BATCH], outer[BATCH], factor[BATCH], curve[BATCH]; // see RibbonProfile
    float near[BATCH], near_change[BATCH];                         // 1/w
    float middle[BATCH], slope[BATCH], reach[BATCH];               // the strip, in cells
    int top[BATCH], bottom[BATCH], left[BATCH], right[BATCH];      // cells
} Batch;

// A ribbon, of the batch or of those that wait, that touches a cell.
typedef struct Touch {
    uint16_t ribbon, cell;
} Touch;

// The visible share of a ribbon in each pixel of a cell, and the place along the ribbon there.
typedef struct __attribute__((aligned(32))) Laid {
    float alpha[CELL_PIXELS], along[CELL_PIXELS];
} Laid;

// Ribbons that wait for their colours, and what is visible of them.
typedef struct SIMD_ALIGNED Waiting {
    Laid laid[LAID];
    Touch touches[LAID];
    uint8_t seen[WAITING];
    uint32_t point[2][WAITING];                  // as in Batch
    float first[3][WAITING], change[3][WAITING]; // colour
    int count, ribbons;                          // of touches; of ribbons
} Waiting;

struct CompositeScratch {
    Touch touches[TOUCHES + BLOCK_CELLS + USUAL];
    Waiting waiting;
    Batch batch;
    uint8_t open[BLOCK_CELLS + USUAL]; // cells that are not yet opaque
    uint8_t now[BLOCK_CELLS + USUAL];  // open cells in which this batch may be visible
    float farthest[BLOCK_CELLS];       // least 1/w of mesh and floor in the cell
    // Sums of the shares of ribbons that are too faint to be shaded.
    float skipped[BLOCK_CELLS][CELL_PIXELS];
    uint32_t wanted[WANTED], known[KNOWN];
};

size_t composite_scratch_size(void)
{
    return (sizeof(CompositeScratch) + 63) / 64 * 64;
}

SIMD_INLINE float clamp_share(float x)
{
    return simd_min(simd_max(x, 0), 1);
}

// --- Ribbons.

// A strand's opacity.
static float opacity_of(const LaneHair *hair, uint32_t strand)
{
    const MaterialParams *m = &hair->caster.material;
    size_t root =
        (size_t)(strand / STRAND_TILE) * m->vertex_count * STRAND_TILE + strand % STRAND_TILE;
    return hair->caster.paint ? m->opacity * (float)(hair->caster.paint[root][1] >> 16) / 65535
                              : m->opacity;
}

SIMD_INLINE void fetch(const Ribbons *ribbons, const uint64_t *order, int count, Batch *b)
{
    for (int i = 0; i < BATCH; ++i) {
        uint32_t slot = (uint32_t)order[i < count ? i : count - 1];
        const LaneHair *hair = lane_hair_of(ribbons->shader.hairs, slot);
        const ScreenPoint *p = &ribbons->points[slot];
        uint32_t strand = (uint32_t)(slot - hair->first_point) / hair->points,
                 root = (uint32_t)hair->first_point + strand * hair->points;
        bool last = BITS_OF_FLOAT(p[1].inverse_w) >> 31;
        const ScreenPoint *four[4] = {slot > root ? p - 1 : p, p, p + 1, last ? p + 1 : p + 2};
        for (int k = 0; k < 4; ++k) {
            b->x[k][i] = four[k]->x, b->y[k][i] = four[k]->y;
            b->near_at[k][i] = fabsf(four[k]->inverse_w);
        }
        b->opacity[i] = opacity_of(hair, strand);
        b->half_width[i] = low_level(p[0].place), b->widening[i] = low_level(p[1].place);
        b->point[0][i] = root + (p[0].place >> 16), b->point[1][i] = root + (p[1].place >> 16);
    }
}

SIMD_INLINE void set_linear(Linear *l, int i, float at, float by_x, float by_y)
{
    l->at[i] = at, l->by_x[i] = by_x, l->by_y[i] = by_y;
}

// The cell of a position in px within the block. The caller adds 0.5 px where it needs the first
// pixel whose centre is not before the position (a ceiling).
SIMD_INLINE int cell_of(float px, int size, int cell)
{
    float last = (float)(size - 1), at = px > 0 ? px : 0;
    return (int)(at < last ? at : last) / cell;
}

// Unit directions of the previous ribbon, the ribbon itself and the next ribbon; 0 if there is
// none.
typedef struct SIMD_ALIGNED RibbonWays {
    float x[3][BATCH], y[3][BATCH];
} RibbonWays;

SIMD_INLINE void find_directions(const Batch *restrict b, RibbonWays *restrict ways)
{
    for (int n = 0; n < 3; ++n)
        for (int i = 0; i < BATCH; ++i) {
            float x = b->x[n + 1][i] - b->x[n][i], y = b->y[n + 1][i] - b->y[n][i],
                  square = x * x + y * y, scale = 1 / sqrtf(simd_max(square, 1e-20f));
            bool there = (square > 1e-12f) & (b->near_at[n][i] > 0) & (b->near_at[n + 1][i] > 0);
            scale = (there | (n == 1)) ? scale : 0;
            ways->x[n][i] = x * scale, ways->y[n][i] = y * scale;
        }
}

// In row r of cells the strip's middle line is at the column middle + r * slope (column c has its
// pixels' centre at c). The strip touches the columns whose centres are within `reach` of it.
SIMD_INLINE void find_strips(const Block *block, const RibbonWays *restrict ways, Batch *restrict b)
{
    const float WIDE = 1.0f / CELL_WIDTH, left = (float)block->x, top = (float)block->y;
    for (int i = 0; i < BATCH; ++i) {
        float dx = ways->x[1][i], dy = ways->y[1][i],
              reach = simd_max(b->half_width[i], b->half_width[i] + b->widening[i]) +
                      0.5f * (fabsf(dx) + fabsf(dy));
        RibbonBound first = ribbon_bound(dx, dy, ways->x[0][i], ways->y[0][i]),
                    last = ribbon_bound(dx, dy, ways->x[2][i], ways->y[2][i]);
        float before = ribbon_overhang(first, dx, dy, reach),
              behind = ribbon_overhang(last, dx, dy, reach), px = b->x[1][i] - dx * before,
              py = b->y[1][i] - dy * before, qx = b->x[2][i] + dx * behind,
              qy = b->y[2][i] + dy * behind, wide = reach * fabsf(dy), tall = reach * fabsf(dx),
              rows = 1 / simd_max(fabsf(dy), 1e-5f), slope = dx * copysignf(rows, dy);
        b->middle[i] =
            (b->x[1][i] - left + (0.5f * CELL_HEIGHT - (b->y[1][i] - top)) * slope) * WIDE - 0.5f;
        b->slope[i] = slope * (CELL_HEIGHT * WIDE);
        b->reach[i] = WIDE * (reach * rows + 0.5f * (CELL_HEIGHT - 1) * fabsf(slope) +
                              0.5f * (CELL_WIDTH - 1));
        b->top[i] = cell_of(simd_min(py, qy) - tall + 0.5f - top, BLOCK_HEIGHT, CELL_HEIGHT);
        b->bottom[i] = cell_of(simd_max(py, qy) + tall - 0.5f - top, BLOCK_HEIGHT, CELL_HEIGHT);
        b->left[i] = cell_of(simd_min(px, qx) - wide + 0.5f - left, BLOCK_WIDTH, CELL_WIDTH);
        b->right[i] = cell_of(simd_max(px, qx) + wide - 0.5f - left, BLOCK_WIDTH, CELL_WIDTH);
    }
}

SIMD_INLINE void find_lines(const Block *block, bool solid, const RibbonWays *restrict ways,
                            Batch *restrict b)
{
    float x = (float)block->x + 0.5f, y = (float)block->y + 0.5f; // the first pixel's centre
    for (int i = 0; i < BATCH; ++i) {
        float ax = x - b->x[1][i], ay = y - b->y[1][i], bx = x - b->x[2][i], by = y - b->y[2][i],
              way_x = ax - bx, way_y = ay - by, dx = ways->x[1][i], dy = ways->y[1][i],
              inverse = 1 / sqrtf(simd_max(way_x * way_x + way_y * way_y, 1e-20f));
        RibbonBound first = ribbon_bound(dx, dy, ways->x[0][i], ways->y[0][i]),
                    last = ribbon_bound(dx, dy, ways->x[2][i], ways->y[2][i]);
        RibbonProfile profile = ribbon_profile(dx, dy);
        set_linear(&b->across, i, ay * dx - ax * dy, -dy, dx);
        set_linear(&b->along, i, (ax * dx + ay * dy) * inverse, dx * inverse, dy * inverse);
        set_linear(&b->first_share, i, ax * first.x + ay * first.y + first.offset, first.x,
                   first.y);
        set_linear(&b->last_share, i, 1 - bx * last.x - by * last.y - last.offset, -last.x,
                   -last.y);
        b->inner[i] = profile.inner, b->outer[i] = profile.outer, b->curve[i] = profile.curve;
        b->factor[i] = profile.factor * (solid ? 1 : b->opacity[i]);
    }
}

SIMD_INLINE void unpack(const Block *block, bool solid, Batch *restrict b)
{
    RibbonWays ways;
    for (int i = 0; i < BATCH; ++i) {
        b->widening[i] -= b->half_width[i];
        b->near[i] = b->near_at[1][i], b->near_change[i] = b->near_at[2][i] - b->near_at[1][i];
    }
    find_directions(b, &ways);
    find_lines(block, solid, &ways, b);
    find_strips(block, &ways, b);
}

// --- Cells.

// Lists the open cells that the ribbon touches. Returns the new number of touches. Up to USUAL
// cells of a row are added without branches, because branches would be mispredicted.
SIMD_INLINE int list_touches(const Batch *b, int i, const uint8_t *open, Touch *touches, int count)
{
    float middle = b->middle[i], slope = b->slope[i], reach = b->reach[i];
    float left = (float)b->left[i], right = (float)b->right[i];
    for (int row = b->top[i]; row <= b->bottom[i]; ++row) {
        float at = middle + (float)row * slope,
              low = simd_min(simd_max(at - reach, left), right + 1),
              high = simd_max(simd_min(at + reach, right), left - 1);
        int column = (int)low;
        column += (float)column < low;
        column = column < b->left[i] ? b->left[i] : column; // if `low` is NaN
        int wide = (int)(high + 1) - column, cell = row * BLOCK_CELLS_ACROSS + column;
        for (int k = 0; k < USUAL; ++k) {
            touches[count] = (Touch){(uint16_t)i, (uint16_t)(cell + k)};
            count += open[cell + k] & (k < wide);
        }
        for (int k = USUAL; k < wide; ++k) {
            touches[count] = (Touch){(uint16_t)i, (uint16_t)(cell + k)};
            count += open[cell + k];
        }
    }
    return count;
}

SIMD_INLINE float linear(const Linear *l, int i, float x, float y)
{
    return l->at[i] + x * l->by_x[i] + y * l->by_y[i];
}

// The share of a pixel that the ribbon covers, reduced by its opacity and by its ends.
SIMD_INLINE float coverage(const Batch *b, int i, float x, float y, float along)
{
    float across = fabsf(linear(&b->across, i, x, y)),
          half_width = b->half_width[i] + along * b->widening[i], beyond = across - half_width,
          before = ribbon_area(fabsf(beyond), b->inner[i], b->outer[i], b->curve[i]),
          covered = ribbon_area(across + half_width, b->inner[i], b->outer[i], b->curve[i]) -
                    copysignf(before, beyond);
    float first = linear(&b->first_share, i, x, y), last = linear(&b->last_share, i, x, y);
    return b->factor[i] * covered * clamp_share(simd_min(first, last));
}

// Pixels with a transmittance below this limit count as opaque.
SIMD_INLINE float through_limit(float least)
{
    return simd_max(2 * least, RIBBON_LEAST_THROUGH);
}

// Blends ribbon i behind the cell's content, without colours: `laid` gets its visible share in each
// pixel. x, y: the cell's first pixel in the block. Bit 0 of the result: more than `least` of the
// ribbon is visible in some pixel, or any of it where much of the hair was skipped. Bit 1: in some
// pixel the transmittance is still more than through_limit(least). `rims`: of the cell `at`; NULL:
// it has none.
SIMD_INLINE int lay_under(const Batch *restrict b, int i, float x, float y, BlockForm form,
                          float least, Cell *restrict cell, const float *restrict hidden,
                          BlockRims *restrict rims, int at, const float *restrict skipped,
                          Laid *restrict laid)
{
    float open = through_limit(least);
    int seen = 0, through = 0;
    for (int k = 0; k < CELL_PIXELS; ++k) {
        float along = clamp_share(linear(&b->along, i, x + LANE_X[k], y + LANE_Y[k]));
        float alpha = coverage(b, i, x + LANE_X[k], y + LANE_Y[k], along);
        float near = b->near[i] + along * b->near_change[i];
        if (form == BLOCK_OVER_MESH) alpha = near >= hidden[k] ? alpha : 0;
        alpha *= cell->through[k];
        float shown = alpha;
        if (rims) {
            bool before = near >= rims->near[at][k];
            shown = before ? alpha : alpha - rims->share[at][k] * alpha;
            rims->front[at][k] -= before ? alpha : 0;
        }
        laid->alpha[k] = shown, laid->along[k] = along;
        seen |= shown > (skipped[k] < MOST_SKIPPED * (1 - cell->through[k]) ? least : 0);
        cell->through[k] -= alpha;
        through |= cell->through[k] > open;
    }
    return seen | through << 1;
}

// Like lay_under, but only the nearest ribbon of each pixel is visible.
SIMD_INLINE int keep_nearest(const Batch *restrict b, int i, float x, float y, Cell *restrict cell,
                             float *restrict hidden, Laid *restrict laid)
{
    int some = 0;
    for (int k = 0; k < CELL_PIXELS; ++k) {
        float along = clamp_share(linear(&b->along, i, x + LANE_X[k], y + LANE_Y[k]));
        float near = b->near[i] + along * b->near_change[i];
        bool seen = (coverage(b, i, x + LANE_X[k], y + LANE_Y[k], along) >= RIBBON_LEAST_COVERAGE) &
                    (near > hidden[k]);
        hidden[k] = seen ? near : hidden[k];
        cell->through[k] = seen ? 0 : cell->through[k];
        laid->alpha[k] = seen ? 1 : 0, laid->along[k] = along;
        some |= seen;
    }
    return some | 2;
}

SIMD_INLINE void add_color(const Waiting *restrict w, int i, BlockForm form,
                           const Laid *restrict laid, Cell *restrict cell)
{
    for (int k = 0; k < CELL_PIXELS; ++k) {
        float alpha = laid->alpha[k], along = laid->along[k],
              red = w->first[0][i] + along * w->change[0][i],
              green = w->first[1][i] + along * w->change[1][i],
              blue = w->first[2][i] + along * w->change[2][i];
        if (form == BLOCK_NEAREST) {
            cell->red[k] = alpha > 0 ? red : cell->red[k];
            cell->green[k] = alpha > 0 ? green : cell->green[k];
            cell->blue[k] = alpha > 0 ? blue : cell->blue[k];
        } else {
            cell->red[k] += alpha * red;
            cell->green[k] += alpha * green;
            cell->blue[k] += alpha * blue;
        }
    }
}

// --- Shading.

SIMD_INLINE void want(CompositeScratch *scratch, const Ribbons *ribbons, uint32_t point, int *count)
{
    uint32_t *known = &scratch->known[point * 2654435761u >> 20];
    if (shades_find(ribbons->shader.shades, point) || *known == point) return;
    *known = point;
    scratch->wanted[(*count)++] = point;
}

// Shades the end points of waiting ribbons that have no colours yet, and sets the ribbons' colours.
SIMD_INLINE void shade(const Ribbons *ribbons, SimdLevel level, CompositeScratch *scratch)
{
    Waiting *w = &scratch->waiting;
    int wanted = 0;
    memset(scratch->known, 0xff, sizeof scratch->known);
    for (int i = 0; i < w->ribbons; ++i)
        for (int end = 0; end < 2 && w->seen[i]; ++end)
            __builtin_prefetch((const void *)&ribbons->shader.shades->points[w->point[end][i]], 0,
                               2);
    for (int i = 0; i < w->ribbons; ++i)
        for (int end = 0; end < 2 && w->seen[i]; ++end)
            want(scratch, ribbons, w->point[end][i], &wanted);
    shade_points_on[level](&ribbons->shader, scratch->wanted, wanted);
    for (int i = 0; i < w->ribbons; ++i) {
        if (!w->seen[i]) continue;
        uint64_t a = shades_find(ribbons->shader.shades, w->point[0][i]),
                 z = shades_find(ribbons->shader.shades, w->point[1][i]);
        for (int c = 0; c < 3; ++c) {
            w->first[c][i] = low_level((uint32_t)(a >> 16 * c));
            w->change[c][i] = low_level((uint32_t)(z >> 16 * c)) - w->first[c][i];
        }
    }
}

// Adds the colours of all that waits, in the order in which it was laid.
SIMD_INLINE void add_colors(const Block *block, BlockForm form, const Ribbons *ribbons,
                            SimdLevel level, CompositeScratch *scratch)
{
    Waiting *w = &scratch->waiting;
    if (w->ribbons == 0) return;
    shade(ribbons, level, scratch);
    for (int t = 0; t < w->count; ++t)
        add_color(w, w->touches[t].ribbon, form, &w->laid[t], &block->cells[w->touches[t].cell]);
    w->count = w->ribbons = 0;
}

// Lays the batch's touches. Colours are added first if what waits leaves no room for them.
SIMD_INLINE void lay(const Block *block, BlockForm form, const Ribbons *ribbons, SimdLevel level,
                     int count, CompositeScratch *scratch)
{
    Batch *batch = &scratch->batch;
    Waiting *w = &scratch->waiting;
    float least = ribbons->least_seen;
    if (count == 0) return;
    if (w->ribbons == WAITING || w->count + count > LAID)
        add_colors(block, form, ribbons, level, scratch);
    int first = w->ribbons, laid = w->count;
    for (int end = 0; end < 2; ++end)
        memcpy(&w->point[end][first], batch->point[end], sizeof batch->point[end]);
    memset(&w->seen[first], 0, BATCH);
    for (int t = 0; t < count; ++t) {
        int i = scratch->touches[t].ribbon, c = scratch->touches[t].cell;
        float x = (float)(c % BLOCK_CELLS_ACROSS * CELL_WIDTH),
              y = (float)(c / BLOCK_CELLS_ACROSS * CELL_HEIGHT);
        Laid *own = &w->laid[laid];
        Cell *cell = &block->cells[c];
        float *hidden = block->hidden[c], *skipped = scratch->skipped[c];
        int found;
        if (form == BLOCK_NEAREST)
            found = keep_nearest(batch, i, x, y, cell, hidden, own);
        else if (form == BLOCK_OVER_MESH && block->rims->any[c])
            found =
                lay_under(batch, i, x, y, form, least, cell, hidden, block->rims, c, skipped, own);
        else
            found = lay_under(batch, i, x, y, form, least, cell, hidden, NULL, c, skipped, own);
        w->touches[laid] = (Touch){(uint16_t)(first + i), (uint16_t)c};
        w->seen[first + i] |= found & 1;
        scratch->open[c] &= found >> 1;
        if (!(found & 1) && least > 0)
            for (int k = 0; k < CELL_PIXELS; ++k) scratch->skipped[c][k] += own->alpha[k];
        laid += found & 1;
    }
    w->count = laid;
    w->ribbons += BATCH;
}

// --- A block.

// The least 1/w of mesh and floor in each cell: ribbons with less are hidden in all of its pixels.
SIMD_INLINE void find_farthest(const Block *block, float farthest[BLOCK_CELLS])
{
    for (int c = 0; c < BLOCK_CELLS; ++c) {
        float least = block->hidden[c][0];
        for (int k = 1; k < CELL_PIXELS; ++k) least = simd_min(block->hidden[c][k], least);
        farthest[c] = least;
    }
}

// Marks the cells in which this batch may be visible. False if all cells are full.
SIMD_INLINE bool look_through(BlockForm form, CompositeScratch *scratch)
{
    const Batch *b = &scratch->batch;
    float nearest = 0;
    uint8_t any = 0; // a byte, as the cells are: then 64 of them are looked at together
    for (int c = 0; c < BLOCK_CELLS; ++c) any |= scratch->open[c];
    if (form != BLOCK_OVER_MESH) {
        memcpy(scratch->now, scratch->open, BLOCK_CELLS);
        return any;
    }
    for (int i = 0; i < BATCH; ++i)
        nearest = simd_max(simd_max(b->near_at[1][i], b->near_at[2][i]), nearest);
    for (int c = 0; c < BLOCK_CELLS; ++c)
        scratch->now[c] = scratch->open[c] & (scratch->farthest[c] <= nearest);
    return any;
}

// Scales colours up to make good for what was left out: ribbons behind almost opaque pixels, and
// ribbons that were too faint to be shaded.
SIMD_INLINE void fill_up(const Block *block, BlockForm form, float least, CompositeScratch *scratch)
{
    float open = through_limit(least);
    for (int c = 0; c < BLOCK_CELLS; ++c) {
        Cell *cell = &block->cells[c];
        BlockRims *rims = form == BLOCK_OVER_MESH && block->rims->any[c] ? block->rims : NULL;
        for (int k = 0; k < CELL_PIXELS; ++k) {
            float through = cell->through[k], laid = 1 - through - scratch->skipped[c][k];
            float all = through <= open ? 1 : 1 - through;
            cell->through[k] = through <= open ? 0 : through;
            if (rims) { // hide a share of the ribbons behind them
                float front = rims->front[c][k], share = rims->share[c][k];
                laid -= share * (front - through);
                front = rims->front[c][k] = front <= open ? 0 : front;
                all -= share * (front - cell->through[k]);
            }
            float scale = all / simd_max(laid, 1e-6f);
            scale = laid > 1e-3f ? scale : 1;
            cell->red[k] *= scale, cell->green[k] *= scale, cell->blue[k] *= scale;
        }
    }
}

SIMD_INLINE void composite(const Block *block, BlockForm form, SimdLevel level,
                           const Ribbons *ribbons, const uint64_t *order, size_t count,
                           CompositeScratch *scratch)
{
    memset(scratch->open, 1, sizeof scratch->open);
    memset(scratch->skipped, 0, sizeof scratch->skipped);
    scratch->waiting.count = scratch->waiting.ribbons = 0;
    if (form == BLOCK_OVER_MESH) find_farthest(block, scratch->farthest);
    for (size_t done = 0; done < count; done += BATCH) {
        // Prefetches the next batch to the second-level cache; the first level can track fewer
        // requests.
        for (size_t i = done + BATCH; i < done + 2 * BATCH && i < count; ++i) {
            const ScreenPoint *p = &ribbons->points[(uint32_t)order[i]];
            __builtin_prefetch((const char *)p - sizeof *p, 0, 2);
            __builtin_prefetch((const char *)(p + 3) - 1, 0, 2);
        }
        int size = count - done < BATCH ? (int)(count - done) : BATCH, listed = 0;
        fetch(ribbons, order + done, size, &scratch->batch);
        if (!look_through(form, scratch)) break;
        unpack(block, form == BLOCK_NEAREST, &scratch->batch);
        for (int i = 0; i < size; ++i) {
            listed = list_touches(&scratch->batch, i, scratch->now, scratch->touches, listed);
            if (listed < TOUCHES && i < size - 1) continue;
            lay(block, form, ribbons, level, listed, scratch);
            listed = 0;
        }
    }
    add_colors(block, form, ribbons, level, scratch);
    if (ribbons->least_seen > 0 && form != BLOCK_NEAREST)
        fill_up(block, form, ribbons->least_seen, scratch);
}

// --- Versions for each kind of processor. None fuses multiplications and additions
// (-ffp-contract=off), so all give the same bits.

typedef void Composite(const Block *block, const Ribbons *ribbons, const uint64_t *order,
                       size_t count, CompositeScratch *scratch);

#define COMPOSITE(name, form, level, target)                                                       \
    target static void name(const Block *block, const Ribbons *ribbons, const uint64_t *order,     \
                            size_t count, CompositeScratch *scratch)                               \
    {                                                                                              \
        composite(block, form, level, ribbons, order, count, scratch);                             \
    }
#define COMPOSITES(name, level, target)                                                            \
    COMPOSITE(name##_open, BLOCK_OPEN, level, target)                                              \
    COMPOSITE(name##_over_mesh, BLOCK_OVER_MESH, level, target)                                    \
    COMPOSITE(name##_nearest, BLOCK_NEAREST, level, target)                                        \
    static Composite *const forms_##name[BLOCK_FORMS] = {name##_open, name##_over_mesh,            \
                                                         name##_nearest};

COMPOSITES(any, SIMD_ANY, SIMD_FOR_ANY)
COMPOSITES(avx2, SIMD_AVX2, SIMD_FOR_AVX2)
SIMD_WITH_AVX512(COMPOSITES(avx512, SIMD_AVX512, SIMD_FOR_AVX512))

void composite_block_on(SimdLevel level, const Block *block, BlockForm form, const Ribbons *ribbons,
                        const uint64_t *order, size_t count, CompositeScratch *scratch)
{
    static Composite *const *const versions[SIMD_LEVELS] = {forms_any, forms_avx2,
                                                            SIMD_AVX512_OF(forms)};
    versions[level][form](block, ribbons, order, count, scratch);
}

void composite_block(const Block *block, BlockForm form, const Ribbons *ribbons,
                     const uint64_t *order, size_t count, CompositeScratch *scratch)
{
    composite_block_on(simd_level(), block, form, ribbons, order, count, scratch);
}
