// SPDX-License-Identifier: MIT
// Makes hair: the thesis's test sets, and styles that look like hair.
#pragma once

#include "mesh/scalp.h"
#include "strands/strands.h"

typedef enum StrandsStyle {
    STRANDS_STYLE_RANDOM,   // chains of equal segments, each in a random direction (the thesis's
                            // sets)
    STRANDS_STYLE_STRAIGHT, // long hair, combed back, that falls around the head
    STRANDS_STYLE_CURLS,    // the same, wound into helices
    STRANDS_STYLE_FUR,      // short and upright, everywhere on a sphere
    STRANDS_STYLES
} StrandsStyle;

typedef struct StrandsRecipe {
    StrandsStyle style;
    ScalpShape shape;
    uint32_t count;         // strands, 1 .. 10^7
    uint32_t vertices;      // per strand, 2 .. 65535; count * vertices < 2^32 - 1
    float length;           // metres, 1e-3 .. 100: the longest strand's, along its segments
    float length_variation; // 0 .. 1: strands are shorter by up to this share
    float curl_radius;      // metres, 0 .. 1: at the tip; it grows from 0 at the root
    float curl_turns;       // 0 .. 1000, over the strand's length
    float curl_disorder; // 0 .. 1: 0: neighbouring curls are in phase; 1: each has a random phase
    uint32_t seed;
} StrandsRecipe;

// A recipe that looks good for the style.
StrandsRecipe strands_make_recipe(StrandsStyle style);

// Makes the strands; equal recipes give equal strands. Roots are evenly spread over the surface
// (scalp.h), and so are the first roots of any number. Every strand has a texture coordinate, its
// root's longitude and latitude, 0..1. Lengths are within 1 % of the recipe's (within rounding for
// random and straight strands). RESULT_USAGE names a value out of range, RESULT_FAILED when memory
// is short.
Result strands_make(Strands *strands, const StrandsRecipe *recipe, Error *error);

// The thesis's test sets "1k16", "1k32", "10k16", "10k32": thousands of strands x vertices of the
// random style, 0.25 m long, on the sphere's upper part. RESULT_USAGE for another name.
Result strands_make_set(Strands *strands, const char *name, uint32_t seed, Error *error);
