// SPDX-License-Identifier: MIT
// What inbetween.comp is given, for one batch of strands.
#include "common/shared.h"

UNIFORM_BLOCK(InbetweenParams, inbetween_params, BIND_STEP)
{
    vec4 earlier_rotation;    // quaternions x y z w: the head's frame -> world
    vec4 earlier_translation; // xyz, m
    vec4 later_rotation;
    vec4 later_translation;
    vec4 now_rotation;
    vec4 now_translation;
    float share; // of the way from earlier to later
    uint strand_count;
    uint vertex_count;
}
END_BLOCK(InbetweenParams, inbetween_params);
