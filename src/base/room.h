// SPDX-License-Identifier: MIT
// Large arrays whose content need not be kept when they grow. They lie on large pages where the
// system has them, since passes over hair touch them at random places.
#pragma once

#include <stdbool.h>
#include <stddef.h>

// Memory for `count` elements of `size` bytes (> 0), to be freed by free(). NULL if it is short.
void *room_new(size_t count, size_t size);

// If *array (owned; NULL if *room is 0) has room for fewer than `count` elements, replaces it by a
// new one of `count`. False if memory is short; *array is then NULL and *room 0.
bool room_make(void *array, size_t *room, size_t count, size_t size);

// Lets malloc keep a few MiB of freed memory for the next blocks, where it would return them to the
// system. A batch of small scenes then does not fault the same pages in again for each scene.
void room_keep_freed(void);
