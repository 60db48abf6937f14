// SPDX-License-Identifier: MIT
#include "base/room.h"

#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>

enum { PAGE = 2 << 20 }; // bytes of a large page on most processors

void *room_new(size_t count, size_t size)
{
    if (count > (SIZE_MAX - PAGE) / size) return NULL;
    size_t bytes = count * size;
    if (bytes < PAGE) return malloc(bytes);
    void *memory = aligned_alloc(PAGE, (bytes + PAGE - 1) / PAGE * PAGE);
#ifdef MADV_HUGEPAGE
    if (memory) madvise(memory, bytes, MADV_HUGEPAGE); // only advice: it may fail
#endif
    return memory;
}

bool room_make(void *array, size_t *room, size_t count, size_t size)
{
    void **own = array, *memory;
    if (*room >= count) return true;
    free(*own);
    memory = room_new(count, size);
    *own = memory;
    *room = memory ? count : 0;
    return memory != NULL;
}
