// SPDX-License-Identifier: MIT
// Editing strands: selecting, ordering, joining, shape and place.
#pragma once

#include "strands/strands.h"

// --- Shape and place. The numbers of strands and vertices do not change.

// Makes the root the tip, with all vertex data except mobility, because the new root is the one
// that must be fixed.
void strands_reverse(Strands *strands);

// Smooths the strands. In each pass, every vertex except root and tip moves half-way to the
// midpoint of its neighbours. This is a binomial filter (1/4, 1/2, 1/4); n passes are close to a
// Gaussian of variance n / 2 vertices squared. Strands become shorter.
void strands_smooth(Strands *strands, uint32_t passes);

// A similarity: p' = scale * rotation * p + translation.
typedef struct StrandsMove {
    double scale;          // > 0
    double rotation[3][3]; // orthogonal
    double translation[3]; // metres
} StrandsMove;

// The identity.
StrandsMove strands_move_none(void);

// The rotation about axis 0 (x), 1 (y) or 2 (z) in degrees, counter-clockwise as seen from the tip
// of the axis.
StrandsMove strands_move_rotation(int axis, double angle_deg);

// Computes in double and rounds once; the identity leaves all bits unchanged. The origin is scaled
// and rotated. Vertex thickness
// (metres) and the followers' radius are scaled, too.
void strands_move(Strands *strands, const StrandsMove *move);

// Converts to another unit and axis for writing: positions in units of `metres`, with z up (x, -z,
// y) or y up. The inverse of reading with this unit and axis.
void strands_to_unit(Strands *strands, double metres, bool up_z);

// --- Far from the world's zero.

// Whether the positions have an origin, and this origin in another unit and axis.
bool strands_are_far(const Strands *strands);
void strands_find_origin(const Strands *strands, double metres, bool up_z, double origin[3]);

// Adds the origin (metres, y up) to the positions, which rounds them to float32.
void strands_give_back_origin(Strands *strands);

// --- Selecting and ordering.

// Strand i < count becomes the former strand which[i]; strands that are not listed are removed.
// RESULT_FAILED when memory is short; then nothing has changed.
Result strands_pick(Strands *strands, const uint32_t *which, uint32_t count, Error *error);

// Keeps a random share (0 .. 1) of the strands, at least one, in their order. The selection depends
// only on the seed and the number of strands. Errors as above.
Result strands_thin(Strands *strands, double share, uint32_t seed, Error *error);

// Puts the strands in a random order that depends only on the seed and their number.
Result strands_shuffle(Strands *strands, uint32_t seed, Error *error);

// Concatenates sets. Optional arrays are kept if all sets have them, the files' followers if they
// are the same in all sets. RESULT_FAILED when memory is short or 32-bit indices do not suffice.
Result strands_join(Strands *all, const Strands *sets, uint32_t count, Error *error);

// Numbers the groups of joined sets: a strand's group is the index of its set, from 0. With
// `inner`, the groups within a set stay separate and are numbered after those of the sets before.
// RESULT_FAILED when memory is short or a number exceeds STRANDS_MOST_GROUP.
Result strands_group_sets(Strands *all, const Strands *sets, uint32_t count, bool inner,
                          Error *error);

// Keeps the strands of one group; strands without groups are in group 0. RESULT_BAD_INPUT (without
// a place) if there are none.
Result strands_pick_group(Strands *strands, double group, Error *error);
