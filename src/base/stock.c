// SPDX-License-Identifier: MIT
#include "base/stock.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

struct StockItem {
    StockItem *next;
    void (*destroy)(void *value);
    void *key;
    size_t size;
    uint32_t users;
    max_align_t value[];
};

static StockItem *item_of(const void *value)
{
    return (StockItem *)((char *)value - offsetof(StockItem, value));
}

static void end_item(StockItem *item, bool lost)
{
    if (!lost) item->destroy(item->value);
    free(item->key);
    free(item);
}

static void *put_first(Stock *stock, StockItem *item)
{
    item->next = stock->items;
    stock->items = item;
    ++item->users;
    return item->value;
}

void *stock_take(Stock *stock, const void *key, size_t size)
{
    for (StockItem **at = &stock->items, *item; (item = *at) != NULL; at = &item->next) {
        if (item->size != size || memcmp(item->key, key, size) != 0) continue;
        *at = item->next;
        return put_first(stock, item);
    }
    return NULL;
}

void *stock_add(Stock *stock, const void *key, size_t size, size_t value_size,
                void (*destroy)(void *value))
{
    StockItem *item = calloc(1, sizeof *item + value_size);
    void *copy = malloc(size);
    if (!item || !copy) {
        free(item);
        free(copy);
        return NULL;
    }
    memcpy(copy, key, size);
    *item = (StockItem){.destroy = destroy, .key = copy, .size = size};
    return put_first(stock, item);
}

void stock_return(Stock *stock, void *value)
{
    assert(item_of(value)->users > 0);
    --item_of(value)->users;
    uint32_t idle = 0;
    for (StockItem **at = &stock->items, *item; (item = *at) != NULL;) {
        if (item->users == 0 && ++idle > stock->most) {
            *at = item->next;
            end_item(item, false);
        } else {
            at = &item->next;
        }
    }
}

void *stock_next(const Stock *stock, const void *value)
{
    StockItem *item = value ? item_of(value)->next : stock->items;
    return item ? item->value : NULL;
}

void stock_destroy(Stock *stock, bool lost)
{
    while (stock->items) {
        StockItem *item = stock->items;
        stock->items = item->next;
        end_item(item, lost);
    }
}
