// SPDX-License-Identifier: MIT
// What a scene says of the simple shapes that hair must not cross: their text and JSON, and what
// the GPU reads of them. The kinds are those of a table, glsl/common/collider_table.h.
#pragma once

#include "base/json.h"

#include "glsl/common/collider_table.h"

#include <stdbool.h>
#include <stdint.h>

typedef enum ColliderKind {
#define KIND(kind, name, numbers, frame) COLLIDER_##kind,
    COLLIDERS(KIND, KIND)
#undef KIND
        COLLIDER_KINDS,
} ColliderKind;

// The largest of a shape's numbers.
#define COLLIDERS_FARTHEST 1e6

enum { COLLIDER_NUMBERS = 4 * COLLIDER_TEXELS };

// Metres. Directions are of unit length, whatever the scene says.
typedef struct Collider {
    ColliderKind kind;
    bool world;                      // stands in the world, else in the head's frame
    float numbers[COLLIDER_NUMBERS]; // as many as the table says
} Collider;

// A zeroed list is valid and empty.
typedef struct Colliders {
    Collider *list; // [count], owned
    uint32_t count;
} Colliders;

// Appends a shape, of which numbers, kind and frame are as the user gave them. RESULT_USAGE for a
// radius below 0, a number beyond 1e6 or a direction of length 0; RESULT_FAILED when memory is
// short.
Result colliders_add(Colliders *colliders, const Collider *collider, Error *error);

// Appends what a text lists: shapes as "NAME:N,N,N,..." with ';' between them, "world:" before the
// name of one that does not follow the head. RESULT_USAGE with what was got and what was expected;
// the list may have grown.
Result colliders_parse(Colliders *colliders, const char *text, Error *error);

// Appends what the value of "colliders" in a scene file lists: an array of
// {"sphere": [x, y, z, radius], "frame": "head" or "world"} and so on, or a text as above.
// RESULT_BAD_INPUT with the place, RESULT_FAILED when memory is short.
Result colliders_from_json(Colliders *colliders, const JsonPlace *place, const json_t *value,
                           Error *error);

// The array that colliders_from_json reads back. NULL when memory is short.
json_t *colliders_to_json(const Colliders *colliders);
void colliders_destroy(Colliders *colliders);

// The group of shapes in GPU memory that a kind belongs to, below COLLIDER_GROUPS.
uint32_t colliders_group(ColliderKind kind);

// What sim/colliders.glsl reads of a shape in a frame that `rotation` (a unit quaternion x y z w)
// and `translation` (m) take into the world. Cones: first point and radius there; unit axis and
// length L; g = growth of the radius a metre, g/sqrt(1 - g^2). Others: as the table says.
void colliders_pack(const Collider *collider, const float rotation[4], const float translation[3],
                    float texel[COLLIDER_TEXELS][4]);

// Whether the packed shape may reach into a ball, m.
bool colliders_reach(const Collider *collider, const float texel[COLLIDER_TEXELS][4],
                     const float centre[3], float radius);
