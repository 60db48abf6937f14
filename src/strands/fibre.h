// SPDX-License-Identifier: MIT
// How thick a strand is drawn when nobody says.
#pragma once

#include "base/params.h"
#include "strands/strands.h"

// Fibre radius at the root, metres, > 0, for drawing these strands with so many followers each.
//
// A head carries 100,000 hairs of about 40 um; files hold a few thousand, each of which stands for
// many. So the strands share out the picture instead: laid side by side they would cover the mean
// silhouette of the hair's box (a quarter of its surface, Cauchy) FIBRE_LAYERS times. Twice as many
// strands are drawn half as thick; the same hair in another unit looks the same. Kept between
// 1/5000 and 1/400 of the longest strand, for single strands and very dense fur.
float fibre_auto_radius(const Strands *strands, uint32_t followers);

// The section's radius if it says one, else that.
float fibre_radius(const SectionParams *params, const Strands *strands, uint32_t followers);
