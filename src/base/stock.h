// SPDX-License-Identifier: MIT
// Things that are costly to make and that the next user will often want just so: each is kept under
// a key, counts its users, and stays for a while when it has none.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct StockItem StockItem;

// Not for several threads at once. Begins with {.most = N}.
typedef struct Stock {
    StockItem *items; // the one that was taken last first
    uint32_t most;    // items that have no user and still are kept
} Stock;

// The value under a key of `size` bytes, with one user more; NULL: there is none.
void *stock_take(Stock *stock, const void *key, size_t size);

// Room for a new value of `value_size` bytes under that key, zeroed, with one user. `destroy` ends
// what the value has become. NULL when memory is short.
void *stock_add(Stock *stock, const void *key, size_t size, size_t value_size,
                void (*destroy)(void *value));

// One user fewer. Where more than `most` values have none, those that were taken longest ago go.
void stock_return(Stock *stock, void *value);

// All values, for a search by what they are: the first (`value` NULL), the next; NULL: no more.
void *stock_next(const Stock *stock, const void *value);

// Ends all, whoever uses them; `lost`: what they stand for has gone already, only memory is freed.
void stock_destroy(Stock *stock, bool lost);
