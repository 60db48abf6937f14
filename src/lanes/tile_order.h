// SPDX-License-Identifier: MIT
// The order in which tiles of strands are best walked: neighbours in space after each other, so
// that what they touch of maps and cells is still near the processor.
#pragma once

#include "draw/mapped_caster.h"

#include <stddef.h>

// Zeroed at the start.
typedef struct TileOrder {
    uint32_t *all; // [room], owned: of one caster behind the other
    uint32_t *key; // [room], owned
    size_t room;
} TileOrder;

// Finds each caster's order by where the middles of its strands are, and leaves it in the caster's
// `order`. Without memory casters have none: tiles are walked by their numbers.
void tile_order_find(TileOrder *order, MappedCaster *casters, uint32_t count);

void tile_order_destroy(TileOrder *order);
