// SPDX-License-Identifier: MIT
#include "lanes/ribbon_store.h"

#include <stdlib.h>

Result ribbon_store_create(RibbonStore *store, size_t most, Error *error)
{
    *store = (RibbonStore){.keys = malloc(most * sizeof *store->keys),
                           .records = malloc(most * sizeof *store->records)};
    if (store->keys && store->records) return RESULT_OK;
    ribbon_store_destroy(store);
    return error_set(error, RESULT_FAILED, "no memory for %zu ribbons", most);
}

void ribbon_store_add(RibbonStore *store, const RibbonKey *keys, const RibbonRecord *records,
                      size_t slots)
{
    for (size_t i = 0; i < slots; ++i) {
        if (!keys[i].depth) continue;
        store->keys[store->count] = keys[i];
        store->records[store->count++] = records[i];
    }
}

void ribbon_store_destroy(RibbonStore *store)
{
    free(store->keys);
    free(store->records);
    *store = (RibbonStore){0};
}
