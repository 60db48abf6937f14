// SPDX-License-Identifier: MIT
// Pulls chains along waypoints as the solvers do: the state consists of unit directions and
// lengths; positions are summed up at the end. A lane for each case; `spans` has the case's first
// point, segments, first waypoint and number of waypoints.
#include "common/shared.h"
#include "sim/tractrix.glsl"

#define GROUP_SIZE 8
layout(local_size_x = GROUP_SIZE) in;
#include "common/lane.glsl"
layout(std430, binding = BIND_STATE_OUT) readonly buffer Spans { uvec4 spans[]; };
layout(std430, binding = BIND_TIPS) readonly buffer Waypoints { vec4 waypoints[]; };
// Input: start points; output: results.
layout(std430, binding = BIND_POSITION_OUT) buffer Points { vec4 points[]; };

void main()
{
    int i = lane_index();
    if (i >= spans.length()) return;
    uvec4 span = spans[i];
    uint head = span.x, segments = span.y;
    vec3 x = points[head].xyz, before = x;
    for (uint j = head + 1u; j <= head + segments; ++j) {
        vec3 here = points[j].xyz;
        float L;
        vec3 d = tractrix_direction(here - before, L);
        points[j] = vec4(d, L);
        before = here;
    }
    for (uint m = 0u; m < span.w; ++m) {
        vec3 target = waypoints[span.z + m].xyz, move = target - x;
        x = target;
        for (uint j = head + 1u; j <= head + segments; ++j) {
            vec4 segment = points[j];
            segment.xyz = tractrix_renormalise(tractrix_turn(segment.xyz, segment.w, move));
            points[j] = segment;
        }
    }
    points[head] = vec4(x, 0.0);
    for (uint j = head + 1u; j <= head + segments; ++j) {
        x += points[j].w * points[j].xyz;
        points[j] = vec4(x, 0.0);
    }
}
