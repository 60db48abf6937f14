// SPDX-License-Identifier: MIT
#include "scene/floor.h"

#include <math.h>
#include <string.h>

static const float GAP = 0.01f; // distance below the objects, in heights of the objects
static const float FADE = 3;    // radius at which the floor has faded out, over the opaque one

static float find_height(const Scene *scene, const Outline *all)
{
    float height = -INFINITY;
    for (uint32_t b = 0; b < scene->body_count; ++b) {
        const Colliders *colliders = &scene->bodies[b].colliders;
        for (uint32_t i = 0; i < colliders->count; ++i)
            if (colliders->list[i].kind == COLLIDER_GROUND)
                height = fmaxf(height, colliders->list[i].numbers[0]);
    }
    if (!scene->run.floor_height.automatic) return scene->run.floor_height.value;
    return height > -INFINITY ? height : all->low[1] - GAP * (all->high[1] - all->low[1]);
}

Floor floor_find(const Scene *scene, const Framing *framing)
{
    const Outline *all = &framing->all;
    Floor floor = {.kind = (FloorKind)scene->run.floor};
    if (floor.kind == FLOOR_NONE) return floor;
    memcpy(floor.color, scene->run.floor_color, sizeof floor.color);
    for (int k = 0; k < 3; ++k) floor.middle[k] = 0.5f * (all->low[k] + all->high[k]);
    floor.middle[1] = find_height(scene, all);
    float width = all->high[0] - all->low[0], length = all->high[2] - all->low[2],
          height = fmaxf(all->high[1] - floor.middle[1], 0);
    floor.whole = fmaxf(0.5f * hypotf(width, length) + height, 1e-3f);
    floor.faded = FADE * floor.whole;
    return floor;
}
