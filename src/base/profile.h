// SPDX-License-Identifier: MIT
// A number that varies along the strand: piecewise linear between points, from the root (0) to the
// tip (1).
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { PROFILE_MOST = 8 };

typedef struct Profile {
    uint32_t count;            // points; 0: constant
    float at[PROFILE_MOST];    // place as a share of the strand, ascending
    float value[PROFILE_MOST]; // value at that place
} Profile;

// A parameter of the kind PROFILE: the number, and its profile along the strand. With a profile,
// the number is its mean.
typedef struct ProfileNumber {
    float mean;
    Profile along;
} ProfileNumber;

// The value at `share` of the strand (0 .. 1), of a parameter with mean `mean` and profile `along`.
// Constant before the first point and after the last.
float profile_at(float mean, const Profile *along, double share);

// Parses "A", "A:B:C" (evenly spaced from root to tip) or "A:B@0.3:C" (B at 0.3; the first is at
// the root and the last at the tip unless given). False, with `number` unchanged, if it is not such
// a text, a value is outside of minimum .. maximum, places do not ascend within 0 .. 1, or there
// are more than PROFILE_MOST points.
bool profile_parse(ProfileNumber *number, const char *text, double minimum, double maximum);

// Writes text that profile_parse reads back exactly, cut at `size` (400 is enough).
void profile_format(const ProfileNumber *number, char *text, size_t size);
