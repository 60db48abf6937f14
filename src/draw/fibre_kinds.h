// SPDX-License-Identifier: MIT
// The kinds of fibres in an image. Looks whose fibres scatter light from other fibres in the same
// way share a kind.
#pragma once

#include "draw/light_scene.h"
#include "draw/look.h"

// A zeroed struct is empty.
typedef struct FibreKinds {
    FibreLobes lobes[LIGHT_GRID_KINDS]; // [count], owned
    FibreTable table[LIGHT_GRID_KINDS];
    int count;
} FibreKinds;

// The number of a look's kind, which is added if it is new. If there are too many kinds, further
// looks share the last one. RESULT_FAILED if memory is short.
Result fibre_kinds_find(FibreKinds *kinds, const Look *look, int *kind, Error *error);

// Whether the look's kind has been added.
bool fibre_kinds_know(const FibreKinds *kinds, const Look *look);

void fibre_kinds_destroy(FibreKinds *kinds); // leaves it empty
