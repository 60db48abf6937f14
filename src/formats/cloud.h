// SPDX-License-Identifier: MIT
// Lists of points without strands: S times P points, strand after strand, as written by
// NeuralHaircut, GaussianHaircut and HAAR.
#pragma once

#include "formats/format.h"

// The number P of points per strand: given by the caller, or found from jumps between consecutive
// points. A jump is a distance of more than 4 times the median. P must divide the number of points,
// at least 9 of 10 boundaries between strands must be jumps, and at least 9 of 10 jumps must be at
// boundaries; only one P can satisfy this. Fails the reader if the caller's P does not divide the
// number or if no P is found. Notes a P that was found. The source need not have strands yet.
uint32_t cloud_find_size(FormatSource *source, Reader *reader, const float (*positions)[3],
                         uint32_t count);

// Sets strands.first and `place` for strands of `size` points each; the source must have their
// arrays.
void cloud_set_strands(FormatSource *source, uint32_t size);
