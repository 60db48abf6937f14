// SPDX-License-Identifier: MIT
// The scene's colliders: their text and JSON forms, and their form for the GPU. The kinds are in
// the table glsl/common/collider_table.h.
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

// Bound of a shape's numbers.
#define COLLIDERS_FARTHEST 1e6

enum { COLLIDER_NUMBERS = 4 * COLLIDER_TEXELS };

// Metres. Directions are unit vectors, whatever the scene says.
typedef struct Collider {
    ColliderKind kind;
    bool world;                      // fixed to the world, otherwise to the head's frame
    float numbers[COLLIDER_NUMBERS]; // as many as the table lists
} Collider;

// A zeroed list is valid and empty.
typedef struct Colliders {
    Collider *list; // [count], owned
    uint32_t count;
} Colliders;

// Appends a shape with numbers, kind and frame as the user gave them. RESULT_USAGE for a radius
// below 0, a number beyond 1e6 or a direction of length 0; RESULT_FAILED when memory is short.
Result colliders_add(Colliders *colliders, const Collider *collider, Error *error);

// Appends the shapes of a text: "NAME:N,N,N,..." separated by ';', with "world:" before the name of
// a shape that does not follow the head. RESULT_USAGE with the text and what was expected; the list
// may have grown.
Result colliders_parse(Colliders *colliders, const char *text, Error *error);

// Appends the shapes of the value of "colliders" in a scene file: an array of {"sphere": [x, y, z,
// radius], "frame": "head" or "world"} and so on, or a text as above. RESULT_BAD_INPUT with the
// place, RESULT_FAILED when memory is short.
Result colliders_from_json(Colliders *colliders, const JsonPlace *place, const json_t *value,
                           Error *error);

// The array in the form that colliders_from_json reads. NULL when memory is short.
json_t *colliders_to_json(const Colliders *colliders);
void colliders_destroy(Colliders *colliders);

// The group in GPU memory that a kind belongs to, below COLLIDER_GROUPS.
uint32_t colliders_group(ColliderKind kind);

// Writes the data of a shape for sim/colliders.glsl. `rotation` (a unit quaternion x y z w) and
// `translation` (m) transform the shape's frame to the world. Cones: first point and radius in the
// world; unit axis and length L; g = growth of the radius per metre, g/sqrt(1 - g^2). Others: as in
// the table.
void colliders_pack(const Collider *collider, const float rotation[4], const float translation[3],
                    float texel[COLLIDER_TEXELS][4]);

// Whether the packed shape may reach into a ball (m).
bool colliders_reach(const Collider *collider, const float texel[COLLIDER_TEXELS][4],
                     const float centre[3], float radius);
