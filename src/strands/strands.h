// SPDX-License-Identifier: MIT
// The room strands: hair strands on the CPU as files describe them, polylines from root to tip.
//
// It measures and edits strands, and computes their colours and radii (paint.h) and their followers
// (follow_plan.h). Input: strands of files, which the room formats reads, and SectionParams.
// Output: Strands in metres, y up, which `sim` uploads to the GPU.
#pragma once

#include "base/error.h"
#include "strands/fibre.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// Strand s has the vertices first[s] .. first[s + 1] - 1, root first. Optional arrays are NULL if
// the source has none. The struct owns everything; a zeroed struct is a valid empty set.
typedef struct Strands {
    uint32_t strand_count;
    uint32_t vertex_count; // of all strands together
    uint32_t *first;       // [strand_count + 1]
    float (*position)[3];  // [vertex_count], metres, y up
    float *mobility;       // [vertex_count], TressFX 4's w, > 0 if movable; NULL: all but the roots
    float (*strand_uv)[2]; // [strand_count], texture coordinate at the root, 0..1
    float (*vertex_uv)[2]; // [vertex_count]
    float *strand_thickness; // [strand_count], factor or width as the file says (TressFX)
    float *strand_group;     // [strand_count] integers from 0: group of the groom
    float *vertex_thickness; // [vertex_count] widths, metres
    bool relative_widths;    // they have no unit: only their ratios count
    float (*color)[4];       // [vertex_count], linear RGB and opacity, 0..1
    uint32_t followers;      // per guide, as the file asks for
    float follower_radius;   // metres, largest distance from the guide; 0 if the file has none
    bool both_ends_fixed;    // tips are fixed, too
    double origin[3]; // m, y up: the place in the file's world where the positions have their zero;
                      // 0 unless the reader was asked to take it away (far from the world's zero)
    Fibre fibre;      // as the file says, in SI units whatever the unit of positions
    // Unit (m) and axis of positions that were converted for a file by strands_to_unit. Otherwise
    // unit is 0, and positions are in metres with y up.
    double unit;
    bool up_z;
} Strands;

// The optional arrays, of vertices and of strands: X(member, numbers per element, replacement for a
// number that is not finite).
#define STRANDS_ARRAYS_OF_VERTICES(X)                                                              \
    X(mobility, 1, 1) X(vertex_uv, 2, 0) X(vertex_thickness, 1, 1) X(color, 4, 1)
#define STRANDS_ARRAYS_OF_STRANDS(X)                                                               \
    X(strand_uv, 2, 0) X(strand_thickness, 1, 1) X(strand_group, 1, 0)

enum {
    STRANDS_MAX_SIZE = 65535,       // vertices of a strand that is simulated or drawn
    STRANDS_MOST_GROUP = 16777215,  // largest integer up to which float32 has all integers
    STRANDS_MAX_FOLLOWERS = 1000000 // per guide, in a file; every format can store it
};

// Allocates `first` and `position` (both zeroed), but no optional array. RESULT_FAILED when memory
// is short or a count exceeds 32-bit indices.
Result strands_create(Strands *strands, uint32_t strand_count, uint32_t vertex_count, Error *error);
void strands_destroy(Strands *strands);

// The number of vertices of strand s, from its root, that move with the head: the root, and those
// of mobility 0 before the first that may move.
uint32_t strands_held(const Strands *strands, uint32_t s);

// The number of strands with vertices of mobility 0 behind one that may move (fixed tips are not
// counted). These vertices are simulated.
uint32_t strands_held_elsewhere(const Strands *strands);

// The number of vertices of strand s.
static inline uint32_t strands_size(const Strands *strands, uint32_t s)
{
    return strands->first[s + 1] - strands->first[s];
}

// The length of strand s in metres: the sum of its segments.
double strands_length(const Strands *strands, uint32_t s);

// The axis-aligned bounding box of all vertices, metres; {0,0,0} twice for an empty set.
void strands_bounds(const Strands *strands, float low[3], float high[3]);

// Data of strands besides positions. Only data with information counts: texture coordinates that
// are all zero do not, nor a mobility of 0 at roots and 1 elsewhere.
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
    STRANDS_HAS_FIBRE = 1024,
};

// Whether no vertex has an opacity below 1.
bool strands_are_opaque(const Strands *strands);

// The features (bits above) that the strands have.
uint32_t strands_features(const Strands *strands);

// Writes the names of the features, separated by commas; "" if there are none.
void strands_features_describe(uint32_t features, char *text, size_t size);
