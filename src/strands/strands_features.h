// SPDX-License-Identifier: MIT
// What a set of strands has besides positions, and what of it each kind of file holds: so that
// whatever gets lost on the way can be told.
#pragma once

#include "strands/strands_report.h"

// A bit for each. Only what says something counts: no texture coordinates that are all zero, no
// mobility of 0 at roots and 1 elsewhere.
enum {
    STRANDS_HAS_MOBILITY = 1,
    STRANDS_HAS_STRAND_UV = 2,
    STRANDS_HAS_VERTEX_UV = 4,
    STRANDS_HAS_STRAND_THICKNESS = 8,
    STRANDS_HAS_VERTEX_THICKNESS = 16,
    STRANDS_HAS_COLOR = 32,
    STRANDS_HAS_FOLLOWERS = 64,
    STRANDS_HAS_FOLLOWER_RADIUS = 128,
    STRANDS_HAS_FIXED_ENDS = 256,
};

// Those of the bits above that the strands have.
uint32_t strands_features(const Strands *strands);

// Those that a file of this kind holds as strands_write writes it.
uint32_t strands_kind_features(StrandsKind kind);

// Their names with commas between them, "" for none.
void strands_features_describe(uint32_t features, char *text, size_t size);
