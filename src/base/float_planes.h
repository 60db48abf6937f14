// SPDX-License-Identifier: MIT
// Packs floats without loss: each becomes its distance in units of the last place from the one
// `stride` before. The distances are stored byte by byte, all lowest bytes first; each of these
// four planes is deflated if that makes it smaller. docs/cache.md has the format.
#pragma once

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// The most bytes that `count` floats take.
size_t float_planes_bound(size_t count);

// Packs floats of any bits into `packed`, which has room for the bound; `stride` >= 1. Returns the
// bytes used, 0 if memory is short. The same floats give the same bytes.
size_t float_planes_pack(const float *values, size_t count, size_t stride, uint8_t *packed);

// The same bits again. `size` bytes must be just what was packed: anything else gives false, and
// values that mean nothing. No bytes are read beyond `size`. False with errno ENOMEM if memory is
// short, else errno is 0.
bool float_planes_unpack(float *values, size_t count, size_t stride, const uint8_t *packed,
                         size_t size);
