// SPDX-License-Identifier: MIT
// What the hair stands on: a round piece of a level plane, which fades away from its middle.
#pragma once

#include "scene/outline.h"

typedef struct Floor {
    FloorKind kind;     // none: the rest does not matter
    float middle[3];    // m, in the world
    float whole, faded; // m from the middle: up to there it is whole, from there on gone
    float color[3];     // sRGB 0..1
} Floor;

// As the scene asks. Automatic is the height of the highest `ground` among its colliders or,
// without one, just below all that the sequence is expected to show. Around the middle of that it
// is as wide as what stands there and, for the shadows, as far again as that is high.
Floor floor_find(const Scene *scene, const Framing *framing);
