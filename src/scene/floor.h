// SPDX-License-Identifier: MIT
// The floor: a round piece of a horizontal plane that fades out at its edge.
#pragma once

#include "scene/outline.h"

typedef struct Floor {
    FloorKind kind;     // FLOOR_NONE: the other members are unused
    float middle[3];    // m, in the world
    float whole, faded; // m from the middle: opaque up to `whole`, invisible from `faded` on
    float color[3];     // sRGB 0..1
} Floor;

// The floor of the scene. Its automatic height is that of the highest `ground` among the colliders;
// without one it is just below everything that the sequence is expected to show. It is as wide as
// that, plus its height to make room for shadows.
Floor floor_find(const Scene *scene, const Framing *framing);
