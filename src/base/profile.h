// SPDX-License-Identifier: MIT
// A number that differs along the strand: points between which it goes in straight lines, from the
// root (0) to the tip (1).
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { PROFILE_MOST = 8 };

typedef struct Profile {
    uint32_t count;            // of points; 0: the number is the same everywhere
    float at[PROFILE_MOST];    // share of the strand, ascending
    float value[PROFILE_MOST]; // there
} Profile;

// A parameter of the kind PROFILE: the number, and how it differs along the strand. Where it does,
// the number is its mean.
typedef struct ProfileNumber {
    float mean;
    Profile along;
} ProfileNumber;

// The profile `along` of a parameter whose number is `mean`, at `share` of the strand (0 .. 1);
// before its first point and behind its last it stays as there.
float profile_at(float mean, const Profile *along, double share);

// Reads "A", "A:B:C" (evenly spaced from root to tip) or "A:B@0.3:C" (B at 0.3; the first is at the
// root, the last at the tip, unless told). False, `number` unchanged: it is no such text, a value
// is outside of minimum .. maximum, places do not ascend within 0 .. 1, or there are more than
// PROFILE_MOST.
bool profile_parse(ProfileNumber *number, const char *text, double minimum, double maximum);

// Writes text that profile_parse reads back to the same bits, cut at `size` (400 is enough).
void profile_format(const ProfileNumber *number, char *text, size_t size);
