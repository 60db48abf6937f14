// SPDX-License-Identifier: MIT
#include "lanes/pixels.h"

#include "base/simd.h"
#include "image/tone.h"
#include "lanes/mesh_raster.h"

#include "glsl/common/shared_math.h"
#include "glsl/kernel/edge.h"

#include <math.h>
#include <string.h>

enum { CHANNELS = 4 };

// A row of cells, stored as rows of pixels.
typedef struct Strip {
    float light[CHANNELS][CELL_HEIGHT][BLOCK_WIDTH];
} Strip;

static int least_int(int a, int b)
{
    return a < b ? a : b;
}

// Converts a half float that is finite and not negative.
SIMD_INLINE float float_of_half(uint16_t half)
{
    return simd_float_of((uint32_t)(half & 0x7fff) << 13) * 0x1p112f;
}

bool pixels_have_base(const BlockBase *base, int x, int y)
{
    return base && x < base->x + base->width && x + BLOCK_WIDTH > base->x &&
           y < base->y + base->height && y + BLOCK_HEIGHT > base->y;
}

// The index of a sample in the base; -1 outside.
SIMD_INLINE int base_at(const BlockBase *base, int x, int y)
{
    x -= base->x, y -= base->y;
    return x >= 0 && x < base->width && y >= 0 && y < base->height ? y * base->width + x : -1;
}

static void hide(const Block *block, const BlockBase *base, const PixelStyle *style)
{
    for (int c = 0; c < BLOCK_CELLS; ++c)
        for (int k = 0; k < CELL_PIXELS; ++k) {
            int at = base_at(base, block->x + c % BLOCK_CELLS_ACROSS * CELL_WIDTH + k % CELL_WIDTH,
                             block->y + c / BLOCK_CELLS_ACROSS * CELL_HEIGHT + k / CELL_WIDTH);
            float z = at < 0 ? EDGE_NOWHERE : base->depth[at];
            block->hidden[c][k] = edge_inverse_w(z, style->depth[0], style->depth[1]);
        }
}

// Notes the rims of the base's pixels; `hide` ran before.
static void add_rims(const Block *block, const BlockBase *base, const PixelStyle *style)
{
    BlockRims *rims = block->rims;
    int words = (base->width + RIM_BITS - 1) / RIM_BITS;
    for (int y = 0; y < BLOCK_HEIGHT; ++y)
        for (int x = 0; x < BLOCK_WIDTH; ++x) {
            int at = base_at(base, block->x + x, block->y + y), row = block->y + y - base->y,
                column = block->x + x - base->x;
            if (at < 0) continue;
            unsigned bits = base->rimmed[row * words + column / RIM_BITS] >> column % RIM_BITS;
            if (!bits) x += RIM_BITS - 1 - column % RIM_BITS;
            if (!(bits & 1)) continue;
            const BaseRim *rim = &base->rim[at];
            int c = y / CELL_HEIGHT * BLOCK_CELLS_ACROSS + x / CELL_WIDTH,
                k = y % CELL_HEIGHT * CELL_WIDTH + x % CELL_WIDTH;
            for (int i = 0; !rims->any[c] && i < CELL_PIXELS; ++i) {
                rims->near[c][i] = rims->share[c][i] = 0, rims->front[c][i] = 1;
                for (int j = 0; j < 3; ++j) rims->light[j][c][i] = 0;
            }
            rims->any[c] = 1;
            rims->near[c][k] = edge_inverse_w(rim->depth, style->depth[0], style->depth[1]);
            rims->share[c][k] = (float)rim->samples / MESH_EDGES;
            for (int j = 0; j < 3; ++j) rims->light[j][c][k] = float_of_half(rim->light[j]);
        }
}

void pixels_clear(const Block *block, const BlockBase *base, const PixelStyle *style)
{
    memset(block->cells, 0, BLOCK_CELLS * sizeof *block->cells);
    memset(block->hidden, 0, BLOCK_CELLS * sizeof *block->hidden);
    for (int c = 0; c < BLOCK_CELLS; ++c)
        for (int k = 0; k < CELL_PIXELS; ++k) block->cells[c].through[k] = 1;
    if (!base) return;
    hide(block, base, style);
    if (!block->rims) return;
    memset(block->rims->any, 0, sizeof block->rims->any);
    add_rims(block, base, style);
}

// --- Visible light: ribbons over the base.

static void fill_behind(const Block *block, const BlockBase *base, const PixelStyle *style,
                        int column, int row, float behind[CHANNELS][CELL_PIXELS])
{
    for (int c = 0; c < CHANNELS; ++c)
        for (int k = 0; k < CELL_PIXELS; ++k) behind[c][k] = style->background[c];
    for (int k = 0; k < CELL_PIXELS && base; ++k) {
        int at = base_at(base, block->x + column * CELL_WIDTH + k % CELL_WIDTH,
                         block->y + row * CELL_HEIGHT + k / CELL_WIDTH);
        for (int c = 0; c < CHANNELS && at >= 0; ++c)
            behind[c][k] = float_of_half(base->light[at][c]);
    }
}

SIMD_INLINE void lay_over(const Cell *restrict cell, float light[restrict CHANNELS][CELL_PIXELS])
{
    for (int k = 0; k < CELL_PIXELS; ++k) {
        float through = cell->through[k];
        light[0][k] = cell->red[k] + through * light[0][k];
        light[1][k] = cell->green[k] + through * light[1][k];
        light[2][k] = cell->blue[k] + through * light[2][k];
        light[3][k] = 1 - through + through * light[3][k];
    }
}

// Lays the rims of a cell over hair that lies behind them. `light` includes them as if all ribbons
// lay before them.
static void lay_rims(const BlockRims *rims, const Cell *cell, int at,
                     float light[CHANNELS][CELL_PIXELS])
{
    for (int c = 0; c < 3; ++c)
        for (int k = 0; k < CELL_PIXELS; ++k)
            light[c][k] += (rims->front[at][k] - cell->through[k]) * rims->light[c][at][k];
}

// The value that --aov depth shows for the inverse distance `near`; 0 if nothing is there. See
// display.glsl.
static float depth_shown(const PixelStyle *style, float near)
{
    float distance = 1 / simd_max(near, 1e-20f), from = style->depth_range[0],
          to = style->depth_range[1],
          share = to > from ? simd_min(simd_max((to - distance) / (to - from), 0), 1) : distance;
    return near > 0 ? share : 0;
}

// `hidden`: the inverse distance of the nearest ribbon, otherwise of the mesh, otherwise 0.
static void show_depth(const float *hidden, const PixelStyle *style,
                       float light[CHANNELS][CELL_PIXELS])
{
    for (int c = 0; c < CHANNELS; ++c)
        for (int k = 0; k < CELL_PIXELS; ++k)
            light[c][k] = c == 3 ? 1 : depth_shown(style, hidden[k]);
}

static void fill_strip(const Block *block, const BlockBase *base, const PixelStyle *style, int row,
                       Strip *strip)
{
    for (int column = 0; column < BLOCK_CELLS_ACROSS; ++column) {
        int at = row * BLOCK_CELLS_ACROSS + column;
        float light[CHANNELS][CELL_PIXELS];
        fill_behind(block, base, style, column, row, light);
        if (style->shows_depth)
            show_depth(block->hidden[at], style, light);
        else
            lay_over(&block->cells[at], light);
        if (base && block->rims && block->rims->any[at])
            lay_rims(block->rims, &block->cells[at], at, light);
        for (int c = 0; c < CHANNELS; ++c)
            for (int y = 0; y < CELL_HEIGHT; ++y)
                memcpy(&strip->light[c][y][column * CELL_WIDTH], &light[c][y * CELL_WIDTH],
                       CELL_WIDTH * sizeof(float));
    }
}

// Replaces squares of side x side samples by their mean.
SIMD_INLINE void average_squares(Strip *strip, int side)
{
    for (int c = 0; c < CHANNELS; ++c)
        for (int y = 0; y < CELL_HEIGHT / side; ++y)
            for (int x = 0; x < BLOCK_WIDTH / side; ++x) {
                float sum = 0;
                for (int k = 0; k < side * side; ++k)
                    sum += strip->light[c][y * side + k / side][x * side + k % side];
                strip->light[c][y][x] = sum / (float)(side * side);
            }
}

static void average(Strip *strip, int side)
{
    if (side == 2) average_squares(strip, 2);
    if (side == 4) average_squares(strip, 4);
}

// --- Colours, as in display.glsl.

// `behind`: the backing's colour in this channel, of which `share` is seen.
SIMD_INLINE float displayed(int kind, float light, float behind, float share)
{
    switch (kind) {
    case TONE_REINHARD:
        return srgb_from_linear(tone_over(tone_reinhard(light), behind, share));
    case TONE_FILMIC:
        return srgb_from_linear(tone_over(tone_filmic(light), behind, share));
    case TONE_NONE: // has no backing
        return srgb_from_linear(light);
    default:
        return light;
    }
}

// Converts a row to straight alpha and to colours of this tone. (Over a backing the image is opaque
// and has no alpha.)
SIMD_INLINE void display_as(Strip *restrict strip, int y, const float backing[4], int kind)
{
    for (int x = 0; x < BLOCK_WIDTH; ++x) {
        float alpha = strip->light[3][y][x], straight = 1 / simd_max(alpha, 1e-6f),
              share = backing[3] * (1 - alpha);
        for (int c = 0; c < 3; ++c)
            strip->light[c][y][x] =
                displayed(kind, strip->light[c][y][x] * straight, backing[c], share);
    }
}

static void display(Strip *strip, int y, const PixelStyle *style)
{
    if (style->tone == TONE_NONE) display_as(strip, y, style->backing, TONE_NONE);
    if (style->tone == TONE_REINHARD) display_as(strip, y, style->backing, TONE_REINHARD);
    if (style->tone == TONE_FILMIC) display_as(strip, y, style->backing, TONE_FILMIC);
    if (style->tone == TONE_LIGHT) display_as(strip, y, style->backing, TONE_LIGHT);
}

static void find_levels(const float light[BLOCK_WIDTH], float most_level,
                        int32_t levels[BLOCK_WIDTH])
{
    for (int x = 0; x < BLOCK_WIDTH; ++x)
        levels[x] = (int32_t)(simd_min(simd_max(light[x], 0), 1) * most_level + 0.5f);
}

static void store_8(const Strip *strip, int y, int channels, int width, uint8_t *to)
{
    int32_t levels[BLOCK_WIDTH];
    for (int c = 0; c < channels; ++c) {
        find_levels(strip->light[c][y], 255, levels);
        for (int x = 0; x < width; ++x) to[x * channels + c] = (uint8_t)levels[x];
    }
}

static void store_16(const Strip *strip, int y, int channels, int width, uint16_t *to)
{
    int32_t levels[BLOCK_WIDTH];
    for (int c = 0; c < channels; ++c) {
        find_levels(strip->light[c][y], 65535, levels);
        for (int x = 0; x < width; ++x) to[x * channels + c] = (uint16_t)levels[x];
    }
}

static void store_float(const Strip *strip, int y, int channels, int width, float *to)
{
    for (int c = 0; c < channels; ++c)
        for (int x = 0; x < width; ++x) to[x * channels + c] = strip->light[c][y][x];
}

static void store_row(Strip *strip, int y, const PixelStyle *style, const Image *image, int width,
                      void *to)
{
    if (image->kind != IMAGE_FLOAT) display(strip, y, style);
    if (image->kind == IMAGE_8)
        store_8(strip, y, image->channels, width, to);
    else if (image->kind == IMAGE_16)
        store_16(strip, y, image->channels, width, to);
    else
        store_float(strip, y, image->channels, width, to);
}

static bool is_row_clear(const Block *block, int row)
{
    float least_through = 1;
    for (int c = 0; c < BLOCK_CELLS_ACROSS; ++c)
        for (int k = 0; k < CELL_PIXELS; ++k)
            least_through =
                simd_min(least_through, block->cells[row * BLOCK_CELLS_ACROSS + c].through[k]);
    return least_through == 1;
}

void pixels_store(const Block *block, const BlockBase *base, const PixelStyle *style,
                  const Image *image)
{
    int s = style->samples, left = block->x / s, top = block->y / s,
        width = least_int(BLOCK_WIDTH / s, image->width - left),
        height = least_int(BLOCK_HEIGHT / s, image->height - top);
    size_t pixel = (size_t)image->channels * image_channel_size(image->kind),
           pitch = (size_t)image->width * pixel;
    uint8_t *to = image->pixels + (size_t)top * pitch + (size_t)left * pixel;
    const uint8_t *clear = NULL; // a finished row without hair, which others copy
    Strip strip;
    bool is_clear = false;
    for (int y = 0; y < height; ++y, to += pitch) {
        int row = y * s / CELL_HEIGHT, within = y % (CELL_HEIGHT / s);
        if (within == 0) is_clear = !base && is_row_clear(block, row);
        if (is_clear && clear) {
            memcpy(to, clear, (size_t)width * pixel);
            continue;
        }
        if (is_clear) clear = to;
        if (within == 0) {
            fill_strip(block, base, style, row, &strip);
            average(&strip, s);
        }
        store_row(&strip, within, style, image, width, to);
    }
}
