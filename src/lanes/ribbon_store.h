// SPDX-License-Identifier: MIT
// Ribbons that were moved out of the driver's buffers. Of a large groom most slots hold none, since
// straight stretches are one ribbon: 1,000,000 strands of 16 vertices take 30 million slots.
#pragma once

#include "base/error.h"
#include "lanes/ribbon_record.h"

#include <stddef.h>

// A zeroed struct is empty.
typedef struct RibbonStore {
    RibbonKey *keys;       // [most], owned
    RibbonRecord *records; // [most], owned
    size_t count;
} RibbonStore;

// Makes an empty store with room for `most` ribbons. The system gives the memory as it is written.
// RESULT_FAILED if memory is short.
Result ribbon_store_create(RibbonStore *store, size_t most, Error *error);

// Adds the ribbons of so many slots in their order; there must be room. Slots with depth 0 hold
// none.
void ribbon_store_add(RibbonStore *store, const RibbonKey *keys, const RibbonRecord *records,
                      size_t slots);

void ribbon_store_destroy(RibbonStore *store);
