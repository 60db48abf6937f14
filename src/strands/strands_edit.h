// SPDX-License-Identifier: MIT
// Changes of strands: which ones and in what order, several sets as one, shape and place.
#pragma once

#include "strands/strands.h"

// --- Shape and place: the numbers of strands and vertices stay.

// The root becomes the tip, with what belongs to each vertex; mobility stays at its place, since it
// is the root that is fixed.
void strands_reverse(Strands *strands);

// Smoothing passes: in each, every vertex but root and tip goes half-way to the middle between its
// neighbours: a binomial filter (1/4, 1/2, 1/4), after n passes close to a Gaussian of variance
// n / 2 vertices squared. Strands become shorter by what is smoothed away.
void strands_smooth(Strands *strands, uint32_t passes);

// A similarity: p' = scale * rotation * p + translation.
typedef struct StrandsMove {
    double scale;          // > 0
    double rotation[3][3]; // orthogonal
    double translation[3]; // metres
} StrandsMove;

// Nothing moves.
StrandsMove strands_move_none(void);

// About the axis 0 (x), 1 (y) or 2 (z), degrees, counter-clockwise seen from its tip.
StrandsMove strands_move_rotation(int axis, double angle_deg);

// In double, rounded once; by no move at all bits stay. Thickness of vertices (metres) and the
// followers' radius are scaled, too.
void strands_move(Strands *strands, const StrandsMove *move);

// To another unit and axis for writing: positions in units of `metres`, with z up (x, -z, y)
// or y up. The inverse of what reading with that unit and axis does.
void strands_to_unit(Strands *strands, double metres, bool up_z);

// --- Which strands, and in what order.

// Strand i < count becomes what strand which[i] was; those that are not named are gone.
// RESULT_FAILED when memory is short; then nothing has changed.
Result strands_pick(Strands *strands, const uint32_t *which, uint32_t count, Error *error);

// Keeps a random share (0 .. 1) of the strands, at least one, in their order; the same ones for the
// same seed and number of strands. Errors as above.
Result strands_thin(Strands *strands, double share, uint32_t seed, Error *error);

// Puts the strands in an order that depends on `seed` and their number only.
Result strands_shuffle(Strands *strands, uint32_t seed, Error *error);

// One set behind the other. Optional arrays and what a file asks for of followers are kept if all
// sets have them (followers: the same ones). RESULT_FAILED when memory is short or 32-bit indices
// are.
Result strands_join(Strands *all, const Strands *sets, uint32_t count, Error *error);

// Numbers the groups of joined sets: a strand's is that of its set, from 0. With `inner` a set that
// has groups keeps them apart, its numbers behind those of the sets before it. RESULT_FAILED when
// memory is short, or numbers are beyond STRANDS_MOST_GROUP.
Result strands_group_sets(Strands *all, const Strands *sets, uint32_t count, bool inner,
                          Error *error);

// Keeps the strands of one group, those without groups being of group 0. RESULT_BAD_INPUT, without
// a place, where there is none.
Result strands_pick_group(Strands *strands, double group, Error *error);
