// SPDX-License-Identifier: MIT
// Lists of points without strands: S times P points, strand after strand, as NeuralHaircut,
// GaussianHaircut and HAAR write them.
#pragma once

#include "strands/formats/format.h"

// Points of each strand: as the caller wishes, or found from where consecutive points jump. A jump
// is a distance above 4 times the median one; P divides the number of points, at least 9 of 10
// places between two strands are jumps, and at least 9 of 10 jumps lie there, which only one P can
// satisfy. Fails the reader if the wish does not divide the number or if there is no such P; notes
// what was found. The source need not have strands yet.
uint32_t cloud_find_size(FormatSource *source, Reader *reader, const float (*positions)[3],
                         uint32_t count);

// strands.first and place of strands of `size` points each; the source has them all.
void cloud_set_strands(FormatSource *source, uint32_t size);
