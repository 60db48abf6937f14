// SPDX-License-Identifier: MIT
// Some of the strands of hair, which stand for all of them in shadow maps.
#pragma once

#include "base/error.h"
#include "draw/mapped_caster.h"

// A zeroed struct is empty.
typedef struct ShadowSample {
    MappedCaster *casters; // [room], owned
    uint32_t room;
    float (*position)[4]; // [position_room], owned: of one caster behind the other
    uint32_t (*paint)[4]; // [paint_room], owned
    size_t position_room, paint_room;
} ShadowSample;

// Takes one of every so many neighbouring strands of each batch that no fewer than `least` strands
// remain, the same ones as long as the casters' numbers of strands are the same; all if there are
// fewer, or if `least` is 0. Neighbours stand beside each other in files and among followers, so
// that no tuft loses more than others. What is taken has the weight of those that it stands for.
// On `parts` threads. RESULT_FAILED if memory is short.
Result shadow_sample_take(ShadowSample *sample, MappedCasters casters, int least, int parts,
                          MappedCasters *taken, Error *error);
void shadow_sample_destroy(ShadowSample *sample);
