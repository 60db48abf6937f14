// SPDX-License-Identifier: MIT
#include "base/room.h"

#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>

enum { PAGE = 2 << 20 }; // bytes of a large page on most processors
enum { KEPT = 2 << 20 };

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

// glibc returns memory once twice the largest block with its own mapping that has been freed so far
// is free, and at first from 128 KiB on. So this acts as a larger image would, and unlike mallopt
// it leaves limits alone that the host has set.
void room_keep_freed(void)
{
    void *volatile block = malloc(KEPT); // volatile: otherwise compilers leave both calls out
    free(block);
}
