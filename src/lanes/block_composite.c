// SPDX-License-Identifier: MIT
// Ribbons come in batches: their records are unpacked side by side, the cells that each touches are
// listed, and then each touch is a turn of one loop in which every pixel of a cell is a lane of a
// vector. Compilers make the vectors; what they may make of them is said at the end of this file.
#include "lanes/block_composite.h"

#include "base/simd.h"

#include "glsl/common/shared_math.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum {
    BATCH = 128,    // ribbons at a time
    TOUCHES = 4096, // of them that are listed before they are drawn
    USUAL = 2,      // cells in a row that a ribbon touches, as a rule
};

// Words of a record.
enum {
    FIRST_X,
    FIRST_Y,
    LAST_X,
    LAST_Y,
    WIDTHS,
    FIRST_BOUND,
    LAST_BOUND,
    OPACITY, // and how 1/w changes
    FIRST_RG,
    FIRST_B_LAST_R,
    LAST_GB,
    DEPTH,
    SLOPE,
    REACH,
    ROWS,
    COLUMNS,
    WORDS
};

_Static_assert(WORDS * sizeof(uint32_t) == sizeof(RibbonRecord), "words make a record");

static const float LEAST = 1.0f / 1024;        // share of what is behind that still counts
static const float LEAST_COVERAGE = 1.0f / 16; // as in hair.frag

// Column and row of a cell's pixels.
static const float LANE_X[CELL_PIXELS] = {0, 1, 0, 1, 0, 1, 0, 1},
                   LANE_Y[CELL_PIXELS] = {0, 0, 1, 1, 2, 2, 3, 3};

// What is linear in the image: in the block's first pixel, by column and by row.
typedef struct Linear {
    float at[BATCH], by_x[BATCH], by_y[BATCH];
} Linear;

// Some ribbons, a field after another.
typedef struct Batch {
    Linear across;                            // distance from the middle line
    Linear along;                             // share of the ribbon's length
    Linear first_share, last_share;           // of a pixel, that the ends leave it
    float half_width[BATCH], widening[BATCH]; // px: at the first end, and from there to the last
    float inner[BATCH], outer[BATCH], factor[BATCH], curve[BATCH]; // see coverage
    float first[3][BATCH], change[3][BATCH];                       // colour
    float near[BATCH], near_change[BATCH];                         // 1/w
    float middle[BATCH], slope[BATCH], reach[BATCH];          // the strip, in cells: see find_strip
    int top[BATCH], bottom[BATCH], left[BATCH], right[BATCH]; // cells
} Batch;

// A ribbon of the batch in a cell.
typedef struct Touch {
    uint16_t ribbon, cell;
} Touch;

SIMD_INLINE float clamp_share(float x)
{
    return simd_min(simd_max(x, 0), 1);
}

// --- Records, packed as in block.glsl.

SIMD_INLINE float low_short(uint32_t word)
{
    return simd_float_of(word << 16);
}

SIMD_INLINE float high_short(uint32_t word)
{
    return simd_float_of(word & 0xffff0000u);
}

// The share beyond an end is clamp_share(distance along its bound + this).
SIMD_INLINE float bound_offset(float x, float y)
{
    return x * x + y * y < 4 ? 0.5f : 1;
}

SIMD_INLINE void fetch(const RibbonRecord *records, const uint64_t *order, int count,
                       uint32_t words[WORDS][BATCH])
{
    for (int i = 0; i < BATCH; ++i) {
        uint32_t record[WORDS];
        memcpy(record, &records[(uint32_t)order[i < count ? i : count - 1]], sizeof record);
        for (int k = 0; k < WORDS; ++k) words[k][i] = record[k];
    }
}

SIMD_INLINE void set_linear(Linear *l, int i, float at, float by_x, float by_y)
{
    l->at[i] = at, l->by_x[i] = by_x, l->by_y[i] = by_y;
}

// x, y: the middle of the block's first pixel.
SIMD_INLINE void find_line(uint32_t words[WORDS][BATCH], int i, float x, float y, bool solid,
                           Batch *b)
{
    float ax = x - simd_float_of(words[FIRST_X][i]), ay = y - simd_float_of(words[FIRST_Y][i]),
          bx = x - simd_float_of(words[LAST_X][i]), by = y - simd_float_of(words[LAST_Y][i]),
          way_x = ax - bx, way_y = ay - by,
          inverse = 1 / sqrtf(simd_max(way_x * way_x + way_y * way_y, 1e-20f)),
          dx = way_x * inverse, dy = way_y * inverse;
    set_linear(&b->across, i, ay * dx - ax * dy, -dy, dx);
    set_linear(&b->along, i, (ax * dx + ay * dy) * inverse, dx * inverse, dy * inverse);
    float fx = low_short(words[FIRST_BOUND][i]), fy = high_short(words[FIRST_BOUND][i]),
          lx = low_short(words[LAST_BOUND][i]), ly = high_short(words[LAST_BOUND][i]);
    set_linear(&b->first_share, i, ax * fx + ay * fy + bound_offset(fx, fy), fx, fy);
    set_linear(&b->last_share, i, 1 - bx * lx - by * ly - bound_offset(lx, ly), -lx, -ly);
    float opacity = solid ? 1 : (float)(int)(words[OPACITY][i] & 0xfff) * (1.0f / 4095),
          steep = simd_max(fabsf(dx), fabsf(dy)),
          flat = simd_max(simd_min(fabsf(dx), fabsf(dy)), 1e-3f);
    b->inner[i] = 0.5f * (steep - flat), b->outer[i] = 0.5f * (steep + flat);
    b->factor[i] = opacity / steep, b->curve[i] = 0.5f / flat;
}

SIMD_INLINE void find_change(uint32_t words[WORDS][BATCH], int i, Batch *b)
{
    b->half_width[i] = low_level(words[WIDTHS][i]);
    b->widening[i] = high_level(words[WIDTHS][i]) - b->half_width[i];
    b->first[0][i] = low_level(words[FIRST_RG][i]),
    b->change[0][i] = high_level(words[FIRST_B_LAST_R][i]) - b->first[0][i];
    b->first[1][i] = high_level(words[FIRST_RG][i]),
    b->change[1][i] = low_level(words[LAST_GB][i]) - b->first[1][i];
    b->first[2][i] = low_level(words[FIRST_B_LAST_R][i]),
    b->change[2][i] = high_level(words[LAST_GB][i]) - b->first[2][i];
    float change = simd_float_of(words[OPACITY][i] & 0xfffff000u),
          mean = simd_float_of(words[DEPTH][i]);
    b->near[i] = mean * (1 - 0.5f * change), b->near_change[i] = mean * change;
}

SIMD_INLINE int cell_of(uint32_t px, int begin, int size, int cell)
{
    int at = (int)px - begin;
    return (at < 0 ? 0 : at < size ? at : size - 1) / cell;
}

// In row r of cells the strip's middle is at the column middle + r * slope, counted so that column
// c has its pixels' middle at c, and it touches columns whose middles lie within `reach` of that.
// x, y: the block's corner.
SIMD_INLINE void find_strip(uint32_t words[WORDS][BATCH], int i, int x, int y, Batch *b)
{
    const float WIDE = 1.0f / CELL_WIDTH;
    float slope = simd_float_of(words[SLOPE][i]), a_x = simd_float_of(words[FIRST_X][i]) - (float)x,
          a_y = simd_float_of(words[FIRST_Y][i]) - (float)y;
    b->middle[i] = (a_x + (0.5f * CELL_HEIGHT - a_y) * slope) * WIDE - 0.5f;
    b->slope[i] = slope * (CELL_HEIGHT * WIDE);
    b->reach[i] = WIDE * (simd_float_of(words[REACH][i]) + 0.5f * (CELL_HEIGHT - 1) * fabsf(slope) +
                          0.5f * (CELL_WIDTH - 1));
    b->top[i] = cell_of(words[ROWS][i] & 0xffff, y, BLOCK_HEIGHT, CELL_HEIGHT);
    b->bottom[i] = cell_of(words[ROWS][i] >> 16, y, BLOCK_HEIGHT, CELL_HEIGHT);
    b->left[i] = cell_of(words[COLUMNS][i] & 0xffff, x, BLOCK_WIDTH, CELL_WIDTH);
    b->right[i] = cell_of(words[COLUMNS][i] >> 16, x, BLOCK_WIDTH, CELL_WIDTH);
}

SIMD_INLINE void unpack(uint32_t words[WORDS][BATCH], const Block *block, bool solid,
                        Batch *restrict b)
{
    for (int i = 0; i < BATCH; ++i) {
        find_line(words, i, (float)block->x + 0.5f, (float)block->y + 0.5f, solid, b);
        find_change(words, i, b);
        find_strip(words, i, block->x, block->y, b);
    }
}

// --- Cells.

// Lists the ribbon's touches of cells that are open; returns how many are listed then. Adds without
// branches, which would be foreseen badly, up to USUAL a row.
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
        column = column < b->left[i] ? b->left[i] : column; // of what is no number
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

SIMD_INLINE float profile_area(const Batch *b, int i, float t)
{
    float m = simd_min(t, b->outer[i]), u = simd_max(m - b->inner[i], 0);
    return m - b->curve[i] * (u * u);
}

// The share of a pixel that the ribbon covers, times its opacity and what its ends leave it. As in
// coverage.glsl: the pixel's profile across the ribbon is a box as wide as the larger component a
// of the direction spread by one as wide as the smaller, b, a trapezoid. With its area between the
// middle and t >= 0, A(t) = (m - max(m - (a - b)/2, 0)^2 / (2 b)) / a where m = min(t, (a + b)/2),
// the ribbon |across| < h covers A(d + h) - sign(d - h) A(|d - h|) at the distance d.
SIMD_INLINE float coverage(const Batch *b, int i, float x, float y, float along)
{
    float across = fabsf(linear(&b->across, i, x, y)),
          half_width = b->half_width[i] + along * b->widening[i], beyond = across - half_width,
          before = profile_area(b, i, fabsf(beyond)),
          covered = profile_area(b, i, across + half_width) - copysignf(before, beyond);
    float first = linear(&b->first_share, i, x, y), last = linear(&b->last_share, i, x, y);
    return b->factor[i] * covered * clamp_share(simd_min(first, last));
}

SIMD_INLINE float color(const Batch *b, int i, int channel, float along)
{
    return b->first[channel][i] + along * b->change[channel][i];
}

// x, y: of the cell's first pixel in the block.
SIMD_INLINE void lay_under(const Batch *restrict b, int i, float x, float y, BlockForm form,
                           Cell *restrict cell, const float *restrict hidden)
{
    for (int k = 0; k < CELL_PIXELS; ++k) {
        float along = clamp_share(linear(&b->along, i, x + LANE_X[k], y + LANE_Y[k]));
        float alpha = coverage(b, i, x + LANE_X[k], y + LANE_Y[k], along);
        if (form == BLOCK_OVER_MESH)
            alpha = b->near[i] + along * b->near_change[i] >= hidden[k] ? alpha : 0;
        alpha *= cell->through[k];
        cell->through[k] -= alpha;
        cell->red[k] += alpha * color(b, i, 0, along);
        cell->green[k] += alpha * color(b, i, 1, along);
        cell->blue[k] += alpha * color(b, i, 2, along);
    }
}

SIMD_INLINE void keep_nearest(const Batch *restrict b, int i, float x, float y, Cell *restrict cell,
                              float *restrict hidden)
{
    for (int k = 0; k < CELL_PIXELS; ++k) {
        float along = clamp_share(linear(&b->along, i, x + LANE_X[k], y + LANE_Y[k]));
        float near = b->near[i] + along * b->near_change[i];
        bool seen = (coverage(b, i, x + LANE_X[k], y + LANE_Y[k], along) >= LEAST_COVERAGE) &
                    (near > hidden[k]);
        hidden[k] = seen ? near : hidden[k];
        cell->through[k] = seen ? 0 : cell->through[k];
        cell->red[k] = seen ? color(b, i, 0, along) : cell->red[k];
        cell->green[k] = seen ? color(b, i, 1, along) : cell->green[k];
        cell->blue[k] = seen ? color(b, i, 2, along) : cell->blue[k];
    }
}

SIMD_INLINE void draw(const Block *block, BlockForm form, const Batch *batch, const Touch *touches,
                      int count)
{
    for (int t = 0; t < count; ++t) {
        int i = touches[t].ribbon, c = touches[t].cell;
        float x = (float)(c % BLOCK_CELLS_ACROSS * CELL_WIDTH),
              y = (float)(c / BLOCK_CELLS_ACROSS * CELL_HEIGHT);
        if (form == BLOCK_NEAREST)
            keep_nearest(batch, i, x, y, &block->cells[c], block->hidden[c]);
        else
            lay_under(batch, i, x, y, form, &block->cells[c], block->hidden[c]);
    }
}

// Finds the cells that something can still be seen through; whether there are any.
SIMD_INLINE bool look_through(const Block *block, uint8_t *open)
{
    bool any = false;
    for (int c = 0; c < BLOCK_CELLS; ++c) {
        float through = 0;
        for (int k = 0; k < CELL_PIXELS; ++k)
            through = simd_max(through, block->cells[c].through[k]);
        open[c] = through > LEAST;
        any |= open[c];
    }
    return any;
}

SIMD_INLINE void composite(const Block *block, BlockForm form, const RibbonRecord *records,
                           const uint64_t *order, size_t count)
{
    uint8_t open[BLOCK_CELLS + USUAL];
    uint32_t words[WORDS][BATCH];
    Touch touches[TOUCHES + BLOCK_CELLS + USUAL];
    Batch batch;
    memset(open, 1, sizeof open);
    for (size_t done = 0; done < count; done += BATCH) {
        if (form != BLOCK_NEAREST && done && !look_through(block, open)) return;
        // To the second level: there are more than the first one can wait for.
        for (size_t i = done + BATCH; i < done + 2 * BATCH && i < count; ++i)
            __builtin_prefetch(&records[(uint32_t)order[i]], 0, 2);
        int size = count - done < BATCH ? (int)(count - done) : BATCH, listed = 0;
        fetch(records, order + done, size, words);
        unpack(words, block, form == BLOCK_NEAREST, &batch);
        for (int i = 0; i < size; ++i) {
            listed = list_touches(&batch, i, open, touches, listed);
            if (listed < TOUCHES && i < size - 1) continue;
            draw(block, form, &batch, touches, listed);
            listed = 0;
        }
    }
}

// --- The same for all kinds of processors. None fuses multiplications and additions
// (-ffp-contract=off), so that all give the same bits.

typedef void Composite(const Block *block, BlockForm form, const RibbonRecord *records,
                       const uint64_t *order, size_t count);

#define COMPOSITE(name, form, target)                                                              \
    target static void name(const Block *block, BlockForm asked, const RibbonRecord *records,      \
                            const uint64_t *order, size_t count)                                   \
    {                                                                                              \
        (void)asked;                                                                               \
        composite(block, form, records, order, count);                                             \
    }
#define COMPOSITES(name, target)                                                                   \
    COMPOSITE(name##_open, BLOCK_OPEN, target)                                                     \
    COMPOSITE(name##_over_mesh, BLOCK_OVER_MESH, target)                                           \
    COMPOSITE(name##_nearest, BLOCK_NEAREST, target)                                               \
    static Composite *const name[BLOCK_FORMS] = {name##_open, name##_over_mesh, name##_nearest};

COMPOSITES(any, SIMD_FOR_ANY)
COMPOSITES(avx2, SIMD_FOR_AVX2)
COMPOSITES(avx512, SIMD_FOR_AVX512)

void block_composite_on(SimdLevel level, const Block *block, BlockForm form,
                        const RibbonRecord *records, const uint64_t *order, size_t count)
{
    static Composite *const *const versions[SIMD_LEVELS] = {any, avx2, avx512};
    versions[level][form](block, form, records, order, count);
}

void block_composite(const Block *block, BlockForm form, const RibbonRecord *records,
                     const uint64_t *order, size_t count)
{
    block_composite_on(simd_level(), block, form, records, order, count);
}
