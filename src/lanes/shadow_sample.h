// SPDX-License-Identifier: MIT
// A sample of the strands, which represents all of them in shadow maps.
#pragma once

#include "base/error.h"
#include "draw/mapped_caster.h"

// A zeroed struct is empty.
typedef struct ShadowSample {
    MappedCaster *casters; // [room], owned
    uint32_t room;
    float (*position)[4]; // [position_room], owned: of all casters, one after the other
    uint32_t (*paint)[4]; // [paint_room], owned
    size_t position_room, paint_room;
} ShadowSample;

// Takes one of every n neighbouring strands of each batch, with n as large as leaves at least
// `least` strands; all strands if there are fewer, or if `least` is 0. The sample is the same as
// long as the casters' numbers of strands are. Neighbours lie side by side in files and among
// followers, so no tuft loses more than others. Each strand of the sample has the weight of the
// strands that it represents. Runs on `parts` threads. RESULT_FAILED if memory is short.
Result shadow_sample_take(ShadowSample *sample, MappedCasters casters, int least, int parts,
                          MappedCasters *taken, Error *error);
void shadow_sample_destroy(ShadowSample *sample);
