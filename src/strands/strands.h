// SPDX-License-Identifier: MIT
// The room strands: hair strands on the CPU, as files describe them: polylines from root to tip.
//
// It reads and writes hair files (strands_read.h, formats/format.h), mends what is wrong
// with them and reports it, measures and edits strands, and says how they are coloured and how
// thick they are (paint.h) and where their followers lie (follow_plan.h). It takes in files and
// SectionParams; it hands on Strands in metres, y up, which `sim` puts on the GPU.
#pragma once

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// Strand s has the vertices first[s] .. first[s + 1] - 1, root first. Optional arrays are NULL
// where the source has none. Everything is owned by the struct; a zeroed struct is a valid empty
// set.
typedef struct Strands {
    uint32_t strand_count;
    uint32_t vertex_count; // of all strands together
    uint32_t *first;       // [strand_count + 1]
    float (*position)[3];  // [vertex_count], metres, y up
    float *mobility; // [vertex_count], TressFX 4's w: > 0 may move; NULL: all but the root may
    float (*strand_uv)[2];   // [strand_count], texture coordinate at the root, 0..1
    float (*vertex_uv)[2];   // [vertex_count]
    float *strand_thickness; // [strand_count], factor or width as the file says (TressFX)
    float *strand_group; // [strand_count], whole numbers from 0: which part of the groom it is of
    float *vertex_thickness; // [vertex_count], metres (HAIR files)
    float (*color)[4];       // [vertex_count], linear RGB and opacity, 0..1
    uint32_t followers;      // followers that the file asks for, per guide
    float follower_radius;   // metres: how far from their guide; 0: the file does not say
    bool both_ends_fixed;    // the tips do not move either
    double unit;             // m, and axis of positions made ready for a file (strands_to_unit); 0:
    bool up_z;               // metres, y up, which holds everywhere else
} Strands;

// The arrays that a set may have or not, of vertices and of whole strands: X(member, numbers in an
// element, what mends a number that is not finite).
#define STRANDS_ARRAYS_OF_VERTICES(X)                                                              \
    X(mobility, 1, 1) X(vertex_uv, 2, 0) X(vertex_thickness, 1, 1) X(color, 4, 1)
#define STRANDS_ARRAYS_OF_STRANDS(X)                                                               \
    X(strand_uv, 2, 0) X(strand_thickness, 1, 1) X(strand_group, 1, 0)

enum {
    STRANDS_MAX_SIZE = 65535,      // vertices of one strand that is simulated or drawn
    STRANDS_MOST_GROUP = 16777215, // up to which float32 has all whole numbers
    STRANDS_MAX_FOLLOWERS =
        1000000 // that a file may ask for, per guide: every format holds as many
};

// Makes room: `first` (all zero), `position` (all zero), no optional array. RESULT_FAILED when
// memory is short or a count is beyond what 32-bit indices hold.
Result strands_create(Strands *strands, uint32_t strand_count, uint32_t vertex_count, Error *error);
void strands_destroy(Strands *strands);

// Vertices of strand s.
static inline uint32_t strands_size(const Strands *strands, uint32_t s)
{
    return strands->first[s + 1] - strands->first[s];
}

// Length of strand s, metres: the sum of its segments.
double strands_length(const Strands *strands, uint32_t s);

// Axis-aligned box around all vertices, metres; {0,0,0} twice for an empty set.
void strands_bounds(const Strands *strands, float low[3], float high[3]);

// What strands have besides positions. Only what says something counts: no texture coordinates that
// are all zero, no mobility of 0 at roots and 1 elsewhere.
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
    STRANDS_HAS_GROUP = 512,
};

// Whether no vertex's colour has an opacity below 1.
bool strands_are_opaque(const Strands *strands);

// Those of the bits above that the strands have.
uint32_t strands_features(const Strands *strands);

// Their names with commas between them, "" for none.
void strands_features_describe(uint32_t features, char *text, size_t size);
