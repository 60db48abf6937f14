// SPDX-License-Identifier: MIT
// Lossless compression of floats. Each float becomes its distance, in units of the last place, from
// the float `stride` before. The distances are stored by byte planes, all lowest bytes first; each
// of the four planes is deflated if that makes it smaller. docs/cache.md describes the format.
#pragma once

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// An upper bound of the packed size of `count` floats.
size_t float_planes_bound(size_t count);

// Packs floats with any bits into `packed`, which must have room for the bound; `stride` >= 1.
// Returns the number of bytes used; 0 if memory is short. Deterministic.
size_t float_planes_pack(const float *values, size_t count, size_t stride, uint8_t *packed);

// Unpacks to exactly the same bits. `size` must be the packed size; for other data returns false
// and meaningless values, but never reads beyond `size`. False with errno ENOMEM if memory is
// short, otherwise errno is 0.
bool float_planes_unpack(float *values, size_t count, size_t stride, const uint8_t *packed,
                         size_t size);
