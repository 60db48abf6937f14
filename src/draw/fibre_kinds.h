// SPDX-License-Identifier: MIT
// The kinds of fibres among the looks of an image: each scatters light from other fibres in a way
// of its own.
#pragma once

#include "draw/light_scene.h"
#include "draw/look.h"

// A zeroed struct is empty.
typedef struct FibreKinds {
    FibreLobes lobes[LIGHT_GRID_KINDS]; // [count], owned
    FibreTable table[LIGHT_GRID_KINDS];
    int count;
} FibreKinds;

// The kind of a look, which is added if it is new; looks that are too many share the last one.
// RESULT_FAILED if memory is short.
Result fibre_kinds_find(FibreKinds *kinds, const Look *look, int *kind, Error *error);

// Whether the look's kind is there.
bool fibre_kinds_know(const FibreKinds *kinds, const Look *look);

void fibre_kinds_destroy(FibreKinds *kinds); // leaves it empty
