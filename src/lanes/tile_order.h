// SPDX-License-Identifier: MIT
// The order in which passes visit tiles of strands: neighbours in space follow each other, so that
// the texels and cells that they touch stay in the cache.
#pragma once

#include "draw/mapped_caster.h"

#include <stddef.h>

// Zeroed at the start.
typedef struct TileOrder {
    uint32_t *all; // [room], owned: of all casters, one after the other
    uint32_t *key; // [room], owned
    size_t room;
} TileOrder;

// Finds each caster's order from the middles of its strands, and sets its `order`. If memory is
// short casters have none: tiles are then visited by their numbers.
void tile_order_find(TileOrder *order, MappedCaster *casters, uint32_t count);

void tile_order_destroy(TileOrder *order);
