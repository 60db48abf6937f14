// SPDX-License-Identifier: MIT
// Values that are costly to make and are often needed again: each has a key, counts its users, and
// is kept for a while when it has none.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct StockItem StockItem;

// Must not be used by several threads at once. Initialise with {.most = N}.
typedef struct Stock {
    StockItem *items; // the most recently taken first
    uint32_t most;    // number of items that are kept without users
} Stock;

// Adds a user to the value of a key of `size` bytes; NULL: there is no such value.
void *stock_take(Stock *stock, const void *key, size_t size);

// Adds a zeroed value of `value_size` bytes for that key, with one user. `destroy` destroys what
// the caller has put into it. NULL when memory is short.
void *stock_add(Stock *stock, const void *key, size_t size, size_t value_size,
                void (*destroy)(void *value));

// Removes a user. If more than `most` values have none, the least recently taken ones are
// destroyed.
void stock_return(Stock *stock, void *value);

// Iterates over all values: the first (`value` NULL), the next; NULL: no more.
void *stock_next(const Stock *stock, const void *value);

// Destroys all values, also those with users; `lost`: what they represent no longer exists, so only
// memory is freed.
void stock_destroy(Stock *stock, bool lost);
