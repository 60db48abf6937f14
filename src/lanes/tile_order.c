// SPDX-License-Identifier: MIT
#include "lanes/tile_order.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

// The number of cells of the hair's box along each axis, and of all cells.
enum { BITS = 4, SIDE = 1 << BITS, CELLS = 1 << (3 * BITS), W = STRAND_TILE };

static size_t count_tiles(const MappedCaster *caster)
{
    return ((size_t)caster->material.drawn_strands + W - 1) / W;
}

static bool make_room(TileOrder *order, size_t count)
{
    if (count <= order->room) return true;
    tile_order_destroy(order);
    order->all = malloc(count * sizeof *order->all);
    order->key = malloc(count * sizeof *order->key);
    if (order->all && order->key) order->room = count;
    return order->room > 0;
}

// The place of a tile: the middle of its first strand.
static const float *find_place(const MappedCaster *caster, size_t tile)
{
    size_t vertices = caster->material.vertex_count;
    return caster->position[(tile * vertices + vertices / 2) * W];
}

static void find_box(const MappedCaster *caster, size_t tiles, float low[3], float high[3])
{
    for (int k = 0; k < 3; ++k) low[k] = 1e6f, high[k] = -1e6f;
    for (size_t t = 0; t < tiles; ++t) {
        const float *x = find_place(caster, t);
        for (int k = 0; k < 3; ++k) { // NaN leaves them unchanged
            low[k] = x[k] < low[k] ? x[k] : low[k];
            high[k] = x[k] > high[k] ? x[k] : high[k];
        }
    }
}

// The key of a place: the bits of its cell's coordinates, interleaved (Morton order).
static uint32_t find_key(const float x[3], const float low[3], const float scale[3])
{
    uint32_t key = 0;
    for (int k = 0; k < 3; ++k) {
        float at = (x[k] - low[k]) * scale[k];
        uint32_t cell = at > 0 ? at < SIDE - 1 ? (uint32_t)at : SIDE - 1 : 0;
        for (int bit = 0; bit < BITS; ++bit) key |= (cell >> bit & 1) << (3 * bit + k);
    }
    return key;
}

static void sort(const MappedCaster *caster, size_t tiles, uint32_t *key, uint32_t *out)
{
    uint32_t first[CELLS + 1] = {0};
    float low[3], high[3], scale[3];
    find_box(caster, tiles, low, high);
    for (int k = 0; k < 3; ++k) scale[k] = SIDE / fmaxf(high[k] - low[k], 1e-6f);
    for (size_t t = 0; t < tiles; ++t) {
        key[t] = find_key(find_place(caster, t), low, scale);
        ++first[key[t] + 1];
    }
    for (int c = 0; c < CELLS; ++c) first[c + 1] += first[c];
    for (size_t t = 0; t < tiles; ++t) out[first[key[t]]++] = (uint32_t)t;
}

void tile_order_find(TileOrder *order, MappedCaster *casters, uint32_t count)
{
    size_t sum = 0;
    for (uint32_t i = 0; i < count; ++i) sum += count_tiles(&casters[i]);
    if (!make_room(order, sum)) return;
    sum = 0;
    for (uint32_t i = 0; i < count; ++i) {
        size_t tiles = count_tiles(&casters[i]);
        sort(&casters[i], tiles, order->key, order->all + sum);
        casters[i].order = order->all + sum;
        sum += tiles;
    }
}

void tile_order_destroy(TileOrder *order)
{
    free(order->all);
    free(order->key);
    *order = (TileOrder){0};
}
