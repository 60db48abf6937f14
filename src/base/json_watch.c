// SPDX-License-Identifier: MIT
// A file of its own, so that the library does not contain it.
#include "base/json.h"

#include <stdlib.h>

static void *allocate(size_t size)
{
    void *block = malloc(size);
    if (!block) json_memory_note();
    return block;
}

void json_memory_watch(void)
{
    json_set_alloc_funcs(allocate, free);
}
