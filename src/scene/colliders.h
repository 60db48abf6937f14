// SPDX-License-Identifier: MIT
// What a scene says of the simple shapes that hair must not cross.
#pragma once

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

// How a shape is written: a word and so many numbers.
typedef enum ColliderKind {
    COLLIDER_SPHERE,  // x y z radius
    COLLIDER_CAPSULE, // x y z radius of either end: a rounded cone
    COLLIDER_GROUND,  // height: the half-space below it
    COLLIDER_PLANE,   // outward direction, height along it: the half-space behind
    COLLIDER_KINDS,
} ColliderKind;

enum { COLLIDER_NUMBERS = 8 };

// Metres. A plane's direction is of unit length, whatever the scene says.
typedef struct Collider {
    ColliderKind kind;
    bool world;                      // stands in the world, else in the head's frame; planes do
    float numbers[COLLIDER_NUMBERS]; // as many as collider_numbers(kind)
} Collider;

// A zeroed list is valid and empty.
typedef struct Colliders {
    Collider *list; // [count], owned
    uint32_t count;
} Colliders;

// The word of a kind, and how many numbers it has.
const char *collider_word(ColliderKind kind);
uint32_t collider_numbers(ColliderKind kind);

// Appends a shape, of which numbers, kind and frame are as the user gave them. RESULT_USAGE for a
// radius below 0, a number beyond 1e6 or a plane without direction;
// RESULT_FAILED when memory is short.
Result colliders_add(Colliders *colliders, const Collider *collider, Error *error);

// Appends what a text lists: shapes as "WORD:N,N,N,..." with ';' between them, "world:" before the
// word of one that does not follow the head. RESULT_USAGE with what was got and what was expected;
// the list may have grown.
Result colliders_parse(Colliders *colliders, const char *text, Error *error);
void colliders_destroy(Colliders *colliders);
